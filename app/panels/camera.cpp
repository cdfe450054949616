#include "panels/camera.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "figure/label.hpp"
#include "figure/sides.hpp"
#include "paint/label.hpp"

namespace achilles {

namespace {

constexpr const char* popup = "camera menu";

// More of the world below, so that what the run needs ends above the lowest `strip` pixels of the picture.
void keep_clear(Drawing& drawing, const Rectangle& area, double strip) {
    const double width = drawing.x_high - drawing.x_low, height = drawing.y_high - drawing.y_low;
    const double unit = std::min(double{area.width} / width, double{area.height} / height);
    const double below = 0.5 * (double{area.height} - unit * height);
    if (!(unit > 0.0) || !std::isfinite(unit) || below >= strip || double{area.height} < 2.5 * strip) return;
    double more = 2.0 * (strip - below) / unit;  // as long as the width decides what is seen
    if (unit * (height + more) > double{area.height}) more = strip * height / (double{area.height} - strip);
    drawing.y_low -= more;
}

}  // namespace

float switches_height() { return ImGui::GetTextLineHeight() + units(14.0F); }

Drawing seen_world(const Session& session, const Rectangle& area) {
    const Scene& scene = session.scene();
    const double width = double{area.width}, height = double{area.height};
    if (const auto look = scene.look()) {
        Drawing drawing = session.limits();
        const double high = look->width * height / width;
        drawing.x_low = look->x - 0.5 * look->width, drawing.x_high = look->x + 0.5 * look->width;
        drawing.y_low = look->y - 0.5 * high, drawing.y_high = look->y + 0.5 * high;
        return drawing;
    }
    const double arrow = longest_arrow * std::min(width, height);
    const CameraPicture picture{width, height, scene.shows("velocity") ? arrow : 0.0,
                                scene.shows("force") ? arrow : 0.0};
    Drawing drawing = session.stage().camera().at(scene.camera(), session.now(), picture);
    if (scene.camera() == CameraMode::fit) keep_clear(drawing, area, double{switches_height()});
    return widened(drawing, width, height);
}

float show_camera_menu(const Session& session, const Drawing& seen, float right, float y, PanelState& state,
                       Commands& commands) {
    const CameraMode mode = session.scene().camera();
    const std::string name(to_text(mode));
    const ImVec2 size = ImGui::CalcTextSize(name.c_str());
    const float height = ImGui::GetTextLineHeight(), sign = 0.35F * height;
    const float width = size.x + 2.2F * sign + units(4.0F), x = right - width;
    ImGui::SetCursorScreenPos({x, y});
    if (ImGui::InvisibleButton("camera", {width, height})) ImGui::OpenPopup(popup);
    remember(state, "camera");
    const bool lit = ImGui::IsItemHovered();
    tooltip("camera: what this view shows");
    const ImU32 color = packed(lit ? text_color() : faint_color());
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText({x, y}, color, name.c_str());
    const float middle = y + 0.55F * height, left = x + size.x + units(6.0F);
    list->AddTriangleFilled({left, middle - 0.4F * sign}, {left + 1.4F * sign, middle - 0.4F * sign},
                            {left + 0.7F * sign, middle + 0.5F * sign}, color);
    if (ImGui::BeginPopup(popup)) {
        constexpr std::array<std::pair<CameraMode, const char*>, 4> cameras{
            {{CameraMode::fit, "fit: the whole run"},
             {CameraMode::fixed, "fixed: the current view"},
             {CameraMode::follow, "follow: move with the body"},
             {CameraMode::zeno, "zeno: zoom in on the next Zeno point"}}};
        for (const auto& [camera, says] : cameras) {
            if (!menu_item(says, state, camera == mode)) continue;
            if (camera == CameraMode::fixed)
                commands.emplace_back(command::Look{0.5 * (seen.x_low + seen.x_high), 0.5 * (seen.y_low + seen.y_high),
                                                    seen.x_high - seen.x_low});
            else
                commands.emplace_back(command::Camera{std::string(to_text(camera))});
        }
        close_by_escape(state);
        ImGui::EndPopup();
    }
    return x;
}

void show_scale_bar(const Session& session, const Rectangle& area, double unit, float right, PanelState& state) {
    const float left = area.x + units(12.0F), label = units(76.0F);
    const float room = right - left - label - units(16.0F);
    const bool beside = room >= units(40.0F);
    const double most = beside ? std::min(0.22 * double{area.width}, double{room}) : 0.22 * double{area.width};
    const float bottom = area.y + area.height - units(beside ? 11.0F : 11.0F) - (beside ? 0.0F : switches_height());
    const double length = paint_scale_bar(ImGui::GetWindowDrawList(), {left, bottom}, most, unit,
                                          session.stage().unit(), faint_color(), double{units(1.0F)});
    const float high = ImGui::GetTextLineHeight();
    state.places["scale bar"] = {left, bottom - high, static_cast<float>(length), high};
}

bool shows_sides(const Session& session) {
    return session.scene().shows("sides") && Sides(session.trajectory(), session.samples()).exist();
}

double show_sides(const Session& session, const Rectangle& area) {
    const Sides sides(session.trajectory(), session.samples());
    const std::array<Drawing, 2> limits = sides.limits();
    const float gap = units(8.0F), top = ImGui::GetTextLineHeight() + units(6.0F);
    const bool beside = area.width >= area.height;
    Rectangle part{area.x, area.y, beside ? 0.5F * (area.width - gap) : area.width,
                   beside ? area.height : 0.5F * (area.height - gap)};
    double unit = 0.0;
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (std::size_t side = 0; side < 2; ++side) {
        const Rectangle picture{part.x, part.y + top, part.width, std::max(1.0F, part.height - top)};
        const Drawing seen = widened(limits[side], double{picture.width}, double{picture.height});
        unit = paint(sides.draw(side, session.now(), seen, session.theme(), session.scene().shows("trail")), list,
                     picture, double{units(1.0F)})
                   .unit;
        const std::string name = typeset(Sides::all()[side].name) + " across, " + typeset("z") + " up";
        paint_label(list, part.x + units(12.0F), part.y, name, faint_color(), ImGui::GetFontSize());
        part.x += beside ? part.width + gap : 0.0F;
        part.y += beside ? 0.0F : part.height + gap;
    }
    return unit;
}

}  // namespace achilles
