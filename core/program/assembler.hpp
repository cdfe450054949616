// Xbyak's code generator, with the numbers of a function in mind: where each stands, and which are still in a register.
//
// Only the files that write code include this: it takes long to compile.
#pragma once

#include <xbyak/xbyak.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>

#include "program/machine.hpp"

namespace achilles {

// What stands so many doubles behind an address.
inline Xbyak::Address at(const Xbyak::Reg64& base, std::ptrdiff_t doubles) {
    return Xbyak::util::ptr[base + static_cast<std::size_t>(8 * doubles)];
}

// A number stands at an index from an address in a register of the processor. Of the vector registers 0 .. 15 the first
// few are free for use; results are kept in the others as long as there is room, besides being stored.
class Assembler : public Xbyak::CodeGenerator {
 public:
    using Xmm = Xbyak::Xmm;
    using Operand = Xbyak::Operand;

    // Numbers of the function stand at (numbers, index), one double each or eight, one after the other.
    Assembler(const Xbyak::Reg64& numbers, unsigned free) : Assembler(numbers, free, Width::one, Width::one) {}
    // An instruction works on a whole number or, of eight doubles, on four: see for_each_part().
    Assembler(const Xbyak::Reg64& numbers, unsigned free, Width of_number, Width of_vector)
        : CodeGenerator(Xbyak::DEFAULT_MAX_CODE_SIZE, Xbyak::AutoGrow, &ordinary_memory),
          numbers_(numbers),
          free_(free),
          doubles_(static_cast<std::ptrdiff_t>(of_number)),
          width_(of_vector) {
        setDefaultJmpNEAR(true);  // how far a jump forward goes is not known when it is written
    }
    // All that was written, its jumps in place; wherever it is copied to, it does the same.
    std::span<const std::uint8_t> bytes() {
        ready();
        return {getCode(), getSize()};
    }

    // ---- numbers ----

    // Of an instruction.
    Width width() const { return width_; }
    // Does for each part of the numbers that is as wide as a vector what `write` writes for one. Registers hold what belongs
    // to the part; where there are several, none of it is left for what comes before or after.
    template <class Write>
    void for_each_part(const Write& write) {
        const auto wide = static_cast<std::ptrdiff_t>(width_);
        if (wide == doubles_) return write();
        for (part_ = 0; part_ < doubles_; part_ += wide) {
            forget_all();
            write();
        }
        forget_all();
        part_ = 0;
    }
    // How many doubles from the beginning of a number its part begins that is worked on.
    std::ptrdiff_t part() const { return part_; }
    // How many doubles from the first number another one begins; and its part as an operand.
    std::ptrdiff_t place(std::uint32_t index) const { return static_cast<std::ptrdiff_t>(index) * doubles_; }
    Xbyak::Address number(std::uint32_t index) const { return at(numbers_, place(index) + part_); }
    // A register as wide as an instruction.
    Xmm vector(unsigned reg) const {
        constexpr auto one = Operand::XMM, four = Operand::YMM, eight = Operand::ZMM;
        return {width_ == Width::one ? one : width_ == Width::four ? four : eight, static_cast<int>(reg)};
    }

    // A register for the result with this index. What it held is forgotten.
    Xmm result(std::uint32_t index) {
        const unsigned reg = free_ + results_++ % room();
        if (held_[reg]) holding_.erase(*held_[reg]);
        hold(index, reg);
        return vector(reg);
    }
    // The register that holds a number.
    std::optional<Xmm> holder(std::uint32_t index) const {
        const auto found = holding_.find(index);
        if (found == holding_.end()) return std::nullopt;
        return vector(found->second);
    }
    void forget_all() {
        held_.fill(std::nullopt);
        holding_.clear();
        results_ = 0;
    }
    // From here on this register is known to hold a number; one past those of results holds it for good.
    void hold(std::uint32_t index, unsigned reg) {
        if (reg < held_.size()) held_[reg] = index;
        holding_[index] = reg;
    }
    // How many results are held at once.
    unsigned room() const { return 16 - free_; }

