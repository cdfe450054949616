// Eight doubles, one for each of eight runs, as plain data. Also the conditions and selections that code over one
// number or over eight uses instead of branches.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace achilles {

struct alignas(64) Double8 {
    static constexpr std::size_t count = 8;
    double lane[count] = {};

    double& operator[](std::size_t i) { return lane[i]; }
    double operator[](std::size_t i) const { return lane[i]; }
};

// Sines and cosines of eight angles (rad), with an absolute error of at most one ulp of 1.
void sine_and_cosine_of_lanes(const Double8* angle, Double8* sine, Double8* cosine);

// The type of a comparison: bool for a double, a mask for several doubles (lanes.hpp).
template <class Number>
struct ConditionOf {
    using Type = bool;
};
template <class Number>
using Condition = typename ConditionOf<Number>::Type;

// Returns a if the condition holds, else b.
inline double select(bool condition, double a, double b) { return condition ? a : b; }
inline bool any(bool condition) { return condition; }
// min and max return b if either argument is NaN.
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }

// Approximates log2(x), x > 0, within 0.09, from the bits of the exponent and the mantissa.
inline double rough_log2(double x) { return static_cast<double>(std::bit_cast<std::int64_t>(x)) * 0x1p-52 - 1023.0; }

}  // namespace achilles
