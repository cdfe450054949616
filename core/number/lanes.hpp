// Eight doubles in vectors of `Bytes` bytes. The result in each lane does not depend on the other lanes.
//
// Processors differ in vector size. A function compiled for one size does not use the vectors of another size if it is
// inlined into code for that size. The arithmetic here is therefore always inlined, and the templates built on it (such
// as TaylorStep) are compiled once for each vector size: see series/lane_kinds.hpp.
//
// Numbers are loaded, stored and copied part by part. The compiler copies other structures, and memory, in pieces of 16
// bytes. A wider vector that is loaded from there has to wait until all pieces have left the store buffer. (A copy need
// not be inlined: containers of the standard library are not compiled for wide vectors.)
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "number/double8.hpp"

#define IN_LANES [[gnu::always_inline]] inline
#define EACH_PART _Pragma("GCC unroll 4") for (std::size_t p = 0; p < sizeof(Double8) / Bytes; ++p)
#define OF_TWO(Result, name, Operand, expression)                     \
    IN_LANES friend Result name(const Operand& x, const Operand& y) { \
        Result result;                                                \
        EACH_PART {                                                   \
            const auto &a = x.part[p], &b = y.part[p];                \
            result.part[p] = expression;                              \
        }                                                             \
        return result;                                                \
    }

namespace achilles {

// A condition for each lane: all bits of the lane are set, or none.
template <std::size_t Bytes>
struct alignas(Double8) Mask {
    using Vector [[gnu::vector_size(Bytes)]] = std::int64_t;
    static constexpr std::size_t per_part = Bytes / sizeof(double);
    Vector part[sizeof(Double8) / Bytes];

    Mask() = default;
    Mask(const Mask& x) { *this = x; }
    Mask& operator=(const Mask& x) {  // NOLINT(bugprone-unhandled-self-assignment)
        EACH_PART part[p] = x.part[p];
        return *this;
    }
    IN_LANES explicit Mask(bool all) { EACH_PART part[p] = Vector{} - static_cast<std::int64_t>(all); }
    IN_LANES bool operator[](std::size_t i) const { return part[i / per_part][i % per_part] != 0; }
    IN_LANES void set(std::size_t i) { part[i / per_part][i % per_part] = -1; }

    OF_TWO(Mask, operator&, Mask, a& b)
    OF_TWO(Mask, operator|, Mask, a | b)
    IN_LANES friend Mask operator~(const Mask& a) {
        Mask result;
        EACH_PART result.part[p] = ~a.part[p];
        return result;
    }
    IN_LANES friend Mask& operator&=(Mask& a, const Mask& b) { return a = a & b; }
    IN_LANES friend bool any(const Mask& mask) {
        auto of_parts = mask.part[0];
        EACH_PART of_parts |= mask.part[p];
        std::int64_t all = 0;
        for (std::size_t i = 0; i < per_part; ++i) all |= of_parts[i];
        return all != 0;
    }
};

template <std::size_t Bytes>
struct alignas(Double8) Lanes {
    using Vector [[gnu::vector_size(Bytes)]] = double;
    using VectorInMemory [[gnu::vector_size(Bytes), gnu::may_alias]] = double;
    using Mask = achilles::Mask<Bytes>;
    static constexpr std::size_t per_part = Mask::per_part;
    Vector part[sizeof(Double8) / Bytes];

    Lanes() = default;
    Lanes(const Lanes& x) { *this = x; }
    Lanes& operator=(const Lanes& x) {  // NOLINT(bugprone-unhandled-self-assignment)
        EACH_PART part[p] = x.part[p];
        return *this;
    }
    IN_LANES Lanes(double x) { EACH_PART part[p] = Vector{} + x; }
    IN_LANES Lanes(const Double8& x) {
        EACH_PART part[p] = *reinterpret_cast<const VectorInMemory*>(x.lane + p * per_part);
    }
    IN_LANES operator Double8() const {
        Double8 x;
        EACH_PART* reinterpret_cast<VectorInMemory*>(x.lane + p * per_part) = part[p];
        return x;
    }
    IN_LANES double operator[](std::size_t i) const { return part[i / per_part][i % per_part]; }
    IN_LANES void set(std::size_t i, double x) { part[i / per_part][i % per_part] = x; }

