// Forward differentiation: a value with its derivatives in N directions, over any number type. Code written for a
// Number also runs on a Jet. With N = 0 a Jet is a plain number whose products with an exact 0 are exact.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "number/interval.hpp"
#include "number/jet8.hpp"

namespace achilles {

// The product a b. For intervals, 0 times a defined interval is exactly 0. The general product would widen it by the
// smallest denormal, and later products with the result take a hundred times as long (theory-truncation.md 5).
inline double times(double a, double b) { return a * b; }
inline Interval times(const Interval& a, const Interval& b) {
    if ((a.lo() == 0.0 && a.hi() == 0.0 && b.is_defined()) || (b.lo() == 0.0 && b.hi() == 0.0 && a.is_defined()))
        return Interval(0.0);
    return a * b;
}

template <class Number, std::size_t N>
struct Jet {
    using Component = Number;
    Number value{};
    [[no_unique_address]] std::array<Number, N> slope{};

    Jet() = default;
    Jet(const Number& x) : value(x) {}                                     // NOLINT: a constant
    Jet(double x) requires(!std::is_same_v<Number, double>) : value(x) {}  // NOLINT
    // The independent variable of direction i: its derivative is 1 in direction i and 0 in the others.
    static Jet variable(const Number& x, std::size_t i) {
        Jet result(x);
        result.slope[i] = Number(1.0);
        return result;
    }

    // f(x) by the chain rule: f is f(x) and by_x is f'(x).
    friend Jet chain(const Jet& x, const Number& f, const Number& by_x) {
        Jet result(f);
        for (std::size_t i = 0; i < N; ++i) result.slope[i] = times(by_x, x.slope[i]);
        return result;
    }

    // x with a b' added to its derivatives.
    friend Jet and_slope(Jet x, const Number& a, const Jet& b) {
        for (std::size_t i = 0; i < N; ++i) x.slope[i] = x.slope[i] + times(a, b.slope[i]);
        return x;
    }

    friend Jet operator-(const Jet& a) {
        Jet result(-a.value);
        for (std::size_t i = 0; i < N; ++i) result.slope[i] = -a.slope[i];
        return result;
    }
    friend Jet operator+(const Jet& a, const Jet& b) {
        Jet result(a.value + b.value);
        for (std::size_t i = 0; i < N; ++i) result.slope[i] = a.slope[i] + b.slope[i];
        return result;
    }
    friend Jet operator-(const Jet& a, const Jet& b) {
        Jet result(a.value - b.value);
        for (std::size_t i = 0; i < N; ++i) result.slope[i] = a.slope[i] - b.slope[i];
        return result;
    }
    friend Jet operator*(const Jet& a, const Jet& b) {
        Jet result(times(a.value, b.value));
        for (std::size_t i = 0; i < N; ++i) result.slope[i] = times(a.slope[i], b.value) + times(a.value, b.slope[i]);
        return result;
    }
    friend Jet operator*(const Jet& a, double b) {
        Jet result(times(a.value, Number(b)));
        for (std::size_t i = 0; i < N; ++i) result.slope[i] = times(a.slope[i], Number(b));
        return result;
    }
    friend Jet operator*(double a, const Jet& b) { return b * a; }
    // (a/b)' = (a' - (a/b) b')/b
    friend Jet operator/(const Jet& a, const Jet& b) {
        Jet result(a.value / b.value);
        for (std::size_t i = 0; i < N; ++i) {
            const Number rise = a.slope[i] - times(result.value, b.slope[i]);
            result.slope[i] = is_zero(rise) && is_defined(result.value) ? Number(0.0) : rise / b.value;
        }
        return result;
    }
    Jet& operator+=(const Jet& b) { return *this = *this + b; }
    Jet& operator-=(const Jet& b) { return *this = *this - b; }
    Jet& operator*=(const Jet& b) { return *this = *this * b; }

