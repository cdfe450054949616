// Fine: a double-double number with a rigorous error radius (about 100 bits). It is used for the center of an
// enclosure, because what Interval loses there at each operation is never recovered over a long run
// (theory-enclosure.md 2).
//
// Double-double arithmetic (Dekker 1971): Knuth's sum and products by fused multiply-add. Each remaining rounding to
// nearest is off by at most 2^-53 of its result, and this is added to the radius. The assumptions are those of
// Interval: rounding to nearest, and its error bounds for libm. Sums, products, quotients, square roots, sines and
// cosines do not use libm.
#pragma once

#include <array>
#include <cmath>

#include "number/interval.hpp"

namespace achilles {

class DoubleDoubleBall {
 public:
    DoubleDoubleBall() = default;
    DoubleDoubleBall(double x) : high_(x) {}  // NOLINT: exact
    DoubleDoubleBall(int x) : high_(x) {}     // NOLINT
    explicit DoubleDoubleBall(const Interval& x) : high_(mid(x)), radius_(x.lo() == x.hi() ? 0.0 : rad(x)) {}
    // A value that is not defined: its radius is infinite.
    static DoubleDoubleBall undefined() { return {0.0, 0.0, rounding::infinity}; }

    bool is_defined() const { return radius_ < rounding::infinity; }
    // The exact value lies within radius() of high() + low().
    double high() const { return high_; }
    double low() const { return low_; }
    double radius() const { return radius_; }
    static DoubleDoubleBall half_pi() { return {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, 0x1p-108}; }
    // An interval that contains the exact value.
    Interval range() const {
        if (!is_defined()) return Interval::undefined();
        if (low_ == 0.0 && radius_ == 0.0) return {high_};
        return Interval(high_) + (Interval(low_) + Interval(-radius_, radius_));
    }

    friend DoubleDoubleBall operator-(const DoubleDoubleBall& a) { return {-a.high_, -a.low_, a.radius_}; }
    friend DoubleDoubleBall operator+(const DoubleDoubleBall& a, const DoubleDoubleBall& b) {
        const ValueAndError s = sum(a.high_, b.high_), t = sum(a.low_, b.low_);
        const double first = s.error + t.value;
        const ValueAndError u = sum(s.value, first);
        const double second = u.error + t.error;
        const ValueAndError result = sum(u.value, second);
        return {result.value, result.error,
                outward(a.radius_ + b.radius_ + half_ulps(std::abs(first) + std::abs(second)))};
    }
    friend DoubleDoubleBall operator-(const DoubleDoubleBall& a, const DoubleDoubleBall& b) { return a + (-b); }
    friend DoubleDoubleBall operator*(const DoubleDoubleBall& a, const DoubleDoubleBall& b) {
        if (a.is_zero() || b.is_zero()) return (a.is_zero() ? b : a).is_defined() ? DoubleDoubleBall() : undefined();
        const ValueAndError p = product(a.high_, b.high_);
        const double x = a.high_ * b.low_, y = a.low_ * b.high_, cross = x + y, low = p.error + cross;
        const ValueAndError result = sum(p.value, low);
        const double size_a = std::abs(a.high_) + std::abs(a.low_), size_b = std::abs(b.high_) + std::abs(b.low_);
        return {result.value, result.error,
                outward(size_a * b.radius_ + (size_b + b.radius_) * a.radius_ + std::abs(a.low_ * b.low_) +
                        half_ulps(std::abs(x) + std::abs(y) + std::abs(cross) + std::abs(low)) + tiny)};
    }
    // Two quotient digits Q; the error is bounded by |a - Q b|/|b|.
    friend DoubleDoubleBall operator/(const DoubleDoubleBall& a, const DoubleDoubleBall& b) {
        const double least = mig(b.range());
        if (!(least > 0.0) || !a.is_defined()) return undefined();
        const double first = a.high_ / b.high_;
        const DoubleDoubleBall rest = a - DoubleDoubleBall(first) * b;
        const double second = rest.high_ / b.high_;
        const ValueAndError result = sum(first, second);
        return {result.value, result.error, over((rest - DoubleDoubleBall(second) * b).range(), least)};
    }
    DoubleDoubleBall& operator+=(const DoubleDoubleBall& b) { return *this = *this + b; }
    DoubleDoubleBall& operator-=(const DoubleDoubleBall& b) { return *this = *this - b; }
    DoubleDoubleBall& operator*=(const DoubleDoubleBall& b) { return *this = *this * b; }

    // Square root as a two-digit s; the error is bounded by |sqrt(a) - s| = |a - s^2|/(sqrt(a) + s).
    friend DoubleDoubleBall sqrt(const DoubleDoubleBall& a) {
        if (a.is_zero()) return {};
        if (!(a.range().lo() > 0.0)) return undefined();
        const double first = std::sqrt(a.high_);
        const double second = (a - DoubleDoubleBall(first) * DoubleDoubleBall(first)).high_ / (2.0 * first);
        const ValueAndError s = sum(first, second);
        const DoubleDoubleBall root{s.value, s.error, 0.0};
        return {s.value, s.error, over((a - root * root).range(), root.range().lo())};
    }
    friend void sine_and_cosine(const DoubleDoubleBall& a, DoubleDoubleBall& sine, DoubleDoubleBall& cosine);

 private:
    struct ValueAndError {
        double value, error;
    };
    struct Series;

