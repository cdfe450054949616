#include "output/event_descriptions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/precision.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

std::string value_with_unit(const std::string& value, const std::string& unit) {
    return unit.empty() ? value : value + " " + unit;
}

// "9 impacts before the cut": infinitely many follow a cut.
std::string counted(long impacts, int cuts) {
    return fmt::format("{} {}{}", impacts, impacts == 1 ? "impact" : "impacts",
                       cuts == 0   ? ""
                       : cuts == 1 ? " before the cut"
                                   : " before the cuts");
}

std::string seconds(double t, double error) { return known_digits(t, error, 6) + " s"; }

}  // namespace

std::optional<double> proved_time(const Event& event) {
    if (!event.certificate || !event.certificate->certified || is_plastic_landing(event)) return std::nullopt;
    return std::max(event.certificate->zeno_high - event.t, event.t - event.certificate->zeno_low);
}

EventDescriptions::EventDescriptions(const Trajectory& trajectory, const ErrorEstimate* estimate, Angles angles)
    : trajectory_(trajectory), precision_(trajectory, estimate), shows_bounds_(angles == Angles::radians) {
    const Model& model = *trajectory.model;
    is_of_several_ = has_several_places(model);
    if (model.has_friction()) slips_ = std::make_shared<Slips>(trajectory);
    energy_unit_ = unit_of_expression(model.description(), "energy");
    for (const std::string& rate : output_names(model.description(), "gap'")) {
        RateUnit unit{unit_of_expression(model.description(), rate), 1.0};
        if (angles == Angles::degrees && unit.text.starts_with("rad/"))
            unit = {"deg" + unit.text.substr(3), degrees(1.0)};
        rate_units_.push_back(std::move(unit));
    }
    EnergyBalance balance(model, trajectory.run);
    Sample start, end;
    start.t = trajectory.run.options.start_time, start.state = trajectory.run.start();
    end.t = trajectory.end_time, end.state = trajectory.end;
    for (const Sample* sample : {&start, &end}) {
        const Energies energies = balance.at(*sample);
        energy_scale_ = std::max({energy_scale_, std::abs(energies.kinetic), std::abs(energies.potential)});
    }
    for (std::size_t i = 0; i < trajectory.events.size() && !by_convention_; ++i)
        if (trajectory.events[i].joint && trajectory.events[i].joint->order_matters) by_convention_ = i;
}

std::string EventDescriptions::energy(double value, double error) const {
    const double shown = flush_noise_to_zero(value, 10.0 * std::max(energy_scale_, std::abs(trajectory_.loss)));
    const std::string digits = shown == 0.0 ? "0" : known_digits(shown, error, 3);
    return digits == "0" ? "" : value_with_unit(digits, energy_unit_);
}

// The same for an energy that changes at this event.
std::string EventDescriptions::energy(double value, const Event& event) const {
    Sample before;
    before.t = event.t;
    before.state = {event.q, event.v_before, event.t};
    return energy(value, precision_.of_energy(before));
}

// ", 0.4 J lost"; empty for an elastic impact.
std::string EventDescriptions::lost(double energy, const Event& event) const {
    const std::string text = this->energy(energy, event);
    if (text.empty()) return "";
    return energy_unit_.empty() ? ", energy lost " + text : ", " + text + " lost";
}

std::string EventDescriptions::of(std::size_t event) const {
    switch (trajectory_.events[event].kind) {
        case Event::Kind::zeno:
            return zeno(event);
        case Event::Kind::release:
            return release(trajectory_.events[event]);
        case Event::Kind::stick:
        case Event::Kind::slip:
        case Event::Kind::reversal:
            return friction(trajectory_.events[event]);
        case Event::Kind::collapse:
            return collapse(event);
        case Event::Kind::jump:
            return jump(event);
        case Event::Kind::pass:
            return pass(trajectory_.events[event]);
        case Event::Kind::impact:
            break;
    }
    return impact(event);
}

// "jump 'legs swap', 0.02 J lost"
std::string EventDescriptions::jump(std::size_t index) const {
    const Event& event = trajectory_.events[index];
    const double loss = energy_lost(trajectory_, index);
    if (loss >= 0.0) return fmt::format("jump '{}'{}", jump_name(trajectory_, event), lost(loss, event));
    const std::string gained = energy(-loss, event);
    std::string text = fmt::format("jump '{}'", jump_name(trajectory_, event));
    if (gained.empty()) return text;
    return text + (energy_unit_.empty() ? ", energy gained " + gained : ", " + gained + " gained");
}

