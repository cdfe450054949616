// OpenGL 3.3 core contexts that render in memory with Mesa's software renderer, for class Offscreen.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "surface/gl.hpp"

// The part of OSMesa's interface in use. It is declared here because Mesa no longer has the header and its library is
// loaded at run time.
namespace achilles::osmesa {

using Context = struct OpaqueContext*;
using Address = void (*)();

Context OSMesaCreateContextAttribs(const int* attributes, Context sharing);
void OSMesaDestroyContext(Context context);
unsigned char OSMesaMakeCurrent(Context context, void* buffer, unsigned type, int width, int height);
Address OSMesaGetProcAddress(const char* name);

inline constexpr int rgba = 0x1908, format = 0x22, profile = 0x33, core_profile = 0x34, major_version = 0x36,
                     minor_version = 0x37;

}  // namespace achilles::osmesa

namespace achilles {

// A library loaded with dlopen. If it is missing, the user gets a message; its symbols are not exported to other
// libraries.
class LoadedLibrary {
 public:
    // Loads the library and never unloads it, because renderers keep threads and exit handlers. Throws
    // std::runtime_error with its name if it is missing.
    explicit LoadedLibrary(const char* name);

    // Looks up a function. Throws std::runtime_error with both names if it is missing.
    template <class Function>
    void find(const char* name, Function& function) const {
        function = reinterpret_cast<Function>(address(name));
    }

 private:
    void* address(const char* name) const;

    std::string name_;
    void* library_;
};

struct MemoryContext {
    std::shared_ptr<void> owned;                  // the context is destroyed with it
    std::function<void()> make_current, release;  // makes it current for the calling thread, and the inverse
    AddressFunction address;
};

// All throw std::runtime_error with the name of the missing library, or with another reason.
MemoryContext os_mesa_context();  // via libOSMesa
MemoryContext egl_context();      // via libEGL without a surface (egl.cpp)
// OSMesa for pictures of this size in pixels, or EGL where Debian no longer has OSMesa; both produce the same bytes.
// ACHILLES_OFFSCREEN=osmesa or egl forces one. Throws NotEnoughMemory as well. A page has its own (app/web).
MemoryContext memory_context(int width, int height);

// Mesa's renderer generates machine code and crashes where the system forbids executable memory. In this case another
// renderer is chosen, which is slower and differs in the last bits. Call it before a context is created.
void choose_renderer();

}  // namespace achilles
