// Reads the expressions of a system file: T, V, Q, h, e and M of the equations (theory.md 1).
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

// Sets kinetic, potential, Q, gaps, restitutions and M of the equations, in whose graph it works. Adds the mistakes in
// these expressions and in the definitions of parameters, including a T that is not quadratic and homogeneous in the
// rates after expansion. Missing texts are skipped. An unknown name is reported once per file, at its first place;
// expressions that depend on it are not checked.
void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, ErrorCollector& mistakes);

// Adds the mistakes in all expressions of the file: those above, drawings and views. Returns whether those above have
// none.
bool check_expressions(const SystemDescription& system, Names names, ErrorCollector& mistakes);

// ---- polynomials in the rates: they show that T is quadratic, and give the mass matrix ----

// Exponents of the rates -> coefficient, which contains no rates. No coefficient is the number 0.
using RatePolynomial = std::map<std::array<std::uint8_t, max_coordinates>, Expression>;

// Expands an expression in the symbols of `slots` (the rates). Returns nullopt if it is not a polynomial of degree 8 or
// less; `offender` is then the smallest part of the expression that is not.
std::optional<RatePolynomial> expand_in_rates(Expression expression, std::span<const std::uint32_t> slots,
                                              Expression& offender);

}  // namespace achilles
