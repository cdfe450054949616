// Xbyak's code generator, extended by where each number of a function is stored and which numbers are in registers.
//
// Only the files that generate code include this, because it takes long to compile.
#pragma once

#include <xbyak/xbyak.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "program/machine.hpp"

namespace achilles {

// The memory operand at an offset, counted in doubles, from an address.
inline Xbyak::Address at(const Xbyak::Reg64& base, std::ptrdiff_t doubles) {
    return Xbyak::util::ptr[base + static_cast<std::size_t>(8 * doubles)];
}

// A number is identified by its index from an address in a general register. Of the vector registers 0 .. 15 the first
// `free` are for temporary use. The others cache results, which are also stored in memory; with vectors of eight,
// cache_in_all_registers() adds those up to 31.
class Assembler : public Xbyak::CodeGenerator {
 public:
    using Xmm = Xbyak::Xmm;
    using Operand = Xbyak::Operand;

    // Numbers are at (numbers, index), contiguous, one or eight doubles each.
    Assembler(const Xbyak::Reg64& numbers, unsigned free) : Assembler(numbers, free, Width::one, Width::one) {}
    // `of_vector` is the number of doubles that an instruction processes: the whole number, or four of eight (see
    // for_each_part()).
    Assembler(const Xbyak::Reg64& numbers, unsigned free, Width of_number, Width of_vector)
        : CodeGenerator(Xbyak::DEFAULT_MAX_CODE_SIZE, Xbyak::AutoGrow, &ordinary_memory),
          numbers_(numbers),
          free_(free),
          doubles_(static_cast<std::ptrdiff_t>(of_number)),
          wide_(of_vector),
          width_(of_vector) {
        setDefaultJmpNEAR(true);  // the distance of a forward jump is not known when it is emitted
    }
    // The complete code with its jumps resolved. It is position-independent.
    std::span<const std::uint8_t> bytes() {
        ready();
        return {getCode(), getSize()};
    }

    // ---- numbers ----

    // Width of the instructions.
    Width width() const { return width_; }
    // Calls `write` for each vector-wide part of the numbers. Cached registers belong to one part. If there are several
    // parts, no register stays cached before, between or after them.
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
    // Offset, in doubles, of the current part from the beginning of its number.
    std::ptrdiff_t part() const { return part_; }
    // Offset, in doubles, of a number from the first one, and the current part of a number as an operand.
    std::ptrdiff_t place(std::uint32_t index) const { return static_cast<std::ptrdiff_t>(index) * doubles_; }
    Xbyak::Address number(std::uint32_t index) const {
        if (!is_single(index) || width_ == Width::one) return at(numbers_, place(index) + part_);
        return Xbyak::util::ptr_b[numbers_ + static_cast<std::size_t>(8 * place(index))];
    }
    // A number that is in memory as one double, but in registers in all lanes. Needs vectors of eight.
    void make_single(std::uint32_t index) {
        single_.resize(std::max(single_.size(), index + std::size_t{1}));
        single_[index] = true;
    }
    // Computes such a number, as result(index), by instructions for one double.
    template <class Write>
    void compute_single(std::uint32_t index, const Write& write) {
        width_ = Width::one;
        write();
        width_ = wide_;
        const Xmm result = *holder(index);
        broadcast(result, Xmm(result.getIdx()));
    }
    bool is_single(std::uint32_t index) const { return index < single_.size() && single_[index]; }
    // A vector register of the instructions' width.
    Xmm vector(unsigned reg) const { return vector(reg, width_); }

