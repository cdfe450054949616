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

class Fine {
 public:
    Fine() = default;
    Fine(double x) : high_(x) {}  // NOLINT: exact
    Fine(int x) : high_(x) {}     // NOLINT
    explicit Fine(const Interval& x) : high_(mid(x)), radius_(x.lo() == x.hi() ? 0.0 : rad(x)) {}
    // A value that is not defined: its radius is infinite.
    static Fine undefined() { return {0.0, 0.0, rounding::infinity}; }

    bool is_defined() const { return radius_ < rounding::infinity; }
    // The exact value lies within radius() of high() + low().
    double high() const { return high_; }
    double low() const { return low_; }
    double radius() const { return radius_; }
    static Fine half_pi() { return {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, 0x1p-108}; }
    // An interval that contains the exact value.
    Interval range() const {
        if (!is_defined()) return Interval::undefined();
        if (low_ == 0.0 && radius_ == 0.0) return {high_};
        return Interval(high_) + (Interval(low_) + Interval(-radius_, radius_));
    }

    friend Fine operator-(const Fine& a) { return {-a.high_, -a.low_, a.radius_}; }
    friend Fine operator+(const Fine& a, const Fine& b) {
        const Two s = sum(a.high_, b.high_), t = sum(a.low_, b.low_);
        const double first = s.error + t.value;
        const Two u = sum(s.value, first);
        const double second = u.error + t.error;
        const Two result = sum(u.value, second);
        return {result.value, result.error,
                outward(a.radius_ + b.radius_ + half_ulps(std::abs(first) + std::abs(second)))};
    }
    friend Fine operator-(const Fine& a, const Fine& b) { return a + (-b); }
    friend Fine operator*(const Fine& a, const Fine& b) {
        if (a.is_zero() || b.is_zero()) return (a.is_zero() ? b : a).is_defined() ? Fine() : undefined();
        const Two p = product(a.high_, b.high_);
        const double x = a.high_ * b.low_, y = a.low_ * b.high_, cross = x + y, low = p.error + cross;
        const Two result = sum(p.value, low);
        const double size_a = std::abs(a.high_) + std::abs(a.low_), size_b = std::abs(b.high_) + std::abs(b.low_);
        return {result.value, result.error,
                outward(size_a * b.radius_ + (size_b + b.radius_) * a.radius_ + std::abs(a.low_ * b.low_) +
                        half_ulps(std::abs(x) + std::abs(y) + std::abs(cross) + std::abs(low)) + tiny)};
    }
    // Two quotient digits Q; the error is bounded by |a - Q b|/|b|.
    friend Fine operator/(const Fine& a, const Fine& b) {
        const double least = mig(b.range());
        if (!(least > 0.0) || !a.is_defined()) return undefined();
        const double first = a.high_ / b.high_;
        const Fine rest = a - Fine(first) * b;
        const double second = rest.high_ / b.high_;
        const Two result = sum(first, second);
        return {result.value, result.error, over((rest - Fine(second) * b).range(), least)};
    }
    Fine& operator+=(const Fine& b) { return *this = *this + b; }
    Fine& operator-=(const Fine& b) { return *this = *this - b; }
    Fine& operator*=(const Fine& b) { return *this = *this * b; }

    // Square root as a two-digit s; the error is bounded by |sqrt(a) - s| = |a - s^2|/(sqrt(a) + s).
    friend Fine sqrt(const Fine& a) {
        if (a.is_zero()) return {};
        if (!(a.range().lo() > 0.0)) return undefined();
        const double first = std::sqrt(a.high_);
        const double second = (a - Fine(first) * Fine(first)).high_ / (2.0 * first);
        const Two s = sum(first, second);
        const Fine root{s.value, s.error, 0.0};
        return {s.value, s.error, over((a - root * root).range(), root.range().lo())};
    }
    friend void sine_and_cosine(const Fine& a, Fine& sine, Fine& cosine);

 private:
    struct Two {
        double value, error;
    };
    struct Series;

