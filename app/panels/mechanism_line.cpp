#include "panels/mechanism_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "figure/mechanism_scene.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr const char* camera_popup = "camera menu";
constexpr float label_of_scale = 56.0F, min_scale_bar = 34.0F;

}  // namespace

float switches_height() { return ImGui::GetTextLineHeight() + units(14.0F); }

float show_camera_menu(const Session& session, const Drawing& seen, float right, float y,
                       const std::vector<const char*>& layers, PanelState& state, Commands& commands) {
    const CameraMode mode = session.scene().camera();
    const std::string name(to_text(mode));
    const float height = ImGui::GetTextLineHeight(), width = ImGui::CalcTextSize(name.c_str()).x + units(13.0F);
    ImGui::SetCursorScreenPos({right - width, y});
    if (ImGui::InvisibleButton("camera", {width, height})) ImGui::OpenPopup(camera_popup);
    remember(state, "camera");
    const bool lit = ImGui::IsItemHovered();
    tooltip("camera: what this view shows");
    ImGui::GetWindowDrawList()->AddText({right - width, y}, packed(lit ? text_color() : faint_color()), name.c_str());
    paint_menu_arrow(right - units(7.0F), std::floor(y + 0.55F * height), lit);
    if (ImGui::BeginPopup(camera_popup)) {
        constexpr std::array<std::pair<CameraMode, const char*>, 4> cameras{
            {{CameraMode::fit, "fit: the whole run"},
             {CameraMode::fixed, "fixed: the current view"},
             {CameraMode::follow, "follow: move with the body"},
             {CameraMode::zeno, "zeno: zoom in on the next Zeno point"}}};
        for (const auto& [camera, says] : cameras) {
            const bool chosen = ImGui::MenuItem(says, nullptr, camera == mode);
            remember(state, std::string("menu ") + says);
            if (!chosen) continue;
            if (camera == CameraMode::fixed)
                commands.emplace_back(command::LookAt{0.5 * (seen.x_low + seen.x_high),
                                                      0.5 * (seen.y_low + seen.y_high), seen.x_high - seen.x_low});
            else
                commands.emplace_back(command::SetCamera{std::string(to_text(camera))});
        }
        if (!layers.empty()) ImGui::Separator();
        for (const char* layer : layers) {
            const bool shown = session.scene().shows(layer);
            if (ImGui::MenuItem(layer, nullptr, shown)) commands.emplace_back(command::Show{layer, !shown});
            remember(state, std::string("show ") + layer);
        }
        close_by_escape(state);
        ImGui::EndPopup();
    }
    return right - width;
}

void show_scale_bar(const Session& session, const Rectangle& line, double unit, float right, PanelState& state) {
    const float left = line.x + units(12.0F), high = ImGui::GetTextLineHeight(), bottom = line.y + units(5.0F) + high;
    const double most = std::min<double>(0.22F * line.width, right - left - units(label_of_scale + 8.0F));
    const double length = paint_scale_bar(ImGui::GetWindowDrawList(), {left, bottom}, most, unit,
                                          session.mechanism_scene().unit(), faint_color(), double{units(1.0F)});
    state.places["scale bar"] = {left, bottom - high, static_cast<float>(length), high};
}

bool have_room(const std::vector<const char*>& layers, const Rectangle& line, float right) {
    float width = units(12.0F + min_scale_bar + label_of_scale + 8.0F);
    for (const char* what : layers) width += ImGui::CalcTextSize(what).x + units(between_switches);
    return width <= right - line.x;
}

float show_switches(const Session& session, const std::vector<const char*>& layers, float right, float y,
                    PanelState& state, Commands& commands) {
    float x = right;
    for (const char* what : layers) {
        const std::string_view word = what;
        const bool is_plane = word == "plane";
        const bool shown = session.scene().shows(what);
        const ImVec2 size = ImGui::CalcTextSize(what);
        x -= size.x;
        ImGui::SetCursorScreenPos({x, y});
        ImGui::PushID(what);
        if (ImGui::InvisibleButton("switch", size)) commands.emplace_back(command::Show{what, !shown});
        ImGui::PopID();
        remember(state, std::string("show ") + what);
        const bool lit = ImGui::IsItemHovered();
        tooltip(is_plane && shown            ? "back to the mechanism"
                : is_plane                   ? "the plane of two quantities, where the gap is open, and the run"
                : word == "contours"         ? (shown ? "hide the energy contours" : "show the energy contours")
                : word == "sides"            ? (shown ? "back to the drawing" : "show two side views: x and z, y and z")
                : word == "strobe" && !shown ? "show the poses at the events"
                                             : std::string(shown ? "hide the " : "show the ") + what);
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddText({x, y}, packed(lit ? text_color() : faint_color(), shown || lit ? 1.0F : 0.6F), what);
        if (shown) list->AddLine({x, y + size.y}, {x + size.x, y + size.y}, packed(faint_color()), units(1.0F));
        x -= units(between_switches);
    }
    return x;
}

}  // namespace achilles
