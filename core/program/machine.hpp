// Straight-line arithmetic as machine code instead of a loop over instructions.
//
// A loop over instructions passes every result through memory and has branches that are hard to predict; both take
// longer than the arithmetic. In machine code, recent results stay in registers. It does the same operations in the
// same order, so the results are the same to the last bit. Loops are used if machine code is not available: on another
// processor, on a system that does not allow it, or in a build without ACHILLES_MACHINE_CODE.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace achilles {

// Immutable executable code.
class MachineCode {
 public:
    // Returns null if executable memory is not available. The code must be position-independent.
    static std::shared_ptr<const MachineCode> of(std::span<const std::uint8_t> bytes);
    ~MachineCode();
    MachineCode(const MachineCode&) = delete;
    MachineCode& operator=(const MachineCode&) = delete;

    // The function at this byte offset.
    template <class Function>
    Function* as(std::size_t offset = 0) const {
        return reinterpret_cast<Function*>(static_cast<std::uint8_t*>(memory_) + margin + offset);
    }

 private:
    static constexpr std::size_t margin = 16;  // sanitizers read bytes before a function
    MachineCode(void* memory, std::size_t size) : memory_(memory), size_(size) {}
    void* memory_;
    std::size_t size_;
};

// Number of doubles that an instruction processes. Four needs AVX2 (as does the code for one), eight AVX-512.
enum class Width : unsigned { one = 1, four = 4, eight = 8 };

// The widest vectors that this processor and system support. nullopt if machine code is not available, or if the
// environment variable ACHILLES_MACHINE_CODE is 0; programs compiled then use loops.
std::optional<Width> best_width();
// The variable is read once at program start, because other threads may change the environment later. This function
// reads it again.
void ask_environment_for_code();

struct Instruction;

// Code for these instructions of a program; the first writes register `first`. Its type is void(double* registers), or
// void(Double8* registers) for numbers of eight doubles with vectors of four or eight. May be null.
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first,
                                                Width of_number = Width::one, Width of_vector = Width::one);

}  // namespace achilles
