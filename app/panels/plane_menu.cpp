// What the configuration plane shows is chosen here.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "paint/label.hpp"
#include "panels/plane.hpp"
#include "panels/widgets.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr const char* popup = "plane menu";

std::string name_of(const PlaneTexts& texts) { return typeset(texts.first) + ", " + typeset(texts.second); }

bool fields(PlaneView& plane, PanelState& state, bool focuses) {
    bool typed = false;
    for (const auto& [name, text] : {std::pair{"y", &plane.y}, std::pair{"x", &plane.x}}) {
        label(name, units(20.0F));
        ImGui::SameLine();
        ImGui::SetNextItemWidth(units(240.0F));
        if (focuses && text == &plane.y) ImGui::SetKeyboardFocusHere();
        typed =
            ImGui::InputText((std::string("##") + name).c_str(), text, ImGuiInputTextFlags_EnterReturnsTrue) || typed;
        remember(state, std::string("plane ") + name);
        tooltip(
            "an expression in t, coordinates, rates x', parameters, gap, gap', gap'', lambda, energy. Press Enter to "
            "show it. If both are coordinates or rates, you can drag the start, and contours are drawn");
    }
    return typed;
}

void show_menu(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup(popup)) return;
    PlaneView& plane = state.plane;
    const std::vector<PlaneTexts> all = planes_of(session.description());
    for (std::size_t i = 0; i < all.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const ImVec2 at = ImGui::GetCursorScreenPos();
        if (ImGui::Selectable("##pair", all[i] == plane.texts)) {
            if (i == 0)
                commands.emplace_back(command::DefaultPlane{});
            else
                commands.emplace_back(command::ShowPlane{all[i].first, all[i].second});
        }
        remember(state, "plane " + all[i].first + ", " + all[i].second);
        paint_label(ImGui::GetWindowDrawList(), at.x, at.y, name_of(all[i]), text_color(), ImGui::GetFontSize());
        ImGui::PopID();
    }
    ImGui::Separator();
    const bool was_entered = std::exchange(plane.was_entered, false);
    if (was_entered) plane.is_wrong = !session.error().empty();
    const bool typed = fields(plane, state, was_entered && plane.is_wrong);
    if (plane.is_wrong && !session.error().empty()) show_message(session.error(), units(264.0F));
    if (typed) commands.emplace_back(command::ShowPlane{plane.x, plane.y});
    plane.was_entered = typed;
    if (was_entered && !plane.is_wrong) ImGui::CloseCurrentPopup();
    close_by_escape(state);
    ImGui::EndPopup();
}

// What shade and contours mean, from the right. Returns where that begins.
float show_meaning(const Session& session, const Rectangle& row, float left, const PlaneView& plane) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize(), box = units(11.0F), between = units(14.0F);
    const float middle = std::floor(row.y + 0.5F * ImGui::GetTextLineHeight());
    float right = row.x + row.width;
    const auto place = [&](const std::string& text) {
        const float x = right - label_width(text, size);
        if (x - box - units(6.0F) - between < left) return false;
        paint_label(list, x, row.y, text, faint_color(), size);
        right = x - units(6.0F);
        return true;
    };
    const bool is_shaded = !plane.surfaces.open.empty();
    if (is_shaded) {
        const Plane& shown = *plane.plane;
        const auto is_coordinate = [](const PlaneAxis& axis) { return axis.coordinate && !axis.is_rate; };
        const int axes = (is_coordinate(shown.x()) ? 1 : 0) + (is_coordinate(shown.y()) ? 1 : 0);
        const std::string present = shown.surfaces_key(session.now().state).empty()          ? ""
                                    : shown.is_of_states() && axes == session.model()->dof() ? " now"
                                                                                             : ", the others as now";
        if (!place("h \u2265 0" + present) && !place("h \u2265 0")) return right;
        list->AddRectFilled({right - box, middle - 0.5F * box}, {right, middle + 0.5F * box},
                            packed(session.theme().accent, 0.25F));
        right -= box + between;
    }
    const auto is_drawn = [](const Plane::Surface& surface) { return !surface.points.empty(); };
    if (!is_shaded && std::any_of(plane.surfaces.lines.begin(), plane.surfaces.lines.end(), is_drawn)) {
        if (!place("h = 0")) return right;
        list->AddLine({right - units(14.0F), middle}, {right, middle}, packed(session.theme().surface), units(2.0F));
        right -= units(14.0F) + between;
    }
    if (plane.levels.empty()) return right;
    const std::string unit = typeset_unit(unit_of_expression(session.description(), "energy"));
    if (!place(with_unit(plane.plane->is_of_coordinates() ? "V" : "E", unit))) return right;
    list->AddLine({right - units(14.0F), middle}, {right, middle}, packed(session.theme().faint, 0.7F), units(1.0F));
    return right - units(14.0F);
}

}  // namespace

void show_plane_heading(const Session& session, const Rectangle& row, PanelState& state, Commands& commands) {
    PlaneView& plane = state.plane;
    const float size = ImGui::GetFontSize(), arrow = units(16.0F);
    const std::string names = name_of(plane.texts), title = shortened(names, [&](const std::string&text) {
                                                        return label_width(text, size) <= row.width - arrow;
                                                    });
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float width = label_width(title, size);
    ImGui::SetCursorScreenPos({row.x, row.y});
    if (ImGui::InvisibleButton("axes", {width + arrow, row.height})) {
        plane.x = plane.texts.first, plane.y = plane.texts.second;
        plane.was_entered = plane.is_wrong = false;
        ImGui::OpenPopup(popup);
    }
    remember(state, "plane axes");
    const bool lit = ImGui::IsItemHovered();
    tooltip((title == names ? "" : plane.texts.first + ", " + plane.texts.second + "\n") +
            "choose two other quantities: coordinates, rates, gaps or any expressions");
    paint_label(list, row.x, row.y, title, lit ? text_color() : faint_color(), size);
    const float x = row.x + width + units(5.0F), y = std::floor(row.y + 0.5F * ImGui::GetTextLineHeight());
    list->AddTriangleFilled({x, y - units(2.0F)}, {x + units(7.0F), y - units(2.0F)},
                            {x + units(3.5F), y + units(3.0F)}, packed(lit ? text_color() : faint_color()));
    show_meaning(session, row, row.x + width + arrow, plane);
    show_menu(session, state, commands);
}

}  // namespace achilles
