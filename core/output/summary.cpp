#include <fmt/format.h>

#include <algorithm>

#include "model/model.hpp"
#include "number/ground.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

// " m", for what has a unit.
std::string unit_after(const Model& model, const std::string& name) {
    const std::string unit = unit_of(model.description(), name);
    return unit.empty() ? "" : " " + unit;
}

// "x = 1.5 m, y = 2 m" for values from this slot on; what is noise beside their scale is 0.
std::string named(const Model& model, std::size_t first_slot, const Vector& values, const Vector& scale) {
    std::string text;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const std::string& name = model.slot_names()[first_slot + static_cast<std::size_t>(i)];
        text += fmt::format("{}{} = {:.9g}{}", i == 0 ? "" : ", ", name, without_noise(values[i], scale[i]) + 0.0,
                            unit_after(model, name));
    }
    return text;
}

std::string impact_lines(const std::vector<const Event*>& impacts) {
    constexpr std::size_t shown_first = 4, shown_last = 1;
    std::string text;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        const std::size_t left = impacts.size() - i;
        if (i == shown_first && left > shown_last + 1) {
            text += fmt::format("  ...       {} more impacts\n", left - shown_last);
            i = impacts.size() - shown_last;
        }
        text += fmt::format("  impact    t = {:<16.10g} gap speed {:.6g}\n", impacts[i]->t, impacts[i]->impact_speed);
    }
    return text;
}

// A line for each part of a sentence.
std::string indented(std::string sentence) {
    const std::string margin(12, ' ');
    for (std::size_t at = 0; (at = sentence.find("; ", at)) != std::string::npos; ++at)
        sentence.replace(at, 2, ";\n" + margin);
    return margin + sentence + "\n";
}

std::string event_line(const Model& model, const Event& event, const State& scale) {
    const bool is_plastic = is_plastic_landing(event);
    std::string text = fmt::format("  {:<9} t = {:<16.10g} {}\n", is_plastic ? "landing" : to_text(event.kind), event.t,
                                   named(model, 0, event.q, scale.q));
    if (is_plastic)
        text += "            plastic: it comes to rest on the surface by its first impact, without a bounce\n";
    else if (event.kind == Event::Kind::zeno)
        text +=
            fmt::format("            after {} impacts, cut short at the last of them, t = {:.10g}, gap speed {:.3g}\n",
                        event.impacts, event.truncation->t, event.truncation->impact_speed);
    if (event.certificate) text += indented(sentence(*event.certificate));
    return text;
}

// What certificates rest on.
std::string assumed() {
    return fmt::format(
        "They assume IEEE double arithmetic in round-to-nearest (set where they are\n"
        "made) and elementary functions within {} ulp ({} for sinh, cosh, tanh), those of {} here.",
        rounding::libm, rounding::hyperbolic, mathematical_library());
}

}  // namespace

std::string interval_text(double low, double high) {
    int digits = 8;
    while (digits < 17 && fmt::format("{:.{}g}", low, digits - 2) == fmt::format("{:.{}g}", high, digits - 2)) ++digits;
    return fmt::format("[{:.{}g}, {:.{}g}]", low, digits, high, digits);
}

std::string bound_text(double bound) { return fmt::format("{:.2g}", std::max(bound, 1e-30)); }

std::string sentence(const Certificate& c) {
    if (!c.certified) return "not certified";
    std::string text = fmt::format(
        "tau_inf in {} s, the Zeno time; the true Zeno point is within {} of the position at the cut, its velocity "
        "within {} "
        "of that after the cut: |q_inf - q*|, |v_inf - v*|",
        interval_text(c.zeno_low, c.zeno_high), bound_text(c.position_bound), bound_text(c.velocity_bound));
    if (c.position_bound == 0.0 && c.velocity_bound == 0.0) text = fmt::format("tau_inf = {:.10g} s", c.zeno_low);
    if (c.uniform_position && *c.uniform_position > 0.0)
        text += fmt::format(
            "; from the cut to tau_inf what is drawn is within {} of the true position (the bounces not drawn are no "
            "higher); at tau_inf it is within {} (position) and {} (velocity) of the true motion",
            bound_text(*c.uniform_position), bound_text(*c.shadowing_position), bound_text(*c.shadowing_velocity));
    const char* link = c.position_bound == 0.0 ? "; " : c.paper ? "; decided by the condition " : "; decided by the ";
    text += link;
    text += c.decisive;
    if (c.below_rounding) text += " (below rounding: shorter flights cannot be resolved)";
    return text;
}

std::string summary(const Trajectory& trajectory) {
    const Ground ground;
    const Model& model = *trajectory.model;
    const Options& o = trajectory.run.options;
    std::string text = fmt::format("{}\n", model.description().title);
    text += fmt::format("  {}", to_text(o.method));
    for (const Option* option : told_options())
        if (option->key == "tolerance" || option->table == "truncation") text += ", " + phrase(*option, o, "{:g}");
    text += "\n\n";
    const State scale = scale_of(trajectory);
    std::vector<const Event*> impacts;
    std::size_t next = 0;
    for (const Phase& phase : trajectory.phases) {
        text += fmt::format("{} phase, t = {:.10g} to {:.10g} s\n", to_text(phase.kind), phase.start, phase.end);
        // A phase's events end with the one that ends the phase.
        for (bool open = true; open && next < trajectory.events.size(); ++next) {
            const Event& event = trajectory.events[next];
            open = event.kind == Event::Kind::impact;
            if (open) {
                impacts.push_back(&event);
            } else {
                text += impact_lines(impacts) + event_line(model, event, scale);
                impacts.clear();
            }
        }
    }
    text += impact_lines(impacts);
    const Statistics& s = trajectory.statistics;
    const auto n = static_cast<std::size_t>(model.dof());
    text += fmt::format("\nend at t = {:.10g} s, {}: {}; {}", trajectory.end_time, to_text(trajectory.end_phase),
                        named(model, 0, trajectory.end.q, scale.q), named(model, n, trajectory.end.v, scale.v));
    text += fmt::format("\noutcome: {} ({})\n", to_text(trajectory.outcome.kind), trajectory.outcome.message);
    text +=
        fmt::format("{} impacts, {} steps, {} evaluations, energy drift {:.2g}, least gap {:.2g}\n", s.impacts, s.steps,
                    s.evaluations, without_noise(s.energy_drift, 1.0), without_noise(s.least_gap, scale.q.maxCoeff()));
    if (s.impacts > 0) text += "Gap speeds are |hdot|, at which the gap closes: not the speed of a body.\n";
    const bool completed = std::any_of(trajectory.events.begin(), trajectory.events.end(),
                                       [](const Event& event) { return event.kind == Event::Kind::zeno; });
    if (completed)
        text +=
            "Certificates do not cover the integration and rounding errors made before each truncation, nor how the\n"
            "errors of several truncations add up. " +
            assumed() + "\n";
    return text;
}

}  // namespace achilles
