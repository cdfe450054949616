// The names of a system file and the expressions in which each may appear. A derived parameter is replaced by its
// expression in the other parameters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "run/trajectory.hpp"
#include "system/description.hpp"

namespace achilles {

// The first force, or else the dissipation, in which held(NAME) stands; null if there is none, or if a
// parameter or coordinate has this name.
const Text* first_with_held(const SystemDescription& system);

// Something that proofs do not cover, in words, and where the file of the system has it.
struct UnprovedFeature {
    std::string_view what;
    Location at;
};
// nullopt if proofs cover all of the system.
std::optional<UnprovedFeature> first_unproved(const SystemDescription& system);

// The slots of the inputs of a system's programs.
Layout layout_of(const SystemDescription& system);

// The names of the inputs, by slot: what to_text() prints.
std::vector<std::string> slot_names(const SystemDescription& system, const Layout& layout);

// Coordinates, rates, t, parameters: for the kinetic energy, a slip, a guard and what a jump sets.
Scope state_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// These, and held(NAME): for a force and the dissipation.
Scope force_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Coordinates, t, parameters.
Scope potential_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
Scope gap_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Coordinates, t, parameters: for the limit of sticking. With `slip`, the sliding speed: for friction while sliding.
Scope static_friction_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
Scope friction_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Parameters.
Scope restitution_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Parameters: for the period and the shift of [orbit].
Scope closing_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Parameters: for a derived parameter; the caller adds its units.
Scope definition_scope(const SystemDescription& system, const Layout& layout, Graph& graph);
// Coordinates, t, parameters; the caller adds the curve's own parameter.
Scope drawing_scope(const SystemDescription& system, const Layout& layout, Graph& graph);

// A quantity of a whole run that may appear in an expression, in addition to those of a view: the time or speed of the
// k-th or last event, the number of events, or the smallest gap.
struct RunQuantity {
    enum class Kind { time, speed, count, least_gap };
    Kind kind;
    std::optional<Event::Kind> event;  // empty for least_gap
    int k = 0;                         // index of the event, from 1; 0: the last one
    friend bool operator==(const RunQuantity&, const RunQuantity&) = default;
};

// A quantity of a run with the name that expressions use.
struct NamedRunQuantity {
    std::string_view name;
    RunQuantity quantity;
};
std::span<const NamedRunQuantity> run_quantities();
// Null if no quantity of a run has this name.
const NamedRunQuantity* run_quantity(std::string_view name);
// Why a system cannot have this quantity, such as "needs friction, and this system has none"; empty if it can.
std::string why_absent(const RunQuantity& quantity, const SystemDescription& system);
// Whether the name is that of a number of events.
bool is_count_of_events(std::string_view name);

// t, coordinates, rates, parameters, gap, gap', gap'', lambda, energy, with friction slip, friction_force and heat;
// their values are taken from the equations.
Scope view_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations);

// The names of view_scope() and quantities of the run: input layout.count() + i is quantities[i]. Parsing appends to
// `quantities` and creates nodes in `graph`, so both must outlive the scope.
Scope measure_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations,
                    std::vector<RunQuantity>& quantities);

}  // namespace achilles