std::string EventDescriptions::pass(const Event& event) const {
    return fmt::format("the gap{} passes through zero: no contact, since 'when' is not positive",
                       is_of_several_ ? " of " + joined_names(*trajectory_.model, event.contacts) : "");
}

// "sticks", "starts to slide to the left", "reverses and slides to the left"; of several, each with its name.
std::string EventDescriptions::friction(const Event& event) const {
    const State after{event.q, event.v_after, event.t};
    std::string text;
    for (const std::size_t i : event.contacts) {
        text += text.empty() ? "" : ", ";
        if (is_of_several_) text += joined_names(*trajectory_.model, ContactSet::of(i)) + " ";
        const int sign = slip_sign(event.mode.state(i));
        if (sign == 0)
            text += "sticks";
        else if (event.kind == Event::Kind::slip)
            text += "starts to slide " + slips_->direction(i, sign, after);
        else
            text += "reverses and " + slips_->verb(i, event.mode, after);
    }
    return text;
}

// "sticking", "sliding to the left".
std::string EventDescriptions::participle(std::size_t which, Mode mode, const State& at) const {
    const int sign = slip_sign(mode.state(which));
    return sign == 0 ? "sticking" : "sliding " + slips_->direction(which, sign, at);
}

// "left sticks, stop is held, right slides to the left", for contacts and joints that are not open.
std::string EventDescriptions::verbs(ContactSet which, Mode mode, const State& at) const {
    const ContactSet rough = rough_in(*trajectory_.model, mode);
    std::string text;
    for (const std::size_t i : which)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", joined_names(*trajectory_.model, ContactSet::of(i)),
                            rough.contains(i) ? slips_->verb(i, mode, at) : "is held");
    return text;
}

// What friction does after an impact or a Zeno point: ", sticking", or of several "; left sticks". Only for contacts
// that the event puts into another state.
std::string EventDescriptions::friction_after(std::size_t index) const {
    const Event& event = trajectory_.events[index];
    if (slips_ == nullptr) return "";
    const Mode before = mode_before(trajectory_, index);
    ContactSet changed;
    for (const std::size_t i : rough_in(*trajectory_.model, event.mode))
        if (before.state(i) != event.mode.state(i)) changed = changed.with(i);
    if (changed.empty()) return "";
    const State after{event.q, event.v_after, event.t};
    if (!is_of_several_) return ", " + participle(*changed.begin(), event.mode, after);
    return "; " + verbs(changed, event.mode, after);
}

std::string EventDescriptions::impact(std::size_t index) const {
    const Event& event = trajectory_.events[index];
    std::size_t first = 0;
    while (first + 1 < rate_units_.size() && !event.contacts.contains(first)) ++first;
    std::string text = "impact";
    if (is_of_several_) text += " of " + joined_names(*trajectory_.model, event.contacts, " and ");
    if (event.contacts.count() > 1) text += " at once";
    const RateUnit& unit = rate_units_[first];
    text += " at gap speed " + value_with_unit(known_digits(event.impact_speed * unit.factor,
                                                            precision_.of_gap_speed(index) * unit.factor, 4),
                                               unit.text);
    const Event* next = index + 1 < trajectory_.events.size() ? &trajectory_.events[index + 1] : nullptr;
    const bool is_cut =
        next != nullptr && next->truncation && next->truncation->t == event.t && !is_plastic_landing(*next);
    const std::string loss = lost(energy_lost(trajectory_, index), event);
    text += loss;
    if (is_cut && !next->is_collapse() && !loss.empty()) text += " by it and the restart";
    if (event.friction != nullptr) {
        const std::string heat = energy(slips_->heat_of_impact(event), event);
        if (!heat.empty()) text += ", heat of friction " + heat;
    }
    if (!event.opened.empty()) text += "; it opens " + joined_names(*trajectory_.model, event.opened, " and ");
    if (event.joint && event.joint->order_matters)
        text += "; order-dependent outcome: resolved together by Moreau's law";
    if (event.joint && event.joint->is_nonunique) text += "; impulses not unique";
    if (is_cut) text += "; the impact sequence is cut here";
    return text + friction_after(index);
}

