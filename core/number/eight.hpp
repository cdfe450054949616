// Eight numbers side by side, one of each of eight runs, as data; and what a method over one number or over eight uses
// in place of branches: conditions and choices.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace achilles {

struct alignas(64) Eight {
    static constexpr std::size_t count = 8;
    double lane[count] = {};

    double& operator[](std::size_t i) { return lane[i]; }
    double operator[](std::size_t i) const { return lane[i]; }
};

// Of eight angles, to within an ulp of 1.
void sine_and_cosine_of_lanes(const Eight* angle, Eight* sine, Eight* cosine);

// For a double a condition is a bool, for doubles side by side a mask (lanes.hpp).
template <class Number>
struct ConditionOf {
    using Type = bool;
};
template <class Number>
using Condition = typename ConditionOf<Number>::Type;

// a where the condition holds, else b.
inline double select(bool condition, double a, double b) { return condition ? a : b; }
inline bool any(bool condition) { return condition; }
// b where they cannot be compared.
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }

// Within 0.09 of log2(x), x > 0: exponent and mantissa as they stand in a double.
inline double rough_log2(double x) { return static_cast<double>(std::bit_cast<std::int64_t>(x)) * 0x1p-52 - 1023.0; }

}  // namespace achilles
