// A context of OpenGL 3.3 core that draws in memory, by Mesa's software renderer: as much of one as Offscreen needs.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "surface/gl.hpp"

// What of OSMesa's interface we use, declared here: Mesa no longer has the header, and its library is loaded by hand.
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

// A library that is loaded by hand: a machine without it gets a sentence, and its names take nobody else's place.
class LoadedLibrary {
 public:
    // Loads it for good: what draws keeps threads and exit handlers. Throws std::runtime_error that names it if it is
    // missing.
    explicit LoadedLibrary(const char* name);

    // The function of this name. Throws std::runtime_error that names both if there is none.
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
    std::shared_ptr<void> owned;                  // the context ends with it
    std::function<void()> make_current, release;  // current for the calling thread, and no more
    AddressFunction address;
};

// All throw std::runtime_error that names the library if it is missing, or what else is.
MemoryContext os_mesa_context();  // by libOSMesa
MemoryContext egl_context();      // by libEGL without a surface (egl.cpp)

// Mesa's renderer compiles what it draws with, and crashes where the system makes no memory executable: then another is
// chosen, which draws other last bits and takes longer. To be called before a context is made.
void choose_renderer();

}  // namespace achilles
