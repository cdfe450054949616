#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "model/model.hpp"
#include "number/float_environment.hpp"
#include "output/contacts.hpp"
#include "output/json_parts.hpp"
#include "output/output.hpp"
#include "sensitivity/error_estimate.hpp"
#include "sensitivity/quantities.hpp"
#include "simulate/sampler.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

using Json = nlohmann::ordered_json;

// Numbers are printed in the shortest form that is read back as the same double. Numbers that are not finite are null.

Json list(const Vector& x) {
    Json result = Json::array();
    for (Eigen::Index i = 0; i < x.size(); ++i) result.push_back(number_json(x[i]));
    return result;
}

Json list(const Eigen::VectorXd& x) {
    Json result = Json::array();
    for (const double each : x) result.push_back(number_json(each));
    return result;
}

// A matrix as a list of rows.
Json table(const Eigen::MatrixXd& x) {
    Json result = Json::array();
    for (Eigen::Index i = 0; i < x.rows(); ++i) result.push_back(list(Eigen::VectorXd(x.row(i).transpose())));
    return result;
}

// Derivatives along the event; null for events beyond the last one with derivatives.
Json derivatives_at(const Trajectory& trajectory, const Derivatives& derivatives, std::size_t event) {
    if (event >= derivatives.events.size()) return nullptr;
    const Derivatives::EventSensitivity& at = derivatives.events[event];
    Json result = {{"t", list(at.t)}, {"q", table(at.q)}};
    if (trajectory.events[event].is_impact()) {
        result["v_before"] = table(at.v_before);
        result["v_after"] = table(at.v_after);
        result["impact_speed"] = list(at.impact_speed);
    } else {
        result["v"] = table(at.v_after);
    }
    return result;
}

Json derivatives_of(const Dependence& dependence) {
    const Derivatives& d = dependence.derivatives;
    Json refused = Json::object(), of = Json::array();
    for (std::size_t k = 0; k < d.refused.size(); ++k)
        if (!d.refused[k].empty()) refused[d.directions[k]] = d.refused[k];
    for (const Quantity& quantity : dependence.quantities) {
        of.push_back({{"expression", quantity.expression},
                      {"value", number_json(quantity.value)},
                      {"derivatives", list(quantity.derivatives)}});
        if (!quantity.refused.empty()) of.back()["reason"] = quantity.refused;
    }
    Json result = {{"directions", d.directions},
                   {"margins",
                    {{"grazing_speed", number_json(d.margins.grazing_speed)},
                     {"gap_minimum", number_json(d.margins.gap_minimum)},
                     {"a_inf", number_json(d.margins.a_inf)},
                     {"release_jerk", number_json(d.margins.release_jerk)}}},
                   {"of", of},
                   {"refused", refused},
                   {"none_from", nullptr}};
    if (!d.broken.empty()) result["none_from"] = {{"t", number_json(d.broken_from)}, {"reason", d.broken}};
    return result;
}

Json system_of(const Trajectory& trajectory) {
    const SystemDescription& description = trajectory.model->description();
    Json coordinates = Json::array(), parameters = Json::object();
    for (const auto& coordinate : description.coordinates) coordinates.push_back(coordinate.name);
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        parameters[description.parameters[i].name] = number_json(trajectory.run.parameters[i]);
    const std::vector<double> derived = derived_values(*trajectory.model, trajectory.run.parameters);
    for (std::size_t i = 0; i < derived.size(); ++i) parameters[description.derived[i].name] = number_json(derived[i]);
    Json contacts = Json::array();
    for (const ConstraintDescription& constraint : description.constraints) contacts.push_back(constraint.name);
    return {
        {"title", description.title}, {"coordinates", coordinates}, {"parameters", parameters}, {"contacts", contacts}};
}

// The units of quantities with a known unit.
Json units_of(const SystemDescription& description) {
    Json units = {{"t", "s"}};
    for (const std::string& name : settable_names(description))
        if (const std::string unit = unit_of(description, name); !unit.empty()) units[name] = unit;
    for (const DerivedDescription& derived : description.derived)
        if (!derived.unit.empty()) units[derived.name] = derived.unit;
    return units;
}

