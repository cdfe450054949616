#include "certify/roots.hpp"

namespace achilles::test {

Real value(const Reals& coefficients, const Real& t) {
    Real sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * t + coefficients[k];
    return sum;
}

Reals derivative(const Reals& coefficients) {
    Reals result;
    for (std::size_t k = 1; k < coefficients.size(); ++k) result.push_back(k * coefficients[k]);
    return result;
}

namespace {

// b_i = sum_k C(i,k)/C(n,k) a_k for the powers a_k of t/length.
Reals bernstein(Reals b, const Real& length) {
    const std::size_t n = b.size() - 1;
    Real factor = 1;  // length^k / C(n,k)
    for (std::size_t k = 1; k <= n; ++k) {
        factor *= length * k / (n + 1 - k);
        b[k] *= factor;
    }
    for (std::size_t step = 1; step <= n; ++step)
        for (std::size_t i = n; i >= step; --i) b[i] += b[i - 1];
    return b;
}

int variations(const Reals& b) {
    int count = 0, last = 0;
    for (const Real& x : b) {
        const int sign = x > 0 ? 1 : x < 0 ? -1 : 0;
        if (sign != 0 && last != 0 && sign != last) ++count;
        if (sign != 0) last = sign;
    }
    return count;
}

// One root in (low, high), positive on its left: Newton's method, kept inside by bisection.
Real locate(const Reals& coefficients, Real low, Real high) {
    const Reals slope = derivative(coefficients);
    Real t = (low + high) / 2;
    for (int round = 0; round < 300; ++round) {
        const Real f = value(coefficients, t);
        (f > 0 ? low : high) = t;
        Real next = t - f / value(slope, t);
        if (!(next > low && next < high)) next = (low + high) / 2;
        const bool close = abs(next - t) <= 1e-33 * abs(next);
        t = next;
        if (close) break;
    }
    return t;
}

std::optional<Real> search(const Reals& coefficients, Reals left, const Real& low, const Real& high, int depth) {
    const int count = variations(left);
    if (count == 0 || depth > 100) return std::nullopt;
    if (count == 1) {
        for (const Real& x : left) {
            if (x > 0) return locate(coefficients, low, high);
            if (x < 0) return std::nullopt;
        }
    }
    const Real middle = (low + high) / 2;
    const std::size_t n = left.size() - 1;
    Reals right(left.size());
    right[n] = left[n];
    for (std::size_t step = 1; step <= n; ++step) {  // de Casteljau
        for (std::size_t i = n; i >= step; --i) left[i] = (left[i] + left[i - 1]) / 2;
        right[n - step] = left[n];
    }
    if (auto found = search(coefficients, std::move(left), low, middle, depth + 1)) return found;
    return search(coefficients, std::move(right), middle, high, depth + 1);
}

}  // namespace

std::optional<Real> first_descent(const Reals& coefficients, const Real& length) {
    return search(coefficients, bernstein(coefficients, length), 0, length, 0);
}

}  // namespace achilles::test
