// Expressions as polynomials in the rates: their degree in the rates, and the coefficients.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>

#include "expression/expression.hpp"
#include "run/state.hpp"

namespace achilles {

// Exponents of the rates -> coefficient, which contains no rates. No coefficient is the number 0.
using RatePolynomial = std::map<std::array<std::uint8_t, max_coordinates>, Expression>;

// Degree of a term in all rates together.
int degree(const RatePolynomial::key_type& exponents);

// Expands an expression in the symbols of `slots` (the rates). Returns nullopt if it is not a polynomial of degree 8 or
// less with at most 5000 terms; `offender` is then the smallest part of the expression that is not.
std::optional<RatePolynomial> expand_in_rates(Expression expression, std::span<const std::uint32_t> slots,
                                              Expression& offender);

}  // namespace achilles
