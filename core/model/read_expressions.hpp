// What the expressions of a system file mean: its names as symbols, which of them may stand where, and the equations'
// ingredients T, V, h, e and M (theory.md 1).
#pragma once

#include <string>
#include <vector>

#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "system/description.hpp"
#include "system/mistakes.hpp"
#include "system/read_tables.hpp"

namespace achilles {

// Which names may stand in a view (t, coordinates, rates, parameters, gap, gap', gap'', lambda, energy: with values
// from the equations), and in a drawing (coordinates and parameters; a drawn curve's own is for the caller to add).
Scope view_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations);
Scope drawing_scope(const SystemDescription& system, const Layout& layout, Graph& graph);

// The names of the inputs, by slot: what to_text() prints.
std::vector<std::string> slot_names(const SystemDescription& system, const Layout& layout);

// Sets kinetic, potential, gap, restitution and M of the equations, whose graph this is, and adds what is wrong with
// them: among it a T that is not quadratic and homogeneous in the rates after expansion. What is missing is passed
// over. An unknown name is told where it stands first, once in the file, and what depends on it is not looked into.
void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, Mistakes& mistakes);

// Adds what is wrong with any expression of the file: the above, drawings and views.
void check_expressions(const SystemDescription& system, Names names, Mistakes& mistakes);

}  // namespace achilles
