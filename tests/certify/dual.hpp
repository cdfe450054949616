// Dual number: a value of 34 digits with its derivative by one direction. Comparisons use the value alone. It shares no
// code with the derivatives that it tests.
#pragma once

#if __has_include(<quadmath.h>)
#include <boost/multiprecision/float128.hpp>
#else
#include <boost/multiprecision/cpp_bin_float.hpp>
#endif
#include <type_traits>

#include "expression/scalar.hpp"

namespace achilles::test {

// 34 digits. The compiler's own type, where there is one, is several times faster.
#if __has_include(<quadmath.h>)
using Real = boost::multiprecision::float128;
#else
using Real = boost::multiprecision::cpp_bin_float_quad;
#endif

struct Dual {
    Real value = 0, slope = 0;

    Dual() = default;
    Dual(const Real& x, const Real& by = 0) : value(x), slope(by) {}  // NOLINT: a constant
    template <class Number>
    requires std::is_arithmetic_v<Number> Dual(Number x) : value(x) {}  // NOLINT
    explicit operator double() const { return static_cast<double>(value); }

    friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
    friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
    friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
    friend Dual operator*(const Dual& a, const Dual& b) {
        return {a.value * b.value, a.slope * b.value + a.value * b.slope};
    }
    friend Dual operator/(const Dual& a, const Dual& b) {
        const Real ratio = a.value / b.value;
        return {ratio, (a.slope - ratio * b.slope) / b.value};
    }
    Dual& operator+=(const Dual& b) { return *this = *this + b; }
    Dual& operator-=(const Dual& b) { return *this = *this - b; }
    Dual& operator*=(const Dual& b) { return *this = *this * b; }
    friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
    friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
    friend bool operator>(const Dual& a, const Dual& b) { return b < a; }
    friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
    friend bool operator>=(const Dual& a, const Dual& b) { return b <= a; }

    // The dual number f(x) for given values f and f'(x).
    friend Dual chain(const Dual& x, const Real& f, const Real& by_x) { return {f, by_x * x.slope}; }
    friend Dual abs(const Dual& x) { return x.value < 0 ? -x : x; }
    friend Dual sqrt(const Dual& x) {
        const Real root = sqrt(x.value);
        return chain(x, root, 0.5 / root);
    }
    friend Dual exp(const Dual& x) {
        const Real e = exp(x.value);
        return chain(x, e, e);
    }
    friend Dual log(const Dual& x) { return chain(x, log(x.value), 1 / x.value); }
    friend Dual sin(const Dual& x) { return chain(x, sin(x.value), cos(x.value)); }
    friend Dual cos(const Dual& x) { return chain(x, cos(x.value), -sin(x.value)); }
    friend Dual tan(const Dual& x) { return sin(x) / cos(x); }
    friend Dual asin(const Dual& x) { return chain(x, asin(x.value), 1 / sqrt(Real(1 - x.value * x.value))); }
    friend Dual acos(const Dual& x) { return chain(x, acos(x.value), -1 / sqrt(Real(1 - x.value * x.value))); }
    friend Dual atan(const Dual& x) { return chain(x, atan(x.value), 1 / (1 + x.value * x.value)); }
    friend Dual sinh(const Dual& x) { return chain(x, sinh(x.value), cosh(x.value)); }
    friend Dual cosh(const Dual& x) { return chain(x, cosh(x.value), sinh(x.value)); }
    friend Dual tanh(const Dual& x) { return sinh(x) / cosh(x); }
    friend Dual pow(const Dual& a, const Dual& b) { return exp(b * log(a)); }
};

}  // namespace achilles::test

namespace achilles {

template <>
inline test::Dual scalar_from<test::Dual>(const Constant& constant) {
    return scalar_from<test::Real>(constant);
}
// pi by a constant: acos(-1) has no derivative.
template <>
inline test::Dual scalar_pi<test::Dual>() {
    return scalar_pi<test::Real>();
}

}  // namespace achilles
