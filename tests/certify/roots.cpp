#include "certify/roots.hpp"

namespace achilles::test {

template <class Number>
Number value(const List<Number>& coefficients, const Number& t) {
    Number sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * t + coefficients[k];
    return sum;
}

template <class Number>
List<Number> derivative(const List<Number>& coefficients) {
    List<Number> result;
    for (std::size_t k = 1; k < coefficients.size(); ++k) result.push_back(k * coefficients[k]);
    return result;
}

namespace {

// b_i = sum_k C(i,k)/C(n,k) a_k for the powers a_k of t/length.
template <class Number>
List<Number> bernstein(List<Number> b, const Number& length) {
    const std::size_t n = b.size() - 1;
    Number factor = 1;  // length^k / C(n,k)
    for (std::size_t k = 1; k <= n; ++k) {
        factor *= length * k / (n + 1 - k);
        b[k] *= factor;
    }
    for (std::size_t step = 1; step <= n; ++step)
        for (std::size_t i = n; i >= step; --i) b[i] += b[i - 1];
    return b;
}

template <class Number>
int variations(const List<Number>& b) {
    int count = 0, last = 0;
    for (const Number& x : b) {
        const int sign = x > 0 ? 1 : x < 0 ? -1 : 0;
        if (sign != 0 && last != 0 && sign != last) ++count;
        if (sign != 0) last = sign;
    }
    return count;
}

// The single root in (low, high), with positive values on its left: Newton's method safeguarded by bisection.
template <class Number>
Number locate(const List<Number>& coefficients, Number low, Number high) {
    const List<Number> slope = derivative(coefficients);
    Number t = (low + high) / 2;
    for (int round = 0; round < 300; ++round) {
        const Number f = value(coefficients, t);
        (f > 0 ? low : high) = t;
        Number next = t - f / value(slope, t);
        if (!(next > low && next < high)) next = (low + high) / 2;
        const bool close = abs(next - t) <= 1e-33 * abs(next);
        t = next;
        if (close) break;
    }
    // The derivative part of a dual number converges one step later than its value.
    const Number last = t - value(coefficients, t) / value(slope, t);
    return abs(last - t) <= 1e-30 * abs(t) ? last : t;
}

template <class Number>
std::optional<Number> search(const List<Number>& coefficients, List<Number> left, const Number& low, const Number& high,
                             int depth) {
    const int count = variations(left);
    if (count == 0 || depth > 100) return std::nullopt;
    if (count == 1) {
        for (const Number& x : left) {
            if (x > 0) return locate(coefficients, low, high);
            if (x < 0) return std::nullopt;
        }
    }
    const Number middle = (low + high) / 2;
    const std::size_t n = left.size() - 1;
    List<Number> right(left.size());
    right[n] = left[n];
    for (std::size_t step = 1; step <= n; ++step) {  // de Casteljau
        for (std::size_t i = n; i >= step; --i) left[i] = (left[i] + left[i - 1]) / 2;
        right[n - step] = left[n];
    }
    if (auto found = search(coefficients, std::move(left), low, middle, depth + 1)) return found;
    return search(coefficients, std::move(right), middle, high, depth + 1);
}

}  // namespace

template <class Number>
std::optional<Number> first_descent(const List<Number>& coefficients, const std::type_identity_t<Number>& length) {
    return search<Number>(coefficients, bernstein<Number>(coefficients, length), 0, length, 0);
}

template Real value(const Reals&, const Real&);
template Dual value(const List<Dual>&, const Dual&);
template Reals derivative(const Reals&);
template List<Dual> derivative(const List<Dual>&);
template std::optional<Real> first_descent<Real>(const Reals&, const Real&);
template std::optional<Dual> first_descent<Dual>(const List<Dual>&, const Dual&);

}  // namespace achilles::test