Json samples_of(const Trajectory& trajectory, const std::vector<double>& times) {
    Json samples = Json::array();
    for (const Sample& sample : samples_at(trajectory, times)) {
        samples.push_back({{"t", number_json(sample.t)},
                           {"j", sample.j},
                           {"phase", to_text(sample.phase)},
                           {"held", contact_names(*trajectory.model, sample.mode.held())},
                           {"q", list(sample.state.q)},
                           {"v", list(sample.state.v)}});
        if (trajectory.model->has_conditional_contacts())
            samples.back()["inactive"] = contact_names(*trajectory.model, sample.inactive);
        if (trajectory.model->has_latches())
            samples.back()["latched"] = contact_names(*trajectory.model, sample.latched);
    }
    return samples;
}

Json options_of(const Options& options) {
    Json result = Json::object();
    for (const Option* option : options_in_report_order({"method", "tolerance"})) {
        if (is_left_out(*option, options)) continue;
        const OptionValue value = option->get(options);
        const auto* x = std::get_if<double>(&value);
        result[std::string(option->key)] =
            x ? number_json(*x) : std::visit([](const auto& other) { return Json(other); }, value);
    }
    return result;
}

// The outcome, and the tolerances of the second run if the requested ones left it undecided.
Json outcome_of(const Trajectory& trajectory) {
    Json again = nullptr;
    if (trajectory.rerun_options)
        for (const Option& option : all_options())
            if (option.is_tolerance)
                again[std::string(option.key)] = number_json(std::get<double>(option.get(*trajectory.rerun_options)));
    return {
        {"kind", to_text(trajectory.outcome.kind)}, {"message", trajectory.outcome.message}, {"made_again_by", again}};
}

Json names(const Trajectory& trajectory, ContactSet contacts) { return contact_names(*trajectory.model, contacts); }

// Values as an object with the names of contacts as keys.
template <class Pairs, class Value>
Json by_contact(const Trajectory& trajectory, const Pairs& pairs, const Value& value) {
    Json result = Json::object();
    for (const auto& entry : pairs) {
        const auto& [contact, json] = value(entry);
        result[trajectory.model->description().constraints[contact].name] = json;
    }
    return result;
}
Json by_contact(const Trajectory& trajectory, const std::vector<std::pair<std::size_t, double>>& values) {
    return by_contact(trajectory, values,
                      [](const auto& entry) { return std::pair(entry.first, number_json(entry.second)); });
}

// The bounds on the other contacts of a certificate.
void add_others(Json& result, const Trajectory& trajectory, const Certificate::OtherContactBounds& others) {
    using HeldContactBound = Certificate::OtherContactBounds::HeldContactBound;
    result["transmission"] = by_contact(trajectory, others.held, [](const HeldContactBound& held) {
        return std::pair(held.contact, Json{number_json(held.transmission_low), number_json(held.transmission_high)});
    });
    result["least_force"] = by_contact(trajectory, others.held, [](const HeldContactBound& held) {
        return std::pair(held.contact, number_json(held.least_force));
    });
    result["least_other_gap"] = number_json(others.least_gap);
    if (others.rounded_zero) result["rounded_zero"] = true;
}

