#include "program/machine.hpp"

#include <sys/mman.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace achilles {

namespace {

bool is_enabled_by_environment() {
    const char* const given = std::getenv("ACHILLES_MACHINE_CODE");
    return given == nullptr || std::string_view(given) != "0";
}
std::atomic<bool> is_enabled = is_enabled_by_environment();

}  // namespace

void ask_environment_for_code() { is_enabled = is_enabled_by_environment(); }

// The memory is first written, then made executable; it is never both at once.
std::shared_ptr<const MachineCode> MachineCode::of(std::span<const std::uint8_t> bytes) {
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
    if (!is_enabled) return std::nullopt;
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2")) return std::nullopt;
    return __builtin_cpu_supports("avx512f") ? Width::eight : Width::four;
}

}  // namespace achilles
