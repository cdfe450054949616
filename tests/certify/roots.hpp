// First descent of a polynomial through zero, in 34 digits, for the reference motions. Shares no code with
// core/number/polynomial.
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

// The first t in (0, length) at which the polynomial changes from positive to negative. Roots are isolated by sign
// variations in the Bernstein basis, so two close roots are not missed. A double root to working precision does not
// count.
template <class Number>
std::optional<Number> first_descent(const List<Number>& coefficients, const std::type_identity_t<Number>& length);

}  // namespace achilles::test
