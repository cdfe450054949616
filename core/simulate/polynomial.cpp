#include "simulate/polynomial.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

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

using Bernstein = std::array<double, Polynomial::capacity>;

// b_i = sum_j C(i,j)/C(d,j) c_j: the coefficients over [0, 1].
Bernstein to_bernstein(const Polynomial& p) {
    Bernstein b{};
    std::array<double, Polynomial::capacity> scaled{};  // c_j / C(d, j)
    double binomial = 1.0;
    for (int j = 0; j <= p.degree; ++j) {
        scaled[static_cast<std::size_t>(j)] = p.c[static_cast<std::size_t>(j)] / binomial;
        binomial = binomial * (p.degree - j) / (j + 1);
    }
    for (int i = 0; i <= p.degree; ++i) {
        double sum = 0.0, choose = 1.0;
        for (int j = 0; j <= i; ++j) {
            sum += choose * scaled[static_cast<std::size_t>(j)];
            choose = choose * (i - j) / (j + 1);
        }
        b[static_cast<std::size_t>(i)] = sum;
    }
    return b;
}

int sign_variations(const Bernstein& b, int degree) {
    int count = 0;
    double last = 0.0;
    for (int i = 0; i <= degree; ++i) {
        const double value = b[static_cast<std::size_t>(i)];
        if (value == 0.0) continue;
        if (last * value < 0.0) ++count;
        last = value > 0.0 ? 1.0 : -1.0;
    }
    return count;
}

// De Casteljau at the middle: the halves' coefficients.
void halve(const Bernstein& b, int degree, Bernstein& left, Bernstein& right) {
    right = b;
    for (int level = 0; level <= degree; ++level) {
        left[static_cast<std::size_t>(level)] = right[0];
        for (int i = 0; i < degree - level; ++i)
            right[static_cast<std::size_t>(i)] =
                0.5 * (right[static_cast<std::size_t>(i)] + right[static_cast<std::size_t>(i) + 1]);
    }
    // After the loop right[i] holds the last entry of each level, in the right order.
}

double polish(const Polynomial& p, double low, double high) {
    const double at_low = p(low), at_high = p(high);
    if (at_low == 0.0) return low;
    if (at_high == 0.0) return high;
    if (at_low * at_high > 0.0) return 0.5 * (low + high);  // signs lost to rounding: the bracket itself is the answer
    std::uintmax_t iterations = 60;
    const auto bracket = boost::math::tools::toms748_solve([&](double x) { return p(x); }, low, high, at_low, at_high,
                                                           boost::math::tools::eps_tolerance<double>(52), iterations);
    return 0.5 * (bracket.first + bracket.second);
}

std::optional<double> search(const Polynomial& p, const Bernstein& b, double low, double high, int depth) {
    const double first = b[0], last = b[static_cast<std::size_t>(p.degree)];
    const int variations = sign_variations(b, p.degree);
    if (variations == 0) {
        if (last == 0.0 && first > 0.0) return high;
        return std::nullopt;
    }
    if (variations == 1) {
        if (first < 0.0) return std::nullopt;  // it rises through zero here
        return polish(p, low, high);
    }
    if (depth == 0) return std::nullopt;  // a touch, to within rounding
    Bernstein left{}, right{};
    halve(b, p.degree, left, right);
    const double middle = 0.5 * (low + high);
    if (const auto root = search(p, left, low, middle, depth - 1)) return root;
    return search(p, right, middle, high, depth - 1);
}

}  // namespace

std::optional<double> first_descent(const Polynomial& polynomial, int known) {
    Polynomial p;
    p.degree = polynomial.degree - known;
    for (int i = 0; i <= p.degree; ++i)
        p.c[static_cast<std::size_t>(i)] = polynomial.c[static_cast<std::size_t>(i + known)];
    return search(p, to_bernstein(p), 0.0, 1.0, 40);
}

}  // namespace achilles
