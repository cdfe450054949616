#include "number/polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "number/inner_loops.hpp"

namespace achilles {

double Polynomial::operator()(double theta) const {
    double value = 0.0;
    for (int i = degree; i >= 0; --i) value = value * theta + c[static_cast<std::size_t>(i)];
    return value;
}

double Polynomial::slope(double theta) const {
    double value = 0.0;
    for (int i = degree; i >= 1; --i) value = value * theta + i * c[static_cast<std::size_t>(i)];
    return value;
}

Polynomial::EndValue Polynomial::at_end() const {
    using Pair = Pack<double, 2>::Value;  // for the value and the slope
    constexpr Pair next{0.0, 1.0};
    Pair sums{}, weights{1.0, static_cast<double>(degree)};
    for (int i = degree; i >= 1; --i, weights -= next) sums += c[static_cast<std::size_t>(i)] * weights;
    return {sums[0] + c[0], sums[1]};
}

Polynomial interpolate(const std::array<double, 5>& f) {
    // Newton's forward differences at x = 4 theta, expanded in terms of the differences from the first value.
    const double d1 = f[1] - f[0], d2 = f[2] - f[0], d3 = f[3] - f[0], d4 = f[4] - f[0];
    Polynomial p;
    p.degree = 4;
    p.c[0] = f[0];
    p.c[1] = 16.0 * d1 - 12.0 * d2 + 16.0 / 3.0 * d3 - d4;
    p.c[2] = -208.0 / 3.0 * d1 + 76.0 * d2 - 112.0 / 3.0 * d3 + 22.0 / 3.0 * d4;
    p.c[3] = 96.0 * d1 - 128.0 * d2 + 224.0 / 3.0 * d3 - 16.0 * d4;
    p.c[4] = -128.0 / 3.0 * d1 + 64.0 * d2 - 128.0 / 3.0 * d3 + 32.0 / 3.0 * d4;
    return p;
}

namespace {

using Coefficients = std::array<double, Polynomial::capacity>;

// The coefficients of a polynomial, or of the quotient after low powers are divided out.
struct PolynomialTerms {
    const double* c;
    int degree;
};

// C(i, j), stored by j: column j is contiguous in i.
constexpr auto binomials = [] {
    std::array<Coefficients, Polynomial::capacity> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[0][i] = 1.0;
        for (std::size_t j = 1; j <= i; ++j) table[j][i] = table[j - 1][i - 1] + (j < i ? table[j][i - 1] : 0.0);
    }
    return table;
}();

// Coefficients in the Bernstein basis over [0, 1]: b_i = sum_j C(i,j)/C(d,j) c_j.
Coefficients to_bernstein(const PolynomialTerms& p) {
    Coefficients b{};
    const auto d = static_cast<std::size_t>(p.degree);
    for (std::size_t j = 0; j <= d; ++j) {
        const double scaled = p.c[j] / binomials[j][d];
        for (std::size_t i = j / 4 * 4; i <= d; i += 4)  // C(i, j) = 0 for i < j
            for (std::size_t k = 0; k < 4; ++k) b[i + k] += binomials[j][i + k] * scaled;
    }
    return b;
}

// De Casteljau's algorithm at 1/2: coefficients over the left and the right half. A level is computed in vectors of
// four, and the numbers behind its end are not used.
void halve(const Coefficients& b, int degree, Coefficients& left, Coefficients& right) {
    using Four = Pack<double, 4>;
    std::array<double, Polynomial::capacity + Four::count> level;
    std::copy(b.begin(), b.end(), level.begin());
    for (auto last = static_cast<std::size_t>(degree);; --last) {
        left[static_cast<std::size_t>(degree) - last] = level[0];
        right[last] = level[last];
        if (last == 0) break;
        for (std::size_t i = 0; i < last; i += Four::count)
            Four::store(0.5 * (Four::load(&level[i]) + Four::load(&level[i + 1])), &level[i]);
    }
}

// The root between `low`, where p > 0, and `high`, where p < 0. Newton's method from x, kept inside the shrinking
// bracket. From iteration `rounds` on, a Newton step of relative size below 2^-30 ends the iteration.
double newton(const PolynomialTerms& p, double low, double high, double x, int rounds) {
    constexpr double squared_away = 0x1p-30;  // after a step this small the error is about its square
    for (int round = 0; round < 100; ++round) {
        const auto [value, slope] = value_and_slope(p.c, p.degree, x);
        if (value == 0.0) return x;
        (value > 0.0 ? low : high) = x;
        const double newtons = x - value / slope;
        const bool inside = newtons > low && newtons < high;
        const double next = inside ? newtons : 0.5 * (low + high);
        if (std::abs(next - x) <= (inside && round >= rounds ? squared_away : 0x1p-53) * x) return next;
        if (next == low || next == high) return next;
        x = next;
    }
    return x;
}

double polish(const PolynomialTerms& p, double low, double high) {
    const double at_low = value_and_slope(p.c, p.degree, low).value,
                 at_high = value_and_slope(p.c, p.degree, high).value;
    if (!(at_low > 0.0)) return low;
    if (!(at_high < 0.0)) return high;
    return newton(p, low, high, low + (high - low) * (at_low / (at_low - at_high)), 2);
}

// Searches the step from left to right, in subintervals that are halved until the sign variations of each are
// conclusive.
class CrossingSearch {
 public:
    CrossingSearch(const PolynomialTerms& p, double remainder) : p_(p), remainder_(remainder) {}