    // A register for the result with this index. Its previous content is dropped from the cache.
    Xmm result(std::uint32_t index) {
        const unsigned reg = free_ + results_++ % room();
        if (const auto before = held_[reg]) {
            if (*before < last_use_.size() && last_use_[*before] >= position_) store(vector(reg), *before);
            holding_.erase(*before);
        }
        hold(index, reg);
        return vector(reg);
    }
    // From now on, a result is stored only if its register is reused while the result is still needed. `last_use` gives
    // the last position at which each number is used. set_position() gives the position of the code that follows.
    void store_when_needed(std::vector<std::size_t> last_use) { last_use_ = std::move(last_use); }
    void set_position(std::size_t position) { position_ = position; }
    // The register that caches a number, if any.
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
    // Records that the register holds a number. Registers beyond those of results keep it permanently.
    void hold(std::uint32_t index, unsigned reg) {
        if (reg < end_) held_[reg] = index;
        holding_[index] = reg;
    }
    // The number of results that can be cached at once.
    unsigned room() const { return end_ - free_; }
    void cache_in_all_registers() { end_ = 32; }

    void store(const Xmm& from, std::uint32_t index) {
        if (is_single(index) || wide_ == Width::one) return vmovsd(at(numbers_, place(index)), Xmm(from.getIdx()));
        vmovupd(at(numbers_, place(index) + part_), vector(static_cast<unsigned>(from.getIdx()), wide_));
    }
    void get(const Xmm& to, std::uint32_t index) {
        if (const auto held = holder(index)) return vmovapd(to, *held);  // vmovsd would depend on the old upper half
        if (is_single(index) && width_ != Width::one) return broadcast(to, at(numbers_, place(index)));
        width_ == Width::one ? vmovsd(to, number(index)) : vmovupd(to, number(index));
    }
    // The register that caches the number; otherwise loads the number into the given register and returns that.
    Xmm held_or(const Xmm& otherwise, std::uint32_t index) {
        if (const auto held = holder(index)) return *held;
        get(otherwise, index);
        return otherwise;
    }

    // Copies one double to all lanes.
    void broadcast(const Xmm& to, const Operand& from) {
        if (width_ == Width::eight) return vbroadcastsd(Xbyak::Zmm(to.getIdx()), from);
        vbroadcastsd(Xbyak::Ymm(to.getIdx()), from);
    }

    // ---- arithmetic ----

    // One operation as an instruction for a double and as one for vectors.
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
        const Xmm low(reg.getIdx());  // clears the whole register
        vxorpd(low, low, low);
    }

    // ---- functions ----

    // Start and end of a function that calls others. The first argument is kept in rbx, and the push aligns the stack
    // as calls require.
    void prologue() {
        push(rbx);
        mov(rbx, rdi);
    }
    void epilogue() {
        if (width_ != Width::one) vzeroupper();  // avoids slow transitions to code without wide vectors
        pop(rbx);
        ret();
    }
    // Calls a function with arguments in vector registers 0 and 1, rdi, rsi and rdx. Its result is in vector register
    // 0. All other registers are lost.
    void call(const void* function) {
        if (width_ != Width::one) vzeroupper();
        mov(rax, reinterpret_cast<std::uintptr_t>(function));
        CodeGenerator::call(rax);
        forget_all();
    }

 private:
    // Code is generated in ordinary memory; MachineCode copies it to memory that is executable and not writable.
    struct OrdinaryMemory : Xbyak::Allocator {
        bool useProtect() const override { return false; }
    };
    static inline OrdinaryMemory ordinary_memory;

    static Xmm vector(unsigned reg, Width width) {
        constexpr auto one = Operand::XMM, four = Operand::YMM, eight = Operand::ZMM;
        return {width == Width::one ? one : width == Width::four ? four : eight, static_cast<int>(reg)};
    }

    Xbyak::Reg64 numbers_;
    unsigned free_, end_ = 16;
    std::ptrdiff_t doubles_;  // per number
    Width wide_;              // width of the vectors of this code
    Width width_;             // width of the instructions that are being written
    std::ptrdiff_t part_ = 0;
    unsigned results_ = 0;
    std::vector<std::size_t> last_use_;  // empty if the caller stores all results
    std::size_t position_ = 0;
    std::vector<bool> single_;
    std::unordered_map<std::uint32_t, unsigned> holding_;  // from a number to the register that caches it
    std::array<std::optional<std::uint32_t>, 32> held_;    // and the inverse
};

}  // namespace achilles
