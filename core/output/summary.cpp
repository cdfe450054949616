// The summary of a run, and that of its derivatives.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/model.hpp"
#include "number/float_environment.hpp"
#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "sensitivity/error_estimate.hpp"
#include "sensitivity/quantities.hpp"
#include "simulate/sampler.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// " m"; empty if the quantity has no unit.
std::string unit_after(const Model& model, const std::string& name) {
    const std::string unit = unit_of(model.description(), name);
    return unit.empty() ? "" : " " + unit;
}

// "x = 1.5 m, y = 2 m" for values from this slot on, with the digits that their errors leave.
std::string named(const Model& model, std::size_t first_slot, const Vector& values, const Vector& errors) {
    std::string text;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const std::string& name = model.slot_names()[first_slot + static_cast<std::size_t>(i)];
        text += fmt::format("{}{} = {}{}", i == 0 ? "" : ", ", name, known_digits(values[i], errors[i], 9),
                            unit_after(model, name));
    }
    return text;
}

// The parts of a sentence on separate lines.
std::string indented(std::string sentence) {
    const std::string margin(12, ' ');
    for (std::size_t at = 0; (at = sentence.find("; ", at)) != std::string::npos; ++at)
        sentence.replace(at, 2, ";\n" + margin);
    return margin + sentence + "\n";
}

// "in flight", "in contact", or for a system with several contacts "in contact with knee". With friction as the
// sentences of events: "left sticks, right slides up".
std::string contact_state(const EventDescriptions& sentences, const Trajectory& trajectory, Mode mode,
                          const State& at) {
    const Model& model = *trajectory.model;
    if (model.has_friction()) return sentences.state(mode, at);
    if (mode.is_free()) return "in flight";
    return model.contacts() > 1 ? "in contact with " + joined_names(model, mode.held()) : "in contact";
}

// Prints the run phase by phase and event by event.
class RunTimeline {
 public:
    RunTimeline(const Trajectory& trajectory, const ErrorEstimate& estimate)
        : trajectory_(trajectory),
          estimate_(estimate),
          model_(*trajectory.model),
          sentences_(trajectory, &estimate),
          precision_(sentences_.precision()),
          ends_(ends_of_phases(trajectory)) {}

    std::string text() const {
        std::string text;
        const std::vector<ChatterPhases> chatters = chatters_of(trajectory_);
        auto chatter = chatters.begin();
        for (std::size_t phase = 0; phase < ends_.size(); ++phase) {
            if (chatter != chatters.end() && chatter->first == phase) {
                text += chatter_line(*chatter);
                phase = chatter++->last - 1;
                continue;
            }
            text += phase_line(trajectory_.phases[phase]) + events(phase);
        }
        return text;
    }

 private:
    bool is_of_several() const { return has_several_places(model_); }
    std::string names(ContactSet contacts) const { return joined_names(model_, contacts); }
    std::string time(double t) const { return known_digits(t, precision_.of_time(t), 10); }

    std::string phase_line(const Phase& phase) const {
        const bool has_piece = phase.first_piece < trajectory_.pieces.size();
        const State at = has_piece ? state_in(trajectory_.pieces[phase.first_piece], trajectory_.coefficients,
                                              trajectory_.run.q.size(), phase.start)
                                   : trajectory_.end;
        return fmt::format("{}, t = {} to {} s{}\n", contact_state(sentences_, trajectory_, phase.mode, at),
                           time(phase.start), time(phase.end),
                           has_nonunique_forces(phase) ? ", forces not unique" : "");
    }

    std::string chatter_line(const ChatterPhases& chatter) const {
        int impacts = 0;
        ContactSet held;
        for (std::size_t i = chatter.first; i < chatter.last; ++i) {
            impacts += trajectory_.phases[i].impacts;
            held = held.with(trajectory_.phases[i].mode.held());
        }
        return fmt::format(
            "{} consecutive phases, t = {} to {} s, with {} impacts: a contact comes to rest and an impact of another "
            "opens it, repeatedly ({})\n",
            chatter.last - chatter.first, time(trajectory_.phases[chatter.first].start),
            time(trajectory_.phases[chatter.last - 1].end), impacts, names(held));
    }

