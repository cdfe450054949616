// Our declarations of OSMesa agree with its header, on systems that still have it.
#include <gtest/gtest.h>

#include <type_traits>

#include "surface/memory_context.hpp"

#if __has_include(<GL/osmesa.h>)
#include <GL/osmesa.h>

namespace achilles {
namespace {

// Both declare the context as an opaque pointer.
template <class Ours, class Theirs>
constexpr bool is_same_call = false;
template <class R, class... As, class S, class... Bs>
constexpr bool is_same_call<R(As...), S(Bs...)> = sizeof...(As) == sizeof...(Bs) && sizeof(R) == sizeof(S) &&
                                                  ((sizeof(As) == sizeof(Bs) &&
                                                    std::is_pointer_v<As> == std::is_pointer_v<Bs>)&&...);
template <class... As, class... Bs>
constexpr bool is_same_call<void(As...), void(Bs...)> = sizeof...(As) == sizeof...(Bs) &&
                                                        ((sizeof(As) == sizeof(Bs) &&
                                                          std::is_pointer_v<As> == std::is_pointer_v<Bs>)&&...);

TEST(OsMesa, IsDeclaredAsItsHeaderDoes) {
    EXPECT_TRUE((is_same_call<decltype(osmesa::OSMesaCreateContextAttribs), decltype(::OSMesaCreateContextAttribs)>));
    EXPECT_TRUE((is_same_call<decltype(osmesa::OSMesaDestroyContext), decltype(::OSMesaDestroyContext)>));
    EXPECT_TRUE((is_same_call<decltype(osmesa::OSMesaMakeCurrent), decltype(::OSMesaMakeCurrent)>));
    EXPECT_TRUE((std::is_same_v<decltype(osmesa::OSMesaGetProcAddress), decltype(::OSMesaGetProcAddress)>));
    EXPECT_EQ(osmesa::rgba, OSMESA_RGBA);
    EXPECT_EQ(osmesa::format, OSMESA_FORMAT);
    EXPECT_EQ(osmesa::profile, OSMESA_PROFILE);
    EXPECT_EQ(osmesa::core_profile, OSMESA_CORE_PROFILE);
    EXPECT_EQ(osmesa::major_version, OSMESA_CONTEXT_MAJOR_VERSION);
    EXPECT_EQ(osmesa::minor_version, OSMESA_CONTEXT_MINOR_VERSION);
}

}  // namespace
}  // namespace achilles
#endif
