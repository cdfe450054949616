// Straight-line arithmetic as machine code: what an interpreter would look up step by step, laid out once.
//
// A loop over instructions passes each result on through memory and guesses at every turn what comes next; both take a
// processor longer than the arithmetic. Laid out as code, the last results stay in registers. The operations are those
// of the loop, in its order, so results are the same to the last bit. Where there can be no such code (another
// processor, a system that lets no program write code) the loops do the work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace achilles {

// Code that can be run, and never changes.
class MachineCode {
 public:
    // Nothing where that is not to be had.
    static std::shared_ptr<const MachineCode> of(const std::vector<std::uint8_t>& bytes);
    ~MachineCode();
    MachineCode(const MachineCode&) = delete;
    MachineCode& operator=(const MachineCode&) = delete;

    template <class Function>
    Function* as() const {
        return reinterpret_cast<Function*>(static_cast<std::uint8_t*>(memory_) + margin);
    }

 private:
    static constexpr std::size_t margin = 16;  // sanitizers look at what stands before a function
    MachineCode(void* memory, std::size_t size) : memory_(memory), size_(size) {}
    void* memory_;
    std::size_t size_;
};

// Writes x86-64 code on doubles. Numbers stand at (base, index): the base is a pointer in a register of the processor.
// The last results are kept in xmm2 .. xmm15, besides being stored; xmm0 and xmm1 are free for use.
class Assembler {
 public:
    enum class Base : unsigned { kept = 3, second = 6, first = 7 };  // rbx, rsi, rdi: by the calling convention
    enum class Code : std::uint8_t {
        load = 0x10,
        store = 0x11,
        sqrt = 0x51,
        add = 0x58,
        multiply = 0x59,
        subtract = 0x5C,
        divide = 0x5E
    };

    explicit Assembler(Base base) : base_(base) {}
    // Begin and end of a function that calls others: its first argument is kept.
    void enter();
    void leave();
    void leave_at_once() { put(0xC3); }

    // A register for the result with this index. What it held is forgotten.
    unsigned result(std::uint32_t index);
    void store(unsigned reg, std::uint32_t index) { memory(Code::store, reg, base_, index); }
    // reg = reg op number, or op(number) for load and sqrt; from the register that holds it, or from memory.
    void apply(Code code, unsigned reg, std::uint32_t index);
    void registers(Code code, unsigned reg, unsigned other);
    void memory(Code code, unsigned reg, Base base, std::size_t index);
    // reg = -0.0
    void negative_zero(unsigned reg);
    void integer_argument(std::int32_t value);
    // Calls a function with arguments in xmm0, xmm1, edi: its result is in xmm0, all other registers are lost.
    void call(const void* function);

    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
    void put(unsigned byte) { bytes_.push_back(static_cast<std::uint8_t>(byte)); }
    void put(std::uint64_t value, unsigned count);
    void prefix(Code code, unsigned reg, unsigned other);

    Base base_;
    std::vector<std::uint8_t> bytes_;
    unsigned results_ = 0;
    std::map<std::uint32_t, unsigned> holding_;  // the register that holds a number
    std::map<unsigned, std::uint32_t> held_;     // and the other way round
};

}  // namespace achilles