 private:
    static bool is_zero(double x) { return x == 0.0; }
    static bool is_zero(const Interval& x) { return x.lo() == 0.0 && x.hi() == 0.0; }
    static bool is_defined(double x) { return x == x; }
    static bool is_defined(const Interval& x) { return x.is_defined(); }
};

// --- Functions of every type with chain() and and_slope(): the value and its derivatives

template <class Number>
concept HasSlopes = requires {
    typename Number::Component;
};

inline double square(double x) { return x * x; }

template <HasSlopes J>
J sqrt(const J& x) {
    using Number = typename J::Component;
    using std::sqrt;
    const Number r = sqrt(x.value);
    return chain(x, r, Number(0.5) / r);
}
template <HasSlopes J>
J exp(const J& x) {
    using Number = typename J::Component;
    using std::exp;
    const Number r = exp(x.value);
    return chain(x, r, r);
}
template <HasSlopes J>
J log(const J& x) {
    using Number = typename J::Component;
    using std::log;
    return chain(x, log(x.value), Number(1.0) / x.value);
}
template <HasSlopes J>
J sin(const J& x) {
    using std::cos, std::sin;
    return chain(x, sin(x.value), cos(x.value));
}
template <HasSlopes J>
J cos(const J& x) {
    using std::cos, std::sin;
    return chain(x, cos(x.value), -sin(x.value));
}
template <HasSlopes J>
void sine_and_cosine(const J& x, J& sine, J& cosine) {
    using Number = typename J::Component;
    using std::cos, std::sin;
    const Number s = sin(x.value), c = cos(x.value);
    const J angle = x;  // a copy: x may be the same object as sine or cosine
    sine = chain(angle, s, c);
    cosine = chain(angle, c, -s);
}
template <HasSlopes J>
J tan(const J& x) {
    using Number = typename J::Component;
    using std::tan;
    const Number r = tan(x.value);
    return chain(x, r, Number(1.0) + square(r));
}
template <HasSlopes J>
J asin(const J& x) {
    using Number = typename J::Component;
    using std::asin, std::sqrt;
    return chain(x, asin(x.value), Number(1.0) / sqrt(Number(1.0) - square(x.value)));
}
template <HasSlopes J>
J acos(const J& x) {
    using Number = typename J::Component;
    using std::acos, std::sqrt;
    return chain(x, acos(x.value), Number(-1.0) / sqrt(Number(1.0) - square(x.value)));
}
template <HasSlopes J>
J atan(const J& x) {
    using Number = typename J::Component;
    using std::atan;
    return chain(x, atan(x.value), Number(1.0) / (Number(1.0) + square(x.value)));
}
template <HasSlopes J>
J sinh(const J& x) {
    using std::cosh, std::sinh;
    return chain(x, sinh(x.value), cosh(x.value));
}
template <HasSlopes J>
J cosh(const J& x) {
    using std::cosh, std::sinh;
    return chain(x, cosh(x.value), sinh(x.value));
}
template <HasSlopes J>
J tanh(const J& x) {
    using Number = typename J::Component;
    using std::tanh;
    const Number r = tanh(x.value);
    return chain(x, r, Number(1.0) - square(r));
}

inline double integer_power_of(double x, int n) { return std::pow(x, n); }
inline Interval integer_power_of(const Interval& x, int n) { return integer_power(x, n); }
template <HasSlopes J>
J integer_power(const J& x, int n) {
    using Number = typename J::Component;
    if (n == 0) return J(1.0);
    return chain(x, integer_power_of(x.value, n), times(Number(n), integer_power_of(x.value, n - 1)));
}
// a^b for a > 0.
template <HasSlopes J>
J pow(const J& a, const J& b) {
    using Number = typename J::Component;
    using std::log, std::pow;
    const Number r = pow(a.value, b.value);
    return and_slope(chain(a, r, b.value * pow(a.value, b.value - Number(1.0))), log(a.value) * r, b);
}

}  // namespace achilles
