// Straight-line arithmetic as machine code: what an interpreter would look up step by step, laid out once.
//
// A loop over instructions passes each result on through memory and guesses at every turn what comes next; both take a
// processor longer than the arithmetic. Laid out as code, the last results stay in registers. The operations are those
// of the loop, in its order, so results are the same to the last bit. Where there can be no such code (another
// processor, a system that lets no program write code) the loops do the work.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
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
enum class Width : unsigned { one = 1, two = 2, four = 4, eight = 8 };

// The widest that this processor and system can run; none where no code can.
std::optional<Width> best_width();

// Writes x86-64 code on doubles (AVX encodings: three operands). A number stands at an index, counted in doubles, from
// an address in a register of the processor. Of the vector registers 0 .. 15 the first few are free for use; results
// are kept in the others as long as there is room, besides being stored.
class Assembler {
 public:
    enum class Base : unsigned {
        rax = 0,
        rcx = 1,
        rdx = 2,
        rbx = 3,
        rsi = 6,
        rdi = 7,
        r8 = 8,
        r9 = 9,
        r10 = 10,
        r11 = 11
    };
    enum class Code : std::uint8_t {
        load = 0x10,
        store = 0x11,
        unpack = 0x14,     // the low halves of two
        load_high = 0x16,  // the low half, and a number from memory
        sqrt = 0x51,
        both = 0x54,  // bitwise and
        exclusive_or = 0x57,
        add = 0x58,
        multiply = 0x59,
        subtract = 0x5C,
        divide = 0x5E
    };

    // Numbers of the function stand at (numbers, index), `width` doubles each, one after the other.
    Assembler(Base numbers, unsigned free, Width width = Width::one) : numbers_(numbers), free_(free), width_(width) {}

    // ---- numbers ----

    // A register for the result with this index. What it held is forgotten.
    unsigned result(std::uint32_t index);
    void store(unsigned reg, std::uint32_t index) { memory(Code::store, width_, reg, numbers_, place(index)); }
    // to = number
    void get(unsigned to, std::uint32_t index);
    // to = from op number, and op(number) for sqrt; from the register that holds it, or from memory.
    void apply(Code code, unsigned to, unsigned from, std::uint32_t index);
    // to = a op b, both numbers
    void combine(Code code, unsigned to, std::uint32_t a, std::uint32_t b);
    // The register that holds a number.
    std::optional<unsigned> holder(std::uint32_t index) const;
    void forget_all();
    // From here on this register is known to hold a number; one past those of results holds it for good.
    void hold(std::uint32_t index, unsigned reg);
    // How many results are held at once.
    unsigned room() const { return 16 - free_; }

    // ---- vectors ----

    // to = from op other
    void registers(Code code, Width width, unsigned to, unsigned from, unsigned other);
    // to = from op the doubles at (base, index); loads and stores have no `from`.
    void memory(Code code, Width width, unsigned to, unsigned from, Base base, std::ptrdiff_t index);
    void memory(Code code, Width width, unsigned reg, Base base, std::ptrdiff_t index) {
        memory(code, width, reg, 0, base, index);
    }
    // Into all places of a register.
    void broadcast(Width width, unsigned to, Base base, std::ptrdiff_t index);
    // to = the first half of `low`, then `high`; `width` of the result.
    void join(Width width, unsigned to, unsigned low, unsigned high);
    void zero(unsigned reg) { registers(Code::exclusive_or, Width::two, reg, reg, reg); }
    // -0.0 in all places of a register
    void negative_zero(unsigned reg);

    // ---- addresses and jumps ----

    // to = from + so many doubles
    void address(Base to, Base from, std::ptrdiff_t doubles);
    // to = the address that stands at (base, index), and the other way round.
    void load_address(Base to, Base base, std::ptrdiff_t index) { integer(0x8B, to, base, index); }
    void store_address(Base from, Base base, std::ptrdiff_t index) { integer(0x89, from, base, index); }
    // A jump forward to where land() is called with what this returns, if a >= b; a jump back to a place if a < b.
    std::size_t jump_if_not_below(Base a, Base b);
    // The same if the number in a register is not above one in memory, or one of them is none.
    std::size_t jump_if_not_above(unsigned reg, Base base, std::ptrdiff_t index);
    void land(std::size_t jump);
    void jump_back_if_below(Base a, Base b, std::size_t place);
    void jump_back_if_not_above(Base a, Base b, std::size_t place);
    void jump_back(std::size_t place);
    std::size_t here() const { return bytes_.size(); }

    // ---- functions ----

    // Begin and end of a function that calls others: its first argument is kept in rbx.
    void enter();
    void leave();
    // End of one that calls none, after work on vectors.
    void leave_at_once();
    void integer_argument(Base to, std::int32_t value);
    // Calls a function with arguments in vector registers 0 and 1, rdi, rsi and rdx: its result is in 0, all others are
    // lost.
    void call(const void* function);

    Width width() const { return width_; }
    // Where a number of the function stands, in doubles.
    std::ptrdiff_t place(std::uint32_t index) const {
        return static_cast<std::ptrdiff_t>(index) * static_cast<std::ptrdiff_t>(width_);
    }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
    // What the second operand is: a register, or memory at a base.
    struct Operand {
        unsigned reg = 0;
        bool in_memory = false;
        std::int32_t displacement = 0;
    };
    struct Prefix {
        unsigned map = 1, pp = 1;  // opcode map; 1: packed, 3: scalar
        bool wide = false;
    };

    void put(unsigned byte) { bytes_.push_back(static_cast<std::uint8_t>(byte)); }
    void put(std::uint64_t value, unsigned count);
    void encode(const Prefix& prefix, Width width, unsigned opcode, unsigned reg, unsigned from, const Operand& other);
    // A 64-bit instruction between a register and (base, index).
    void integer(unsigned opcode, Base reg, Base base, std::ptrdiff_t index);
    void compare(Base a, Base b);
    // Else code that knows of no wider vectors is slow.
    void clear_upper_halves();

    Base numbers_;
    unsigned free_;
    Width width_;
    std::vector<std::uint8_t> bytes_;
    unsigned results_ = 0;
    std::unordered_map<std::uint32_t, unsigned> holding_;  // the register that holds a number
    std::array<std::optional<std::uint32_t>, 16> held_;    // and the other way round
};

}  // namespace achilles
