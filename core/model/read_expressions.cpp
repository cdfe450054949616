#include "model/read_expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "expression/graph.hpp"
#include "expression/parse.hpp"
#include "model/friction_law.hpp"
#include "model/kinetic_energy.hpp"
#include "model/restitution.hpp"
#include "model/scopes.hpp"
#include "program/program.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// Number of operations, each common subexpression counted once.
std::size_t size_of(Expression expression) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::size_t count = 0;
    for (std::uint32_t id = 0; id < needed.size(); ++id)
        if (needed[id] && !is_leaf(expression.graph().node(id).operation)) ++count;
    return count;
}

struct SizedExpression {
    std::string name;
    Location at;
    std::size_t size = 0;
};

std::string without_primes(const std::string& name) { return name.substr(0, name.find('\'')); }

// Reads the texts of one file and collects their mistakes.
class ExpressionReader {
 public:
    ExpressionReader(Graph& graph, Names& names, ErrorCollector& mistakes)
        : graph_(graph), names_(names), mistakes_(mistakes) {}

    // Returns nullopt if the text is missing or has a mistake, which is added.
    std::optional<Expression> read(const Text& text, Scope& scope, TextParts* parts = nullptr) {
        if (text.text.empty()) return std::nullopt;
        for (bool is_certain = true;; is_certain = false) {
            try {
                const Expression expression = parse(text.text, scope, graph_, parts);
                return is_certain ? std::optional(expression) : std::nullopt;
            } catch (const ParseError& error) {
                // After a substituted name only further unknown names are reported: other errors may follow from the
                // substitution.
                const bool is_reported = error.name.empty() ? !is_certain : needs_no_message(error.name, scope);
                if (!is_reported) mistakes_.add({place_in(text, error.offset), error.what(), error.hint});
                // A hint proposes the whole text as intended, so parsing need not continue.
                if (error.name.empty() || !error.hint.empty() || !go_on(error.name, scope)) return std::nullopt;
            }
        }
    }

 private:
    // Whether this name needs no message. An unknown name is reported once.
    bool needs_no_message(const std::string& name, const Scope& scope) {
        const std::string bare = without_primes(name);
        if (names_.reported.contains(bare)) return true;
        if (scope.forbidden.contains(name) || is_reserved(bare)) return false;
        names_.reported.insert(bare);
        return !names_.complete;
    }

    // Replaces an unknown name by a symbol, so that parsing can continue. Returns false if that does not help.
    bool go_on(const std::string& name, Scope& scope) {
        constexpr int most = 100;  // limit for one file: each replacement parses the text again
        if (!names_.reported.contains(without_primes(name)) || ++guesses_ > most) return false;
        return scope.allowed.emplace(name, graph_.symbol(0)).second;
    }

    Graph& graph_;
    Names& names_;
    ErrorCollector& mistakes_;
    int guesses_ = 0;
};

std::vector<std::uint32_t> rate_slots(const Layout& layout) {
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < layout.dof; ++i) slots.push_back(layout.v(i));
    return slots;
}

void check_gap(const Text& text, Expression gap, const Layout& layout) {
    std::vector<std::uint32_t> q;
    for (std::size_t i = 0; i < layout.dof; ++i) q.push_back(layout.q(i));
    const std::vector<Expression> slope = gradient(gap, q);
    if (std::all_of(slope.begin(), slope.end(), [](Expression e) { return e.is_zero(); }))
        throw Mistake{text.at, "dh = 0 everywhere: the gap does not change with any coordinate", {}};
}

// Calls a function that creates nodes; if the graph becomes too large, adds a mistake.
template <class Make>
void attempt_within_limits(ErrorCollector& mistakes, const SystemDescription& system, const Equations& equations,
                           const Make& make) {
    mistakes.attempt([&] {
        try {
            make();
        } catch (const ExpressionTooLarge& problem) {
            throw too_large(system, equations, "the equations of motion", problem);
        }
    });
}

// Reads the derived parameters to report their mistakes. Their values are part of the scopes.
void read_definitions(const SystemDescription& system, const Layout& layout, ExpressionReader& reader, Graph& graph) {
    if (system.derived.empty()) return;
    const Scope parameters = definition_scope(system, layout, graph);
    for (const DerivedDescription& derived : system.derived) {
        Scope scope = parameters;
        allow_units(scope, derived.unit, graph);
        reader.read(derived.definition, scope);
    }
}

