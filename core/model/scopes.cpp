#include "model/scopes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"

namespace achilles {

namespace {

void allow_positions(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph) {
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
        scope.allowed.emplace(system.coordinates[i].name, graph.symbol(layout.q(i)));
}

void allow_rates(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph) {
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
        scope.allowed.emplace(system.coordinates[i].name + "'", graph.symbol(layout.v(i)));
}

void allow_parameters(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph) {
    for (std::size_t i = 0; i < system.parameters.size(); ++i)
        scope.allowed.emplace(system.parameters[i].name, graph.symbol(layout.parameter(i)));
    if (system.derived.empty()) return;
    Scope known;  // names that a definition may use
    for (const ParameterDescription& parameter : system.parameters)
        known.allowed.emplace(parameter.name, scope.allowed.find(parameter.name)->second);
    for (const DerivedDescription& derived : system.derived) {
        known.units.clear();
        allow_units(known, derived.unit, graph);
        Expression value = graph.symbol(layout.own());  // placeholder if parsing fails, reported elsewhere
        try {
            value = parse(derived.definition.text, known, graph);
        } catch (const ParseError&) {
        }
        known.allowed.emplace(derived.name, value);
        scope.allowed.emplace(derived.name, value);
    }
}

// Forbids names with primes that have no meaning in any expression.
void forbid_primes(Scope& scope, const SystemDescription& system) {
    for (const CoordinateDescription& coordinate : system.coordinates)
        scope.forbidden.emplace(
            coordinate.name + "''",
            fmt::format(
                "the acceleration {}'' is not allowed in an expression: it follows from the equations of motion",
                coordinate.name));
    const auto forbid = [&](const std::string& name) {
        scope.forbidden.emplace(name + "'", fmt::format("'{}' is a parameter: it has no rate", name));
    };
    for (const ParameterDescription& parameter : system.parameters) forbid(parameter.name);
    for (const DerivedDescription& derived : system.derived) forbid(derived.name);
}

constexpr std::array<const char*, 4> contact_outputs{"gap", "gap'", "gap''", "lambda"};
constexpr std::array<const char*, 2> slip_outputs{"slip", "friction_force"};

// Forbids words that have a meaning only in views, or as a value of friction.
void forbid_outputs(Scope& scope, const SystemDescription& system) {
    const auto forbid = [&](const std::string& word) {
        scope.forbidden.emplace(word, fmt::format("'{}' is allowed only in a [[view]]", word));
    };
    if (system.has_friction()) {
        scope.forbidden.emplace("slip", "'slip' is allowed only in friction, in a level and in a [[view]]");
        scope.forbidden.emplace("inf", "'inf' stands alone: friction = \"inf\"");
        for (const char* word : slip_outputs) {
            for (const std::string& name : sliding_names(system, word)) forbid(name);
            forbid(word);
        }
        forbid("heat");
    }
    for (const char* word : contact_outputs) {
        for (const std::string& name : output_names(system, word)) forbid(name);
        forbid(word);
    }
    for (const char* word : {"energy", "work", "loss", "power"}) forbid(word);
    scope.forbidden.emplace("held",
                            "held(NAME) is allowed only in a force and in the dissipation; write what else depends on "
                            "contact as a force");
}

// Coordinates, t and parameters. For messages: `what` names the text, `why` gives the reason why rates are not allowed.
Scope position_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const char* what,
                     const char* why) {
    Scope scope;
    allow_positions(scope, system, layout, graph);
    allow_parameters(scope, system, layout, graph);
    scope.allowed.emplace("t", graph.symbol(layout.t()));
    for (const CoordinateDescription& coordinate : system.coordinates)
        scope.forbidden.emplace(coordinate.name + "'",
                                fmt::format("the rate {}' is not allowed in the {}: {}", coordinate.name, what, why));
    forbid_primes(scope, system);
    forbid_outputs(scope, system);
    return scope;
}

// Parameters. For messages: `what` names the text.
Scope constant_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const char* what) {
    Scope scope;
    allow_parameters(scope, system, layout, graph);
    const auto forbid = [&](const std::string& name, const std::string& shown) {
        scope.forbidden.emplace(name, fmt::format("{} is not allowed in {}: use only parameters", shown, what));
    };
    for (const CoordinateDescription& coordinate : system.coordinates) {
        forbid(coordinate.name, fmt::format("the coordinate '{}'", coordinate.name));
        forbid(coordinate.name + "'", fmt::format("the rate {}'", coordinate.name));
    }
    forbid("t", "'t'");
    forbid_primes(scope, system);
    forbid_outputs(scope, system);
    return scope;
}

}  // namespace