Json certificate_of(const Trajectory& trajectory, const Certificate& c) {
    Json result = {{"certified", c.certified},
                   {"conditions", to_text(c.conditions)},
                   {"reinitialization", to_text(c.reinitialization)},
                   {"below_rounding", c.cut_at_resolution},
                   {"zeno_time", {number_json(c.zeno_low), number_json(c.zeno_high)}},
                   {"position_bound", number_json(c.position_bound)},
                   {"velocity_bound", number_json(c.velocity_bound)},
                   {"shadowing_position", number_json(c.shadowing_position)},
                   {"shadowing_velocity", number_json(c.shadowing_velocity)},
                   {"uniform_position", number_json(c.uniform_position)},
                   {"a_min", number_json(c.a_min)},
                   {"a_max", number_json(c.a_max)},
                   {"decisive", c.tightest_bound}};
    if (c.paper) {
        const Certificate::Paper& p = *c.paper;
        result.update({{"e1", number_json(p.e1)},
                       {"e2", number_json(p.e2)},
                       {"beta", number_json(p.beta)},
                       {"eta", number_json(p.eta)},
                       {"zeta", number_json(p.zeta)},
                       {"c1", number_json(p.c1)},
                       {"c2", number_json(p.c2)},
                       {"c3", number_json(p.c3)}});
    }
    if (c.tail != Certificate::Tail::none) result["tail"] = to_text(c.tail);
    Json inequalities = Json::array();
    for (const Inequality& inequality : c.inequalities())
        inequalities.push_back({{"name", inequality.name},
                                {"left", number_json(inequality.left)},
                                {"right", number_json(inequality.right)}});
    result["inequalities"] = inequalities;
    if (c.others) add_others(result, trajectory, *c.others);
    return result;
}

// The states of contacts and joints with friction; only for systems with friction.
void add_modes(Json& result, const Trajectory& trajectory, Mode mode) {
    if (!trajectory.model->has_friction()) return;
    Json& modes = result["modes"] = Json::object();
    for (const std::size_t i : rough_in(*trajectory.model, mode))
        modes[contact_names(*trajectory.model, ContactSet::of(i)).front()] = state_word(mode.state(i));
}

// The contacts that do not count; only for systems where contacts may.
void add_states(Json& result, const Trajectory& trajectory, ContactSet inactive, ContactSet latched) {
    if (trajectory.model->has_conditional_contacts()) result["inactive"] = names(trajectory, inactive);
    if (trajectory.model->has_latches()) result["latched"] = names(trajectory, latched);
}

// The sign of the slip that begins: a number, or one for each contact by name where they differ.
void add_direction(Json& result, const Trajectory& trajectory, const Event& event) {
    Json& direction = result["direction"] = Json::object();
    std::set<int> signs;
    for (const std::size_t i : event.contacts) {
        const int sign = slip_sign(event.mode.state(i));
        direction[contact_names(*trajectory.model, ContactSet::of(i)).front()] = sign;
        signs.insert(sign);
    }
    if (signs.size() == 1) direction = *signs.begin();
}

// What friction does at an impact.
void add_friction(Json& result, const Trajectory& trajectory, const Event::FrictionImpulses& friction) {
    result["tangential_impulses"] = by_contact(trajectory, friction.tangential);
    if (friction.energy_cap)
        result["energy_capped"] = {{"factor", number_json(*friction.energy_cap)},
                                   {"contacts", names(trajectory, friction.capped)}};
}

// The plastic impact that is the limit of a collapse.
void add_collapse(Json& result, const Trajectory& trajectory, const CollapseInfo& limit) {
    result["impulses"] = by_contact(trajectory, limit.impulses);
    result["loss"] = number_json(limit.loss);
    result["speed_ratio"] = number_json(limit.speed_ratio);
    result["gap_ratio"] = number_json(limit.gap_ratio);
}

// The contacts that take part in an event. For an impact this includes touching contacts that receive an impulse.
ContactSet taking_part(const Trajectory& trajectory, std::size_t index) {
    const Event& event = trajectory.events[index];
    ContactSet all = event.contacts;
    const Mode mode = mode_before(trajectory, index);
    if (event.joint)
        for (const auto& [contact, impulse] : event.joint->impulses)
            if (impulse > 0.0 && !mode.is_held(contact)) all = all.with(contact);
    return all;
}