// The words of the file for the start of this contact, else "contact begins" or "knee is held".
std::string EventDescriptions::beginning(const Event& event) const {
    const bool is_one = event.contacts.count() == 1;
    const std::string words = is_one ? own_words(event.contacts, &ConstraintDescription::begins) : "";
    if (!words.empty()) return words;
    if (!is_of_several_) return "contact begins";
    const bool latches = is_one && event.latched.contains(event.contacts.only());
    return joined_names(*trajectory_.model, event.contacts, " and ") + (latches  ? " latches"
                                                                        : is_one ? " is held"
                                                                                 : " are held");
}

std::string EventDescriptions::change(std::size_t index) const {
    const Event& event = trajectory_.events[index];
    if (event.is_impact())
        return fmt::format("impact of {} opens {}{}", joined_names(*trajectory_.model, event.contacts, " and "),
                           joined_names(*trajectory_.model, event.opened, " and "), friction_after(index));
    if (event.is_friction()) return friction(event);
    if (event.is_collapse()) return collapse(index);
    if (event.is_jump()) return jump(index);
    if (event.is_pass()) return pass(event);
    if (event.is_release()) {
        const bool is_one = event.contacts.count() == 1;
        const std::string ends = is_one ? own_words(event.contacts, &ConstraintDescription::ends) : "";
        if (event.ends_latch)
            return (ends.empty() ? joined_names(*trajectory_.model, event.contacts, " and ") + " opens" : ends) +
                   ": its latch ends";
        if (!ends.empty()) return ends + ": its contact force reached zero";
        return is_of_several_
                   ? "force of " + joined_names(*trajectory_.model, event.contacts, " and ") + " reached zero"
                   : "contact force reached zero";
    }
    if (is_plastic_landing(event)) return beginning(event) + friction_after(index) + "; plastic impact";
    const BounceSequence pile = bounce_sequence_of(trajectory_, index);
    std::string text = beginning(event) + friction_after(index);
    if (pile.impacts == 0) return text;
    text += fmt::format("; impacts since {} s",
                        known_digits(trajectory_.events[pile.first].t, precision_.of_event(pile.first), 4));
    const std::string loss = energy(pile.loss, event);
    if (loss.empty()) return text;
    return text + (energy_unit_.empty() ? " dissipated the energy " : " dissipated ") + loss;
}

std::string EventDescriptions::holding(Mode mode, const State& at, const char* flight) const {
    const Model& model = *trajectory_.model;
    const ContactSet rough = rough_in(model, mode), joints = mode.joints();
    if (!is_of_several_) {
        if (rough.empty()) return mode.is_free() ? flight : "in contact";
        const std::string text = participle(*rough.begin(), mode, at);
        return mode.is_free() ? text : "in contact and " + text;
    }
    std::string text;
    for (const std::size_t i : mode.held()) {
        text += text.empty() ? "held by " : " and ";
        text += joined_names(model, ContactSet::of(i));
        if (rough.contains(i)) text += " (" + slips_->verb(i, mode, at) + ")";
    }
    if (mode.is_free() && (joints.empty() || model.contacts() > 0)) text = flight;
    if (joints.empty()) return text;
    return text + (text.empty() ? "" : ", ") + verbs(joints, mode, at);
}

Mode EventDescriptions::start_mode() const {
    return trajectory_.phases.empty() ? trajectory_.end_mode : trajectory_.phases.front().mode;
}

std::string EventDescriptions::state_at_start() const {
    return holding(start_mode(), trajectory_.run.start(), "free flight");
}

std::string EventDescriptions::state_at_end() const {
    return holding(trajectory_.end_mode, trajectory_.end, "in flight");
}

std::string EventDescriptions::zeno(std::size_t index) const {
    const Event& event = trajectory_.events[index];
    const std::string begins = beginning(event) + friction_after(index);
    // The loss is in the sentence of its impact.
    if (is_plastic_landing(event)) return begins + ": plastic impact";
    const BounceSequence pile = bounce_sequence_of(trajectory_, index);
    std::string text = fmt::format("{}: {}", begins, counted(pile.impacts, event.truncation ? 1 : 0));
    text += lost(pile.loss, event);
    if (precision_.is_beyond(event.t)) return text;  // a certificate holds for the computed motion only
    const std::optional<double> bound = proved_time(event);
    text += !bound           ? ", not certified"
            : !shows_bounds_ ? ", certified"
            : *bound > 0.0   ? fmt::format(", certified to {} s from the cut", rounded_up(*bound))
                             : ", certified from the cut";
    if (by_convention_ && *by_convention_ < index)
        text += fmt::format(", given Moreau's law at event {}", *by_convention_ + 1);
    return text;
}

