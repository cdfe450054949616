// Reads the expressions of a system file: T, V, Q, h, e and M of the equations (theory.md 1).
#pragma once

#include "expression/expression.hpp"
#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"
#include "system/read_tables.hpp"

namespace achilles {

// In place of the shift of a coordinate over a period: whatever the motion makes of it.
inline constexpr std::string_view free_shift = "free";

// Sets the given terms, kinetic, potential, Q, gaps, restitutions, frictions and M of the equations, in whose graph it
// works. Adds the mistakes in these expressions and in the definitions of parameters, including those in T (kinetic_energy.hpp).
// Missing texts are skipped. An unknown name is reported once per file, at its first place;
// expressions that depend on it are not checked.
void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, ErrorCollector& mistakes);

// Adds the mistakes in all expressions of the file: those above, drawings and views. Returns whether those above have
// none. Drops friction that is the number 0 from the description.
bool check_expressions(SystemDescription& system, Names names, ErrorCollector& mistakes);

}  // namespace achilles
