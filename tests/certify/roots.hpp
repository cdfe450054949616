// Where a polynomial first comes down through zero, in 34 digits: every root of the truth. Shares no code with
// core/simulate/polynomial.
#pragma once

#include <optional>
#include <type_traits>

#include "certify/taylor.hpp"

namespace achilles::test {

// The value at t of the polynomial with these coefficients, in ascending powers.
template <class Number>
Number value(const List<Number>& coefficients, const Number& t);
template <class Number>
List<Number> derivative(const List<Number>& coefficients);

// The first t in (0, length) at which it goes from positive to negative. All roots are isolated by the sign variations
// in the Bernstein basis, so that two close together are not one or none; a touch to working precision is no root.
template <class Number>
std::optional<Number> first_descent(const List<Number>& coefficients, const std::type_identity_t<Number>& length);

}  // namespace achilles::test