    std::string events(std::size_t phase) const {
        std::size_t first = phase == 0 ? 0 : ends_[phase - 1];
        std::string text;
        for (std::size_t i = first; i < ends_[phase]; ++i) {
            if (trajectory_.events[i].is_impact()) continue;
            text += impact_lines(first, i) + event_line(i);
            first = i + 1;
        }
        return text + impact_lines(first, ends_[phase]);
    }

    // Lines for successive impacts.
    std::string impact_lines(std::size_t first, std::size_t end) const {
        constexpr std::size_t shown_first = 4, shown_last = 1;
        std::string text;
        for (std::size_t i = first; i < end; ++i) {
            const std::size_t left = end - i;
            if (i - first == shown_first && left > shown_last + 1) {
                text += fmt::format("  ...       {} more impacts\n", left - shown_last);
                i = end - shown_last;
            }
            const Event& impact = trajectory_.events[i];
            text += fmt::format("  impact    t = {:<16} gap speed {}{}\n",
                                known_digits(impact.t, precision_.of_event(i), 10),
                                known_digits(impact.impact_speed, precision_.of_gap_speed(i), 6), of_contacts(impact));
        }
        return text;
    }

    std::string of_contacts(const Event& impact) const {
        if (!is_of_several()) return "";
        std::string text = " of " + names(impact.contacts);
        if (!impact.opened.empty()) text += ", opens " + names(impact.opened);
        if (impact.joint && impact.joint->order_matters) text += ", order-dependent outcome";
        if (impact.joint && impact.joint->is_nonunique) text += ", impulses not unique";
        return text;
    }

    std::string event_line(std::size_t index) const {
        const Event& event = trajectory_.events[index];
        const bool is_plastic = is_plastic_landing(event);
        const std::string contacts = is_of_several() && !event.is_jump() ? " of " + names(event.contacts) + "," : "";
        std::string text = fmt::format("  {:<9} t = {:<16}{} {}\n", names_of(event).word,
                                       known_digits(event.t, precision_.of_event(index), 10), contacts,
                                       named(model_, 0, event.q, precision_.of_state(event.t).q));
        text += indented(sentences_.of(index));
        if (precision_.is_beyond(event.t)) return text;  // a certificate holds for the computed motion only
        if (event.truncation && !is_plastic)
            text += fmt::format("            cut at the last of these impacts, t = {}, gap speed {:.3g}\n",
                                time(event.truncation->t), event.truncation->impact_speed);
        if (!event.certificate) return text;
        text += indented(sentence(*event.certificate, model_.description()));
        if (event.sticks_from > 0)
            text += indented(fmt::format("sticks from impact {} on: each stops the slip{}", event.sticks_from,
                                         event.certificate->tail == Certificate::Tail::stick_then_slip
                                             ? "; slides from the Zeno point on"
                                             : ""));
        if (!is_plastic && index < estimate_.events.size())
            text += indented(
                fmt::format("integration error of this time: about {:.1g} s (estimate)", estimate_.events[index]));
        else if (const double error = integration_error_of_time(trajectory_, index); !is_plastic && error > 0.0)
            text += indented(fmt::format(
                "not covered: earlier integration errors and cuts may have shifted this time by {:.1g} s (estimate)",
                error));
        const auto& others = event.certificate->others;
        if (const std::string of_others = others ? other_contacts_text(model_, *others) : ""; !of_others.empty())
            text += indented("until then " + of_others);
        return text;
    }

    const Trajectory& trajectory_;
    const ErrorEstimate& estimate_;
    const Model& model_;
    EventDescriptions sentences_;
    const Precision& precision_;
    std::vector<std::size_t> ends_;
};