Scope state_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    Scope scope;
    allow_positions(scope, system, layout, graph);
    allow_rates(scope, system, layout, graph);
    allow_parameters(scope, system, layout, graph);
    scope.allowed.emplace("t", graph.symbol(layout.t()));
    forbid_primes(scope, system);
    forbid_outputs(scope, system);
    return scope;
}

Scope force_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    Scope scope = state_scope(system, layout, graph);
    if (!layout.forces_see_contact) return scope;
    scope.forbidden.erase("held");
    auto& held = scope.of_contact["held"];
    for (std::size_t i = 0; i < system.constraints.size(); ++i)
        held.emplace(system.constraints[i].name, graph.symbol(layout.held(i)));
    return scope;
}

Scope potential_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return position_scope(system, layout, graph, "potential",
                          "write terms with rates in a force or in the dissipation");
}

Scope gap_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return position_scope(system, layout, graph, "gap", "it may depend only on coordinates, parameters and time");
}

namespace {

// The scope of a coefficient or level of friction. `why` says why rates are not allowed.
Scope level_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const char* why) {
    Scope scope = position_scope(system, layout, graph, "friction", why);
    std::vector<std::string> forces = output_names(system, "lambda");
    forces.emplace_back("lambda");
    for (const std::string& force : forces)
        scope.forbidden.insert_or_assign(
            force, fmt::format("'{}' is not allowed here: friction that depends on forces is not covered", force));
    return scope;
}

}  // namespace

Scope static_friction_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    Scope scope = level_scope(system, layout, graph, "it may depend only on coordinates, parameters and time");
    scope.forbidden.insert_or_assign("slip", "'slip' is not allowed here: this is the limit at slip 0");
    return scope;
}

Scope friction_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    Scope scope = level_scope(system, layout, graph, "use slip, the sliding speed");
    scope.allowed.emplace("slip", graph.symbol(layout.sliding_speed()));
    return scope;
}

Scope restitution_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return constant_scope(system, layout, graph, "the restitution");
}

Scope closing_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return constant_scope(system, layout, graph, "the period or shift of an orbit");
}

Scope definition_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return constant_scope(system, layout, graph, "a derived parameter");
}

const Text* first_with_held(const SystemDescription& system) {
    const auto is_held = [](const auto& named) { return named.name == "held"; };
    if (std::any_of(system.parameters.begin(), system.parameters.end(), is_held) ||
        std::any_of(system.derived.begin(), system.derived.end(), is_held) ||
        std::any_of(system.coordinates.begin(), system.coordinates.end(), is_held))
        return nullptr;
    const auto has_it = [](const Text& text) {
        const std::vector<std::string> names = names_in(text.text);
        return std::find(names.begin(), names.end(), "held") != names.end();
    };
    for (const CoordinateDescription& coordinate : system.coordinates)
        if (has_it(coordinate.force)) return &coordinate.force;
    return has_it(system.dissipation) ? &system.dissipation : nullptr;
}

std::optional<UnprovedFeature> first_unproved(const SystemDescription& system) {
    if (system.has_friction()) return UnprovedFeature{"dry friction", sliding_places(system).front().level->at};
    if (!system.jumps.empty()) return UnprovedFeature{"jumps", system.jumps.front().at};
    for (const ConstraintDescription& constraint : system.constraints)
        if (!constraint.when.text.empty())
            return UnprovedFeature{"contacts that count only sometimes", constraint.when.at};
    for (const ConstraintDescription& constraint : system.constraints)
        if (!constraint.latch.on.text.empty()) return UnprovedFeature{"latches", constraint.latch.on.at};
    if (const Text* const text = first_with_held(system))
        return UnprovedFeature{"forces that depend on contact", text->at};
    return std::nullopt;
}

Layout layout_of(const SystemDescription& system) {
    const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    return {count(system.coordinates), count(system.parameters), count(system.constraints),
            count(sliding_places(system)), first_with_held(system) != nullptr};
}

