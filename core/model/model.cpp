#include "model/model.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "contacts/contact_law.hpp"
#include "model/friction_law.hpp"
#include "model/read_expressions.hpp"
#include "model/scopes.hpp"
#include "model/unpressed.hpp"
#include "number/float_environment.hpp"
#include "number/jet.hpp"
#include "system/expand.hpp"
#include "system/input_error.hpp"

namespace achilles {

Model::Model(SystemDescription description) : description_(std::move(description)), graph_(std::make_unique<Graph>()) {
    if (description_.coordinates.empty())
        throw InputError(description_.file.empty() ? "the system" : description_.file, {},
                         "a system needs at least one coordinate");
    layout_ = layout_of(description_);
    slot_names_ = achilles::slot_names(description_, layout_);
    const FloatEnvironmentGuard ground;  // constants are evaluated as intervals, too
    ErrorCollector mistakes;
    Names names;
    read_equations(description_, layout_, *graph_, names, equations_, mistakes);
    mistakes.raise(description_);
    try {
        derive(equations_, layout_, *graph_);
        compile();
    } catch (const ExpressionTooLarge& problem) {
        throw too_large("the equations of motion", problem);
    } catch (const std::domain_error& problem) {
        throw description_.error(
            description_.kinetic.at,
            fmt::format("the mass matrix is not positive definite at any state: {}", problem.what()),
            "every coordinate needs a positive inertia");
    }
}

InputError Model::too_large(const char* what, const ExpressionTooLarge& problem) const {
    const Mistake mistake = achilles::too_large(description_, equations_, what, problem);
    return description_.error(mistake.at, mistake.message, mistake.hint);
}

Expression Model::read(const Text& typed, const Scope& scope, Graph& graph) const {
    const bool is_in_file = typed.at.line > 0;
    Text text = typed;
    if (!is_in_file) text.at = {0, 1};
    const auto error_at = [&](const Location& at, const std::string& message, const std::string& hint) {
        // A text that is in no file is shown in the message itself.
        return is_in_file ? description_.error(at, message, hint) : InputError({}, at, message, hint, typed.text);
    };
    try {
        text = with_body_values(description_, scope, text);
        return parse(text.text, scope, graph);
    } catch (const ParseError& error) {
        throw error_at(place_in(text, error.offset), error.what(), error.hint);
    } catch (const Mistake& mistake) {
        throw error_at(mistake.at, mistake.message, mistake.hint);
    }
}

namespace {

// Evaluates over jets without directions: their product with an exact 0 is 0, even if e is the factor 0.
template <class Number>
Interval enclosed(const Program& restitution, const Layout& layout, std::span<const Number> parameters) {
    Evaluator<Jet<Interval, 0>> e(restitution);
    for (std::size_t i = 0; i < parameters.size(); ++i) e.input(layout.parameter(i)) = parameters[i];
    e.fix();
    return e.output(0).value;
}

}  // namespace

Interval Model::restitution(std::span<const Interval> parameters, std::size_t contact) const {
    const FloatEnvironmentGuard ground;
    return enclosed(restitutions_[contact], layout_, parameters);
}

std::vector<Restitution> Model::restitutions(std::span<const double> parameters) const {
    const FloatEnvironmentGuard ground;
    std::vector<Restitution> result(contacts());
    for (std::size_t i = 0; i < contacts(); ++i)
        result[i] = {restitution(parameters, i), enclosed(restitutions_[i], layout_, parameters)};
    return result;
}

std::vector<EventNames> possible_events(const Model& model) {
    std::vector<EventNames> possible;
    for (const EventNames& names : event_names) {
        const EventBase event{names.kind};
        const bool is_possible = event.is_friction()   ? model.has_friction()
                                 : event.is_collapse() ? model.contacts() > 1 && !model.has_friction()
                                 : event.is_jump()     ? model.has_jumps()
                                 : event.is_pass()     ? model.has_conditional_contacts()
                                                       : true;
        if (is_possible) possible.push_back(names);
    }
    return possible;
}

void Model::compile_jumps() {
    Graph& graph = *graph_;
    Expressions guards;
    const auto guard = [&](const std::optional<Expression>& condition) {
        guards.push_back(condition.value_or(graph.number(1)));
    };
    watched_guards_ = achilles::watched_guards(equations_.jumps, equations_.latches);
    for (const WatchedGuard& watched : watched_guards_) guards.push_back(watched.function);
    for (const auto& latch : equations_.latches) has_latches_ = has_latches_ || latch;
    for (const JumpLaw& jump : equations_.jumps) {
        Expressions after;
        for (std::uint32_t slot = 0; slot < 2 * layout_.dof; ++slot) after.push_back(graph.symbol(slot));
        for (const auto& [slot, value] : jump.set) after[slot] = value;
        jump_maps_.emplace_back(after, layout_.slots());
    }
    for (const auto& when : equations_.when) {
        guard(when);
        has_conditional_contacts_ = has_conditional_contacts_ || when.has_value();
    }
    for (const JumpLaw& jump : equations_.jumps) guard(jump.when);
    if (has_guards()) guards_ = Program(guards, layout_.slots());
    Expressions slopes;
    std::vector<std::uint32_t> state;
    for (std::uint32_t slot = 0; slot < 2 * layout_.dof; ++slot) state.push_back(slot);
    for (const WatchedGuard& watched : watched_guards_)
        for (const Expression slope : gradient(watched.function, state)) slopes.push_back(slope);
    if (!slopes.empty()) guard_slopes_ = Program(slopes, layout_.slots());
}

void Model::compile() {
    const Equations& e = equations_;
    compile_jumps();
    const Slots slots = layout_.slots();
    const auto program = [&](Expression output) { return Program(std::span(&output, 1), slots); };
    for (const Expression e_of : e.restitutions) restitutions_.push_back(program(e_of));
    for (std::size_t i = 0; i < contacts(); ++i)
        free_.push_back(&programs_.emplace(ContactInMode({}, i), compile_contact(e.free, i)).first->second);
    energy_ = TypedProgram<EnergyTerms>::of(slots, e.energy, e.kinetic, e.potential);
    const Expression hddot = contacts() > 0 ? e.free.contacts[0].hddot : graph_->number(0);
    start_ = TypedProgram<StartTerms>::of(slots, e.free.f, e.pivots, hddot, e.given.kinetic, e.given.potential);
    std::vector<Text> derived;
    for (const DerivedDescription& one : description_.derived) derived.push_back({one.name, one.definition.at});
    if (!derived.empty()) derived_parameters_ = compile_drawing(derived);
    edges_ = edges_of(equations_, layout_);
    std::vector<Expression> distances;
    for (const DomainBoundary& edge : edges_) distances.push_back(edge.event_function);
    if (!edges_.empty()) edge_series_ = SeriesProgram(Program(distances, slots), 0, distances.size());
}

Model::ContactPrograms Model::compile_contact(const ModeEquations& motion, std::size_t contact) const {
    const ContactEquations& c = motion.contacts.at(contact);
    const Slots slots = layout_.slots();
    const auto program = [&](Expression output) { return Program(std::span(&output, 1), slots); };
    return {program(c.gap),
            program(c.hddot),
            program(c.lambda),
            TypedProgram<ContactTerms>::of(slots, c.gap, c.hdot, c.direction, c.g, c.W, c.gap_t),
            TypedProgram<ReleaseTerms>::of(slots, c.hddot, jerk_of(c, layout_)),
            TypedProgram<Definition7Terms>::of(slots, c.hddot, c.direction, motion.f)};
}

ContactModes& Model::contact_modes() const {
    if (!modes_) modes_ = std::make_unique<ContactModes>(equations_, layout_);
    return *modes_;
}

// The entry of a key, created at first use; its address never changes. Thread-safe, because threads share a model.
template <class Map, class Make>
const auto& Model::derived(Map& map, const typename Map::key_type& key, const Make& make) const {
    const std::scoped_lock lock(modes_mutex_);
    const auto known = map.find(key);
    if (known != map.end()) return known->second;
    const FloatEnvironmentGuard ground;
    try {
        return map.emplace(key, make()).first->second;
    } catch (const ExpressionTooLarge& problem) {
        throw too_large("the equations for held contacts, certificates or derivatives", problem);
    }
}

const ModeDynamics& Model::motion(Mode mode) const {
    return derived(motions_, mode,
                   [&] { return make_motion(contact_modes().of(mode), equations_, layout_, contact_modes()); });
}

const Program& Model::guard_curvatures(Mode mode) const {
    return derived(guard_curvatures_, mode, [&] {
        const ModeEquations& motion = contact_modes().of(mode);
        Expressions second;
        for (const Expression guard : contact_modes().watched_guards())
            second.push_back(rate_of(rate_of(guard, motion.f, layout_), motion.f, layout_));
        return Program(second, layout_.slots());
    });
}

const SeriesProgram& Model::hddot_series(Mode mode) const {
    return derived(hddot_series_, mode,
                   [&] { return make_hddot_series(contact_modes().of(mode), equations_, layout_); });
}

const MotionVariation& Model::variation(Mode mode, std::uint32_t directions) const {
    const ModeDynamics& dynamics = motion(mode);
    return derived(variations_, {mode, directions}, [&] { return make_variation(dynamics, layout_, directions); });
}

const Model::ContactPrograms& Model::programs_of(std::size_t contact, Mode mode) const {
    if (mode == Mode()) return *free_[contact];
    return derived(programs_, {mode, contact}, [&] { return compile_contact(contact_modes().of(mode), contact); });
}

const Program& Model::power(Mode mode) const {
    return derived(powers_, mode, [&] {
        ContactModes& modes = contact_modes();
        return Program(modes.powers(mode, modes.graph().adopt(equations_.power)), layout_.slots());
    });
}

const SeriesProgram& Model::power_series(Mode mode) const {
    const Program& program = power(mode);
    return derived(power_series_, mode, [&] { return SeriesProgram(program, 0, program.output_count()); });
}

const TypedProgram<SlipTerms>& Model::slip_terms(std::size_t which, Mode mode) const {
    return derived(slip_terms_, {mode, which}, [&] {
        const SlipEquations& slip = contact_modes().of(mode).slips.at(which);
        const FrictionLaw& law = equations_.friction.at(which);
        Graph& graph = contact_modes().graph();
        return TypedProgram<SlipTerms>::of(layout_.slots(), slip.u, slip.c, slip.udot, graph.adopt(law.level),
                                           graph.adopt(law.static_level), slip.d, slip.impulse);
    });
}

const Program& Model::friction_force(std::size_t which, Mode mode) const {
    return derived(friction_forces_, {mode, which}, [&] {
        const FrictionForce force = contact_modes().force_of(which, mode);
        return Program(Expressions{force.lambda, force.tau, force.scale}, layout_.slots());
    });
}

bool Model::stays_closed_without_force(std::size_t contact, Mode mode) const {
    return derived(closed_without_force_, {mode, contact},
                   [&] { return needs_no_force(contact, mode, contact_modes(), layout_); });
}

const BouncingModel& Model::bouncing(const BouncingKey& key) const {
    return derived(bouncings_, key, [&] { return derive_bouncing(key, contact_modes(), equations_, layout_); });
}

const OtherContactTerms& Model::other_contact_terms(const BouncingKey& key) const {
    return derived(other_contact_terms_, key,
                   [&] { return derive_other_contacts(key, contact_modes(), equations_, layout_); });
}

const Program& Model::change_at_zeno_point(const BouncingKey& key) const {
    return derived(changes_at_zeno_points_, key, [&] {
        const Mode after = key.mode.with(key.contact, key.state);
        Expressions change = contact_modes().of(after).f;
        const Expressions before = contact_modes().of(after.with_silent(ContactSet::of(key.contact))).f;
        for (std::size_t i = 0; i < change.size(); ++i) change[i] = change[i] - before[i];
        return Program(change, layout_.slots());
    });
}

std::optional<BouncingObstacle> Model::obstacle_to_bouncing(const BouncingKey& key) const {
    if (!has_friction()) return std::nullopt;
    return derived(obstacles_, key, [&] { return achilles::obstacle_to_bouncing(key, contact_modes(), layout_); });
}

const PairPrograms& Model::pair(std::size_t first, std::size_t second, Mode closed) const {
    const auto derive = has_friction() ? derive_sliding_pair : derive_pair;
    return derived(pairs_, {closed, ContactSet::of(first).with(second)},
                   [&] { return derive(first, second, closed, contact_modes(), equations_, layout_); });
}

LanePrograms Model::lane_programs() const {
    return {layout_.dof, motion({}).series, motion(Mode::holding(ContactSet::of(0))).series, contact_terms()};
}

Program Model::compile_view(std::span<const Text> texts) const {
    Graph graph(*graph_);  // a copy, because threads share the model
    const Scope scope = view_scope(description_, layout_, graph, equations_);
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

Program Model::compile_section(const Text& text) const {
    Graph graph(*graph_);
    const Expression value = read(text, view_scope(description_, layout_, graph, equations_), graph);
    std::vector<std::uint32_t> along{layout_.t()};
    for (std::uint32_t i = 0; i < 2 * layout_.dof; ++i) along.push_back(i);
    std::vector<Expression> outputs{value};
    for (const Expression& slope : gradient(value, along)) outputs.push_back(slope);
    return Program(outputs, layout_.slots());
}

Model::MeasureProgram Model::compile_measures(std::span<const Text> texts) const {
    Graph graph(*graph_);
    MeasureProgram result;
    const Scope scope = measure_scope(description_, layout_, graph, equations_, result.quantities);
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    Slots slots = layout_.slots();
    slots.count += static_cast<std::uint32_t>(result.quantities.size());
    result.program = Program(outputs, slots);
    return result;
}

Program Model::compile_of_parameters(std::span<const Text> texts) const {
    Graph graph(*graph_);
    const Scope scope = closing_scope(description_, layout_, graph);
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

Program Model::compile_drawing(std::span<const Text> texts, const std::string& own) const {
    Graph graph(*graph_);
    Scope scope = drawing_scope(description_, layout_, graph);
    if (!own.empty()) scope.allowed.insert_or_assign(own, graph.symbol(layout_.own()));
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

std::vector<double> derived_values(const Model& model, std::span<const double> parameters) {
    std::vector<double> values(model.description().derived.size());
    if (values.empty()) return values;
    auto value = model.evaluator(model.derived_parameters(), parameters);
    value.run();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = value.output(i);
    return values;
}

}  // namespace achilles
