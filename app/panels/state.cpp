// Above the mechanism: the state at this instant in numbers, the phase and the coordinates, their rates below.
#include <algorithm>
#include <string>

#include "figure/label.hpp"
#include "figure/stage.hpp"
#include "number/angle.hpp"
#include "paint/label.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr float edge_of_state = 12.0F, above_state = 8.0F, below_state = 8.0F, phase_width = 130.0F,
                state_width = 130.0F;

// Where there is little room each coordinate has a line, its rate beside it, below the phase.
bool is_narrow(float width) { return width < units(390.0F); }

// A coordinate or its rate, as it is shown.
struct StateValue {
    std::string name, value;
    float width = 0.0F;  // of the longest value that the run may need, with its name
};

StateValue value_of(const Session& session, std::size_t i, bool is_rate) {
    const CoordinateDescription& c = session.description().coordinates[i];
    const bool is_angle = c.unit == "rad";
    const double factor = is_angle ? degrees(1.0) : 1.0;
    const auto at = static_cast<Eigen::Index>(i);
    std::string unit = is_angle ? "\u00b0" : c.unit.empty() ? "" : " " + c.unit;
    if (is_rate && !unit.empty()) unit += "/s";
    const double scale = (is_rate ? session.scale().v : session.scale().q)[at] * factor;
    const State errors = session.precision().of_state(session.now().t);
    const double error = (is_rate ? errors.v : errors.q)[at] * factor;
    const auto text = [&](double value) { return " = " + number_of_size(value, scale, 3, error) + unit; };
    StateValue shown{typeset_name(c.name + (is_rate ? "'" : "")),
                     text((is_rate ? session.now().state.v : session.now().state.q)[at] * factor), 0.0F};
    shown.width = label_width(shown.name + " = " + number_of_size(-scale, scale, 3) + unit, ImGui::GetFontSize());
    return shown;
}

// How wide the columns of a wide state are: as wide as the values need, where there is room for two.
float column_of_state(const Session& session, float width) {
    float wanted = units(state_width);
    for (std::size_t i = 0; i < session.description().coordinates.size(); ++i)
        for (const bool is_rate : {false, true})
            wanted = std::max(wanted, value_of(session, i, is_rate).width + units(14.0F));
    return std::min(wanted, std::max(units(state_width), 0.5F * (width - units(phase_width))));
}

std::size_t columns_of_state(const Session& session, float width) {
    return static_cast<std::size_t>(
        std::max(1.0F, (width - units(phase_width)) / column_of_state(session, width) + 1e-3F));
}

}  // namespace

float state_height(const Session& session, float panel_width) {
    const float width = panel_width - 2.0F * units(edge_of_state);
    const std::size_t count = session.description().coordinates.size(), columns = columns_of_state(session, width);
    const std::size_t lines =
        is_narrow(width) ? count + 1 : 2 * std::max<std::size_t>((count + columns - 1) / columns, 1);
    return ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(lines) + units(below_state);
}

void show_state(const Session& session, const Rectangle& panel) {
    const ImVec2 at{panel.x + units(edge_of_state), panel.y + units(above_state)};
    const float width = panel.width - 2.0F * units(edge_of_state);
    const bool narrow = is_narrow(width);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing();
    const PhaseLabel phase = phase_label(session.now());
    const Color color = phase_color(session.theme(), phase.color);
    list->AddRectFilled({at.x, at.y + 0.25F * size}, {at.x + units(10.0F), at.y + 0.25F * size + units(10.0F)},
                        packed(color), units(2.0F));
    paint_label(list, at.x + units(16.0F), at.y, phase.text, text_color(), size);
    const std::size_t count = session.description().coordinates.size(), columns = columns_of_state(session, width);
    const float column = narrow ? 0.5F * (width - units(16.0F)) : column_of_state(session, width);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = at.x + (narrow ? units(16.0F) : units(phase_width) + column * static_cast<float>(i % columns));
        const float y = at.y + line * static_cast<float>(narrow ? i + 1 : 2 * (i / columns));
        for (const bool is_rate : {false, true}) {
            const StateValue shown = value_of(session, i, is_rate);
            const ImVec2 corner{is_rate && narrow ? x + column : x, is_rate && !narrow ? y + line : y};
            cell(corner, shown.name, shown.value, column - units(8.0F), is_rate ? faint_color() : text_color());
        }
    }
}

}  // namespace achilles