    void store(const Xmm& from, std::uint32_t index) {
        width_ == Width::one ? vmovsd(number(index), from) : vmovupd(number(index), from);
    }
    void get(const Xmm& to, std::uint32_t index) {
        if (const auto held = holder(index)) return vmovapd(to, *held);  // vmovsd would wait for the other half
        width_ == Width::one ? vmovsd(to, number(index)) : vmovupd(to, number(index));
    }
    // The register that holds a number, or else this one, with it.
    Xmm held_or(const Xmm& otherwise, std::uint32_t index) {
        if (const auto held = holder(index)) return *held;
        get(otherwise, index);
        return otherwise;
    }

    // The same double everywhere.
    void broadcast(const Xmm& to, const Operand& from) {
        if (width_ == Width::eight) return vbroadcastsd(Xbyak::Zmm(to.getIdx()), from);
        vbroadcastsd(Xbyak::Ymm(to.getIdx()), from);
    }

    // ---- arithmetic ----

    // The instruction for one double, and that for a vector of them.
    struct Arithmetic {
        void (Xbyak::CodeGenerator::*one)(const Xmm&, const Operand&, const Operand&);
        void (Xbyak::CodeGenerator::*vector)(const Xmm&, const Operand&, const Operand&);
    };
    static constexpr Arithmetic vadd{&CodeGenerator::vaddsd, &CodeGenerator::vaddpd},
        vsub{&CodeGenerator::vsubsd, &CodeGenerator::vsubpd}, vmul{&CodeGenerator::vmulsd, &CodeGenerator::vmulpd},
        vdiv{&CodeGenerator::vdivsd, &CodeGenerator::vdivpd};

    // to = from op other
    void apply(Arithmetic op, const Xmm& to, const Xmm& from, const Operand& other) {
        (this->*(width_ == Width::one ? op.one : op.vector))(to, from, other);
    }
    // to = from op number
    void apply(Arithmetic op, const Xmm& to, const Xmm& from, std::uint32_t index) {
        if (const auto held = holder(index)) return apply(op, to, from, *held);
        apply(op, to, from, number(index));
    }
    // to = a op b, both numbers
    void combine(Arithmetic op, const Xmm& to, std::uint32_t a, std::uint32_t b) { apply(op, to, held_or(to, a), b); }
    // to = -number
    void negate(const Xmm& to, std::uint32_t index) {
        const Xmm one(to.getIdx());
        mov(rax, std::uint64_t{1} << 63);  // -0.0
        vmovq(one, rax);
        if (width_ != Width::one) broadcast(to, one);
        apply(vsub, to, to, index);
    }
    // to = sqrt(number)
    void sqrt(const Xmm& to, std::uint32_t index) {
        const auto write = [&](const Operand& other) {
            width_ == Width::one ? vsqrtsd(to, to, other) : vsqrtpd(to, other);
        };
        if (const auto held = holder(index)) return write(*held);
        write(number(index));
    }
    void zero(const Xmm& reg) {
        const Xmm low(reg.getIdx());  // the rest of the register follows
        vxorpd(low, low, low);
    }

    // ---- functions ----

    // Begin and end of a function that calls others: its first argument is kept in rbx, and the stack is where a call
    // wants it.
    void prologue() {
        push(rbx);
        mov(rbx, rdi);
    }
    void epilogue() {
        if (width_ != Width::one) vzeroupper();  // else code that knows of no wider vectors is slow
        pop(rbx);
        ret();
    }
    // Calls a function with arguments in vector registers 0 and 1, rdi, rsi and rdx: its result is in 0, all others are
    // lost.
    void call(const void* function) {
        if (width_ != Width::one) vzeroupper();
        mov(rax, reinterpret_cast<std::uintptr_t>(function));
        CodeGenerator::call(rax);
        forget_all();
    }

 private:
    // Code is written where it cannot be run, and MachineCode makes it what can be run and not written.
    struct OrdinaryMemory : Xbyak::Allocator {
        bool useProtect() const override { return false; }
    };
    static inline OrdinaryMemory ordinary_memory;

    Xbyak::Reg64 numbers_;
    unsigned free_;
    std::ptrdiff_t doubles_;  // of a number
    Width width_;
    std::ptrdiff_t part_ = 0;
    unsigned results_ = 0;
    std::unordered_map<std::uint32_t, unsigned> holding_;  // the register that holds a number
    std::array<std::optional<std::uint32_t>, 16> held_;    // and the other way round
};

}  // namespace achilles
