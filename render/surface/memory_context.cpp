#include "surface/memory_context.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include "surface/offscreen.hpp"

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

// ---- the choice ----

namespace {

// Address space (bytes) that Mesa and its compiler need for pictures of this size. Measured without a limit on two
// cores: 460 MB and 9 bytes per pixel; each further core has a thread with its stack.
std::size_t room_for(int width, int height) {
    constexpr std::size_t fixed = std::size_t{512} << 20, per_core = std::size_t{8} << 20, per_pixel = 16;
    const std::size_t cores = std::clamp(std::thread::hardware_concurrency(), 2U, 16U);  // Mesa uses at most 16
    return fixed + (cores - 2) * per_core +
           per_pixel * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

MemoryContext memory_context(int width, int height) {
    check_room("drawing", room_for(width, height));
    choose_renderer();
    const char* const given = std::getenv("ACHILLES_OFFSCREEN");
    const std::string wanted = given == nullptr ? "" : given;
    if (wanted == "osmesa") return os_mesa_context();
    if (wanted == "egl") return egl_context();
    if (!wanted.empty()) throw std::runtime_error("ACHILLES_OFFSCREEN must be osmesa or egl, not '" + wanted + "'");
    std::string missing;
    try {
        return os_mesa_context();
    } catch (const std::runtime_error& error) {
        missing = error.what();
    }
    try {
        return egl_context();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("drawing without a window needs OSMesa or EGL, but " + missing + ", and " +
                                 error.what() + "\ninstall the package libosmesa6, or libegl1 and libgl1-mesa-dri");
    }
}

void check_room(const std::string& purpose, std::size_t bytes) {
    void* const room =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        throw NotEnoughMemory("there is not enough memory for " + purpose + ", which may take " +
                              std::to_string(bytes >> 20) + " MB; ulimit -v prints the limit for this process");
    ::munmap(room, bytes);
}

}  // namespace achilles
