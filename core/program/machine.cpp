#include "program/machine.hpp"

#include <cstring>

#if defined(__x86_64__) && defined(__linux__)
#include <sys/mman.h>
#endif

namespace achilles {

#if defined(__x86_64__) && defined(__linux__)

// Written first, made executable then, and never both at once.
std::shared_ptr<const MachineCode> MachineCode::of(const std::vector<std::uint8_t>& bytes) {
    const std::size_t size = margin + bytes.size();
    void* const memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return nullptr;
    std::shared_ptr<const MachineCode> code(new MachineCode(memory, size));
    std::memcpy(static_cast<std::uint8_t*>(memory) + margin, bytes.data(), bytes.size());
    if (mprotect(memory, size, PROT_READ | PROT_EXEC) != 0) return nullptr;
    return code;
}

MachineCode::~MachineCode() { munmap(memory_, size_); }

std::optional<Width> best_width() {
    static const std::optional<Width> widest = []() -> std::optional<Width> {
        __builtin_cpu_init();
        if (!__builtin_cpu_supports("avx2")) return std::nullopt;
        return __builtin_cpu_supports("avx512f") ? Width::eight : Width::four;
    }();
    return widest;
}

#else

std::shared_ptr<const MachineCode> MachineCode::of(const std::vector<std::uint8_t>&) { return nullptr; }
MachineCode::~MachineCode() = default;
std::optional<Width> best_width() { return std::nullopt; }

#endif

namespace {

constexpr unsigned packed = 1, scalar = 3;  // pp of an instruction's prefix
constexpr unsigned rm(unsigned reg) { return reg & 7u; }

}  // namespace

void Assembler::put(std::uint64_t value, unsigned count) {
    for (unsigned i = 0; i < count; ++i) put(static_cast<unsigned>(value >> 8 * i & 0xFFu));
}

// VEX, or EVEX for eight doubles. A displacement is one byte where that is enough; EVEX counts it in operands.
void Assembler::encode(const Prefix& prefix, Width width, unsigned opcode, unsigned reg, unsigned from,
                       const Operand& other) {
    const unsigned high = (reg > 7 ? 0u : 0x80u) | 0x40u | (other.reg > 7 ? 0u : 0x20u), source = (~from & 15u) << 3;
    std::int32_t unit = 1;
    if (width == Width::eight) {
        const auto low = [](unsigned number, unsigned bit) { return number & bit ? 0u : 1u; };  // bits are inverted
        put(0x62);
        put(low(reg, 8) << 7 | low(other.reg, 16) << 6 | low(other.reg, 8) << 5 | low(reg, 16) << 4 | prefix.map);
        put((prefix.wide ? 0x80u : 0u) | source | 4u | prefix.pp);
        put(0x40u | low(from, 16) << 3);
        unit = prefix.map == 2 ? 8 : 64;  // map 2: the broadcast
    } else {
        const unsigned rest = source | (width == Width::four ? 4u : 0u) | prefix.pp;
        if (prefix.map == 1 && !prefix.wide && other.reg < 8) {
            put(0xC5);
            put((high & 0x80u) | rest);
        } else {
            put(0xC4);
            put(high | prefix.map);
            put((prefix.wide ? 0x80u : 0u) | rest);
        }
    }
    put(opcode);
    if (!other.in_memory) return put(0xC0u | rm(reg) << 3 | rm(other.reg));
    const std::int32_t near = other.displacement / unit;
    const bool short_form = near * unit == other.displacement && near >= -128 && near <= 127;
    put((short_form ? 0x40u : 0x80u) | rm(reg) << 3 | rm(other.reg));
    put(static_cast<std::uint32_t>(short_form ? near : other.displacement), short_form ? 1 : 4);
}

void Assembler::registers(Code code, Width width, unsigned to, unsigned from, unsigned other) {
    const bool one = width == Width::one;
    if (code == Code::load)  // vmovapd: vmovsd would wait for the other half of a register
        return encode({.pp = packed, .wide = width == Width::eight}, one ? Width::two : width, 0x28, to, 0, {other});
    encode({.pp = one ? scalar : packed, .wide = width == Width::eight}, width, static_cast<unsigned>(code), to,
           code == Code::sqrt && !one ? 0 : from, {other});
}

void Assembler::memory(Code code, Width width, unsigned to, unsigned from, Base base, std::ptrdiff_t index) {
    const unsigned pp = width == Width::one && code != Code::load_high ? scalar : packed;
    encode({.pp = pp, .wide = width == Width::eight}, width, static_cast<unsigned>(code), to,
           code == Code::sqrt && width != Width::one ? 0 : from,
           {static_cast<unsigned>(base), true, static_cast<std::int32_t>(8 * index)});
}

void Assembler::broadcast(Width width, unsigned to, Base base, std::ptrdiff_t index) {
    encode({.map = 2, .pp = packed, .wide = width == Width::eight}, width, 0x19, to, 0,
           {static_cast<unsigned>(base), true, static_cast<std::int32_t>(8 * index)});
}

void Assembler::join(Width width, unsigned to, unsigned low, unsigned high) {
    const bool eight = width == Width::eight;
    if (width == Width::two) return registers(Code::unpack, width, to, low, high);
    encode({.map = 3, .pp = packed, .wide = eight}, width, eight ? 0x1A : 0x18, to, low, {high});
    put(1);
}

unsigned Assembler::result(std::uint32_t index) {
    const unsigned reg = free_ + results_++ % (16 - free_);
    if (held_[reg]) holding_.erase(*held_[reg]);
    held_[reg] = index;
    holding_[index] = reg;
    return reg;
}

std::optional<unsigned> Assembler::holder(std::uint32_t index) const {
    const auto found = holding_.find(index);
    if (found == holding_.end()) return std::nullopt;
    return found->second;
}

void Assembler::forget_all() {
    held_.fill(std::nullopt);
    holding_.clear();
    results_ = 0;
}

void Assembler::hold(std::uint32_t index, unsigned reg) {
    if (reg < held_.size()) held_[reg] = index;
    holding_[index] = reg;
}

void Assembler::get(unsigned to, std::uint32_t index) {
    if (const auto reg = holder(index)) return registers(Code::load, width_, to, 0, *reg);
    memory(Code::load, width_, to, numbers_, place(index));
}

void Assembler::apply(Code code, unsigned to, unsigned from, std::uint32_t index) {
    if (const auto reg = holder(index)) return registers(code, width_, to, from, *reg);
    memory(code, width_, to, from, numbers_, place(index));
}

void Assembler::combine(Code code, unsigned to, std::uint32_t a, std::uint32_t b) {
    auto from = holder(a);
    if (!from) get(to, a);
    apply(code, to, from ? *from : to, b);
}

// mov rax, imm64; vmovq xmm, rax; vbroadcastsd
void Assembler::negative_zero(unsigned reg) {
    put(0xB848, 2);
    put(std::uint64_t{1} << 63, 8);
    encode({.pp = packed, .wide = true}, Width::two, 0x6E, reg, 0, {0});
    if (width_ == Width::one) return;
    encode({.map = 2, .pp = packed, .wide = width_ == Width::eight}, width_, 0x19, reg, 0, {reg});
}

void Assembler::integer(unsigned opcode, Base reg, Base base, std::ptrdiff_t index) {
    const auto r = static_cast<unsigned>(reg), b = static_cast<unsigned>(base);
    put(0x48u | (r > 7 ? 4u : 0u) | (b > 7 ? 1u : 0u));
    put(opcode);
    put(0x80u | rm(r) << 3 | rm(b));
    put(static_cast<std::uint32_t>(8 * index), 4);
}

void Assembler::address(Base to, Base from, std::ptrdiff_t doubles) { integer(0x8D, to, from, doubles); }

void Assembler::compare(Base a, Base b) {
    const auto x = static_cast<unsigned>(a), y = static_cast<unsigned>(b);
    put(0x48u | (y > 7 ? 4u : 0u) | (x > 7 ? 1u : 0u));
    put(0x39);
    put(0xC0u | rm(y) << 3 | rm(x));
}

std::size_t Assembler::jump_if_not_below(Base a, Base b) {
    compare(a, b);
    put(0x830F, 2);
    put(std::uint64_t{0}, 4);
    return here();
}

// vucomisd; jbe: also where they cannot be compared
std::size_t Assembler::jump_if_not_above(unsigned reg, Base base, std::ptrdiff_t index) {
    encode({.pp = packed}, Width::one, 0x2E, reg, 0,
           {static_cast<unsigned>(base), true, static_cast<std::int32_t>(8 * index)});
    put(0x860F, 2);
    put(std::uint64_t{0}, 4);
    return here();
}

void Assembler::jump_back(std::size_t place) {
    put(0xE9);
    put(static_cast<std::uint32_t>(place - (here() + 4)), 4);
}

void Assembler::land(std::size_t jump) {
    const auto distance = static_cast<std::uint32_t>(here() - jump);
    for (unsigned i = 0; i < 4; ++i) bytes_[jump - 4 + i] = static_cast<std::uint8_t>(distance >> 8 * i & 0xFFu);
}

void Assembler::jump_back_if_below(Base a, Base b, std::size_t place) {
    compare(a, b);
    put(0x820F, 2);
    put(static_cast<std::uint32_t>(place - (here() + 4)), 4);
}

void Assembler::jump_back_if_not_above(Base a, Base b, std::size_t place) {
    compare(a, b);
    put(0x860F, 2);
    put(static_cast<std::uint32_t>(place - (here() + 4)), 4);
}

// push rbx; mov rbx, rdi: the stack is then where a call wants it.
void Assembler::enter() { put(0xFB894853, 4); }
// pop rbx; ret
void Assembler::leave() {
    if (width_ != Width::one) clear_upper_halves();
    put(0xC35B, 2);
}
// ret
void Assembler::leave_at_once() {
    clear_upper_halves();
    put(0xC3);
}

// vzeroupper
void Assembler::clear_upper_halves() { put(0x77F8C5, 3); }

// mov r32, imm32
void Assembler::integer_argument(Base to, std::int32_t value) {
    put(0xB8 + static_cast<unsigned>(to));  // one of the first eight
    put(static_cast<std::uint32_t>(value), 4);
}

// mov rax, imm64; call rax
void Assembler::call(const void* function) {
    if (width_ != Width::one) clear_upper_halves();
    put(0xB848, 2);
    put(reinterpret_cast<std::uintptr_t>(function), 8);
    put(0xD0FF, 2);
    forget_all();
}

}  // namespace achilles
