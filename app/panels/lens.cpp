// The Zeno lens in place of a certificate: the bouncing in logarithmic time, to be scrolled for ever.
#include "figure/lens.hpp"

#include <algorithm>
#include <cmath>

#include "paint/axes.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr double decades = 4.0;  // seen at once

}  // namespace

void show_lens(const Session& session, std::size_t event, PanelState& state, Commands& commands) {
    const auto lens = Lens::at(session.trajectory(), event);
    if (!lens) {
        ImGui::TextUnformatted("One impact and no bouncing: there is no row to look at.");
        return;
    }
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(
        fitted("Each flight is e times as long as the last: in logarithmic time, scaled by its speed "
               "squared, the bouncing is an even row without end.",
               ImGui::GetContentRegionAvail().x)
            .c_str());
    ImGui::PopStyleColor();
    const double low = session.scene().lens().value_or(lens->first() - 0.1);
    const double width = decades * std::max(1.0, lens->spacing());
    const Panel panel = lens->panel(low, low + width, session.theme());
    const Rectangle area = remaining();
    if (area.height < units(40.0F)) return;
    Figure style;
    style.background = session.theme().background;
    style.ink = session.theme().ink;
    style.grid = session.theme().grid;
    style.text_size = 13.0;
    const Rectangle inside = paint(panel, style, ImGui::GetWindowDrawList(), area, units(1.0F));
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton("lens", {area.width, area.height});
    remember(state, "lens");
    const ImGuiIO& io = ImGui::GetIO();
    double moved = 0.0;
    if (ImGui::IsItemHovered()) moved -= 0.25 * double{io.MouseWheel};
    if (ImGui::IsItemActive() && inside.width > 1.0F) moved -= width * double{io.MouseDelta.x} / double{inside.width};
    if (moved != 0.0) commands.emplace_back(command::Lens{std::max(low + moved, lens->first() - 1.0)});
    tooltip(
        "drag or use the wheel: the row never ends. Bars: where the run was cut, and where the certified interval of "
        "the Zeno time begins");
}

}  // namespace achilles
