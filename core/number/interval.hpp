// Interval: a closed set of reals [lo, hi] that provably contains the exact value. Outward rounding happens only in
// this file.
//
// Assumes round to nearest (theory.md 9.5): libm does not honor rounding modes, and optimizers ignore them. Every
// result is widened outward. An IEEE operation is off by at most half an ulp, and ulp(x) <= 2^-52 |x| for normal x, so
//     exact value of x op y  in  fl(x op y) +- (2^-52 |fl(x op y)| + smallest denormal).
// A factor of 2^-53 is not enough: 1 + 2^-53 rounds back to 1, and the widening is lost.
//
// Assumptions about libm, measured but not proved (glibc's tables of known errors; Zimmermann et al., "Accuracy of
// mathematical functions"): errors below 1 ulp for sin cos tan asin acos atan exp log pow, where we allow 2, and up to
// 2.3 ulp for sinh cosh tanh, where we allow 4. Arguments of any size are reduced exactly.
//
// Endpoints may be infinite (lo = -inf, hi = +inf): then the set is unbounded. undefined() has NaN endpoints. It
// results from a domain violation, a division by an interval that contains 0, or a NaN, and it propagates. Every
// comparison with it is false, so it cannot be mistaken for a proof. Prove with certainly_...(); a negated comparison
// proves nothing.
#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#if defined(__FAST_MATH__) || FLT_EVAL_METHOD != 0
#error "Interval needs IEEE double arithmetic: no -ffast-math, no x87"
#endif

namespace achilles {

namespace rounding {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double largest = std::numeric_limits<double>::max();
inline constexpr double least = std::numeric_limits<double>::denorm_min();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();  // 2^-52
inline constexpr int libm = 2;                                             // ulps allowed to libm
inline constexpr int hyperbolic = 4;                                       // ulps allowed to sinh, cosh, tanh

// Upper bound on every real within `ulps` ulps of a real whose nearest double is x. An overflow to -inf is first raised
// to the largest negative double. NaN stays NaN.
inline double up(double x, int ulps = 1) {
    const double y = x < -largest ? -largest : x;
    return y + ulps * (epsilon * std::abs(y) + least);
}
inline double down(double x, int ulps = 1) {
    const double y = x > largest ? largest : x;
    return y - ulps * (epsilon * std::abs(y) + least);
}
// The same for sums, differences and square roots. Their denormal results are exact, so 0 stays 0.
inline double sum_up(double x) {
    const double y = x < -largest ? -largest : x;
    return y + epsilon * std::abs(y);
}
inline double sum_down(double x) {
    const double y = x > largest ? largest : x;
    return y - epsilon * std::abs(y);
}

// Two numbers that one instruction of the processor computes together. Of a comparison with a constant GCC 12 does not
// make the minimum or maximum that the processor has, hence the intrinsics. Both versions give the same bits.
using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;

#ifdef __SSE2__
inline Pair least_of(Pair a, Pair b) { return _mm_min_pd(a, b); }
inline Pair most_of(Pair a, Pair b) { return _mm_max_pd(a, b); }  // b if one of them is NaN
inline Pair size_of(Pair a) { return _mm_andnot_pd(Pair{-0.0, -0.0}, a); }
inline Pair swapped(Pair a) { return _mm_shuffle_pd(a, a, 1); }
inline bool has_nan(Pair a, Pair b) { return _mm_movemask_pd(_mm_cmpunord_pd(a, b)) != 0; }
#else
inline Pair least_of(Pair a, Pair b) { return a < b ? a : b; }
inline Pair most_of(Pair a, Pair b) { return a > b ? a : b; }
inline Pair size_of(Pair a) { return Pair{std::abs(a[0]), std::abs(a[1])}; }
inline Pair swapped(Pair a) { return Pair{a[1], a[0]}; }
inline bool has_nan(Pair a, Pair b) {
    return std::isnan(a[0]) || std::isnan(a[1]) || std::isnan(b[0]) || std::isnan(b[1]);
}
#endif

// up() and sum_up() of both numbers.
inline Pair up(Pair x) {
    const Pair y = most_of(Pair{-largest, -largest}, x);
    return y + (epsilon * size_of(y) + least);
}
inline Pair sum_up(Pair x) {
    const Pair y = most_of(Pair{-largest, -largest}, x);
    return y + epsilon * size_of(y);
}

}  // namespace rounding

class Interval {
 public:
    Interval() = default;                                                        // [0, 0]
    Interval(double x) : Interval(x, x) {}                                       // NOLINT: a double is a point
    Interval(int x) : ends_{-static_cast<double>(x), static_cast<double>(x)} {}  // NOLINT
    // Undefined unless it is a set of reals: lo > hi, a NaN, lo = +inf and hi = -inf are undefined.
    Interval(double lo, double hi) : ends_{-lo, hi} {
        if (!(lo <= hi) || lo > rounding::largest || hi < -rounding::largest) *this = undefined();
    }

