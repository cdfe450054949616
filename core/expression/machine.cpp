#include "expression/machine.hpp"

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

#else

std::shared_ptr<const MachineCode> MachineCode::of(const std::vector<std::uint8_t>&) { return nullptr; }
MachineCode::~MachineCode() = default;

#endif

void Assembler::put(std::uint64_t value, unsigned count) {
    for (unsigned i = 0; i < count; ++i) put(static_cast<unsigned>(value >> 8 * i & 0xFFu));
}

// F2 (REX) 0F op: movsd, addsd, ...
void Assembler::prefix(Code code, unsigned reg, unsigned other) {
    put(0xF2);
    if (reg > 7 || other > 7) put(0x40u | reg >> 3 << 2 | other >> 3);
    put(0x0F);
    put(static_cast<unsigned>(code));
}

void Assembler::registers(Code code, unsigned reg, unsigned other) {
    if (code == Code::load) {  // movaps: movsd would wait for the other half of the register
        if (reg > 7 || other > 7) put(0x40u | reg >> 3 << 2 | other >> 3);
        put(0x280F, 2);
    } else {
        prefix(code, reg, other);
    }
    put(0xC0u | (reg & 7u) << 3 | (other & 7u));
}

void Assembler::memory(Code code, unsigned reg, Base base, std::size_t index) {
    prefix(code, reg, 0);
    put(0x80u | (reg & 7u) << 3 | static_cast<unsigned>(base));
    put(8 * index, 4);
}

unsigned Assembler::result(std::uint32_t index) {
    const unsigned reg = 2 + results_++ % 14;
    if (const auto old = held_.find(reg); old != held_.end()) holding_.erase(old->second);
    held_[reg] = index;
    holding_[index] = reg;
    return reg;
}

void Assembler::apply(Code code, unsigned reg, std::uint32_t index) {
    if (const auto found = holding_.find(index); found != holding_.end()) return registers(code, reg, found->second);
    memory(code, reg, base_, index);
}

// push rbx; mov rbx, rdi: the stack is then where a call wants it.
void Assembler::enter() { put(0xFB894853, 4); }
// pop rbx; ret
void Assembler::leave() { put(0xC35B, 2); }

// mov rax, imm64; movq xmm, rax
void Assembler::negative_zero(unsigned reg) {
    put(0xB848, 2);
    put(std::uint64_t{1} << 63, 8);
    put(0x66);
    put(reg > 7 ? 0x4Cu : 0x48u);
    put(0x6E0F, 2);
    put(0xC0u | (reg & 7u) << 3);
}

// mov edi, imm32
void Assembler::integer_argument(std::int32_t value) {
    put(0xBF);
    put(static_cast<std::uint32_t>(value), 4);
}

// mov rax, imm64; call rax
void Assembler::call(const void* function) {
    put(0xB848, 2);
    put(reinterpret_cast<std::uintptr_t>(function), 8);
    put(0xD0FF, 2);
    held_.clear();
    holding_.clear();
}

}  // namespace achilles