    OF_TWO(Lanes, operator+, Lanes, a + b)
    OF_TWO(Lanes, operator-, Lanes, a - b)
    OF_TWO(Lanes, operator*, Lanes, a* b)
    OF_TWO(Lanes, operator/, Lanes, a / b)
    OF_TWO(Mask, operator<, Lanes, a < b)
    OF_TWO(Mask, operator>, Lanes, a > b)
    OF_TWO(Mask, operator<=, Lanes, a <= b)
    OF_TWO(Mask, operator==, Lanes, a == b)
    // min and max return b if either argument is NaN
    OF_TWO(Lanes, min, Lanes, a < b ? a : b)
    OF_TWO(Lanes, max, Lanes, a > b ? a : b)
    IN_LANES friend Lanes operator-(const Lanes& a) {
        Lanes result;
        EACH_PART result.part[p] = -a.part[p];
        return result;
    }
    IN_LANES friend Lanes& operator+=(Lanes& a, const Lanes& b) { return a = a + b; }
    IN_LANES friend Lanes& operator*=(Lanes& a, const Lanes& b) { return a = a * b; }

    // For each lane: a if the mask is set, else b.
    IN_LANES friend Lanes select(const Mask& mask, const Lanes& a, const Lanes& b) {
        Lanes result;
        EACH_PART result.part[p] = mask.part[p] ? a.part[p] : b.part[p];
        return result;
    }

    // The bits of the doubles as integers, and back.
    IN_LANES friend Mask bits(const Lanes& a) {
        Mask result;
        EACH_PART result.part[p] = reinterpret_cast<typename Mask::Vector>(a.part[p]);
        return result;
    }
    IN_LANES static Lanes doubles(const Mask& a) {
        Lanes result;
        EACH_PART result.part[p] = reinterpret_cast<Vector>(a.part[p]);
        return result;
    }
    IN_LANES friend Lanes abs(const Lanes& a) {
        Mask result = bits(a);
        EACH_PART result.part[p] &= INT64_MAX;
        return doubles(result);
    }

