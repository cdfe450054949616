// What a scalar type must offer to run a program: arithmetic, the functions, constants, integer powers.
// double and Interval are given here; others (multiprecision in tests) fall to the generic definitions.
#pragma once

#include <cmath>
#include <numbers>

#include "expression/expression.hpp"
#include "number/interval.hpp"

namespace achilles {

// A number with its derivatives, which a constant has not (number/jet.hpp).
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

// x^n by repeated squaring; Interval brings its own, tight for even n.
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
