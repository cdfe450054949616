// Where a polynomial first comes down through zero, in 34 digits: every root of the truth. Shares no code with
// core/simulate/polynomial.
#pragma once

#include <optional>

#include "certify/taylor.hpp"

namespace achilles::test {

// The value at t of the polynomial with these coefficients, in ascending powers.
Real value(const Reals& coefficients, const Real& t);
Reals derivative(const Reals& coefficients);

// The first t in (0, length) at which it goes from positive to negative. All roots are isolated by the sign variations
// in the Bernstein basis, so that two close together are not one or none; a touch to working precision is no root.
std::optional<Real> first_descent(const Reals& coefficients, const Real& length);

}  // namespace achilles::test
