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

Polynomial::End Polynomial::at_end() const {
    End end;
    for (int i = degree; i >= 1; --i) {
        const double term = c[static_cast<std::size_t>(i)];
        end.value += term;
        end.slope += i * term;
    }
    end.value += c[0];
    return end;
}

Polynomial interpolate(const std::array<double, 5>& f) {
    // Newton's forward differences at x = 4 theta, expanded: coefficients of the differences from the first value.
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

// What a polynomial consists of, or the rest where low powers are divided out.
struct Terms {
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

// b_i = sum_j C(i,j)/C(d,j) c_j: the coefficients over [0, 1].
Coefficients to_bernstein(const Terms& p) {
    Coefficients b{};
    const auto d = static_cast<std::size_t>(p.degree);
    for (std::size_t j = 0; j <= d; ++j) {
        const double scaled = p.c[j] / binomials[j][d];
        for (std::size_t i = j / 4 * 4; i <= d; i += 4)  // C(i, j) = 0 for i < j
            for (std::size_t k = 0; k < 4; ++k) b[i + k] += binomials[j][i + k] * scaled;
    }
    return b;
}

// De Casteljau at the middle: the halves' coefficients. Afterwards right[i] holds the last entry of each level.
void halve(const Coefficients& b, int degree, Coefficients& left, Coefficients& right) {
    right = b;
    for (int level = 0; level <= degree; ++level) {
        left[static_cast<std::size_t>(level)] = right[0];
        for (int i = 0; i < degree - level; ++i)
            right[static_cast<std::size_t>(i)] =
                0.5 * (right[static_cast<std::size_t>(i)] + right[static_cast<std::size_t>(i) + 1]);
    }
}

// The root between a positive and a negative end, from a guess: Newton's method, kept inside the shrinking bracket.
// After so many rounds a small step is taken to be near the root.
double newton(const Terms& p, double low, double high, double x, int rounds) {
    constexpr double squared_away = 0x1p-30;  // a step this small leaves an error of its square
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

double polish(const Terms& p, double low, double high) {
    const double at_low = value_and_slope(p.c, p.degree, low).value,
                 at_high = value_and_slope(p.c, p.degree, high).value;
    if (!(at_low > 0.0)) return low;
    if (!(at_high < 0.0)) return high;
    return newton(p, low, high, low + (high - low) * (at_low / (at_low - at_high)), 2);
}

// Looks through the step from left to right, in pieces that are halved until each says one thing.
class Search {
 public:
    Search(const Terms& p, double remainder) : p_(p), remainder_(remainder) {}

    Descent run() {
        const Coefficients b = to_bernstein(p_);
        inside_ = starts_inside_ = !(b[0] > remainder_);
        if (visit(b, 0.0, 1.0, 45)) return found_;
        if (inside_) return {Descent::Kind::open, since_};
        if (rose_at_ > 0.0) return {Descent::Kind::rose, rose_at_};
        return {};
    }

 private:
    // Where it comes down into the remainder in a piece that starts above it. By bisection: the piece may end where it
    // leaves the remainder again, to within rounding, and Newton's method would as soon go there.
    double entry(double low, double high) const {
        for (int i = 0; i < 52; ++i) {
            const double middle = 0.5 * (low + high);
            (value_and_slope(p_.c, p_.degree, middle).value > remainder_ ? low : high) = middle;
        }
        return low;
    }

    bool find(Descent::Kind kind, double theta) {
        found_ = {kind, theta};
        return true;
    }

    // One piece. What is known on entering it: inside_, that the quantity has come down into the remainder (at since_)
    // and not left it; otherwise it is above. True if the search is over.
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
            if (crossings_below == 1) return find(Descent::Kind::root, polish(p_, low, high));
            if (crossings_below == 0) {
                inside_ = true;
                since_ = entry(low, high);
                return false;
            }
        }
        if (inside_ && !starts_above) {
            if (rises_and_falls == 0 && crossings_below == 0) return below && find(Descent::Kind::root, low);
            if (rises_and_falls == 0 && crossings_below == 1 && below)
                return find(Descent::Kind::root, polish(p_, since_, high));
            if (rises_and_falls == 1 && crossings_below == 0) {
                if (!starts_inside_) return find(Descent::Kind::undecided, since_);
                inside_ = starts_inside_ = false;
                rose_at_ = high;
                return false;
            }
        }
        if (depth == 0) return find(Descent::Kind::undecided, low);
        Coefficients left{}, right{};
        halve(b, p_.degree, left, right);
        const double middle = 0.5 * (low + high);
        return visit(left, low, middle, depth - 1) || visit(right, middle, high, depth - 1);
    }

    const Terms& p_;
    const double remainder_;
    bool inside_ = false, starts_inside_ = false;
    double since_ = 0.0, rose_at_ = 0.0;
    Descent found_;
};

}  // namespace

Descent first_descent(const Polynomial& polynomial, int known, double remainder) {
    const Terms p{polynomial.c.data() + known, polynomial.degree - known};
    // On [0, 1] the powers of theta decrease, so a polynomial is a mean of the partial sums of its coefficients (Abel),
    // and lies between the least and the largest of these. The slope is bounded by its own partial sums.
    double value = p.c[0], least = value, slope = p.c[1], least_slope = slope, largest_slope = slope;
    for (int k = 1; k <= p.degree; ++k) {
        const double c = p.c[k];
        value += c;
        least = std::min(least, value);
        if (k == 1) continue;
        slope += k * c;
        least_slope = std::min(least_slope, slope);
        largest_slope = std::max(largest_slope, slope);
    }
    if (least > remainder || (largest_slope < 0.0 && value > remainder)) return {};
    // It falls all along, from above the remainder to below it: one root, by Newton's method from the parabola's. Where
    // the slope hardly changes, a small first step of it is trusted at once, else from the third on.
    if (p.c[0] > remainder && largest_slope < 0.0 && value < -remainder) {
        const bool steady = least_slope > 3.0 * largest_slope;  // the slope changes by a factor of three at most
        const double curvature = p.degree > 1 ? p.c[2] : 0.0;
        const double root = std::sqrt(std::max(0.0, p.c[1] * p.c[1] - 4.0 * p.c[0] * curvature));
        return {Descent::Kind::root,
                newton(p, 0.0, 1.0, std::min(1.0, 2.0 * p.c[0] / (root - p.c[1])), steady ? 0 : 2)};
    }
    return Search(p, remainder).run();
}

}  // namespace achilles
