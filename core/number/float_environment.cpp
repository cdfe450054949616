#include "number/float_environment.hpp"

#include <fmt/format.h>

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif
#if defined(__GLIBC__)
#include <gnu/libc-version.h>
#endif

namespace achilles {

#if defined(__SSE2__)

namespace {

// Bits of MXCSR: the rounding mode (0: to nearest) and the two flags that flush denormals to zero.
constexpr unsigned rounding = 0x6000, flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
constexpr unsigned controlled_bits = rounding | flush_to_zero | denormals_are_zero;

}  // namespace

FloatEnvironmentGuard::FloatEnvironmentGuard() : control_(_mm_getcsr()), rounding_(std::fegetround()) {
    if (rounding_ != FE_TONEAREST) std::fesetround(FE_TONEAREST);
    if ((control_ & controlled_bits) != 0) _mm_setcsr(control_ & ~controlled_bits);
}

// Exception flags that were raised in between stay raised.
FloatEnvironmentGuard::~FloatEnvironmentGuard() {
    if (rounding_ != FE_TONEAREST) std::fesetround(rounding_);
    if ((control_ & controlled_bits) != 0) _mm_setcsr((_mm_getcsr() & ~controlled_bits) | (control_ & controlled_bits));
}

#else

FloatEnvironmentGuard::FloatEnvironmentGuard() {
    std::fegetenv(&environment_);
    std::fesetenv(FE_DFL_ENV);
}

FloatEnvironmentGuard::~FloatEnvironmentGuard() { std::fesetenv(&environment_); }

#endif

std::string mathematical_library() {
#if defined(__GLIBC__)
    return std::string("glibc ") + gnu_get_libc_version();
#elif defined(__EMSCRIPTEN__)
    return fmt::format("musl of Emscripten {}.{}.{}", __EMSCRIPTEN_major__, __EMSCRIPTEN_minor__, __EMSCRIPTEN_tiny__);
#else
    return "unknown";
#endif
}

}  // namespace achilles
