// Straight-line arithmetic as machine code: what an interpreter would look up step by step, laid out once.
//
// A loop over instructions passes each result on through memory and guesses at every turn what comes next; both take a
// processor longer than the arithmetic. Laid out as code, the last results stay in registers. The operations are those
// of the loop, in its order, so results are the same to the last bit. Where there can be no such code (another
// processor, a system that lets no program write code, a build without ACHILLES_MACHINE_CODE) the loops do the work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace achilles {

// Code that can be run, and never changes.
class MachineCode {
 public:
    // Nothing where that is not to be had. The bytes must do the same wherever they stand.
    static std::shared_ptr<const MachineCode> of(std::span<const std::uint8_t> bytes);
    ~MachineCode();
    MachineCode(const MachineCode&) = delete;
    MachineCode& operator=(const MachineCode&) = delete;

    // What begins at this byte.
    template <class Function>
    Function* as(std::size_t offset = 0) const {
        return reinterpret_cast<Function*>(static_cast<std::uint8_t*>(memory_) + margin + offset);
    }

 private:
    static constexpr std::size_t margin = 16;  // sanitizers look at what stands before a function
    MachineCode(void* memory, std::size_t size) : memory_(memory), size_(size) {}
    void* memory_;
    std::size_t size_;
};

// How many doubles an instruction works on; four need AVX2, as one does here, and eight AVX-512.
enum class Width : unsigned { one = 1, four = 4, eight = 8 };

// The widest that this processor and system can run; none where no code can, and none if the environment variable
// ACHILLES_MACHINE_CODE is 0: what is compiled then is run by loops.
std::optional<Width> best_width();
// The variable is read when the program starts: later, other threads may change the environment. This reads it again.
void ask_environment_for_code();

struct Instruction;

// Code of type void(double* registers) for these instructions of a program, the first of which writes register `first`; may be
// none. Of numbers of eight doubles it is of type void(Eight* registers), by vectors of four or of eight.
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first,
                                                Width of_number = Width::one, Width of_vector = Width::one);

}  // namespace achilles
