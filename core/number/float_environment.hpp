// Floating-point environment of a proof: IEEE double arithmetic, round to nearest, with denormals.
//
// number/interval.hpp widens every result by the error bound of such arithmetic. A thread may have another environment:
// loading a shared library that was linked with -ffast-math flushes denormals to zero (FTZ for results, DAZ for
// operands), and then 1e-300 * 1e-10 is in [0, 0]. A program may also have set another rounding mode. Every proof
// therefore creates a FloatEnvironmentGuard, which sets the required environment on its thread and restores the
// previous one in its destructor.
//
// It is cheap if nothing has to change (it reads two registers), but meant for a certificate or a run, not for one
// operation. Its calls are not inlined, so the compiler cannot move arithmetic across them.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

#if !defined(__SSE2__)
#include <cfenv>
#endif

namespace achilles {

class FloatEnvironmentGuard {
 public:
    FloatEnvironmentGuard();
    ~FloatEnvironmentGuard();
    FloatEnvironmentGuard(const FloatEnvironmentGuard&) = delete;
    FloatEnvironmentGuard& operator=(const FloatEnvironmentGuard&) = delete;

 private:
#if defined(__SSE2__)
    unsigned control_;  // previous control register of SSE (MXCSR)
    int rounding_;      // previous rounding mode of the x87 unit
#else
    std::fenv_t environment_;
#endif
};

// Name of the math library whose errors interval.hpp allows for, as "glibc 2.36"; "unknown" for other libraries.
std::string mathematical_library();

// True for a denormal: nonzero and smaller than 2^-1022 in size. Tests the bits, because a comparison fails if the
// thread flushes denormals to zero.
inline bool is_subnormal(double x) {
    constexpr std::uint64_t exponent = 0x7FF0000000000000u, fraction = 0x000FFFFFFFFFFFFFu;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return (bits & exponent) == 0 && (bits & fraction) != 0;
}

}  // namespace achilles