    DoubleDoubleBall(double high, double low, double radius)
        : high_(high), low_(low), radius_(std::isfinite(high) && radius >= 0.0 ? radius : rounding::infinity) {}

    bool is_zero() const { return high_ == 0.0 && low_ == 0.0 && radius_ == 0.0; }

    // Both are exact, except that a product may underflow by less than `tiny`.
    static ValueAndError sum(double a, double b) {
        const double s = a + b, of_b = s - a;
        return {s, (a - (s - of_b)) + (b - of_b)};
    }
    static ValueAndError product(double a, double b) {
        const double p = a * b;
        return {p, std::fma(a, b, -p)};
    }
    static constexpr double tiny = 0x1p-900;
    // Bound on the total rounding error of results whose sizes add up to `size`.
    static double half_ulps(double size) { return 0x1p-53 * size; }
    // Upper bound on a few sums and products of nonnegative numbers, given their rounded value.
    static double outward(double bound) { return bound * (1.0 + 0x1p-46); }
    static double over(const Interval& rest, double least) {
        return rest.is_defined() ? (Interval(mag(rest)) / Interval(least)).hi() : rounding::infinity;
    }

    static const Series& series();

    double high_ = 0.0, low_ = 0.0, radius_ = 0.0;
};

struct DoubleDoubleBall::Series {
    std::array<DoubleDoubleBall, 15> of_sine, of_cosine;
};
inline const DoubleDoubleBall::Series& DoubleDoubleBall::series() {
    static const Series all = [] {
        Series made;
        DoubleDoubleBall factorial = 1.0;
        for (int i = 0; i < 15; ++i) {
            const double sign = i % 2 == 0 ? 1.0 : -1.0;
            if (i > 0) factorial = factorial * DoubleDoubleBall((2.0 * i - 1.0) * (2.0 * i));
            made.of_cosine[static_cast<std::size_t>(i)] = DoubleDoubleBall(sign) / factorial;
            made.of_sine[static_cast<std::size_t>(i)] =
                DoubleDoubleBall(sign) / (factorial * DoubleDoubleBall(2.0 * i + 1.0));
        }
        return made;
    }();
    return all;
}

// Sine and cosine: reduces the angle by a multiple of pi/2, then sums both Taylor series. Angles beyond 2^20 use
// Interval.
inline void sine_and_cosine(const DoubleDoubleBall& a, DoubleDoubleBall& sine, DoubleDoubleBall& cosine) {
    constexpr double farthest = 0x1p20;
    if (!(std::abs(a.high_) <= farthest) || !a.is_defined()) {
        const Interval angle = a.range();
        sine = DoubleDoubleBall(sin(angle));
        cosine = DoubleDoubleBall(cos(angle));
        return;
    }
    const double turns = std::nearbyint(a.high_ * (2.0 / 0x1.921fb54442d18p+1)), radius = a.radius_;
    const DoubleDoubleBall x = DoubleDoubleBall{a.high_, a.low_, 0.0} -
                               DoubleDoubleBall(turns) * DoubleDoubleBall::half_pi(),
                           square = x * x;
    const DoubleDoubleBall::Series& terms = DoubleDoubleBall::series();
    DoubleDoubleBall s = terms.of_sine.back(), c = terms.of_cosine.back();
    for (std::size_t i = terms.of_sine.size() - 1; i-- > 0;) {
        s = s * square + terms.of_sine[i];
        c = c * square + terms.of_cosine[i];
    }
    s = s * x;
    // The truncation error is below the first omitted term, |x| < 0.8. Both functions have derivatives of at most 1, so
    // the radius of the angle is added.
    s.radius_ = DoubleDoubleBall::outward(s.radius_ + 0x1p-112 + radius);
    c.radius_ = DoubleDoubleBall::outward(c.radius_ + 0x1p-112 + radius);
    const auto quadrant = static_cast<long>(turns) & 3;
    const DoubleDoubleBall wave[4] = {s, c, -s, -c};
    sine = wave[quadrant];
    cosine = wave[(quadrant + 1) & 3];
}

inline DoubleDoubleBall sin(const DoubleDoubleBall& a) {
    DoubleDoubleBall sine, cosine;
    sine_and_cosine(a, sine, cosine);
    return sine;
}
inline DoubleDoubleBall cos(const DoubleDoubleBall& a) {
    DoubleDoubleBall sine, cosine;
    sine_and_cosine(a, sine, cosine);
    return cosine;
}
inline DoubleDoubleBall tan(const DoubleDoubleBall& a) {
    DoubleDoubleBall sine, cosine;
    sine_and_cosine(a, sine, cosine);
    return sine / cosine;
}

// --- All other functions, no more accurate than intervals

#define AS_AN_INTERVAL(name) \
    inline DoubleDoubleBall name(const DoubleDoubleBall& a) { return DoubleDoubleBall(name(a.range())); }
AS_AN_INTERVAL(exp)
AS_AN_INTERVAL(log)
AS_AN_INTERVAL(asin)
AS_AN_INTERVAL(acos)
AS_AN_INTERVAL(atan)
AS_AN_INTERVAL(sinh)
AS_AN_INTERVAL(cosh)
AS_AN_INTERVAL(tanh)
#undef AS_AN_INTERVAL
inline DoubleDoubleBall pow(const DoubleDoubleBall& a, const DoubleDoubleBall& b) {
    return DoubleDoubleBall(pow(a.range(), b.range()));
}

}  // namespace achilles
