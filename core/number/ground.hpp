// The ground of a proof: IEEE double arithmetic in round-to-nearest, with denormal numbers.
//
// number/interval.hpp widens every result by what such arithmetic may be wrong by. A thread may compute otherwise: any
// shared library that was linked with -ffast-math turns denormals to zero when it is loaded (FTZ for results, DAZ for
// operands), and then 1e-300 * 1e-10 is in [0, 0]; a program may have asked for another rounding. So everything that
// proves stands on a Ground: it sets what is assumed, on its thread, and puts back what was there at its end.
//
// It is cheap where nothing has to change (two registers are read), but meant for a certificate or a run, not for an
// operation. Its calls are not inlined: nothing is computed across them.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

#if !defined(__SSE2__)
#include <cfenv>
#endif

namespace achilles {

class Ground {
 public:
    Ground();
    ~Ground();
    Ground(const Ground&) = delete;
    Ground& operator=(const Ground&) = delete;

 private:
#if defined(__SSE2__)
    unsigned control_;  // of vectors and scalars (MXCSR), as it was
    int rounding_;      // of the old unit (x87), as it was
#else
    std::fenv_t environment_;
#endif
};

// The mathematical library whose errors interval.hpp allows for: "glibc 2.36"; "unknown" where it does not say.
std::string mathematical_library();

// Doubles that have lost digits: below 2^-1022 in size, and not zero.

// By the bits: where denormals are taken for zero, a comparison would see none.
inline bool is_subnormal(double x) {
    constexpr std::uint64_t exponent = 0x7FF0000000000000u, fraction = 0x000FFFFFFFFFFFFFu;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return (bits & exponent) == 0 && (bits & fraction) != 0;
}

}  // namespace achilles
