#include "surface/memory_context.hpp"

#include <dlfcn.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <stdexcept>

namespace achilles {

LoadedLibrary::LoadedLibrary(const char* name) : name_(name), library_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) throw std::runtime_error(name_ + " is missing");
}

void* LoadedLibrary::address(const char* name) const {
    void* found = dlsym(library_, name);
    if (found == nullptr) throw std::runtime_error(name_ + " lacks " + name);
    return found;
}

namespace {

bool can_make_code() {
    constexpr std::size_t size = 4096;
    void* const page = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) return true;  // something else is wrong, and will be told
    const bool can = mprotect(page, size, PROT_READ | PROT_EXEC) == 0;
    munmap(page, size);
    return can;
}

}  // namespace

void choose_renderer() {
    if (can_make_code()) return;
    setenv("GALLIUM_DRIVER", "softpipe", 1);
    setenv("DRAW_USE_LLVM", "0", 1);
}

}  // namespace achilles