    Fine(double high, double low, double radius)
        : high_(high), low_(low), radius_(std::isfinite(high) && radius >= 0.0 ? radius : rounding::infinity) {}

    bool is_zero() const { return high_ == 0.0 && low_ == 0.0 && radius_ == 0.0; }

    // Both are exact, except that a product may underflow by less than `tiny`.
    static Two sum(double a, double b) {
        const double s = a + b, of_b = s - a;
        return {s, (a - (s - of_b)) + (b - of_b)};
    }
    static Two product(double a, double b) {
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

struct Fine::Series {
    std::array<Fine, 15> of_sine, of_cosine;
};
inline const Fine::Series& Fine::series() {
    static const Series all = [] {
        Series made;
        Fine factorial = 1.0;
        for (int i = 0; i < 15; ++i) {
            const double sign = i % 2 == 0 ? 1.0 : -1.0;
            if (i > 0) factorial = factorial * Fine((2.0 * i - 1.0) * (2.0 * i));
            made.of_cosine[static_cast<std::size_t>(i)] = Fine(sign) / factorial;
            made.of_sine[static_cast<std::size_t>(i)] = Fine(sign) / (factorial * Fine(2.0 * i + 1.0));
        }
        return made;
    }();
    return all;
}

// Sine and cosine: reduces the angle by a multiple of pi/2, then sums both Taylor series. Angles beyond 2^20 use
// Interval.
inline void sine_and_cosine(const Fine& a, Fine& sine, Fine& cosine) {
    constexpr double farthest = 0x1p20;
    if (!(std::abs(a.high_) <= farthest) || !a.is_defined()) {
        const Interval angle = a.range();
        sine = Fine(sin(angle));
        cosine = Fine(cos(angle));
        return;
    }
    const double turns = std::nearbyint(a.high_ * (2.0 / 0x1.921fb54442d18p+1)), radius = a.radius_;
    const Fine x = Fine{a.high_, a.low_, 0.0} - Fine(turns) * Fine::half_pi(), square = x * x;
    const Fine::Series& terms = Fine::series();
    Fine s = terms.of_sine.back(), c = terms.of_cosine.back();
    for (std::size_t i = terms.of_sine.size() - 1; i-- > 0;) {
        s = s * square + terms.of_sine[i];
        c = c * square + terms.of_cosine[i];
    }
    s = s * x;
    // The truncation error is below the first omitted term, |x| < 0.8. Both functions have derivatives of at most 1, so
    // the radius of the angle is added.
    s.radius_ = Fine::outward(s.radius_ + 0x1p-112 + radius);
    c.radius_ = Fine::outward(c.radius_ + 0x1p-112 + radius);
    const auto quadrant = static_cast<long>(turns) & 3;
    const Fine wave[4] = {s, c, -s, -c};
    sine = wave[quadrant];
    cosine = wave[(quadrant + 1) & 3];
}

inline Fine sin(const Fine& a) {
    Fine sine, cosine;
    sine_and_cosine(a, sine, cosine);
    return sine;
}
inline Fine cos(const Fine& a) {
    Fine sine, cosine;
    sine_and_cosine(a, sine, cosine);
    return cosine;
}
inline Fine tan(const Fine& a) {
    Fine sine, cosine;
    sine_and_cosine(a, sine, cosine);
    return sine / cosine;
}

// --- All other functions, no more accurate than intervals

#define AS_AN_INTERVAL(name) \
    inline Fine name(const Fine& a) { return Fine(name(a.range())); }
AS_AN_INTERVAL(exp)
AS_AN_INTERVAL(log)
AS_AN_INTERVAL(asin)
AS_AN_INTERVAL(acos)
AS_AN_INTERVAL(atan)
AS_AN_INTERVAL(sinh)
AS_AN_INTERVAL(cosh)
AS_AN_INTERVAL(tanh)
#undef AS_AN_INTERVAL
inline Fine pow(const Fine& a, const Fine& b) { return Fine(pow(a.range(), b.range())); }

}  // namespace achilles