    double lo() const { return 0.0 - ends_[0]; }
    double hi() const { return ends_[1]; }

    static Interval pi() { return trusted(0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1); }
    static Interval undefined() {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return trusted(nan, nan);
    }
    // The real line.
    static Interval everything() { return trusted(-rounding::infinity, rounding::infinity); }

    bool is_defined() const { return lo() <= hi(); }
    bool contains(double x) const { return lo() <= x && x <= hi(); }
    bool contains(const Interval& x) const { return lo() <= x.lo() && x.hi() <= hi(); }

    Interval& operator+=(const Interval& b) { return *this = *this + b; }
    Interval& operator-=(const Interval& b) { return *this = *this - b; }
    Interval& operator*=(const Interval& b) { return *this = *this * b; }
    Interval& operator/=(const Interval& b) { return *this = *this / b; }

    friend Interval operator-(const Interval& a) { return Interval(rounding::swapped(a.ends_)); }
    friend Interval operator+(const Interval& a, const Interval& b) {
        return Interval(rounding::sum_up(a.ends_ + b.ends_));
    }
    friend Interval operator-(const Interval& a, const Interval& b) {
        return Interval(rounding::sum_up(a.ends_ + rounding::swapped(b.ends_)));
    }
    friend Interval operator*(const Interval& a, const Interval& b) {
        return corners(a, b, a.ends_ * b.ends_, a.ends_ * rounding::swapped(b.ends_));
    }
    friend Interval operator/(const Interval& a, const Interval& b) {
        if (!(b.lo() > 0.0 || b.hi() < 0.0)) return undefined();
        return corners(a, b, a.ends_ / b.ends_, a.ends_ / rounding::swapped(b.ends_));
    }

    // [lo, hi] without a check: the caller ensures lo <= hi, or both NaN.
    static Interval trusted(double lo, double hi) { return Interval(rounding::Pair{-lo, hi}); }

 private:
    explicit Interval(rounding::Pair ends) : ends_(ends) {}

    // The hull of the four corner values (p, s) and (-q, -r), widened.
    static Interval corners(const Interval& a, const Interval& b, rounding::Pair ps, rounding::Pair qr) {
        if (rounding::has_nan(ps, qr)) return corners_with_nan(a, b, ps, qr);
        const rounding::Pair one{qr[0], ps[0]}, other{qr[1], ps[1]};
        return Interval(rounding::up(
            rounding::most_of(rounding::most_of(one, other), -rounding::swapped(rounding::least_of(one, other)))));
    }
    // If the operands are defined, a NaN corner is 0 inf or inf / inf. Taking it as 0 is sound: its limits lie in the
    // hull of 0 and the other three corners.
    [[gnu::noinline, gnu::cold]] static Interval corners_with_nan(const Interval& a, const Interval& b,
                                                                  rounding::Pair ps, rounding::Pair qr) {
        if (!a.is_defined() || !b.is_defined()) return undefined();
        const auto number = [](double x) { return std::isnan(x) ? 0.0 : x; };
        return corners(a, b, rounding::Pair{number(ps[0]), number(ps[1])},
                       rounding::Pair{number(qr[0]), number(qr[1])});
    }

