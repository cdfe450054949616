#include "enclose/first_root.hpp"

#include <algorithm>

#include "number/jet.hpp"

namespace achilles {

namespace {

Interval plain_value(const Intervals& c, const Interval& t) {
    Interval sum = c.back();
    for (std::size_t k = c.size() - 1; k-- > 0;) sum = times(sum, t) + c[k];
    return sum;
}

}  // namespace

Interval slope_over(const Intervals& c, const Interval& t) {
    Interval sum(0.0);
    for (std::size_t k = c.size() - 1; k >= 1; --k) sum = times(sum, t) + times(Interval(static_cast<double>(k)), c[k]);
    return sum;
}

// Horner's scheme, or from the middle by the derivative.
Interval value_over(const Intervals& c, const Interval& t) {
    const Interval plain = plain_value(c, t), middle(mid(t));
    const Interval sharp = plain_value(c, middle) + times(slope_over(c, t), t - middle);
    const double lo = std::max(plain.lo(), sharp.lo()), hi = std::min(plain.hi(), sharp.hi());
    return lo <= hi ? Interval(lo, hi) : plain;
}

FirstRoot first_root(const Intervals& c, double length) {
    constexpr double finest = 0x1p-32;  // of the length: next to a graze a gap is narrow
    double a = 0.0, piece = length;
    while (a < length) {
        const double b = std::min(a + piece, length);
        if (value_over(c, {a, b}).lo() > 0.0) {
            a = b;
            piece = 2.0 * piece;
            continue;
        }
        piece = 0.5 * std::min(piece, length - a);
        if (piece < finest * length) break;
    }
    if (a >= length) return {FirstRoot::Kind::none, {}};
    // From a on: p > 0 at a and p' < 0 on [a, b], so that there is one zero at most, and Newton's image before b says that
    // there is one.
    for (double reach = finest * length; a > 0.0 || c.front().lo() > 0.0; reach *= 2.0) {
        const double b = std::min(a + reach, length);
        const Interval slope = slope_over(c, {a, b}), middle(0.5 * a + 0.5 * b);
        if (certainly_negative(slope)) {
            const Interval image = middle - plain_value(c, middle) / slope;
            if (image.hi() < b && image.hi() >= a) return {FirstRoot::Kind::one, {std::max(a, image.lo()), image.hi()}};
        }
        if (b >= length) break;
    }
    return {FirstRoot::Kind::doubt, Interval(a)};
}

}  // namespace achilles