// Q_i = force_i - dR/dv_i.
void read_forces(const SystemDescription& system, const Layout& layout, ExpressionReader& reader, Equations& equations,
                 ErrorCollector& mistakes) {
    Graph& graph = equations.kinetic.graph();
    Scope scope = force_scope(system, layout, graph);
    equations.Q.clear();
    for (const CoordinateDescription& coordinate : system.coordinates)
        equations.Q.push_back(reader.read(coordinate.force, scope).value_or(graph.number(0)));
    const auto dissipation = reader.read(system.dissipation, scope);
    if (!dissipation) return;
    attempt_within_limits(mistakes, system, equations, [&] {
        const std::vector<Expression> slope = gradient(*dissipation, rate_slots(layout));
        for (std::size_t i = 0; i < slope.size(); ++i) equations.Q[i] = equations.Q[i] - slope[i];
    });
}

// The contacts whose held(NAME) stands in the forces.
ContactSet contacts_in(const std::vector<Expression>& forces, const Layout& layout) {
    ContactSet found;
    for (std::size_t i = 0; layout.forces_see_contact && i < layout.contacts; ++i) {
        const std::uint32_t slot = layout.held(i);
        if (std::any_of(forces.begin(), forces.end(), [&](Expression force) { return depends_on(force, {&slot, 1}); }))
            found = found.with(i);
    }
    return found;
}

// The friction of every contact that has it, and of every joint. What has a mistake is the time.
void read_frictions(const SystemDescription& system, const Layout& layout, const Names& names, ExpressionReader& reader,
                    Equations& equations, ErrorCollector& mistakes, Graph& graph) {
    const Expression any_value = graph.symbol(layout.t()), nothing = graph.number(0);
    Scope in_slip = state_scope(system, layout, graph), in_level = friction_scope(system, layout, graph),
          in_static = static_friction_scope(system, layout, graph);
    for (const SlidingPlace& place : sliding_places(system)) {
        FrictionLaw& law = equations.friction[place.number];
        law.never_slides = place.never_slides;
        TextParts parts;
        const auto slip = reader.read(*place.slip, in_slip, &parts);
        law.slip = slip.value_or(any_value);
        law.level = law.static_level =
            law.never_slides ? nothing : reader.read(*place.level, in_level).value_or(any_value);
        if (place.static_level != nullptr)
            law.static_level = reader.read(*place.static_level, in_static).value_or(any_value);
        attempt_within_limits(mistakes, system, equations, [&] {
            if (slip && names.complete) split_slip(system, layout, *place.slip, parts, law);
            const Expression at_zero = at_slip_zero(law.level, layout, *place.level);
            if (place.static_level == nullptr) law.static_level = at_zero;
            law.has_jump = !(law.static_level == at_zero);
        });
    }
}

// The conditions of the contacts, and the jumps.
void read_modes(const SystemDescription& system, const Layout& layout, ExpressionReader& reader, Equations& equations,
                Graph& graph) {
    Scope scope = state_scope(system, layout, graph);
    for (const ConstraintDescription& constraint : system.constraints)
        equations.when.push_back(reader.read(constraint.when, scope));
    for (const ConstraintDescription& constraint : system.constraints) {
        std::optional<LatchLaw>& law = equations.latches.emplace_back();
        if (constraint.latch.on.text.empty()) continue;
        law.emplace().contact = constraint.latch.contact;
        if (!law->contact) law->until = reader.read(constraint.latch.on, scope);
    }
    for (const JumpDescription& jump : system.jumps) {
        JumpLaw& law = equations.jumps.emplace_back();
        law.contact = jump.on.contact;
        if (!law.contact) law.on = reader.read(jump.on.on, scope);
        law.when = reader.read(jump.when, scope);
        for (const JumpDescription::Assignment& each : jump.set)
            if (const auto value = reader.read(each.value, scope))
                law.set.emplace_back(static_cast<std::uint32_t>(each.place), *value);
    }
}

}  // namespace

Mistake too_large(const SystemDescription& system, const Equations& equations, const std::string& what,
                  const ExpressionTooLarge& problem) {
    SizedExpression largest{"the kinetic energy", system.kinetic.at};
    const auto look = [&](const std::string& name, const Text& text, Expression expression) {
        const std::size_t size = size_of(expression);
        if (size > largest.size) largest = {name, text.at, size};
    };
    look("the kinetic energy", system.kinetic, equations.given.kinetic);
    look("the potential", system.potential, equations.given.potential);
    for (std::size_t i = 0; i < equations.given.Q.size(); ++i) {
        const CoordinateDescription& coordinate = system.coordinates[i];
        look("the force on " + coordinate.name, coordinate.force.text.empty() ? system.dissipation : coordinate.force,
             equations.given.Q[i]);
    }
    for (std::size_t i = 0; i < equations.gaps.size(); ++i) {
        const ConstraintDescription& constraint = system.constraints[i];
        look(constraint.name.empty() ? "the gap" : "the gap of " + constraint.name, constraint.gap, equations.gaps[i]);
    }
    return {largest.at,
            fmt::format("{} are too large: {}; the largest expression of the file is {}, with {} operations", what,
                        problem.what(), largest.name, largest.size),
            {}};
}