    FirstCrossing run() {
        const Coefficients b = to_bernstein(p_);
        inside_ = starts_inside_ = !(b[0] > remainder_);
        if (visit(b, 0.0, 1.0, 45)) return found_;
        if (inside_) return {FirstCrossing::Kind::open, since_};
        if (rose_at_ > 0.0) return {FirstCrossing::Kind::increasing, rose_at_};
        return {};
    }

 private:
    // Where the quantity enters the remainder in a subinterval that starts above it. By bisection: the quantity may
    // leave the remainder again near the right end, and Newton's method might converge there.
    double entry(double low, double high) const {
        for (int i = 0; i < 52; ++i) {
            const double middle = 0.5 * (low + high);
            (value_and_slope(p_.c, p_.degree, middle).value > remainder_ ? low : high) = middle;
        }
        return low;
    }

    bool find(FirstCrossing::Kind kind, double theta) {
        found_ = {kind, theta};
        return true;
    }

    // Searches one subinterval. inside_ says that the quantity has entered the remainder (at since_) and not left it;
    // otherwise it is above the remainder. Returns true if the search is over.
    bool visit(const Coefficients& b, double low, double high, int depth) {
        int rises_and_falls = 0, crossings_below = 0;  // sign variations of b - remainder, b + remainder
        bool above = b[0] > remainder_, below = b[0] < -remainder_;
        const bool starts_above = above;
        for (std::size_t i = 1; i <= static_cast<std::size_t>(p_.degree); ++i) {
            const bool now_above = b[i] > remainder_, now_below = b[i] < -remainder_;
            rises_and_falls += now_above != above;
            crossings_below += now_below != below;
            above = now_above;
            below = now_below;
        }
        if (!inside_ && rises_and_falls == 0 && starts_above) return false;
        if (!inside_ && rises_and_falls == 1 && starts_above) {
            if (crossings_below == 1) return find(FirstCrossing::Kind::root, polish(p_, low, high));
            if (crossings_below == 0) {
                inside_ = true;
                since_ = entry(low, high);
                return false;
            }
        }
        if (inside_ && !starts_above) {
            if (rises_and_falls == 0 && crossings_below == 0) return below && find(FirstCrossing::Kind::root, low);
            if (rises_and_falls == 0 && crossings_below == 1 && below)
                return find(FirstCrossing::Kind::root, polish(p_, since_, high));
            if (rises_and_falls == 1 && crossings_below == 0) {
                if (!starts_inside_) return find(FirstCrossing::Kind::undecided, since_);
                inside_ = starts_inside_ = false;
                rose_at_ = high;
                return false;
            }
        }
        if (depth == 0) return find(FirstCrossing::Kind::undecided, low);
        Coefficients left{}, right{};
        halve(b, p_.degree, left, right);
        const double middle = 0.5 * (low + high);
        return visit(left, low, middle, depth - 1) || visit(right, middle, high, depth - 1);
    }

    const PolynomialTerms& p_;
    const double remainder_;
    bool inside_ = false, starts_inside_ = false;
    double since_ = 0.0, rose_at_ = 0.0;
    FirstCrossing found_;
};

}  // namespace

FirstCrossing first_descent(const Polynomial& polynomial, int known, double remainder) {
    const PolynomialTerms p{polynomial.c.data() + known, polynomial.degree - known};
    // On [0, 1] the powers of theta decrease, so the polynomial is a convex combination of the partial sums of its
    // coefficients (Abel summation) and lies between their minimum and maximum. The same holds for the derivative.
    double value = p.c[0], least = value;
    for (int k = 1; k <= p.degree; ++k) {
        value += p.c[k];
        least = std::min(least, value);
    }
    if (least > remainder) return {};
    double slope = p.c[1], min_slope = slope, max_slope = slope, weight = 2.0;
    for (int k = 2; k <= p.degree; ++k, weight += 1.0) {
        slope += weight * p.c[k];
        min_slope = std::min(min_slope, slope);
        max_slope = std::max(max_slope, slope);
    }
    if (max_slope < 0.0 && value > remainder) return {};
    // The polynomial decreases throughout, from above the remainder to below it: there is one root. Newton's method
    // starts from the root of the quadratic part. It may stop at the first small step if the derivative changes little,
    // else at the third.
    if (p.c[0] > remainder && max_slope < 0.0 && value < -remainder) {
        const bool steady = min_slope > 3.0 * max_slope;  // the derivative changes by a factor of at most three
        const double curvature = p.degree > 1 ? p.c[2] : 0.0;
        const double root = std::sqrt(std::max(0.0, p.c[1] * p.c[1] - 4.0 * p.c[0] * curvature));
        return {FirstCrossing::Kind::root,
                newton(p, 0.0, 1.0, std::min(1.0, 2.0 * p.c[0] / (root - p.c[1])), steady ? 0 : 2)};
    }
    return CrossingSearch(p, remainder).run();
}

}  // namespace achilles
