// Beside the list of events: how the pinned run and the present one differ.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "output/output.hpp"
#include "paint/label.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

std::vector<double> zeno_times(const Trajectory& trajectory) {
    std::vector<double> times;
    for (const Event& event : trajectory.events)
        if (event.kind == Event::Kind::zeno) times.push_back(event.t);
    return times;
}

void row(const std::string& name, const std::string& pinned, const std::string& present, const std::string& change,
         bool is_head = false) {
    constexpr float column = 130.0F, first = 110.0F;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x, size = ImGui::GetFontSize();
    const float step = std::min(1.0F, room / units(first + 3.0F * column));
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Color color = is_head ? faint_color() : text_color();
    float x = 0.0F, width = step * units(first);
    for (const std::string* text : {&name, &pinned, &present, &change}) {
        paint_label(list, at.x + x, at.y, fitted(*text, width - units(6.0F)), text == &name ? faint_color() : color,
                    size);
        x += width;
        width = step * units(column);
    }
    ImGui::Dummy({std::min(room, x), ImGui::GetTextLineHeight()});
}

void row(const std::string& name, double pinned, double present) {
    row(name, number(pinned, "{:.10g}"), number(present, "{:.10g}"), number(present - pinned, "{:.3g}"));
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
    row("conditions", kind_of(pinned), kind_of(present), "");
    const std::vector<double> before = zeno_times(pinned), after = zeno_times(present);
    for (std::size_t i = 0; i < std::max(before.size(), after.size()); ++i) {
        const std::string name = fmt::format("Zeno {}", i + 1);
        if (i < before.size() && i < after.size())
            row(name, before[i], after[i]);
        else
            row(name, i < before.size() ? number(before[i], "{:.10g}") : "\u2013",
                i < after.size() ? number(after[i], "{:.10g}") : "\u2013", "");
    }
    row("impacts", std::to_string(pinned.statistics.impacts), std::to_string(present.statistics.impacts),
        number(static_cast<double>(present.statistics.impacts - pinned.statistics.impacts)));
    row("end", pinned.end_time, present.end_time);
    if (!same_system) return;
    const auto& coordinates = session.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? 57.29577951308232 : 1.0;
        row(typeset_name(coordinates[i].name) + (is_angle ? " [\u00b0]" : ""), pinned.end.q[at] * factor,
            present.end.q[at] * factor);
        row(typeset_name(coordinates[i].name + "'") + (is_angle ? " [\u00b0/s]" : ""), pinned.end.v[at] * factor,
            present.end.v[at] * factor);
    }
}

}  // namespace achilles
