// Interval arithmetic that is sound in round-to-nearest. The only file that knows rounding.
//
// Every result is computed to nearest and widened outward: an arithmetic result x by 2^-52 |x| plus the least denormal,
// which is at least one unit in the last place (2^-53 |x| is not enough: at a power of two 1 + 2^-53 rounds back to 1),
// a library function's by as many units as libm may err. Assumed of libm, and tested: sqrt is correctly rounded; sin, cos,
// tan, asin, acos, atan, exp, log and pow err by less than 2 units in the last place, sinh, cosh and tanh by less than 4
// (glibc documents 1 and 2). No rounding mode is changed, so no compiler option can break a proof.
//
// Where a function is not defined on the whole argument, or an operation has no bound, the result is undefined(): both ends
// are NaN. It propagates, and no comparison with it is true, so it can never be mistaken for a proof.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace achilles {

class Interval {
 public:
    constexpr Interval() = default;
    constexpr Interval(double x) : lo_(x), hi_(x) {}  // NOLINT: a number is an interval
    constexpr Interval(int x) : lo_(x), hi_(x) {}     // NOLINT
    // The interval [lo, hi]; undefined unless lo <= hi.
    constexpr Interval(double lo, double hi) : lo_(lo <= hi ? lo : nan), hi_(lo <= hi ? hi : nan) {}

    static constexpr Interval undefined() { return {nan, nan}; }
    static constexpr Interval pi() { return {0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1}; }

    constexpr double lo() const { return lo_; }
    constexpr double hi() const { return hi_; }
    constexpr bool is_defined() const { return lo_ <= hi_; }
    constexpr double mid() const { return lo_ + 0.5 * (hi_ - lo_); }
    constexpr double width() const { return hi_ - lo_; }
    constexpr double rad() const { return 0.5 * (hi_ - lo_); }
    bool contains(double x) const { return lo_ <= x && x <= hi_; }
    bool contains(const Interval& other) const { return lo_ <= other.lo_ && other.hi_ <= hi_; }
    // Largest and least absolute value.
    double mag() const { return std::max(std::abs(lo_), std::abs(hi_)); }
    double mig() const { return lo_ > 0.0 ? lo_ : hi_ < 0.0 ? -hi_ : 0.0 * lo_; }

 private:
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    double lo_ = 0.0, hi_ = 0.0;
};

