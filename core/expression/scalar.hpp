// The operations that a scalar type needs to run a program: arithmetic, functions, constants, integer powers. double
// and Interval have their own here; other types (multiprecision in tests) use the generic definitions.
#pragma once

#include <cmath>
#include <numbers>

#include "expression/expression.hpp"
#include "number/interval.hpp"

namespace achilles {

// Scalar types with derivatives (number/jet.hpp). The derivatives of a constant are zero.
template <class Scalar>
concept HasDerivatives = requires {
    typename Scalar::Component;
};

template <class Scalar>
Scalar scalar_from(const Constant& constant) {
    if constexpr (HasDerivatives<Scalar>)
        return Scalar(scalar_from<typename Scalar::Component>(constant));
    else
        return Scalar(constant.numerator) / Scalar(constant.denominator);
}
template <>
inline double scalar_from<double>(const Constant& constant) {
    return constant.nearest;
}
template <>
inline Interval scalar_from<Interval>(const Constant& constant) {
    return {constant.low, constant.high};
}

template <class Scalar>
Scalar scalar_pi() {
    using std::acos;
    if constexpr (HasDerivatives<Scalar>)
        return Scalar(scalar_pi<typename Scalar::Component>());
    else
        return acos(Scalar(-1));
}
template <>
inline double scalar_pi<double>() {
    return std::numbers::pi;
}
template <>
inline Interval scalar_pi<Interval>() {
    return Interval::pi();
}

// A number near x, for Operation::midpoint.
template <class Scalar>
Scalar midpoint_of(const Scalar& x) {
    if constexpr (HasDerivatives<Scalar>)
        return Scalar(midpoint_of(x.value));
    else
        return x;
}
template <>
inline Interval midpoint_of<Interval>(const Interval& x) {
    return Interval(mid(x));
}

// x^n by repeated squaring. Interval has its own overload, tight for even n.
template <class Scalar>
Scalar integer_power(const Scalar& x, int n) {
    unsigned m = n < 0 ? 0u - static_cast<unsigned>(n) : static_cast<unsigned>(n);
    Scalar base = x, result = Scalar(1);
    for (; m != 0; m >>= 1) {
        if (m & 1u) result = result * base;
        if (m > 1) base = base * base;
    }
    if (n < 0) return Scalar(1) / result;
    return result;
}

}  // namespace achilles