// The energy balance, with the digits of the energy at the end.
std::string balance(const Trajectory& trajectory, const Precision& precision) {
    // If the coordinates are angles only, the unit is not J.
    const char* unit = unit_of_expression(trajectory.model->description(), "energy") == "J" ? " J" : "";
    const bool damped = !trajectory.model->description().dissipation.text.empty();
    Sample end;
    end.t = trajectory.end_time;
    end.state = trajectory.end;
    const double error = precision.of_energy(end);
    const std::string heat = trajectory.model->has_friction()
                                 ? fmt::format(", heat of friction {}{}", known_digits(trajectory.heat, error, 9), unit)
                                 : "";
    return fmt::format("work {}{} by forces{} and moving surfaces, loss {}{} at impacts{}\n",
                       known_digits(trajectory.work, error, 9), unit, damped ? ", dissipation" : "",
                       known_digits(trajectory.loss, error, 9), unit, heat);
}

std::string conventions(int count) {
    return fmt::format(
        "{} an order-dependent outcome; resolved together by Moreau's law\n(--json lists the rates that each order "
        "would give; --simultaneous stop ends the run at the first).\n",
        count == 1 ? "One simultaneous impact had" : fmt::format("{} simultaneous impacts had", count));
}

// The assumptions of certificates.
std::string assumed() {
    return fmt::format(
        "They assume IEEE double arithmetic, rounded to nearest\n(set during the computation), and elementary "
        "functions within {} ulp ({} for sinh, cosh, tanh), here of {}.",
        rounding::libm, rounding::hyperbolic, mathematical_library());
}

}  // namespace

std::string drift_text(double drift) {
    return drift < noise ? fmt::format("below {}", noise) : fmt::format("{:.2g}", drift);
}

std::string least_gap_text(double gap, double scale) {
    if (gap < 0.0 && flush_noise_to_zero(gap, scale) == 0.0) return "0 to rounding";
    return fmt::format("{:.2g}", gap + 0.0);
}

NormUnits norm_units(const SystemDescription& description) {
    std::vector<std::string> units;
    for (const CoordinateDescription& coordinate : description.coordinates) {
        const std::string unit = coordinate.unit.empty() ? "1" : coordinate.unit;
        if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
    }
    if (units == std::vector<std::string>{"1"}) return {};
    std::vector<std::string> rates;
    for (const std::string& unit : units) rates.push_back(unit + "/s");
    const char* const form = units.size() == 1 ? " {}" : " ({})";
    return {fmt::format(fmt::runtime(form), fmt::join(units, ", ")),
            fmt::format(fmt::runtime(form), fmt::join(rates, ", "))};
}

std::string sentence(const Trajectory& trajectory, const ErrorEstimate& estimate) {
    if (const auto horizon = horizon_before_end(trajectory, estimate))
        return fmt::format("the error at the end is not known: the run is trusted until t = {:.6g} s", *horizon);
    if (!estimate.end) return "no estimate of the error at the end: " + estimate.no_estimate_reason;
    return fmt::format("estimated error {:.1g} at the end: an estimate, not a proof", estimate.end->size());
}