// Data that only impacts of several contacts have.
void add_joint(Json& result, const Trajectory& trajectory, const MultiContactInfo& joint) {
    result["order_matters"] = joint.order_matters;
    result["not_unique"] = joint.is_nonunique;
    if (joint.rounded_zero) result["rounded_zero"] = true;
    if (!joint.order_matters) return;
    Json& alternatives = result["alternatives"] = Json::array();
    for (const MultiContactInfo::ImpactOrderOutcome& other : joint.alternatives) {
        Json first = nullptr;
        if (other.first) first = trajectory.model->description().constraints[*other.first].name;
        alternatives.push_back({{"first", first}, {"rates_after", by_contact(trajectory, other.rates_after)}});
    }
}

Json event_of(const Trajectory& trajectory, std::size_t index, Impulses& impulses) {
    const Event& event = trajectory.events[index];
    Json result = {{"kind", names_of(event.kind).word}, {"t", number_json(event.t)}};
    const Json contacts = names(trajectory, taking_part(trajectory, index));
    if (contacts.size() == 1)
        result["contact"] = contacts[0];
    else
        result["contacts"] = contacts;
    result["held"] = names(trajectory, event.mode.held());
    result["opened"] = names(trajectory, event.opened);
    add_states(result, trajectory, event.inactive, event.latched);
    if (event.ends_latch) result["ends_latch"] = true;
    result["q"] = list(event.q);
    if (event.is_discontinuous()) {
        result["v_before"] = list(event.v_before);
        result["v_after"] = list(event.v_after);
    } else {
        result["v"] = list(event.v_after);
    }
    if (event.is_jump()) {
        const double loss = energy_lost(trajectory, index);
        result["name"] = jump_name(trajectory, event);
        result["q_before"] = list(event.q_before());
        result["loss"] = number_json(loss);
        Sample before;
        before.t = event.t;
        before.state = {event.q_before(), event.v_before, event.t};
        const Energies energy = EnergyBalance(*trajectory.model, trajectory.run).at(before);
        result["gains_energy"] = loss < -noise * (std::abs(energy.kinetic) + std::abs(energy.potential));
    }
    if (event.is_impact()) {
        result["impact_speed"] = number_json(event.impact_speed);
        result["impulses"] = by_contact(trajectory, impulses.of(index));
        if (event.joint) add_joint(result, trajectory, *event.joint);
        if (event.friction) add_friction(result, trajectory, *event.friction);
    }
    if (event.collapse_info) add_collapse(result, trajectory, *event.collapse_info);
    if (!event.is_friction())
        add_modes(result, trajectory, event.mode);
    else if (event.kind != Event::Kind::stick)
        add_direction(result, trajectory, event);
    if (event.is_zeno()) result["impacts"] = event.impacts;
    if (event.sticks_from > 0) result["sticks_from"] = event.sticks_from;
    if (event.truncation)
        result["truncation"] = {{"t", number_json(event.truncation->t)},
                                {"q", list(event.truncation->q)},
                                {"v_before", list(event.truncation->v_before)},
                                {"v", list(event.truncation->v)},
                                {"impact_speed", number_json(event.truncation->impact_speed)}};
    if (event.certificate) {
        Json& certificate = result["certificate"] = certificate_of(trajectory, *event.certificate);
        if (const std::string convention = assumed_impact_law(trajectory, index); !convention.empty())
            certificate["given"] = convention;
    }
    return result;
}

// Error estimates; null, with the reason, if there are none.
void add_error_estimate(Json& result, const Trajectory& trajectory, const ErrorEstimate& estimate) {
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        Json& of_event = result["events"][i]["error_estimate"] = nullptr;
        if (i < estimate.events.size()) of_event = number_json(estimate.events[i]);
    }
    Json& of_end = result["end"]["error_estimate"] = nullptr;
    if (estimate.end)
        of_end = {{"q", list(estimate.end->q)},
                  {"v", list(estimate.end->v)},
                  {"norm", number_json(estimate.end->norm)},
                  {"sigma", number_json(estimate.end->sigma)},
                  {"reach", number_json(estimate.end->reach())}};
    else
        result["end"]["no_error_estimate"] = estimate.no_estimate_reason;
}

}  // namespace