void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, ErrorCollector& mistakes) {
    ExpressionReader reader(graph, names, mistakes);
    TextParts parts;
    const auto read = [&](const Text& text, Scope scope, TextParts* places = nullptr) {
        return reader.read(text, scope, places);
    };
    read_definitions(system, layout, reader, graph);
    const auto kinetic = read(system.kinetic, state_scope(system, layout, graph), &parts);
    const auto potential = read(system.potential, potential_scope(system, layout, graph));
    std::vector<std::optional<Expression>> gaps, restitutions;
    for (const ConstraintDescription& constraint : system.constraints) {
        gaps.push_back(read(constraint.gap, gap_scope(system, layout, graph)));
        restitutions.push_back(read(constraint.restitution, restitution_scope(system, layout, graph)));
    }
    read_modes(system, layout, reader, equations, graph);
    if (layout.frictions > 0) read_frictions(system, layout, names, reader, equations, mistakes, graph);
    const Expression nothing = graph.number(0);
    equations.kinetic = equations.given.kinetic = kinetic.value_or(nothing);
    equations.potential = equations.given.potential = potential.value_or(nothing);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        equations.gaps.push_back(gaps[i].value_or(nothing));
        equations.restitutions.push_back(restitutions[i].value_or(nothing));
    }
    PrescribedMotion motion{{}, nothing};
    if (kinetic && names.complete)
        attempt_within_limits(mistakes, system, equations,
                              [&] { motion = read_kinetic_energy(system, layout, parts, equations); });
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const ConstraintDescription& constraint = system.constraints[i];
        if (gaps[i] && names.complete)
            attempt_within_limits(mistakes, system, equations, [&] { check_gap(constraint.gap, *gaps[i], layout); });
        // A restitution that depends on parameters is checked at the start of a run.
        if (restitutions[i] && is_constant(*restitutions[i]))
            if (auto mistake = mistake_in(constraint.restitution, value_of_constant(*restitutions[i])))
                mistakes.add(std::move(*mistake));
    }
    read_forces(system, layout, reader, equations, mistakes);
    equations.in_forces = contacts_in(equations.Q, layout);
    equations.given.Q = equations.Q;
    attempt_within_limits(mistakes, system, equations, [&] { add_prescribed_motion(motion, layout, equations); });
}

namespace {

// What no equation uses: slips without friction, drawings, views, the closing of an orbit.
void read_rest(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations,
               const Names& names, ExpressionReader& reader) {
    Scope in_slips = state_scope(system, layout, graph);
    for (const ConstraintDescription& constraint : system.constraints)
        if (!constraint.has_friction()) reader.read(constraint.slip, in_slips);
    Scope in_drawings = drawing_scope(system, layout, graph);
    for (const DrawingDescription& drawing : drawings_of(system)) {
        if (drawing.shape == DrawingDescription::Shape::curve && drawing.over.empty()) continue;  // its name is missing
        if (!drawing.over.empty()) in_drawings.allowed.insert_or_assign(drawing.over, graph.symbol(layout.own()));
        for (const Text& text : texts_of(drawing)) reader.read(text, in_drawings);
        in_drawings.allowed.erase(drawing.over);
    }
    Scope in_views = view_scope(system, layout, graph, equations);
    const bool lacks_contacts = system.constraints.empty() || (names.has_friction && !system.has_friction());
    for (const ViewDescription& view : system.views) {
        if (lacks_contacts && !names.complete) break;  // their table may be misspelled
        reader.read(view.x, in_views);
        for (const Text& text : view.y) reader.read(text, in_views);
    }
    if (!system.orbit) return;
    Scope in_orbit = closing_scope(system, layout, graph);
    reader.read(system.orbit->period, in_orbit);
    for (const Text& text : system.orbit->shift)
        if (text.text != free_shift) reader.read(text, in_orbit);
}

}  // namespace

bool check_expressions(SystemDescription& system, Names names, ErrorCollector& mistakes) {
    Layout layout = layout_of(system);
    Graph graph;
    Equations equations;
    const std::size_t before = mistakes.count();
    read_equations(system, layout, graph, names, equations, mistakes);
    const bool has_equations = mistakes.count() == before;
    drop_zero_friction(system, equations);
    layout = layout_of(system);
    const Expression any_value = graph.symbol(layout.t());
    equations.energy = equations.power = any_value;
    equations.free.contacts.resize(system.constraints.size());
    for (ContactEquations& c : equations.free.contacts) c.hdot = c.hddot = c.lambda = c.gap_t = any_value;
    ExpressionReader reader(graph, names, mistakes);
    attempt_within_limits(mistakes, system, equations,
                          [&] { read_rest(system, layout, graph, equations, names, reader); });
    return has_equations;
}

}  // namespace achilles
