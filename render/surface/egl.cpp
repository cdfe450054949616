// Offscreen rendering via EGL on Mesa's surfaceless platform, the successor of OSMesa. The only file that includes EGL.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include "surface/memory_context.hpp"

namespace achilles {

namespace {

// Loaded at run time like OSMesa, because the window uses its own library.
struct Egl {
    decltype(&eglGetProcAddress) address;
    decltype(&eglInitialize) initialize;
    decltype(&eglBindAPI) bind_api;
    decltype(&eglCreateContext) create_context;
    decltype(&eglDestroyContext) destroy_context;
    decltype(&eglMakeCurrent) make_current;
    EGLDisplay display = EGL_NO_DISPLAY;
};

// Sets an environment variable during its lifetime, unless the user has set it.
class Variable {
 public:
    Variable(const char* name, const char* value) : name_(name), ours_(std::getenv(name) == nullptr) {
        if (ours_) setenv(name, value, 0);
    }
    ~Variable() {
        if (ours_) unsetenv(name_);
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

 private:
    const char* name_;
    bool ours_;
};

const Egl& egl() {
    static const Egl loaded = [] {
        const LoadedLibrary library("libEGL.so.1");
        Egl egl{};
        library.find("eglGetProcAddress", egl.address);
        library.find("eglInitialize", egl.initialize);
        library.find("eglBindAPI", egl.bind_api);
        library.find("eglCreateContext", egl.create_context);
        library.find("eglDestroyContext", egl.destroy_context);
        library.find("eglMakeCurrent", egl.make_current);
        const auto display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl.address("eglGetPlatformDisplayEXT"));
        if (display == nullptr) throw std::runtime_error("libEGL.so.1 does not support platforms");
        // A graphics card would produce other bytes.
        const Variable software("LIBGL_ALWAYS_SOFTWARE", "true");
        egl.display = display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
        if (egl.display == EGL_NO_DISPLAY || egl.initialize(egl.display, nullptr, nullptr) == EGL_FALSE)
            throw std::runtime_error("libEGL.so.1 cannot draw without a surface");
        return egl;
    }();
    return loaded;
}

}  // namespace

MemoryContext egl_context() {
    const Egl& library = egl();
    constexpr std::array<EGLint, 7> attributes{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext made = EGL_NO_CONTEXT;
    if (library.bind_api(EGL_OPENGL_API) == EGL_TRUE)
        made = library.create_context(library.display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (made == EGL_NO_CONTEXT) throw std::runtime_error("libEGL.so.1 cannot make an OpenGL 3.3 context");
    const auto bind = [&library](EGLContext context) {
        library.bind_api(EGL_OPENGL_API);  // for this thread
        if (library.make_current(library.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
            throw std::runtime_error("libEGL.so.1 cannot use its OpenGL context in this thread");
    };
    MemoryContext context;
    context.owned =
        std::shared_ptr<void>(made, [&library](void* ended) { library.destroy_context(library.display, ended); });
    context.make_current = [bind, made] { bind(made); };
    // Must not throw, because it is called at the end of scopes. If release fails, the context was not current.
    context.release = [&library] {
        library.bind_api(EGL_OPENGL_API);
        library.make_current(library.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    };
    context.address = [&library](const char* name) { return reinterpret_cast<void*>(library.address(name)); };
    return context;
}

}  // namespace achilles
