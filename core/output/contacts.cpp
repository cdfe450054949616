#include "output/contacts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "output/precision.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

std::vector<std::string> contact_names(const Model& model, ContactSet contacts) {
    const SystemDescription& system = model.description();
    std::vector<std::string> names;
    for (const std::size_t i : contacts)
        names.push_back(is_joint(i) ? system.frictions[i - max_contacts].name : system.constraints[i].name);
    return names;
}

std::string_view state_word(ContactState state) {
    constexpr std::string_view words[] = {"open", "stick", "slip+", "slip-"};
    return words[static_cast<std::size_t>(state)];
}

ContactSet rough_in(const Model& model, Mode mode) {
    ContactSet rough;
    for (const auto& [which, law] : model.equations().friction)
        if (mode.is_held(which)) rough = rough.with(which);
    return rough;
}

std::string modes_text(const std::vector<std::pair<std::size_t, std::string>>& names, Mode mode) {
    std::string text;
    for (const auto& [which, name] : names)
        if (mode.is_held(which))
            text += fmt::format("{}{}:{}", text.empty() ? "" : "+", name, state_word(mode.state(which)));
    return text;
}

std::string modes_text(const Model& model, Mode mode) {
    std::vector<std::pair<std::size_t, std::string>> names;
    for (const std::size_t i : rough_in(model, mode))
        names.emplace_back(i, contact_names(model, ContactSet::of(i)).front());
    return modes_text(names, mode);
}

std::string joined_names(const Model& model, ContactSet contacts, std::string_view between) {
    return fmt::format("{}", fmt::join(contact_names(model, contacts), between));
}

bool has_nonunique_forces(const Phase& phase) { return phase.is_nonunique() || !phase.mode.implied().empty(); }

bool has_several_places(const Model& model) { return model.contacts() + model.description().frictions.size() > 1; }

const std::string& jump_name(const Trajectory& trajectory, const Event& jump) {
    return trajectory.model->description().jumps[jump.jump->number].name;
}

std::string event_contacts_text(const Trajectory& trajectory, const Event& event) {
    const Model& model = *trajectory.model;
    if (event.is_jump()) return jump_name(trajectory, event);
    return has_several_places(model) ? joined_names(model, event.contacts) : "";
}

// ---- slips ----

namespace {

// The coefficient of a slip on the rate of x, x1, x_a, ... (`letter`): 0 if there is none, or if there are several.
double coefficient_on(char letter, const Vector& d, const SystemDescription& system) {
    double found = 0.0;
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
        const std::string& name = system.coordinates[i].name;
        const double here = d[static_cast<Eigen::Index>(i)];
        if (here == 0.0 || name[0] != letter || (name.size() > 1 && std::isalpha(static_cast<unsigned char>(name[1]))))
            continue;
        if (found != 0.0) return 0.0;
        found = here;
    }
    return found;
}

}  // namespace

std::string Slips::direction(std::size_t which, int sign, const State& state) {
    const Vector d = cache_.slip(which, state).d;
    const SystemDescription& system = model_.description();
    const double x = coefficient_on('x', d, system) * sign, y = coefficient_on('y', d, system) * sign;
    if (x != 0.0 && std::abs(x) >= std::abs(y)) return x > 0.0 ? "to the right" : "to the left";
    if (y != 0.0) return y > 0.0 ? "up" : "down";
    return sign > 0 ? "with slip > 0" : "with slip < 0";
}

std::string Slips::verb(std::size_t which, Mode mode, const State& state) {
    const int sign = slip_sign(mode.state(which));
    return sign == 0 ? "sticks" : "slides " + direction(which, sign, state);
}

double Slips::heat_of_impact(const Event& impact) {
    double heat = 0.0;
    if (impact.friction == nullptr) return heat;
    for (const auto& [contact, impulse] : impact.friction->tangential) {
        const double before = cache_.slip(contact, {impact.q, impact.v_before, impact.t}).u,
                     after = cache_.slip(contact, {impact.q, impact.v_after, impact.t}).u;
        heat -= 0.5 * impulse * (before + after);
    }
    return heat;
}

Impulses::Impulses(const Trajectory& trajectory)
    : trajectory_(trajectory), surfaces_(*trajectory.model, trajectory.run) {}

std::vector<std::pair<std::size_t, double>> Impulses::of(std::size_t event) {
    const Event& impact = trajectory_.events[event];
    if (impact.joint && !impact.joint->impulses.empty()) return impact.joint->impulses;
    // Solves G (v+ - v-) = W p for the held and the impacting contacts.
    const ContactSet all = mode_before(trajectory_, event).held().with(impact.contacts);
    if (all.count() > max_closed_contacts) return {};
    const ClosedContacts closed = surfaces_.at({impact.q, impact.v_before, impact.t}, all);
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(all));
    if (!block) return {};
    ContactVector<double> jump(closed.W.rows());
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        jump[static_cast<Eigen::Index>(i)] = closed.contacts[i].g.dot(impact.v_after - impact.v_before);
    const ContactVector<double> p = block->solve(jump);
    std::vector<std::pair<std::size_t, double>> impulses;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        impulses.emplace_back(closed.which[i], p[static_cast<Eigen::Index>(i)]);
    return impulses;
}