std::string sentence(const Certificate& c, const SystemDescription& description) {
    if (!c.certified) return "not certified";
    if (c.position_bound == 0.0 && c.velocity_bound == 0.0) return std::string(c.tightest_bound);
    const NormUnits unit = norm_units(description);
    const auto position = [&](double bound) { return bound_text(bound) + unit.position; };
    const auto velocity = [&](double bound) { return bound_text(bound) + unit.velocity; };
    std::string text = fmt::format(
        "certified for the exact motion from the computed state at the cut: Zeno time tau_inf in {} s; the Zeno point "
        "is within {} of the position at the cut, and its velocity within {} of the velocity of the restart: |q_inf - "
        "q*|, |v_inf - v*|",
        interval_text(c.zeno_low, c.zeno_high), position(c.position_bound), velocity(c.velocity_bound));
    if (c.uniform_position && *c.uniform_position > 0.0)
        text += fmt::format(
            "; from the cut to tau_inf the computed position is within {} of the exact one (the omitted bounces are no "
            "higher): uniform position; at tau_inf the computed position and velocity are within {} and {} of the "
            "exact ones: shadowing position and velocity",
            position(*c.uniform_position), position(*c.shadowing_position), velocity(*c.shadowing_velocity));
    if (c.tail == Certificate::Tail::slip) text += "; slides through: no impact from the cut on stops its slip";
    if (c.cut_at_resolution) text += "; cut there because shorter flights cannot be resolved in double precision";
    const Inequality* closest = c.decision ? &c.decision->closest() : nullptr;
    if (closest != nullptr && !(closest->left <= closest->right))
        return text + fmt::format("; the truncation criterion is not met: {}, {:.2g} < {:.2g}, does not hold",
                                  closest->name, closest->left, closest->right);
    return text + fmt::format("; tightest of the {}: {}", c.paper ? "conditions" : "bounds", c.tightest_bound);
}

std::string summary(const Trajectory& trajectory, const ErrorEstimate* known) {
    const FloatEnvironmentGuard ground;
    const ErrorEstimate estimate = known != nullptr ? *known : estimate_error(trajectory);
    const Model& model = *trajectory.model;
    const Options& o = trajectory.run.options;
    std::string text = fmt::format("{}\n", model.description().title);
    if (const auto remark = horizon_remark(trajectory, estimate)) text += "  " + remark->sentence + "\n";
    text += fmt::format("  {}", to_text(o.method));
    for (const Option* option : options_in_report_order())
        if (option->key == "tolerance" || option->table == "truncation")
            text += ", " + summary_text(*option, o, "{:g}");
    text += "\n";
    for (const RunWarning& remark : remarks(trajectory)) text += "  " + remark.sentence + "\n";
    text += "\n";
    const Precision precision(trajectory, &estimate);
    const State errors = precision.of_state(trajectory.end_time);
    text += RunTimeline(trajectory, estimate).text();
    const Statistics& s = trajectory.statistics;
    const auto n = static_cast<std::size_t>(model.dof());
    text += fmt::format(
        "\nend at t = {:.10g} s, {}: {}; {}", trajectory.end_time,
        contact_state(EventDescriptions(trajectory, &estimate), trajectory, trajectory.end_mode, trajectory.end),
        named(model, 0, trajectory.end.q, errors.q), named(model, n, trajectory.end.v, errors.v));
    text += "\n" + sentence(trajectory, estimate);
    text += fmt::format("\noutcome: {} ({})\n", to_text(trajectory.outcome.kind), trajectory.outcome.message);
    const bool has_power = model.equations().has_power();
    text += fmt::format("{}, {} steps, {} evaluations, energy drift{} {}", EventDescriptions(trajectory).impacts(),
                        s.steps, s.evaluations, has_power ? " (work subtracted)" : "", drift_text(s.energy_drift));
    // It is infinite if no contact counts at any time.
    if (const double least = least_gap(trajectory); model.contacts() > 0 && std::isfinite(least))
        text += ", least gap " + least_gap_text(least, scale_of(trajectory).q.maxCoeff());
    text += "\n";
    if (has_power || model.contacts() > 1 || model.has_friction() || model.has_jumps())
        text += balance(trajectory, precision);
    if (trajectory.ambiguous_impacts > 0) text += conventions(trajectory.ambiguous_impacts);
    if (s.impacts > 0) text += "Gap speed is |hdot|, the rate at which the gap closes, not the speed of a body.\n";
    const bool has_forces = std::any_of(trajectory.events.begin(), trajectory.events.end(), [](const Event& event) {
        return event.certificate && event.certificate->others && !event.certificate->others->held.empty();
    });
    if (has_forces)
        text +=
            "Forces are lambda, the multiplier of the gap; this is the contact force if the gap is a distance between "
            "bodies.\n";
    text += estimate.trusted_until
                ? "Numbers have only the digits that the estimated error supports; the estimate is first-order and "
                  "grows along the run.\nTo check it, rerun with a smaller --tolerance.\n"
                : "The last digits carry integration error, which grows along the run. To see how much, rerun with a "
                  "smaller --tolerance.\n";
    const bool completed = std::any_of(trajectory.events.begin(), trajectory.events.end(), [](const Event& event) {
        return is_zeno_point(event) || (event.is_collapse() && event.truncation);
    });
    if (completed)
        text +=
            "Certificates do not cover integration and rounding errors, before a truncation or after it, nor how the "
            "errors\n"
            "of several truncations add up. " +
            assumed() + "\n";
    return text;
}

