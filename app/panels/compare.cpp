// Beside the list of events: how the pinned run and the present one differ.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/output.hpp"
#include "paint/label.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

// When events of this kind happen.
std::vector<double> times_of(const Trajectory& trajectory, Event::Kind kind) {
    std::vector<double> times;
    for (const Event& event : trajectory.events)
        if (event.kind == kind) times.push_back(event.t);
    return times;
}

// What begins contact in a run is called so where it is nothing else.
bool only_lands(const Trajectory& trajectory) {
    return std::all_of(trajectory.events.begin(), trajectory.events.end(),
                       [](const Event& event) { return event.kind != Event::Kind::zeno || is_plastic_landing(event); });
}

void row(const std::string& name, const std::string& pinned, const std::string& present, const std::string& change,
         bool is_head = false) {
    constexpr float column = 130.0F, first = 110.0F;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x;
    const float step = std::min(1.0F, room / units(first + 3.0F * column));
    const Color color = is_head ? faint_color() : text_color();
    float x = 0.0F, width = step * units(first);
    for (const std::string* text : {&name, &pinned, &present, &change}) {
        cell({at.x + x, at.y}, *text, width - units(6.0F), text == &name ? faint_color() : color);
        x += width;
        width = step * units(column);
    }
    ImGui::Dummy({std::min(room, x), ImGui::GetTextLineHeight()});
}

void row(const std::string& name, double pinned, double present) {
    row(name, number(pinned, "{:.10g}"), number(present, "{:.10g}"), number(present - pinned, "{:.3g}"));
}

// The i-th Zeno points of both runs, or releases, as far as there are so many.
void row_of_times(const std::string& name, const std::vector<double>& pinned, const std::vector<double>& present,
                  std::size_t i) {
    if (i < pinned.size() && i < present.size()) return row(name, pinned[i], present[i]);
    const auto text = [i](const std::vector<double>& times) {
        return i < times.size() ? number(times[i], "{:.10g}") : std::string("\u2013");
    };
    if (i < pinned.size() || i < present.size()) row(name, text(pinned), text(present), "");
}

// What was changed between the runs: parameters, and where they start.
void rows_of_values(const SystemDescription& description, const Run& pinned, const Run& present) {
    const auto value = [](const std::string& name, const std::string& unit, double before, double after) {
        const double factor = unit == "rad" ? degrees(1.0) : 1.0;
        if (before != after) row(name, before * factor, after * factor);
    };
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        value(typeset_name(description.parameters[i].name), description.parameters[i].unit, pinned.parameters[i],
              present.parameters[i]);
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const CoordinateDescription& coordinate = description.coordinates[i];
        value(typeset_name(coordinate.name) + "(0)", coordinate.unit, pinned.q[at], present.q[at]);
        value(typeset_name(coordinate.name + "'") + "(0)", coordinate.unit, pinned.v[at], present.v[at]);
    }
}

std::string eps_of(const Trajectory& trajectory) {
    const Truncation& t = trajectory.run.options.truncation;
    if (t.eps_q == t.eps_v && t.eps_v == t.eps_t) return number(t.eps_q, "{:.3g}");
    return fmt::format("{}, {}, {}", number(t.eps_q, "{:.3g}"), number(t.eps_v, "{:.3g}"), number(t.eps_t, "{:.3g}"));
}

std::string kind_of(const Trajectory& trajectory) {
    const Truncation& truncation = trajectory.run.options.truncation;
    return fmt::format("{}, {}", to_text(truncation.conditions), to_text(truncation.reinitialization));
}

}  // namespace

void show_comparison(const Session& session, PanelState& state, Commands& commands) {
    const Trajectory &pinned = *session.pinned(), &present = session.trajectory();
    const bool same_system = pinned.model == present.model;
    if (show_card_title("Comparison with the pinned run", same_system ? "" : "of another system", state))
        commands.emplace_back(command::Pin{false});
    row("", "pinned", "present", "change", true);
    if (same_system) rows_of_values(session.description(), pinned.run, present.run);
    row("conditions", kind_of(pinned), kind_of(present), "");
    row("\u03b5", eps_of(pinned), eps_of(present), "");
    const auto zeno_before = times_of(pinned, Event::Kind::zeno), zeno_after = times_of(present, Event::Kind::zeno);
    const auto left_before = times_of(pinned, Event::Kind::release),
               left_after = times_of(present, Event::Kind::release);
    const std::size_t most = std::max({zeno_before.size(), zeno_after.size(), left_before.size(), left_after.size()});
    const char* const beginning = only_lands(pinned) && only_lands(present) ? "landing" : "Zeno point";
    for (std::size_t i = 0; i < most; ++i) {
        row_of_times(fmt::format("{} {}", beginning, i + 1), zeno_before, zeno_after, i);
        row_of_times(fmt::format("release {}", i + 1), left_before, left_after, i);
    }
    row("impacts", std::to_string(pinned.statistics.impacts), std::to_string(present.statistics.impacts),
        number(static_cast<double>(present.statistics.impacts - pinned.statistics.impacts)));
    row("end", pinned.end_time, present.end_time);
    if (!same_system) return;
    const auto& coordinates = session.description().coordinates;
    const State& scale = session.scale();
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? degrees(1.0) : 1.0;
        row(typeset_name(coordinates[i].name) + (is_angle ? " [\u00b0]" : ""),
            without_noise(pinned.end.q[at], scale.q[at]) * factor,
            without_noise(present.end.q[at], scale.q[at]) * factor);
        row(typeset_name(coordinates[i].name + "'") + (is_angle ? " [\u00b0/s]" : ""),
            without_noise(pinned.end.v[at], scale.v[at]) * factor,
            without_noise(present.end.v[at], scale.v[at]) * factor);
    }
}

}  // namespace achilles