std::string other_contacts_text(const Model& model, const Certificate::OtherContactBounds& others) {
    constexpr int digits = 3;
    std::vector<std::string> parts;
    for (const Certificate::OtherContactBounds::HeldContactBound& held : others.held)
        parts.push_back(fmt::format(
            "{} stays held: its force is at least {}, and the fraction {} of every impulse is transmitted to it",
            model.description().constraints[held.contact].name, rounded_down(held.least_force, digits),
            interval_text(held.transmission_low + 0.0, held.transmission_high + 0.0)));
    if (others.least_gap)
        parts.push_back(fmt::format("other gaps stay above {}", rounded_down(*others.least_gap, digits)));
    return fmt::format("{}", fmt::join(parts, "; "));
}

std::string assumed_impact_law(const Trajectory& trajectory, std::size_t event) {
    const auto& events = trajectory.events;
    for (std::size_t i = 0; i < event; ++i)
        if (events[i].joint && events[i].joint->order_matters)
            return fmt::format("Moreau's law at event {}, t = {:.10g}", i + 1, events[i].t);
    return "";
}

namespace {

// Whether a phase in this mode goes on after an event.
bool goes_on(const Trajectory& trajectory, std::size_t index, Mode mode) {
    const Event& event = trajectory.events[index];
    const bool jumps_next = index + 1 < trajectory.events.size() && trajectory.events[index + 1].is_jump() &&
                            trajectory.events[index + 1].t == event.t;
    if (event.is_jump()) return jumps_next;  // several jumps of one instant end the phase together
    if (event.is_impact() && jumps_next) return true;
    // Friction may have several events at one instant, of which the first ends the phase.
    return event.mode == mode && (event.is_impact() || event.is_pass() || trajectory.model->has_friction());
}

}  // namespace

std::vector<std::size_t> ends_of_phases(const Trajectory& trajectory) {
    std::vector<std::size_t> ends;
    std::size_t next = 0;
    const auto& events = trajectory.events;
    for (const Phase& phase : trajectory.phases) {
        const bool is_last = &phase == &trajectory.phases.back();
        for (bool open = true; open && next < events.size(); ++next)
            open = is_last || goes_on(trajectory, next, phase.mode);
        ends.push_back(next);
    }
    return ends;
}

std::vector<ChatterPhases> chatters_of(const Trajectory& trajectory) {
    constexpr std::size_t few = 8;  // shorter sequences are printed phase by phase
    std::vector<ChatterPhases> found;
    if (trajectory.model->contacts() < 2) return found;
    const std::vector<std::size_t> ends = ends_of_phases(trajectory);
    // How a phase ends: 1 at a Zeno point, -1 at an impact that opens a held contact, else 0.
    const auto end_of = [&](std::size_t phase) -> int {
        if (ends[phase] == (phase == 0 ? 0 : ends[phase - 1])) return 0;
        const Event& event = trajectory.events[ends[phase] - 1];
        return event.is_zeno() ? 1 : event.is_impact() && !event.opened.empty() ? -1 : 0;
    };
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const std::size_t first = i + 1;  // the phase before the first alternation is not part of it
        if (end_of(i) == 0) continue;
        while (i + 2 < ends.size() && end_of(i + 1) == -end_of(i)) ++i;
        if (i + 1 - first > few) found.push_back({first, i + 1, ends[first - 1], ends[i]});
    }
    return found;
}

EnergyBalance::EnergyBalance(const Model& model, const Run& run)
    : energy_(model.evaluator(model.energy(), run.parameters)) {}

Energies EnergyBalance::at(const Sample& sample) {
    set_state(energy_, State{sample.state.q, sample.state.v, sample.t});
    energy_.run();
    return {energy_.kinetic(), energy_.potential(), sample.work, sample.loss, sample.heat};
}

double energy_lost(const Trajectory& trajectory, std::size_t event) {
    const auto& events = trajectory.events;
    return events[event].loss - (event > 0 ? events[event - 1].loss : 0.0);
}

namespace {

bool meet(ContactSet a, ContactSet b) { return a.without(b) != a; }

}  // namespace

BounceSequence bounce_sequence_of(const Trajectory& trajectory, std::size_t zeno_event) {
    const auto& events = trajectory.events;
    const ContactSet contacts = events[zeno_event].contacts;
    BounceSequence pile{zeno_event, 0, energy_lost(trajectory, zeno_event)};
    for (std::size_t i = zeno_event; i-- > 0;) {
        const Event& event = events[i];
        if (meet(event.opened, contacts)) break;
        if (!meet(event.contacts, contacts)) continue;
        if (!event.is_impact()) break;
        pile.first = i;
        ++pile.impacts;
        pile.loss += energy_lost(trajectory, i);
    }
    return pile;
}

}  // namespace achilles
