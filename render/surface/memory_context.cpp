#include "surface/memory_context.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>

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
    if (page == MAP_FAILED) return true;  // another problem, which is reported elsewhere
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

// ---- offscreen rendering via OSMesa ----

namespace {

constexpr const char* library_name = "libOSMesa.so.8";

// libOSMesa exports all of OpenGL. If linked, it would replace the window's OpenGL, so it is loaded at run time.
struct OsMesa {
    decltype(&osmesa::OSMesaCreateContextAttribs) create;
    decltype(&osmesa::OSMesaDestroyContext) destroy;
    decltype(&osmesa::OSMesaMakeCurrent) make_current;
    decltype(&osmesa::OSMesaGetProcAddress) address;
};

const OsMesa& os_mesa() {
    static const OsMesa loaded = [] {
        const LoadedLibrary library(library_name);
        OsMesa mesa{};
        library.find("OSMesaCreateContextAttribs", mesa.create);
        library.find("OSMesaDestroyContext", mesa.destroy);
        library.find("OSMesaMakeCurrent", mesa.make_current);
        library.find("OSMesaGetProcAddress", mesa.address);
        return mesa;
    }();
    return loaded;
}

}  // namespace

MemoryContext os_mesa_context() {
    constexpr std::array attributes{osmesa::format,
                                    osmesa::rgba,
                                    osmesa::profile,
                                    osmesa::core_profile,
                                    osmesa::major_version,
                                    3,
                                    osmesa::minor_version,
                                    3,
                                    0};
    const OsMesa& library = os_mesa();
    const osmesa::Context made = library.create(attributes.data(), nullptr);
    if (made == nullptr) throw std::runtime_error(std::string(library_name) + " cannot make an OpenGL 3.3 context");
    MemoryContext context;
    context.owned =
        std::shared_ptr<void>(made, [&library](void* ended) { library.destroy(static_cast<osmesa::Context>(ended)); });
    // OSMesa needs a buffer of its own, but the canvas renders into a texture.
    const auto buffer = std::make_shared<std::array<unsigned char, 4>>();
    context.make_current = [&library, made, buffer] {
        library.make_current(made, buffer->data(), GL_UNSIGNED_BYTE, 1, 1);
    };
    context.release = [&library] { library.make_current(nullptr, nullptr, 0, 0, 0); };
    context.address = [&library](const char* name) { return reinterpret_cast<void*>(library.address(name)); };
    return context;
}

}  // namespace achilles
