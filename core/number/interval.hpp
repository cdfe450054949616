// Interval: a closed set of reals [lo, hi] that provably contains the exact value. The only file that knows rounding.
//
// Sound in round-to-nearest (theory.md 9.5; rounding modes do not reach libm, and optimisers ignore them): every
// result is widened outward. An IEEE operation is off by at most half an ulp, and ulp(x) <= 2^-52 |x| for normal x, so
//     exact value of x op y  in  fl(x op y) +- (2^-52 |fl(x op y)| + least denormal).
// Not 2^-53: at a power of two 1 + 2^-53 rounds back to 1, and the widening is lost.
//
// Assumed of libm, which is not proved but measured (glibc's tables of known errors; Zimmermann et al., "Accuracy of
// mathematical functions"): errors below 1 ulp for sin cos tan asin acos atan exp log pow, where we allow 2, and up to
// 2.3 ulp for sinh cosh tanh, where we allow 4; and arguments of any size are reduced exactly.
//
// Endpoints may be infinite (lo = -inf, hi = +inf): then the set is unbounded. What has no value is undefined(), whose
// endpoints are NaN: a domain violation, division by an interval that contains 0, a NaN. It propagates, and no
// comparison with it is ever true: it cannot be mistaken for a proof. Prove with certainly_...(), never by negating a
// question.
#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

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

// Above every real that is within `ulps` ulps of one whose nearest double is x. A -inf that overflow made is lifted to
// a double first. NaN stays NaN.
inline double up(double x, int ulps = 1) {
    const double y = x < -largest ? -largest : x;
    return y + ulps * (epsilon * std::abs(y) + least);
}
inline double down(double x, int ulps = 1) {
    const double y = x > largest ? largest : x;
    return y - ulps * (epsilon * std::abs(y) + least);
}
// The same for sums, differences and roots: there a denormal result is exact, so that 0 stays 0.
inline double sum_up(double x) {
    const double y = x < -largest ? -largest : x;
    return y + epsilon * std::abs(y);
}
inline double sum_down(double x) {
    const double y = x > largest ? largest : x;
    return y - epsilon * std::abs(y);
}

}  // namespace rounding

class Interval {
 public:
    Interval() = default;                   // [0, 0]
    Interval(double x) : Interval(x, x) {}  // NOLINT: a double is a point
    Interval(int x) : lo_(x), hi_(x) {}     // NOLINT
    // Undefined where this is no set of reals: lo > hi, a NaN, lo = +inf, hi = -inf.
    Interval(double lo, double hi) : lo_(lo), hi_(hi) {
        if (!(lo <= hi) || lo > rounding::largest || hi < -rounding::largest) *this = undefined();
    }

    double lo() const { return lo_; }
    double hi() const { return hi_; }

    static Interval pi() { return trusted(0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1); }
    static Interval undefined() {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return trusted(nan, nan);
    }
    // Every real.
    static Interval everything() { return trusted(-rounding::infinity, rounding::infinity); }

    bool is_defined() const { return lo_ <= hi_; }
    bool contains(double x) const { return lo_ <= x && x <= hi_; }
    bool contains(const Interval& x) const { return lo_ <= x.lo_ && x.hi_ <= hi_; }

    Interval& operator+=(const Interval& b) { return *this = *this + b; }
    Interval& operator-=(const Interval& b) { return *this = *this - b; }
    Interval& operator*=(const Interval& b) { return *this = *this * b; }
    Interval& operator/=(const Interval& b) { return *this = *this / b; }

    friend Interval operator-(const Interval& a) { return trusted(-a.hi_, -a.lo_); }
    friend Interval operator+(const Interval& a, const Interval& b) {
        return trusted(rounding::sum_down(a.lo_ + b.lo_), rounding::sum_up(a.hi_ + b.hi_));
    }
    friend Interval operator-(const Interval& a, const Interval& b) {
        return trusted(rounding::sum_down(a.lo_ - b.hi_), rounding::sum_up(a.hi_ - b.lo_));
    }
    friend Interval operator*(const Interval& a, const Interval& b) {
        return corners(a, b, a.lo_ * b.lo_, a.lo_ * b.hi_, a.hi_ * b.lo_, a.hi_ * b.hi_);
    }
    friend Interval operator/(const Interval& a, const Interval& b) {
        if (!(b.lo_ > 0.0 || b.hi_ < 0.0)) return undefined();
        return corners(a, b, a.lo_ / b.lo_, a.lo_ / b.hi_, a.hi_ / b.lo_, a.hi_ / b.hi_);
    }