std::vector<std::string> slot_names(const SystemDescription& system, const Layout& layout) {
    std::vector<std::string> names(layout.count());
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
        names[layout.q(i)] = system.coordinates[i].name;
        names[layout.v(i)] = system.coordinates[i].name + "'";
    }
    for (std::size_t i = 0; i < system.parameters.size(); ++i) names[layout.parameter(i)] = system.parameters[i].name;
    names[layout.t()] = "t";
    names[layout.contact()] = "contact";
    names[layout.sigma()] = "sigma";
    names[layout.second_sigma()] = "sigma_2";
    names[layout.own()] = "own";
    names[layout.work()] = "work";
    names[layout.loss()] = "loss";
    for (std::size_t i = 0; i < layout.contacts; ++i) {
        names[layout.acceleration(i)] = "gap_" + system.constraints[i].name + "''";
        names[layout.force(i)] = "lambda_" + system.constraints[i].name;
    }
    for (std::size_t i = 0; layout.forces_see_contact && i < layout.contacts; ++i)
        names[layout.held(i)] = "held(" + system.constraints[i].name + ")";
    if (layout.frictions == 0) return names;
    names[layout.sliding_speed()] = "slip";
    names[layout.heat()] = "heat";
    const std::vector<std::string> forces = sliding_names(system, "friction_force");
    for (std::size_t i = 0; i < layout.frictions; ++i) names[layout.friction_force(i)] = forces[i];
    return names;
}

namespace {

// h, hdot, the acceleration of the gap and the force of each contact. With several contacts or friction, the last two
// depend on the mode and are inputs.
std::vector<std::array<Expression, 4>> contact_values(const Layout& layout, Graph& graph, const Equations& equations) {
    const Expression held = graph.symbol(layout.contact());
    std::vector<std::array<Expression, 4>> values;
    for (std::size_t i = 0; i < layout.contacts; ++i) {
        const ContactEquations& c = equations.free.contacts[i];
        const Expression hdot = graph.adopt(c.hdot), gap = graph.adopt(equations.gaps[i]);
        if (!layout.has_contact_inputs()) {
            values.push_back(
                {gap, hdot, (graph.number(1) - held) * graph.adopt(c.hddot), held * graph.adopt(c.lambda)});
        } else {
            values.push_back({gap, hdot, graph.symbol(layout.acceleration(i)), graph.symbol(layout.force(i))});
        }
    }
    return values;
}

// slip, friction_force and heat of a view. The words are forbidden if there is no friction.
void allow_slips(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph,
                 const Equations& equations) {
    if (equations.friction.empty()) {
        for (const char* word : {"slip", "friction_force", "heat"})
            scope.forbidden.emplace(word, fmt::format("'{}' needs friction, and this system has none", word));
        return;
    }
    scope.allowed.emplace("heat", graph.symbol(layout.heat()));
    const std::vector<std::string> slips = sliding_names(system, "slip"),
                                   forces = sliding_names(system, "friction_force");
    for (std::size_t k = 0; const auto& [which, law] : equations.friction) {
        scope.allowed.emplace(slips[k], graph.adopt(law.slip));
        scope.allowed.emplace(forces[k], graph.symbol(layout.friction_force(k)));
        ++k;
    }
    for (const auto& [word, names] : {std::pair("slip", &slips), std::pair("friction_force", &forces)})
        scope.forbidden.emplace(word, fmt::format("'{}' needs a name here: {}", word, fmt::join(*names, ", ")));
}

}  // namespace

Scope view_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations) {
    Scope scope;
    allow_positions(scope, system, layout, graph);
    allow_rates(scope, system, layout, graph);
    allow_parameters(scope, system, layout, graph);
    forbid_primes(scope, system);
    scope.allowed.emplace("t", graph.symbol(layout.t()));
    allow_slips(scope, system, layout, graph, equations);
    const std::vector<std::array<Expression, 4>> values = contact_values(layout, graph, equations);
    const bool have_names = std::none_of(system.constraints.begin(), system.constraints.end(),
                                         [](const ConstraintDescription& c) { return c.name.empty(); });
    for (std::size_t i = 0; i < contact_outputs.size(); ++i) {
        const std::vector<std::string> names = output_names(system, contact_outputs[i]);
        for (std::size_t k = 0; k < names.size(); ++k) scope.allowed.emplace(names[k], values[k][i]);
        if (names.empty())
            scope.forbidden.emplace(
                contact_outputs[i],
                fmt::format("{} needs a [[constraint]], and this system has none", in_quotes(contact_outputs[i])));
        if (names.size() > 1)
            scope.forbidden.emplace(
                contact_outputs[i],
                fmt::format(
                    "{} is ambiguous with several constraints{}", in_quotes(contact_outputs[i]),
                    have_names ? fmt::format(": {}", fmt::join(names, ", ")) : ": give each constraint a name"));
    }
    scope.allowed.emplace("energy", graph.adopt(equations.energy));
    Expression power = graph.adopt(equations.power);
    for (std::size_t k = 0; k < layout.contacts; ++k)
        power = power - values[k][3] * graph.adopt(equations.free.contacts[k].gap_t);
    scope.allowed.emplace("power", power);
    scope.allowed.emplace("work", graph.symbol(layout.work()));
    scope.allowed.emplace("loss", graph.symbol(layout.loss()));
    return scope;
}

