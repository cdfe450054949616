// An expression as a polynomial in the rates: how a kinetic energy is proved quadratic and its mass matrix read off.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "expression/expression.hpp"
#include "run/state.hpp"

namespace achilles {

// Exponents of the rates -> coefficient, free of rates. No coefficient is the number 0.
using RatePolynomial = std::map<std::array<std::uint8_t, max_coordinates>, Expression>;

// Expands an expression in the symbols of `slots` (the rates). Returns nothing where it is no polynomial of degree <=
// 8; then `offender` is the smallest part of the expression that is not one.
std::optional<RatePolynomial> expand_in_rates(Expression expression, std::span<const std::uint32_t> slots,
                                              Expression& offender);

}  // namespace achilles
