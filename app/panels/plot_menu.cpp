// Choosing what is plotted: the row above the plots, and the menu of each.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <utility>

#include "figure/label.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

constexpr std::array<std::pair<int, int>, 6> grids{{{1, 1}, {1, 2}, {2, 2}, {2, 3}, {3, 2}, {3, 3}}};
constexpr const char* popup = "plot menu";

std::string joined(const std::vector<Text>& texts) {
    std::string text;
    for (const Text& part : texts) text += (text.empty() ? "" : ", ") + part.text;
    return text;
}

// Expressions separated by commas that stand outside parentheses.
std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (const char c : text) {
        if (c == '(') ++depth;
        if (c == ')') --depth;
        if (c == ',' && depth == 0)
            parts.emplace_back();
        else if (c != ' ' || !parts.back().empty())
            parts.back() += c;
    }
    return parts;
}

// A little picture of the grid, to press.
bool grid_button(int columns, int rows, bool chosen, PanelState& state) {
    const float size = ImGui::GetFrameHeight(), edge = units(5.0F), gap = units(2.0F);
    const std::string id = "grid " + std::to_string(columns) + " " + std::to_string(rows);
    const bool pressed = ImGui::InvisibleButton(id.c_str(), {size, size});
    remember(state, id);
    const ImVec2 at = ImGui::GetItemRectMin();
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (chosen || ImGui::IsItemHovered())
        list->AddRectFilled(at, ImGui::GetItemRectMax(),
                            ImGui::GetColorU32(chosen ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg), units(3.0F));
    const float width = (size - 2.0F * edge - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
    const float height = (size - 2.0F * edge - gap * static_cast<float>(rows - 1)) / static_cast<float>(rows);
    for (int i = 0; i < columns * rows; ++i) {
        const int column = i % columns, row = i / columns;
        const ImVec2 low{at.x + edge + static_cast<float>(column) * (width + gap),
                         at.y + edge + static_cast<float>(row) * (height + gap)};
        list->AddRectFilled(low, {low.x + width, low.y + height}, packed(chosen ? text_color() : faint_color()));
    }
    tooltip(std::to_string(columns * rows) + (columns * rows == 1 ? " plot" : " plots"));
    return pressed;
}

// The views that the file names, and those any system has.
void show_choices(const Session& session, std::size_t plot, Commands& commands) {
    for (std::size_t i = 0; i < session.plotted().choices().size(); ++i) {
        const ViewDescription& view = session.plotted().choices()[i];
        ImGui::PushID(static_cast<int>(i));
        const bool chosen = view.name == session.plotted().list()[plot].view.name;
        if (ImGui::Selectable(view.name.c_str(), chosen)) {
            command::PlotView command{static_cast<int>(plot) + 1, view.x.text, {}};
            for (const Text& y : view.y) command.y.push_back(y.text);
            commands.emplace_back(command);
        }
        ImGui::PopID();
    }
}

}  // namespace

void show_grid_bar(const Session& session, PanelState& state, Commands& commands) {
    const Plots& plots = session.plotted();
    const float y = ImGui::GetCursorPosY();
    for (const auto& [columns, rows] : grids) {
        if (grid_button(columns, rows, plots.columns() == columns && plots.rows() == rows, state))
            commands.emplace_back(command::Grid{columns, rows});
        ImGui::SameLine(0.0F, units(2.0F));
    }
    const char* text = "link time";
    const float width = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(text).x;
    ImGui::SetCursorPos({content_right() - width, y});
    bool linked = plots.linked();
    if (ImGui::Checkbox(text, &linked)) commands.emplace_back(command::Link{linked});
    remember(state, "link");
    tooltip(
        "show the same times in all plots over time. Wheel: zoom; drag: move; right button: zoom to a box; double "
        "click: fit");
}

void open_plot_menu(const Session& session, std::size_t plot, PanelState& state) {
    const ViewDescription& view = session.plotted().list()[plot].view;
    state.plot_menu = {static_cast<int>(plot), view.x.text, joined(view.y)};
    ImGui::OpenPopup(popup);
}

void show_plot_menu(const Session& session, std::size_t plot, PanelState& state, Commands& commands) {
    PlotMenu& menu = state.plot_menu;
    if (menu.plot != static_cast<int>(plot) || !ImGui::BeginPopup(popup)) return;
    const int number = static_cast<int>(plot) + 1;
    const Framing& framing = session.plotted().list()[plot].framing;
    show_choices(session, plot, commands);
    ImGui::Separator();
    const bool was_entered = std::exchange(menu.was_entered, false);
    if (was_entered) menu.is_wrong = !session.error().empty();
    bool typed = false;
    for (const auto& [name, text] : {std::pair{"y", &menu.y}, std::pair{"x", &menu.x}}) {
        label(name, units(20.0F));
        ImGui::SameLine();
        ImGui::SetNextItemWidth(units(240.0F));
        if (was_entered && menu.is_wrong && text == &menu.y) ImGui::SetKeyboardFocusHere();
        typed =
            ImGui::InputText((std::string("##") + name).c_str(), text, ImGuiInputTextFlags_EnterReturnsTrue) || typed;
        remember(state, std::string("expression ") + name);
        tooltip(
            "an expression in t, coordinates, rates x', parameters, gap, gap', gap'', lambda, energy; separate several "
            "curves by commas. Press Enter to plot");
    }
    if (menu.is_wrong && !session.error().empty()) show_message(session.error(), units(264.0F));
    if (typed) commands.emplace_back(command::PlotView{number, menu.x, split(menu.y)});
    menu.was_entered = typed;
    for (const bool is_x : {true, false}) {
        bool on = is_x ? framing.log_x : framing.log_y;
        const char* name = is_x ? "logarithmic x" : "logarithmic y";
        if (ImGui::Checkbox(name, &on)) commands.emplace_back(command::AxisScale{number, is_x, on});
        remember(state, name);
        ImGui::SameLine();
    }
    if (ImGui::Button("fit")) commands.emplace_back(command::Fit{number});
    remember(state, "fit");
    if (!session.pinned().empty() || framing.difference) {
        bool on = framing.difference;
        if (ImGui::Checkbox("difference from the pinned runs", &on))
            commands.emplace_back(command::PlotDifference{number, on});
        remember(state, "difference");
        tooltip("difference of each pinned run from the present one over time, on a logarithmic axis");
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Save figure\u2026", nullptr, false, session.under_way() == nullptr))
        ask_to_take_away(session, state, "svg", number);
    remember(state, "menu Save figure\u2026");
    tooltip("save this plot alone, for print, as SVG, PNG or PDF");
    if (was_entered && !menu.is_wrong) ImGui::CloseCurrentPopup();
    close_by_escape(state);
    ImGui::EndPopup();
}

}  // namespace achilles
