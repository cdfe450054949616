// What of OSMesa's interface we use, declared here: Mesa no longer has the header, and its library is loaded by hand.
#pragma once

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
