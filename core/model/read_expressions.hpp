// What the expressions of a system file mean: the equations' ingredients T, V, Q, h, e and M (theory.md 1).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "expression/expression.hpp"
#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "run/state.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"
#include "system/read_tables.hpp"

namespace achilles {

// Sets kinetic, potential, Q, gap, restitution and M of the equations, whose graph this is, and adds what is wrong with
// them and with the
// definitions of parameters: among it a T that is not quadratic and homogeneous in the rates after expansion. What is missing is passed
// over. An unknown name is told where it stands first, once in the file, and what depends on it is not looked into.
void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, Mistakes& mistakes);

// Adds what is wrong with any expression of the file: the above, drawings and views. Whether the above had nothing wrong.
bool check_expressions(const SystemDescription& system, Names names, Mistakes& mistakes);

// An expression as a polynomial in the rates: how a kinetic energy is proved quadratic and its mass matrix read off.

// Exponents of the rates -> coefficient, free of rates. No coefficient is the number 0.
using RatePolynomial = std::map<std::array<std::uint8_t, max_coordinates>, Expression>;

// Expands an expression in the symbols of `slots` (the rates). Returns nothing where it is no polynomial of degree <=
// 8; then `offender` is the smallest part of the expression that is not one.
std::optional<RatePolynomial> expand_in_rates(Expression expression, std::span<const std::uint32_t> slots,
                                              Expression& offender);

}  // namespace achilles