namespace {

// "x -4.027, y -2.697, ...", without directions whose derivative does not exist.
std::string row(const Derivatives& d, const Eigen::VectorXd& values) {
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < d.directions.size(); ++k) {
        const double x = values[static_cast<Eigen::Index>(k)];
        if (std::isfinite(x)) parts.push_back(fmt::format("{} {:.6g}", d.directions[k], std::abs(x) < 1e-13 ? 0.0 : x));
    }
    return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string margins(const DerivativeMargins& m) {
    std::vector<std::string> parts;
    const auto add = [&](const char* what, const std::optional<double>& x) {
        if (x) parts.push_back(fmt::format("{} {:.3g}", what, *x));
    };
    add("smallest speed of a grazing impact", m.grazing_speed);
    add("smallest minimum of a gap in flight", m.gap_minimum);
    add("smallest -hddot at a Zeno point", m.a_inf);
    add("smallest h''' at a release", m.release_jerk);
    return parts.empty() ? ""
                         : fmt::format("  margins (there are no derivatives where one of them is 0): {}\n",
                                       fmt::join(parts, ", "));
}

}  // namespace

std::string summary(const Trajectory& trajectory, const Dependence& dependence) {
    const Derivatives& d = dependence.derivatives;
    std::string text = "\nderivatives of event times, and of the state at the fixed end time:\n";
    std::array<int, event_names.size()> counts{};
    for (std::size_t i = 0; i < d.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        const int k = ++counts[static_cast<std::size_t>(event.kind)];
        if (event.is_impact()) continue;
        text += fmt::format("  {}_time({}): {}\n", names_of(event.kind).word, k, row(d, d.events[i].t));
    }
    const auto& coordinates = trajectory.model->description().coordinates;
    for (std::size_t i = 0; d.end && i < coordinates.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        text += fmt::format("  {} at the end: {}\n", coordinates[i].name, row(d, d.end->q.row(k).transpose()));
        text += fmt::format("  {}' at the end: {}\n", coordinates[i].name, row(d, d.end->v.row(k).transpose()));
    }
    for (const Quantity& quantity : dependence.quantities)
        text +=
            fmt::format("  {} = {:.10g}: {}\n", quantity.expression, quantity.value,
                        quantity.refused.empty() ? row(d, quantity.derivatives) : "no derivative: " + quantity.refused);
    for (std::size_t k = 0; k < d.refused.size(); ++k)
        if (!d.refused[k].empty())
            text += fmt::format("  with respect to {}: no derivative: {}\n", d.directions[k], d.refused[k]);
    if (!d.broken.empty()) text += fmt::format("  no derivatives from t = {:.9g} s on: {}\n", d.broken_from, d.broken);
    if (trajectory.run.options.method == Method::dopri5)
        text += "  computed by Taylor series from the start of each dopri5 step: as accurate as the states there\n";
    return text + margins(d.margins) + "Certificates do not cover derivatives.\n";
}

}  // namespace achilles