    // [lo, hi] known to be ordered, or both NaN: no check.
    static Interval trusted(double lo, double hi) {
        Interval result;
        result.lo_ = lo;
        result.hi_ = hi;
        return result;
    }

 private:
    // The hull of four corner values, widened. A NaN corner of defined operands is 0 inf or inf / inf, whose limits
    // together with the other three corners are bounded by taking it as 0.
    static Interval corners(const Interval& a, const Interval& b, double p, double q, double r, double s) {
        if (std::isnan(p + q + r + s)) {  // NaN corner, or merely inf - inf here
            if (!a.is_defined() || !b.is_defined()) return undefined();
            for (double* corner : {&p, &q, &r, &s}) *corner = std::isnan(*corner) ? 0.0 : *corner;
        }
        return trusted(rounding::down(std::min(std::min(p, q), std::min(r, s))),
                       rounding::up(std::max(std::max(p, q), std::max(r, s))));
    }

    double lo_ = 0.0, hi_ = 0.0;
};

// --- Questions. A doubtful or undefined answer is false.

inline bool certainly_less(const Interval& a, const Interval& b) { return a.hi() < b.lo(); }
inline bool certainly_positive(const Interval& a) { return a.lo() > 0.0; }
inline bool certainly_negative(const Interval& a) { return a.hi() < 0.0; }

// --- Sizes. Of undefined(): mag, rad and width are +inf (std::max cannot lose that, as it loses a NaN), mig is 0.

// The greatest |x|.
inline double mag(const Interval& a) {
    return a.is_defined() ? std::max(std::abs(a.lo()), std::abs(a.hi())) : rounding::infinity;
}
// The least |x|.
inline double mig(const Interval& a) { return std::max({0.0, a.lo(), -a.hi()}); }
// A double inside, near the middle; NaN of undefined().
inline double mid(const Interval& a) {
    const double lo = std::max(a.lo(), -rounding::largest), hi = std::min(a.hi(), rounding::largest);
    return std::clamp(0.5 * lo + 0.5 * hi, lo, hi);
}
// hi - lo, rounded up.
inline double width(const Interval& a) {
    return a.is_defined() ? rounding::sum_up(a.hi() - a.lo()) : rounding::infinity;
}
// A radius about mid() that covers the interval.
inline double rad(const Interval& a) {
    if (!a.is_defined()) return rounding::infinity;
    const double centre = mid(a);
    return rounding::sum_up(std::max(a.hi() - centre, centre - a.lo()));
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

// Bounds of x^n, x >= 0, by repeated squaring; n > 0.
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

// a^b for a > 0: monotone in each variable, so its extremes are at the corners. Undefined where a <= 0 is possible.
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

// Multiples (k + shift) pi that may lie in an interval: k = first .. last, none where first > last.
struct Multiples {
    double first, last;
    bool none() const { return first > last; }
    bool even() const { return last > first || (last == first && std::fmod(first, 2.0) == 0.0); }
    bool odd() const { return last > first || (last == first && std::fmod(first, 2.0) != 0.0); }
};

// Beyond this |x| multiples of pi are not told apart; far below 2^52, where doubles lose their last binary place.
inline constexpr double largest_angle = 0x1p40;

// Every multiple that is inside is found; one that is not may be found too, if it is within rounding of an endpoint.
inline Multiples multiples_of_pi(const Interval& a, double shift) {
    const Interval turns = a / Interval::pi() - shift;
    return {std::ceil(turns.lo()), std::floor(turns.hi())};
}

// The range of sin (shift 1/2) or cos (shift 0): maxima at even multiples, minima at odd ones.
inline Interval wave(const Interval& a, double at_lo, double at_hi, double shift) {
    const Multiples extrema = multiples_of_pi(a, shift);
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
// Undefined where a pole may lie inside.
inline Interval tan(const Interval& a) {
    if (!(mag(a) <= rounding::largest_angle) || !rounding::multiples_of_pi(a, 0.5).none()) return Interval::undefined();
    return Interval::trusted(rounding::down(std::tan(a.lo()), rounding::libm),
                             rounding::up(std::tan(a.hi()), rounding::libm));
}

}  // namespace achilles