    // Approximates log2(x), x > 0, within 0.09, from the bits of the exponent and the mantissa.
    IN_LANES friend Lanes rough_log2(const Lanes& x) {
        Mask result = bits(x);
        EACH_PART result.part[p] = result.part[p] >> 12 | 0x4330000000000000;  // the double 2^52 + (bits >> 12)
        return (doubles(result) - 0x1p52) * 0x1p-40 - 1023.0;
    }
    // Approximates 2^x, |x| < 1000, within 0.3 percent.
    IN_LANES friend Lanes rough_exp2(const Lanes& x) {
        const Lanes shifted = x + 0x1.8p52, f = x - (shifted - 0x1.8p52);  // |f| <= 1/2
        const Lanes mantissa = 1.0 + f * (0.6931 + f * (0.2402 + f * 0.0555));
        Mask result = bits(mantissa);
        const Mask exponent = bits(shifted);
        EACH_PART result.part[p] += exponent.part[p] << 52;
        return doubles(result);
    }
};

template <std::size_t Bytes>
struct ConditionOf<Lanes<Bytes>> {
    using Type = Mask<Bytes>;
};

// Functions that are evaluated one lane at a time because vector versions would not pay off.
template <class Function, std::size_t Bytes>
IN_LANES Lanes<Bytes> each_lane(const Function& function, const Lanes<Bytes>& a) {
    Lanes<Bytes> result;
    for (std::size_t i = 0; i < Double8::count; ++i) result.set(i, function(a[i]));
    return result;
}
#define LANE_BY_LANE(name)                                          \
    template <std::size_t Bytes>                                    \
    IN_LANES Lanes<Bytes> name(const Lanes<Bytes>& a) {             \
        return each_lane([](double x) { return std::name(x); }, a); \
    }
LANE_BY_LANE(tan)
LANE_BY_LANE(asin)
LANE_BY_LANE(acos)
LANE_BY_LANE(atan)
LANE_BY_LANE(sinh)
LANE_BY_LANE(cosh)
LANE_BY_LANE(tanh)
LANE_BY_LANE(exp)
LANE_BY_LANE(log)
template <std::size_t Bytes>
IN_LANES Lanes<Bytes> sqrt(const Lanes<Bytes>& a) {
#if defined(__x86_64__) && !defined(__clang__)
    if constexpr (Bytes == 32) {
        Lanes<Bytes> result;
        EACH_PART result.part[p] = __builtin_ia32_sqrtpd256(a.part[p]);
        return result;
    }
#endif
    return each_lane([](double x) { return std::sqrt(x); }, a);
}
template <std::size_t Bytes>
IN_LANES Lanes<Bytes> pow(const Lanes<Bytes>& a, const Lanes<Bytes>& b) {
    Lanes<Bytes> result;
    for (std::size_t i = 0; i < Double8::count; ++i) result.set(i, std::pow(a[i], b[i]));
    return result;
}

// Sine and cosine with an absolute error of at most one ulp of 1. Subtracts a multiple k of pi/2 from the angle in
// three parts, of which the first two are so short that their products with k are exact. Then sums both Taylor series
// until the terms are below rounding, and selects by quadrant. Angles beyond 2^18 use std::sin and std::cos.
template <std::size_t Bytes>
void sine_and_cosine(const Lanes<Bytes>& angle, Lanes<Bytes>& sine, Lanes<Bytes>& cosine) {
    using Number = Lanes<Bytes>;
    constexpr double farthest = 0x1p18, to_integer = 0x1.8p52;
    constexpr double first = 0x1.921fb544p0, second = 0x1.0b4611a6p-34, third = 0x1.3198a2e037073p-69;  // parts of pi/2
    const Number shifted = angle * (2.0 * std::numbers::inv_pi) + to_integer, k = shifted - to_integer;
    const Number x = ((angle - k * first) - k * second) - k * third, z = x * x;
    // Both series are summed in pairs of terms, to shorten the chain of dependent operations.
    const Number z2 = z * z, z4 = z2 * z2;
    const Number s = ((-1.0 / 6.0 + z * (1.0 / 120.0)) + z2 * (-1.0 / 5040.0 + z * (1.0 / 362880.0))) +
                     z4 * ((-1.0 / 39916800.0 + z * (1.0 / 6227020800.0)) +
                           z2 * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)));
    const Number c = ((1.0 / 24.0 + z * (-1.0 / 720.0)) + z2 * (1.0 / 40320.0 + z * (-1.0 / 3628800.0))) +
                     z4 * ((1.0 / 479001600.0 + z * (-1.0 / 87178291200.0)) + z2 * (1.0 / 20922789888000.0));
    const Number of_sine = x + x * (z * s), of_cosine = 1.0 - (0.5 * z - z * (z * c));
    const Mask<Bytes> quadrant = bits(shifted);
    Mask<Bytes> odd, sine_below, cosine_below;
    EACH_PART {
        const auto& k_of = quadrant.part[p];
        odd.part[p] = (k_of & 1) != 0;
        sine_below.part[p] = (k_of & 2) != 0;
        cosine_below.part[p] = ((k_of + 1) & 2) != 0;
    }
    const Number a = select(odd, of_cosine, of_sine), b = select(odd, of_sine, of_cosine);
    sine = select(sine_below, -a, a);
    cosine = select(cosine_below, -b, b);
    const Mask<Bytes> far = ~(abs(angle) <= farthest);
    if (!any(far)) return;
    sine = select(far, each_lane([](double lane) { return std::sin(lane); }, angle), sine);
    cosine = select(far, each_lane([](double lane) { return std::cos(lane); }, angle), cosine);
}
template <std::size_t Bytes>
Lanes<Bytes> sin(const Lanes<Bytes>& angle) {
    Lanes<Bytes> sine, cosine;
    sine_and_cosine(angle, sine, cosine);
    return sine;
}
template <std::size_t Bytes>
Lanes<Bytes> cos(const Lanes<Bytes>& angle) {
    Lanes<Bytes> sine, cosine;
    sine_and_cosine(angle, sine, cosine);
    return cosine;
}

}  // namespace achilles

#undef LANE_BY_LANE
#undef OF_TWO
#undef EACH_PART
#undef IN_LANES