    // (-lo, hi): both are rounded up, and a change of sign is a swap.
    rounding::Pair ends_{};
};

// --- Comparisons. The result is false unless the relation is proved.

inline bool certainly_less(const Interval& a, const Interval& b) { return a.hi() < b.lo(); }
inline bool certainly_positive(const Interval& a) { return a.lo() > 0.0; }
inline bool certainly_negative(const Interval& a) { return a.hi() < 0.0; }

// --- Sizes. For undefined(), mag, rad and width are +inf (which std::max keeps, unlike NaN), and mig is 0.

// max |x| over the interval.
inline double mag(const Interval& a) {
    return a.is_defined() ? std::max(std::abs(a.lo()), std::abs(a.hi())) : rounding::infinity;
}
// min |x| over the interval.
inline double mig(const Interval& a) { return std::max({0.0, a.lo(), -a.hi()}); }
// A double inside, near the middle; NaN for undefined().
inline double mid(const Interval& a) {
    const double lo = std::max(a.lo(), -rounding::largest), hi = std::min(a.hi(), rounding::largest);
    return std::clamp(0.5 * lo + 0.5 * hi, lo, hi);
}
// hi - lo, rounded up.
inline double width(const Interval& a) {
    return a.is_defined() ? rounding::sum_up(a.hi() - a.lo()) : rounding::infinity;
}
// Radius around mid() that covers the interval.
inline double rad(const Interval& a) {
    if (!a.is_defined()) return rounding::infinity;
    const double center = mid(a);
    return rounding::sum_up(std::max(a.hi() - center, center - a.lo()));
}

// --- Sets

inline Interval hull(const Interval& a, const Interval& b) {
    if (!a.is_defined() || !b.is_defined()) return Interval::undefined();
    return Interval::trusted(std::min(a.lo(), b.lo()), std::max(a.hi(), b.hi()));
}
inline Interval abs(const Interval& a) {
    return a.is_defined() ? Interval::trusted(mig(a), mag(a)) : Interval::undefined();
}
inline Interval max(const Interval& a, const Interval& b) {
    if (!a.is_defined() || !b.is_defined()) return Interval::undefined();
    return Interval::trusted(std::max(a.lo(), b.lo()), std::max(a.hi(), b.hi()));
}

// --- Powers

namespace rounding {

// Bounds on x^n for x >= 0 and n > 0, by repeated squaring.
inline double power_up(double x, unsigned n) {
    double result = 1.0;
    for (; n != 0; n >>= 1) {
        if (n & 1u) result = up(result * x);
        if (n > 1) x = up(x * x);
    }
    return result;
}
inline double power_down(double x, unsigned n) {
    double result = 1.0;
    for (; n != 0; n >>= 1) {
        if (n & 1u) result = std::max(0.0, down(result * x));
        if (n > 1) x = std::max(0.0, down(x * x));
    }
    return result;
}

}  // namespace rounding

inline Interval square(const Interval& a) {
    if (!a.is_defined()) return a;
    const double least = mig(a), most = mag(a);
    return Interval::trusted(std::max(0.0, rounding::down(least * least)), rounding::up(most * most));
}

// x^n for an integer n, tight for even n.
inline Interval integer_power(const Interval& a, int n) {
    if (n == 2) return square(a);
    if (!a.is_defined()) return a;
    if (n == 0) return {1};
    const unsigned m = n < 0 ? 0u - static_cast<unsigned>(n) : static_cast<unsigned>(n);
    Interval result;
    if (a.lo() >= 0.0 || m % 2 == 0) {
        result = Interval::trusted(rounding::power_down(mig(a), m), rounding::power_up(mag(a), m));
    } else {
        const double hi = a.hi() >= 0.0 ? rounding::power_up(a.hi(), m) : -rounding::power_down(-a.hi(), m);
        result = Interval::trusted(-rounding::power_up(-a.lo(), m), hi);
    }
    return n < 0 ? Interval(1) / result : result;
}

// a^b for a > 0: monotone in each variable, so its extremes are at the corners. Undefined if a may be <= 0.
inline Interval pow(const Interval& a, const Interval& b) {
    if (!(a.lo() > 0.0) || !b.is_defined()) return Interval::undefined();
    const double p = std::pow(a.lo(), b.lo()), q = std::pow(a.lo(), b.hi());
    const double r = std::pow(a.hi(), b.lo()), s = std::pow(a.hi(), b.hi());
    return Interval::trusted(std::max(0.0, rounding::down(std::min({p, q, r, s}), rounding::libm)),
                             rounding::up(std::max({p, q, r, s}), rounding::libm));
}

inline Interval sqrt(const Interval& a) {
    if (!(a.lo() >= 0.0)) return Interval::undefined();
    return Interval::trusted(rounding::sum_down(std::sqrt(a.lo())), rounding::sum_up(std::sqrt(a.hi())));
}

// --- Monotone functions: the values at the endpoints, widened

inline Interval exp(const Interval& a) {
    if (!a.is_defined()) return a;
    return Interval::trusted(std::max(0.0, rounding::down(std::exp(a.lo()), rounding::libm)),
                             rounding::up(std::exp(a.hi()), rounding::libm));
}
inline Interval log(const Interval& a) {
    if (!(a.lo() > 0.0)) return Interval::undefined();
    return Interval::trusted(rounding::down(std::log(a.lo()), rounding::libm),
                             rounding::up(std::log(a.hi()), rounding::libm));
}
inline Interval asin(const Interval& a) {
    if (!(a.lo() >= -1.0 && a.hi() <= 1.0)) return Interval::undefined();
    return Interval::trusted(rounding::down(std::asin(a.lo()), rounding::libm),
                             rounding::up(std::asin(a.hi()), rounding::libm));
}
inline Interval acos(const Interval& a) {
    if (!(a.lo() >= -1.0 && a.hi() <= 1.0)) return Interval::undefined();
    return Interval::trusted(std::max(0.0, rounding::down(std::acos(a.hi()), rounding::libm)),
                             rounding::up(std::acos(a.lo()), rounding::libm));
}
inline Interval atan(const Interval& a) {
    return Interval::trusted(rounding::down(std::atan(a.lo()), rounding::libm),
                             rounding::up(std::atan(a.hi()), rounding::libm));
}
inline Interval sinh(const Interval& a) {
    return Interval::trusted(rounding::down(std::sinh(a.lo()), rounding::hyperbolic),
                             rounding::up(std::sinh(a.hi()), rounding::hyperbolic));
}
inline Interval cosh(const Interval& a) {
    if (!a.is_defined()) return a;
    return Interval::trusted(std::max(1.0, rounding::down(std::cosh(mig(a)), rounding::hyperbolic)),
                             rounding::up(std::cosh(mag(a)), rounding::hyperbolic));
}
inline Interval tanh(const Interval& a) {
    if (!a.is_defined()) return a;
    return Interval::trusted(std::max(-1.0, rounding::down(std::tanh(a.lo()), rounding::hyperbolic)),
                             std::min(1.0, rounding::up(std::tanh(a.hi()), rounding::hyperbolic)));
}

// --- Periodic functions

namespace rounding {

// Multiples (k + shift) pi that may lie in an interval, k = first .. last; empty if first > last.
struct PiMultiples {
    double first, last;
    bool none() const { return first > last; }
    bool even() const { return last > first || (last == first && std::fmod(first, 2.0) == 0.0); }
    bool odd() const { return last > first || (last == first && std::fmod(first, 2.0) != 0.0); }
};

// For larger |x| multiples of pi are not distinguished. Far below 2^52, where doubles lose their last fractional bit.
inline constexpr double largest_angle = 0x1p40;

// All multiples (k + shift) pi inside the interval. May also include one that is outside by a rounding error.
inline PiMultiples multiples_of_pi(const Interval& a, double shift) {
    const Interval turns = a / Interval::pi() - shift;
    return {std::ceil(turns.lo()), std::floor(turns.hi())};
}

// Whether an interval between -largest_angle and largest_angle, computed roughly, lies clearly between two successive
// multiples (k + shift) pi. This is so for most narrow intervals, and costs a quarter of multiples_of_pi().
inline bool is_clear_of_multiples(const Interval& a, double shift) {
    constexpr double per_pi = 0x1.45f306dc9c883p-2;  // 1/pi
    constexpr double clear = 0x1p-8;                 // far more than the errors here, at most 2^-12
    constexpr double integers = 0x1.8p52;            // added and subtracted, it rounds to an integer
    const double from = a.lo() * per_pi - shift, to = a.hi() * per_pi - shift;
    const double nearest = (from + integers) - integers;
    return from > nearest ? from > nearest + clear && to < nearest + (1.0 - clear) : to < nearest - clear;
}

// The range of sin (shift 1/2) or cos (shift 0): maxima at even multiples, minima at odd ones.
inline Interval wave(const Interval& a, double at_lo, double at_hi, double shift) {
    const PiMultiples extrema = is_clear_of_multiples(a, shift) ? PiMultiples{1.0, 0.0} : multiples_of_pi(a, shift);
    const double low = extrema.odd() ? -1.0 : std::max(-1.0, down(std::min(at_lo, at_hi), libm));
    const double high = extrema.even() ? 1.0 : std::min(1.0, up(std::max(at_lo, at_hi), libm));
    return Interval::trusted(low, high);
}

}  // namespace rounding

inline Interval sin(const Interval& a) {
    if (!a.is_defined()) return a;
    if (mag(a) > rounding::largest_angle) return Interval::trusted(-1.0, 1.0);
    return rounding::wave(a, std::sin(a.lo()), std::sin(a.hi()), 0.5);
}
inline Interval cos(const Interval& a) {
    if (!a.is_defined()) return a;
    if (mag(a) > rounding::largest_angle) return Interval::trusted(-1.0, 1.0);
    return rounding::wave(a, std::cos(a.lo()), std::cos(a.hi()), 0.0);
}
// Undefined if a pole may lie inside.
inline Interval tan(const Interval& a) {
    if (!(mag(a) <= rounding::largest_angle) || !rounding::multiples_of_pi(a, 0.5).none()) return Interval::undefined();
    return Interval::trusted(rounding::down(std::tan(a.lo()), rounding::libm),
                             rounding::up(std::tan(a.hi()), rounding::libm));
}

}  // namespace achilles