std::string EventDescriptions::collapse(std::size_t index) const {
    const Event& event = trajectory_.events[index];
    const Model& model = *trajectory_.model;
    std::string text = joined_names(model, event.contacts, " and ") + ": ";
    if (event.truncation) {
        text += "infinitely many impacts";
        if (const std::optional<double> bound = proved_time(event))
            text += fmt::format(" within {} s", rounded_up(std::max(*bound, event.t - event.truncation->t)));
        text += ", no force needed";
    } else {
        text += "they close at the same time, and the impacts of either order have no end: a plastic impact";
    }
    if (event.collapse_info)
        text += fmt::format(" (speeds x {:.3g}, gaps x {:.3g} per two impacts)", event.collapse_info->speed_ratio,
                            event.collapse_info->gap_ratio);
    if (event.collapse_info && event.truncation) text += lost(event.collapse_info->loss, event);
    const ContactSet held = event.contacts.within(event.mode.held()),
                     touching = event.contacts.without(held).without(event.opened);
    const auto end = [&](ContactSet contacts, const char* one, const char* both) {
        if (contacts.empty()) return std::string();
        return contacts == event.contacts ? std::string(both) : joined_names(model, contacts, " and ") + one;
    };
    std::string ends;
    for (const std::string& part : {end(held, " is held", "both held"), end(event.opened, " leaves", "both leave"),
                                    end(touching, " touches", "both touch")})
        if (!part.empty()) ends += (ends.empty() ? "; " : ", ") + part;
    return text + ends + friction_after(index);
}

std::string EventDescriptions::impacts() const {
    const auto cuts = std::count_if(trajectory_.events.begin(), trajectory_.events.end(),
                                    [](const Event& event) { return event.truncation && !is_plastic_landing(event); });
    return counted(trajectory_.statistics.impacts, static_cast<int>(std::min<std::ptrdiff_t>(cuts, 2)));
}

std::string EventDescriptions::own_words(ContactSet contact, std::string ConstraintDescription::*words) const {
    std::size_t which = 0;
    while (!contact.contains(which)) ++which;
    return trajectory_.model->description().constraints[which].*words;
}

std::string EventDescriptions::release(const Event& event) const {
    const bool is_one = event.contacts.count() == 1;
    if (const std::string ends = is_one ? own_words(event.contacts, &ConstraintDescription::ends) : ""; !ends.empty())
        return ends + ": its contact force reaches zero";
    if (!is_of_several_) return "contact ends: the contact force reaches zero";
    return joined_names(*trajectory_.model, event.contacts, " and ") +
           (is_one ? " is released: its force reaches zero" : " are released: their forces reach zero");
}

std::string EventDescriptions::state(Mode mode, const State& at) const {
    if (!is_of_several_) return holding(mode, at, "in free flight");
    if (slips_ == nullptr) {
        if (mode.is_free()) return "in free flight";
        return joined_names(*trajectory_.model, mode.held(), " and ") +
               (mode.held().count() == 1 ? " is held" : " are held");
    }
    const ContactSet all = mode.held().with(mode.joints());
    if (mode.is_free() && trajectory_.model->contacts() > 0)
        return all.empty() ? "in free flight" : "in free flight, " + verbs(all, mode, at);
    return verbs(all, mode, at);
}

std::string EventDescriptions::start() const {
    return fmt::format("start at {}: {}", seconds(trajectory_.run.options.start_time, 0.0),
                       state(start_mode(), trajectory_.run.start()));
}

std::string EventDescriptions::end() const {
    std::string text =
        fmt::format("end at {}: {}", seconds(trajectory_.end_time, 0.0), state(trajectory_.end_mode, trajectory_.end));
    if (trajectory_.outcome.kind != Outcome::Kind::end_time)
        text += fmt::format("; the run ends early: {}", to_text(trajectory_.outcome.kind));
    return text;
}

}  // namespace achilles
