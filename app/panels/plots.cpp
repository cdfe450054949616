// The right side: the system's views, with the present in each.
#include <cmath>

#include "figure/axes.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr int columns = 2;

Figure style_of(const Theme& theme) {
    Figure style;
    style.background = theme.background;
    style.ink = theme.ink;
    style.grid = theme.grid;
    style.text_size = 13.0;
    return style;
}

// A line where the plot runs over time, and a dot on every curve.
void paint_present(const Session& session, std::size_t plot, const Rectangle& area, bool over_time, ImDrawList* list) {
    const PanelMap map(session.plots()[plot], area);
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    for (const Point& point : session.present(plot)) {
        const Point pixel = map(point);
        if (over_time && std::isfinite(pixel.x)) {
            const float x = std::floor(static_cast<float>(pixel.x)) + 0.5F;
            list->AddLine({x, area.y}, {x, area.y + area.height}, packed(text_color(), 0.45F), units(1.0F));
        }
        if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) continue;
        const ImVec2 center{static_cast<float>(pixel.x), static_cast<float>(pixel.y)};
        list->AddCircleFilled(center, units(5.0F), packed(session.theme().background), 20);
        list->AddCircleFilled(center, units(3.5F), packed(text_color()), 20);
    }
    list->PopClipRect();
}

void show_plot(const Session& session, std::size_t plot, const Rectangle& cell, PanelState& state, Commands& commands) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({cell.x, cell.y}, {cell.x + cell.width, cell.y + cell.height},
                        packed(session.theme().background), units(4.0F));
    const float inset = units(8.0F);
    const Rectangle inner{cell.x + inset, cell.y + inset, cell.width - 2.0F * inset, cell.height - 2.0F * inset};
    const Panel& panel = session.plots()[plot];
    const Rectangle area = paint(panel, style_of(session.theme()), list, inner, units(1.0F));
    if (area.width < 2.0F || area.height < 2.0F) return;
    const bool over_time = session.description().views[plot].x.text == "t";
    paint_present(session, plot, area, over_time, list);
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton(("plot " + std::to_string(plot)).c_str(), {area.width, area.height});
    remember(state, "plot " + std::to_string(plot));
    double time = 0.0;
    if (over_time && dragged_to(panel.x.low, panel.x.high, area.x, area.width, time) && time != session.time())
        commands.emplace_back(command::Seek{time});
}

}  // namespace

void show_plots(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    const auto count = static_cast<int>(session.plots().size());
    if (count == 0) return;
    const float gap = units(8.0F);
    const int across = std::min(columns, count), down = (count + across - 1) / across;
    const float width = std::floor((area.width - gap * static_cast<float>(across - 1)) / static_cast<float>(across));
    const float height = std::floor((area.height - gap * static_cast<float>(down - 1)) / static_cast<float>(down));
    for (int i = 0; i < count; ++i) {
        const Rectangle cell{area.x + static_cast<float>(i % across) * (width + gap),
                             area.y + static_cast<float>(i / across) * (height + gap), width, height};
        show_plot(session, static_cast<std::size_t>(i), cell, state, commands);
    }
}

}  // namespace achilles
