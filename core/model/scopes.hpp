// What the names of a system file mean, and which of them may stand in which of its expressions. A derived parameter is
// its expression in the others, wherever it stands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "run/trajectory.hpp"
#include "system/description.hpp"

namespace achilles {

// Where the inputs of a system's programs stand.
Layout layout_of(const SystemDescription& system);

// The names of the inputs, by slot: what to_text() prints.
std::vector<std::string> slot_names(const SystemDescription& system, const Layout& layout);

// Coordinates, rates, parameters.
Scope kinetic_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Coordinates, rates, t, parameters: of a force or the dissipation.
Scope force_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Coordinates, t, parameters.
Scope potential_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
Scope gap_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Parameters.
Scope restitution_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// The same of what [orbit] says of a period and a shift.
Scope closing_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// The same in a derived parameter; its units are for the caller to add.
Scope definition_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Coordinates, t, parameters; a drawn curve's own is for the caller to add.
Scope drawing_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// What of a whole run may stand in an expression, besides what a view shows of an instant: the k-th of its events, or the
// last; how many there were; the least gap.
struct RunQuantity {
    enum class Kind { time, speed, count, least_gap };
    Kind kind;
    std::optional<Event::Kind> event;  // but of the least gap
    int k = 0;                         // of an event, from 1; 0: the last one
    friend bool operator==(const RunQuantity&, const RunQuantity&) = default;
};

// t, coordinates, rates, parameters, gap, gap', gap'', lambda, energy: with values from the equations.
Scope view_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations);

// The same, and quantities of the run: input i behind the layout's is quantities[i]. They are noted as they are met, so that
// both outlive the scope.
Scope measure_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations,
                    std::vector<RunQuantity>& quantities);

}  // namespace achilles