Json system_json(const Trajectory& trajectory) { return system_of(trajectory); }
Json options_json(const Trajectory& trajectory) { return options_of(trajectory.run.options); }
Json events_json(const Trajectory& trajectory) {
    Json events = Json::array();
    Impulses impulses(trajectory);
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) events.push_back(event_of(trajectory, i, impulses));
    return events;
}

std::string version() { return ACHILLES_VERSION; }

std::string to_json(const Trajectory& trajectory, const Instants& instants, const Dependence* dependence,
                    const ErrorEstimate* known) {
    const FloatEnvironmentGuard ground;
    const ErrorEstimate estimate = known != nullptr ? *known : estimate_error(trajectory);
    Json phases = Json::array();
    for (const Phase& phase : trajectory.phases) {
        phases.push_back({{"kind", to_text(phase.kind)},
                          {"held", names(trajectory, phase.mode.held())},
                          {"start", number_json(phase.start)},
                          {"end", number_json(phase.end)},
                          {"impacts", phase.impacts}});
        add_modes(phases.back(), trajectory, phase.mode);
        if (has_nonunique_forces(phase)) phases.back()["not_unique"] = true;
    }
    Json warnings = Json::array();
    for (const RunWarning& remark : remarks(trajectory, estimate)) warnings.push_back(remark.sentence);
    const Statistics& s = trajectory.statistics;
    Json result = {{"achilles", version()},
                   {"system", system_of(trajectory)},
                   {"options", options_of(trajectory.run.options)},
                   {"phases", phases},
                   {"events", events_json(trajectory)},
                   {"end",
                    {{"t", number_json(trajectory.end_time)},
                     {"q", list(trajectory.end.q)},
                     {"v", list(trajectory.end.v)},
                     {"phase", to_text(trajectory.end_phase)},
                     {"held", names(trajectory, trajectory.end_mode.held())},
                     {"work", number_json(trajectory.work)},
                     {"loss", number_json(trajectory.loss)},
                     {"by_convention", trajectory.ambiguous_impacts}}},
                   {"outcome", outcome_of(trajectory)},
                   {"trusted_until", number_json(estimate.trusted_until)},
                   {"warnings", warnings},
                   {"start",
                    {{"t", number_json(trajectory.run.options.start_time)},
                     {"q", list(trajectory.run.q)},
                     {"v", list(trajectory.run.v)}}},
                   {"units", units_of(trajectory.model->description())},
                   {"statistics",
                    {{"steps", s.steps},
                     {"evaluations", s.evaluations},
                     {"impacts", s.impacts},
                     {"energy_drift", number_json(s.energy_drift)},
                     {"least_gap", number_json(least_gap(trajectory))}}},
                   {"assumed",  // by the certificates
                    {{"arithmetic", "IEEE 754 double, round to nearest"},
                     {"ulps", rounding::libm},
                     {"ulps_hyperbolic", rounding::hyperbolic},
                     {"library", mathematical_library()}}}};
    add_states(result["start"], trajectory, trajectory.start_inactive, trajectory.start_latched);
    add_states(result["end"], trajectory, trajectory.end_inactive, trajectory.end_latched);
    if (trajectory.model->has_friction()) {
        result["end"]["heat"] = number_json(trajectory.heat);
        add_modes(result["end"], trajectory, trajectory.end_mode);
    }
    add_error_estimate(result, trajectory, estimate);
    if (instants) result["samples"] = samples_of(trajectory, *instants);
    if (dependence != nullptr) {
        const Derivatives& d = dependence->derivatives;
        result["derivatives"] = derivatives_of(*dependence);
        for (std::size_t i = 0; i < trajectory.events.size(); ++i)
            result["events"][i]["derivatives"] = derivatives_at(trajectory, d, i);
        Json& end = result["end"]["derivatives"] = nullptr;
        if (d.end) end = {{"q", table(d.end->q)}, {"v", table(d.end->v)}};
    }
    // Invalid UTF-8 in a title is replaced without an exception, and the result cannot control a terminal.
    return printable_json(result.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace achilles