inline constexpr Interval entire{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

// True only where it holds for every pair of members.
constexpr bool certainly_less(const Interval& a, const Interval& b) { return a.hi() < b.lo(); }
constexpr bool certainly_positive(const Interval& a) { return a.lo() > 0.0; }
constexpr bool certainly_negative(const Interval& a) { return a.hi() < 0.0; }

namespace detail {

// [lo, hi] widened by `ulps` units in the last place or more.
constexpr Interval widened(double lo, double hi, int ulps = 1) {
    const double relative = ulps * 0x1p-52, least = ulps * std::numeric_limits<double>::denorm_min();
    return {lo - (relative * (lo < 0.0 ? -lo : lo) + least), hi + (relative * (hi < 0.0 ? -hi : hi) + least)};
}

// The hull of four values; undefined if one of them, or their sum, is not a number (0 times infinity).
inline Interval hull_of(double p, double q, double r, double s) {
    if (std::isnan(p + q + r + s)) return Interval::undefined();
    return widened(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

// The part of `a` between two bounds that the function never crosses.
inline Interval clamped(const Interval& a, double low, double high) {
    if (!a.is_defined()) return a;
    return {std::max(a.lo(), low), std::min(a.hi(), high)};
}

}  // namespace detail

inline Interval operator-(const Interval& a) { return {-a.hi(), -a.lo()}; }
inline Interval operator+(const Interval& a, const Interval& b) {
    return detail::widened(a.lo() + b.lo(), a.hi() + b.hi());
}
inline Interval operator-(const Interval& a, const Interval& b) {
    return detail::widened(a.lo() - b.hi(), a.hi() - b.lo());
}
inline Interval operator*(const Interval& a, const Interval& b) {
    return detail::hull_of(a.lo() * b.lo(), a.lo() * b.hi(), a.hi() * b.lo(), a.hi() * b.hi());
}
// Undefined where b contains 0.
inline Interval operator/(const Interval& a, const Interval& b) {
    if (!(b.lo() > 0.0 || b.hi() < 0.0)) return Interval::undefined();
    return detail::hull_of(a.lo() / b.lo(), a.lo() / b.hi(), a.hi() / b.lo(), a.hi() / b.hi());
}

inline Interval hull(const Interval& a, const Interval& b) {
    if (!a.is_defined() || !b.is_defined()) return Interval::undefined();
    return {std::min(a.lo(), b.lo()), std::max(a.hi(), b.hi())};
}
inline Interval abs(const Interval& a) { return {a.mig(), a.mag()}; }
inline Interval square(const Interval& a) {
    return detail::clamped(detail::widened(a.mig() * a.mig(), a.mag() * a.mag()), 0.0,
                           std::numeric_limits<double>::infinity());
}

// The part of `a` that is not negative: for what cannot be, a sum of squares, whose lower end rounding has moved below 0.
inline Interval nonnegative(const Interval& a) {
    return detail::clamped(a, 0.0, std::numeric_limits<double>::infinity());
}

// x^n, tight: even powers do not forget that x x >= 0. Found before the generic integer_power of scalar.hpp.
inline Interval integer_power(const Interval& a, int n) {
    const auto raise = [](double x, unsigned m) {
        Interval base(x), result(1.0);
        for (; m != 0; m >>= 1) {
            if ((m & 1u) != 0) result = result * base;
            if (m > 1) base = base * base;
        }
        return result;
    };
    const unsigned m = n < 0 ? 0u - static_cast<unsigned>(n) : static_cast<unsigned>(n);
    if (m == 2 && n > 0) return square(a);
    if (!a.is_defined()) return a;
    const bool even = m % 2 == 0;
    const Interval low = raise(even ? a.mig() : a.lo(), m), high = raise(even ? a.mag() : a.hi(), m);
    const Interval power = detail::clamped(hull(low, high), even ? 0.0 : entire.lo(), entire.hi());
    return n < 0 ? Interval(1.0) / power : power;
}

inline Interval sqrt(const Interval& a) {
    if (!(a.lo() >= 0.0)) return Interval::undefined();
    return detail::clamped(detail::widened(std::sqrt(a.lo()), std::sqrt(a.hi())), 0.0, entire.hi());
}
inline Interval exp(const Interval& a) {
    return detail::clamped(detail::widened(std::exp(a.lo()), std::exp(a.hi()), 2), 0.0, entire.hi());
}
inline Interval log(const Interval& a) {
    if (!(a.lo() > 0.0)) return Interval::undefined();
    return detail::widened(std::log(a.lo()), std::log(a.hi()), 2);
}
inline Interval sinh(const Interval& a) { return detail::widened(std::sinh(a.lo()), std::sinh(a.hi()), 4); }
inline Interval cosh(const Interval& a) {
    return detail::clamped(detail::widened(std::cosh(a.mig()), std::cosh(a.mag()), 4), 1.0, entire.hi());
}
inline Interval tanh(const Interval& a) {
    return detail::clamped(detail::widened(std::tanh(a.lo()), std::tanh(a.hi()), 4), -1.0, 1.0);
}
inline Interval asin(const Interval& a) {
    if (!(a.lo() >= -1.0 && a.hi() <= 1.0)) return Interval::undefined();
    return detail::widened(std::asin(a.lo()), std::asin(a.hi()), 2);
}
inline Interval acos(const Interval& a) {
    if (!(a.lo() >= -1.0 && a.hi() <= 1.0)) return Interval::undefined();
    return detail::clamped(detail::widened(std::acos(a.hi()), std::acos(a.lo()), 2), 0.0, Interval::pi().hi());
}
inline Interval atan(const Interval& a) { return detail::widened(std::atan(a.lo()), std::atan(a.hi()), 2); }

namespace detail {

// The multiples m of pi/2 that may lie inside an interval: first <= m <= last. `known` is false where the argument is too
// large, or too wide, to tell.
struct Quarters {
    bool known = false;
    double first = 0.0, last = -1.0;
    // Is there an m = residue modulo 4 among them?
    bool meet(int residue) const {
        const double m = first + std::fmod(std::fmod(residue - first, 4.0) + 4.0, 4.0);
        return m <= last;
    }
};

inline Quarters quarters(const Interval& a) {
    constexpr Interval half_pi{0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0};
    if (!(a.mag() < 0x1p40)) return {};
    const double low = (Interval(a.lo()) / half_pi).lo(), high = (Interval(a.hi()) / half_pi).hi();
    return {high - low < 1000.0, std::ceil(low), std::floor(high)};
}

// sin and cos: extremes at the quarters `top` and `bottom` modulo 4, monotone between.
inline Interval wave(const Interval& a, double at_lo, double at_hi, int top, int bottom) {
    if (!a.is_defined()) return a;
    const Quarters q = quarters(a);
    if (!q.known) return {-1.0, 1.0};
    const double low = q.meet(bottom) ? -1.0 : std::min(at_lo, at_hi), high = q.meet(top) ? 1.0 : std::max(at_lo, at_hi);
    return clamped(widened(low, high, 2), -1.0, 1.0);
}

}  // namespace detail

inline Interval sin(const Interval& a) { return detail::wave(a, std::sin(a.lo()), std::sin(a.hi()), 1, 3); }
inline Interval cos(const Interval& a) { return detail::wave(a, std::cos(a.lo()), std::cos(a.hi()), 0, 2); }
// Undefined where a pole may lie inside.
inline Interval tan(const Interval& a) {
    const detail::Quarters q = detail::quarters(a);
    if (!q.known || q.meet(1) || q.meet(3)) return Interval::undefined();
    return detail::widened(std::tan(a.lo()), std::tan(a.hi()), 2);
}

// a^b for a > 0 (a >= 0 where b > 0): monotone in each argument, so the corners are the extremes.
inline Interval pow(const Interval& a, const Interval& b) {
    if (!(a.lo() > 0.0 || (a.lo() == 0.0 && b.lo() > 0.0)) || !b.is_defined()) return Interval::undefined();
    const double p = std::pow(a.lo(), b.lo()), q = std::pow(a.lo(), b.hi()), r = std::pow(a.hi(), b.lo()),
                 s = std::pow(a.hi(), b.hi());
    if (std::isnan(p + q + r + s)) return Interval::undefined();
    return detail::clamped(detail::widened(std::min(std::min(p, q), std::min(r, s)),
                                           std::max(std::max(p, q), std::max(r, s)), 2), 0.0, entire.hi());
}

}  // namespace achilles