std::span<const NamedRunQuantity> run_quantities() {
    using enum RunQuantity::Kind;
    using enum Event::Kind;
    static constexpr NamedRunQuantity all[] = {{"zeno_time", {time, zeno}},
                                               {"impact_time", {time, impact}},
                                               {"impact_speed", {speed, impact}},
                                               {"release_time", {time, release}},
                                               {"zeno_points", {count, zeno}},
                                               {"impacts", {count, impact}},
                                               {"releases", {count, release}},
                                               {"least_gap", {least_gap, {}}},
                                               {"stick_time", {time, stick}},
                                               {"slip_time", {time, slip}},
                                               {"reversal_time", {time, reversal}},
                                               {"sticks", {count, stick}},
                                               {"slips", {count, slip}},
                                               {"reversals", {count, reversal}},
                                               {"collapse_time", {time, collapse}},
                                               {"collapses", {count, collapse}},
                                               {"jump_time", {time, jump}},
                                               {"jumps", {count, jump}},
                                               {"pass_time", {time, pass}},
                                               {"passes", {count, pass}}};
    return all;
}

const NamedRunQuantity* run_quantity(std::string_view name) {
    const auto all = run_quantities();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const NamedRunQuantity& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

bool is_count_of_events(std::string_view name) {
    const NamedRunQuantity* const one = run_quantity(name);
    return one != nullptr && one->quantity.kind == RunQuantity::Kind::count;
}

std::string why_absent(const RunQuantity& quantity, const SystemDescription& system) {
    if (!quantity.event) return "";
    switch (*quantity.event) {
        case Event::Kind::stick:
        case Event::Kind::slip:
        case Event::Kind::reversal:
            return system.has_friction() ? "" : "needs friction, and this system has none";
        case Event::Kind::collapse:
            return system.constraints.size() > 1 && !system.has_friction() ? "" : "is of two contacts without friction";
        case Event::Kind::jump:
            return system.jumps.empty() ? "needs jumps, and this system has none" : "";
        case Event::Kind::pass:
            return system.has_conditional_contacts() ? "" : "needs a contact with 'when', and this system has none";
        case Event::Kind::impact:
        case Event::Kind::zeno:
        case Event::Kind::release:
            return "";
    }
    return "";
}

Scope measure_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations,
                    std::vector<RunQuantity>& quantities) {
    Scope scope = view_scope(system, layout, graph, equations);
    const auto input = [&quantities, &layout, &graph](RunQuantity quantity) {
        const auto known = std::find(quantities.begin(), quantities.end(), quantity);
        const auto place = static_cast<std::uint32_t>(known - quantities.begin());
        if (known == quantities.end()) quantities.push_back(quantity);
        return graph.symbol(layout.count() + place);
    };
    for (const auto& [name, quantity] : run_quantities()) {
        if (const std::string reason = why_absent(quantity, system); !reason.empty()) {
            scope.forbidden.emplace(name, fmt::format("'{}' {}", name, reason));
            continue;
        }
        using enum RunQuantity::Kind;
        scope.allowed.emplace(name, input(quantity));  // a name defined by the system takes precedence
        if (quantity.kind != time && quantity.kind != speed) continue;
        scope.listed.emplace(name, [input, one = quantity](int k) { return input({one.kind, one.event, k}); });
    }
    if (layout.frictions == 0) scope.forbidden.emplace("modes", "'modes' needs friction, and this system has none");
    for (const char* word : {"held", "outcome", "modes"})
        scope.forbidden.emplace(word, fmt::format("'{}' is text: use it alone, not in an expression", word));
    return scope;
}

Scope drawing_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return position_scope(system, layout, graph, "drawing", "it may depend only on coordinates, parameters and time");
}

}  // namespace achilles
