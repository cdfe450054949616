// The mechanism view: the mechanism at the current time with trail, velocity and contact force. The wheel zooms,
// dragging the background pans, a double click fits. Dragging any point of a body changes the initial position,
// dragging the tip of the velocity arrow the initial velocity.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "figure/drag.hpp"
#include "figure/label.hpp"
#include "figure/mechanism_scene.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"
#include "session/contact_forces_text.hpp"

namespace achilles {

// ---- view: camera, its menu, scale bar ----

// Length of the longest arrow of a run, as a share of the picture's smaller side.
constexpr double longest_arrow = 0.16;

// Height of the line below the picture: scale bar, layer toggles, camera menu.
float switches_height();
// The visible part of the world.
Drawing seen_world(const Session& session, const Rectangle& area);
// Shows the menu of cameras with its right end at `right` and returns its left end. A fixed camera keeps the current
// view, `seen`. The menu has the layers that have no room beside it.
float show_camera_menu(const Session& session, const Drawing& seen, float right, float y,
                       const std::vector<const char*>& layers, PanelState& state, Commands& commands);
// At the left end of the line below the picture, up to `right`.
void show_scale_bar(const Session& session, const Rectangle& line, double unit, float right, PanelState& state);
// Two side views of a 3D system, beside or above one another. Returns pixels per world unit.
bool shows_sides(const Session& session);
double show_sides(const Session& session, const Rectangle& area);

namespace {

constexpr const char* camera_popup = "camera menu";
constexpr float label_of_scale = 56.0F, min_scale_bar = 34.0F, between_switches = 14.0F;

CameraPicture picture_in(const Session& session, const Rectangle& area) {
    const double arrow = longest_arrow * std::min(double{area.width}, double{area.height});
    const auto length = [&](const char* layer) { return session.scene().shows(layer) ? arrow : 0.0; };
    return {double{area.width}, double{area.height}, length("velocity"), length("force")};
}

// "24 000", with two digits.
std::string rounded_count(double value) {
    const int power = std::max(0, static_cast<int>(std::floor(std::log10(value))));
    const double digits = std::round(value / std::pow(10.0, power - 1));
    if (power > 5) return fmt::format("{:.1f}\u00b7{}", 0.1 * digits, power_of_ten(power));
    std::string text = fmt::format("{:.0f}", digits * std::pow(10.0, power - 1));
    for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), "\u00a0");
    return text;
}

// What the Zeno camera shows, since a picture of two lines does not say it: how much it enlarges, and the bounce.
std::array<std::string, 2> zeno_words(const Session& session, const Rectangle& world) {
    const auto view = session.mechanism_scene().camera().zeno_view(session.now(), picture_in(session, world));
    if (!view) return {"no bounces now: the whole run", ""};
    const auto length = [&](double value) {
        return number_with_unit(number(value, "{:.2g}"), session.mechanism_scene().unit());
    };
    return {fmt::format("{}{} times enlarged", view->is_inside_body ? "inside the body, " : "",
                        rounded_count(view->enlargement)),
            view->is_cut ? fmt::format("the bounces are cut; the last was about {} high", length(view->bounce))
                         : fmt::format("gap {} in a bounce about {} high", length(view->gap), length(view->bounce))};
}

}  // namespace

// The state in numbers leaves this height to the picture.
float least_world() { return units(60.0F); }

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
    const CameraPicture picture = picture_in(session, area);
    return widened(session.mechanism_scene().camera().at(scene.camera(), session.now(), picture), width, height);
}

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

bool shows_sides(const Session& session) {
    return session.scene().shows("sides") && TwoViews(session.trajectory(), session.samples()).exist();
}

double show_sides(const Session& session, const Rectangle& area) {
    const TwoViews sides(session.trajectory(), session.samples());
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
        const std::string name = typeset(TwoViews::all()[side].name) + " across, " + typeset("z") + " up";
        paint_label(list, part.x + units(12.0F), part.y, name, faint_color(), ImGui::GetFontSize());
        part.x += beside ? part.width + gap : 0.0F;
        part.y += beside ? 0.0F : part.height + gap;
    }
    return unit;
}

// ---- the mechanism ----

namespace {

using DragTarget = MechanismDrag::DragTarget;

// The arrow, clipped to the area: its head then marks the direction.
Point inside(const Point& from, const Point& to, const Rectangle& area) {
    const double edge = units(3.0F);
    double share = 1.0;
    const auto limit = [&](double at, double way, double low, double high) {
        if (way > 0.0 && at + share * way > high) share = std::max(0.0, (high - at) / way);
        if (way < 0.0 && at + share * way < low) share = std::max(0.0, (low - at) / way);
    };
    limit(from.x, to.x - from.x, area.x + edge, area.x + area.width - edge);
    limit(from.y, to.y - from.y, area.y + edge, area.y + area.height - edge);
    return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
}

void arrow(const Point& from, const Point& to, const Color& color) {
    const double length = std::hypot(to.x - from.x, to.y - from.y), head = units(9.0F);
    if (!(length > 0.5 * head)) return;
    const Point along{(to.x - from.x) / length, (to.y - from.y) / length};
    const auto at = [&](double back, double side) {
        return ImVec2{static_cast<float>(to.x - back * along.x - side * along.y),
                      static_cast<float>(to.y - back * along.y + side * along.x)};
    };
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddLine({static_cast<float>(from.x), static_cast<float>(from.y)}, at(0.8 * head, 0.0), packed(color),
                  units(2.0F));
    list->AddTriangleFilled(at(0.0, 0.0), at(head, 0.4 * head), at(head, -0.4 * head), packed(color));
}

// Pixels per unit of velocity or force.
double arrow_scale(const Rectangle& area, double largest) {
    return largest > 0.0 ? longest_arrow * double{std::min(area.width, area.height)} / largest : 0.0;
}

// Geometry of the picture, for mouse handling.
struct Picture {
    Rectangle area;
    Placement placement;
    std::vector<Body> bodies;    // by index of Mechanism::grips(); the first has the arrow
    std::vector<Point> centers;  // pixels
    Point tip;                   // of the velocity arrow, pixels
    double scale = 0.0;          // pixels per unit of velocity
};

// Largest velocity and force, for the arrow scale: those of the run or, during a drag, those at its start.
std::pair<double, double> largest(const Session& session, const MechanismDrag& held) {
    if (held.what == DragTarget::none) return {session.trail().fastest, session.trail().strongest};
    return {held.fastest, held.strongest};
}

bool holds_start(const MechanismDrag& held) {
    return held.has_moved && (held.what == DragTarget::body || held.what == DragTarget::arrow);
}

// The state to draw: the current one or, while the start is dragged, the start. (A slow run is not waited for.)
State shown_state(const Session& session, const MechanismDrag& held) {
    return holds_start(held) ? State{session.run().q, session.run().v} : session.now().state;
}

double shown_time(const Session& session, const MechanismDrag& held) {
    return holds_start(held) ? session.run().options.start_time : session.now().t;
}

// The view that keeps everything at its place on the screen.
void stand_still(Drawing& drawing, const Placement& placement, const Rectangle& area) {
    const Point low = placement.world({area.x, double{area.y} + double{area.height}});
    const Point high = placement.world({double{area.x} + double{area.width}, area.y});
    drawing.x_low = low.x, drawing.x_high = high.x;
    drawing.y_low = low.y, drawing.y_high = high.y;
}

bool is_same(const DrawnShape& a, const DrawnShape& b) {
    return a.kind == b.kind && a.radius == b.radius &&
           std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      [](const Point& p, const Point& q) { return p.x == q.x && p.y == q.y; });
}

// Draws the pinned runs at the same time behind everything else, each in its hue. Shapes equal to the current run's are
// left out.
void add_ghosts(const Session& session, Drawing& drawing) {
    const std::vector<DrawnShape> present = drawing.shapes;
    std::vector<DrawnShape> ghosts;
    for (const PinnedRun& pinned : session.pinned()) {
        if (!pinned.shown) continue;
        const Sample then = session.now_of(pinned);
        Color color = run_color(session.theme(), pinned.place);
        Drawing ghost = session.mechanism().draw(then.t, then.state, pinned.trajectory->run.parameters, drawing,
                                                 session.theme(), then.mode);
        pinned.touch->rest(ghost, then.t, then.state);
        for (DrawnShape& shape : ghost.shapes) {
            const auto is_there = [&](const DrawnShape& other) { return is_same(shape, other); };
            if (shape.kind == DrawnShape::Kind::text ||
                (!shape.moves && std::any_of(present.begin(), present.end(), is_there)))
                continue;
            color.a = 200;
            shape.stroke.color = color;
            color.a = 90;
            shape.fill_color = color;
            ghosts.push_back(std::move(shape));
        }
    }
    drawing.shapes.insert(drawing.shapes.begin(), ghosts.begin(), ghosts.end());
}

void paint_arrows(const Session& session, const MechanismDrag& held, Picture& picture) {
    const auto [fastest, strongest] = largest(session, held);
    const Body& body = picture.bodies.front();
    const Point center = picture.centers.front(), v = body.velocity(shown_state(session, held).v);
    picture.scale = arrow_scale(picture.area, fastest);
    const Rectangle& a = picture.area;
    const bool is_seen = center.x >= a.x && center.x <= a.x + a.width && center.y >= a.y && center.y <= a.y + a.height;
    picture.tip = {center.x + picture.scale * v.x, center.y - picture.scale * v.y};
    if (!is_seen) return;
    // With friction the forces are drawn at the contacts.
    const bool has_arrow = !session.mechanism_scene().has_friction_marks();
    if (session.scene().shows("force") && has_arrow && session.now().contact && !holds_start(held)) {
        const double scale = arrow_scale(picture.area, strongest);
        if (const auto F = body.force(contact_force(session.trajectory(), session.now())))
            arrow(center, inside(center, {center.x + scale * F->x, center.y - scale * F->y}, picture.area),
                  phase_color(session.theme(), Phase::Kind::constrained));
    }
    if (session.scene().shows("velocity")) arrow(center, inside(center, picture.tip, picture.area), text_color());
}

Picture paint_picture(const Session& session, const Rectangle& area, const MechanismDrag& held) {
    // While the start is dragged, no contact counts as held.
    Sample now = session.now();
    if (holds_start(held)) now = {}, now.state = shown_state(session, held), now.t = shown_time(session, held);
    const State& state = now.state;
    const double t = now.t;
    // Parameters of the run that is shown, even if another was requested.
    const auto& parameters = (holds_start(held) ? session.run() : session.trajectory().run).parameters;
    Drawing seen = seen_world(session, area);
    if (held.what == DragTarget::body || held.what == DragTarget::arrow) stand_still(seen, held.placement, area);
    const Scene& scene = session.scene();
    Drawing drawing = session.mechanism_scene().draw(
        now, seen, session.theme(), {scene.shows("trail"), scene.shows("strobe"), scene.shows("force")});
    add_ghosts(session, drawing);
    ImDrawList* list = ImGui::GetWindowDrawList();
    Picture picture{area, paint(drawing, list, area, units(1.0F)), {}, {}, {}, 0.0};
    for (AnchorPoint& grip : session.mechanism().grips(parameters)) {
        const auto body = Body::of(grip, t, state);
        if (!body && picture.bodies.empty()) return picture;
        picture.bodies.push_back(body ? *body : picture.bodies.front());
        picture.centers.push_back(picture.placement.pixel(picture.bodies.back().at()));
    }
    if (picture.bodies.empty()) return picture;
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    paint_arrows(session, held, picture);
    list->PopClipRect();
    return picture;
}

double distance(const Point& a, const ImVec2& b) { return std::hypot(a.x - double{b.x}, a.y - double{b.y}); }

ImVec2 pixel(const Point& point) { return {static_cast<float>(point.x), static_cast<float>(point.y)}; }

// The view after zooming by `factor` about the mouse position and panning by `moved` pixels.
command::LookAt zoomed_view(const Picture& picture, const ImVec2& mouse, double factor, const ImVec2& moved) {
    const Rectangle& a = picture.area;
    const Point middle{a.x + 0.5 * a.width, a.y + 0.5 * a.height};
    const Point center = picture.placement.world(
        {mouse.x + (middle.x - mouse.x) * factor - moved.x, mouse.y + (middle.y - mouse.y) * factor - moved.y});
    return {center.x, center.y, factor * double{a.width} / picture.placement.unit};
}

// The `start` command for coordinates, rates or both.
command::SetStart start_of(const Session& session, const Vector* q, const Vector* v) {
    command::SetStart start;
    const auto& coordinates = session.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        if (q != nullptr) start.values.emplace_back(coordinates[i].name, (*q)[at]);
        if (v != nullptr) start.values.emplace_back(coordinates[i].name + "'", (*v)[at]);
    }
    return start;
}

// Target position of the dragged object, pixels.
Point wanted(const MechanismDrag& held) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return {mouse.x + held.offset.x, mouse.y + held.offset.y};
}

void drag_body(const Session& session, const Picture& picture, const MechanismDrag& held, Commands& commands) {
    const Run& run = session.run();
    auto point = held.material ? session.mechanism().grip(*held.material, run.parameters) : std::nullopt;
    if (!held.material)
        if (auto grips = session.mechanism().grips(run.parameters); held.grip < grips.size()) point = grips[held.grip];
    if (!point) return;
    Vector q = dragged_start(*session.model(), run, *point, picture.placement.world(wanted(held)));
    if (const auto body = Body::of(*point, run.options.start_time, {q, run.v}))
        q = rounded_start(*session.model(), run, q, change_per_pixel(*body, q.size(), picture.placement.unit));
    commands.emplace_back(start_of(session, &q, nullptr));
}

void drag_arrow(const Session& session, const Picture& picture, const MechanismDrag& held, Commands& commands) {
    const Run& run = session.run();
    auto grip = session.mechanism().grip(run.parameters);
    const auto body = grip ? Body::of(*grip, run.options.start_time, {run.q, run.v}) : std::nullopt;
    if (!(picture.scale > 0.0) || !body) return;
    const Point to = wanted(held), from = picture.placement.pixel(body->at());
    const Point velocity{(to.x - from.x) / picture.scale, (from.y - to.y) / picture.scale};
    if (auto v = body->rates(session.run().v, velocity)) {
        v = rounded_values(*session.model(), *v, change_per_pixel(*body, v->size(), picture.scale));
        commands.emplace_back(start_of(session, nullptr, &*v));
    }
}

// The object under the mouse: the tip of the velocity arrow, else the nearest center of a body or end of a line, else
// the nearest point of one.
struct Aim {
    DragTarget what = DragTarget::background;
    std::size_t grip = 0;
    std::optional<MaterialPoint> material;  // in place of the grip
    Point at;                               // pixels
    double reach = 0.0;                     // radius of its ring
};

// The point of a line, box or polygon under the mouse that the coordinates can move.
Aim aim_between(const Session& session, const Picture& picture, const MechanismDrag& held, const ImVec2& mouse) {
    const double reach = units(6.0F), t = shown_time(session, held);
    const State state = shown_state(session, held);
    const auto& parameters = (holds_start(held) ? session.run() : session.trajectory().run).parameters;
    const auto material = session.mechanism().material_point(picture.placement.world({mouse.x, mouse.y}),
                                                             reach / picture.placement.unit, t, state, parameters);
    auto grip = material ? session.mechanism().grip(*material, parameters) : std::nullopt;
    const auto body = grip ? Body::of(*grip, t, state) : std::nullopt;
    if (!body || !body->moves()) return {};
    return {DragTarget::body, 0, material, picture.placement.pixel(body->at()), reach};
}

Aim aim(const Session& session, const Picture& picture, const MechanismDrag& held, const ImVec2& mouse) {
    const double reach = units(9.0F);
    Aim best;
    if (picture.bodies.empty()) return best;
    if (session.scene().shows("velocity") && distance(picture.tip, mouse) <= reach &&
        distance(picture.tip, pixel(picture.centers.front())) > reach)
        return {DragTarget::arrow, 0, {}, picture.tip, reach};
    double least = 0.0;
    for (std::size_t i = 0; i < picture.bodies.size(); ++i) {
        const double own = std::max(reach, picture.bodies[i].radius() * picture.placement.unit);
        const double far = distance(picture.centers[i], mouse);
        if (far > own || !picture.bodies[i].moves() || (best.what == DragTarget::body && far >= least)) continue;
        best = {DragTarget::body, i, {}, picture.centers[i], own};
        least = far;
    }
    return best.what == DragTarget::body ? best : aim_between(session, picture, held, mouse);
}

void take_hold(const Session& session, const Picture& picture, const Aim& aim, MechanismDrag& held) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Point offset = aim.what == DragTarget::background ? Point{} : Point{aim.at.x - mouse.x, aim.at.y - mouse.y};
    held = {aim.what,
            false,
            aim.grip,
            aim.material,
            offset,
            picture.placement,
            session.trail().fastest,
            session.trail().strongest};
}

void drag(const Session& session, const Picture& picture, MechanismDrag& held, Commands& commands) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta, mouse = ImGui::GetIO().MousePos;
    if (delta.x == 0.0F && delta.y == 0.0F) return;
    if (held.what == DragTarget::background) {
        if (ImGui::IsMouseDragging(ImGuiMouseButton_Left))
            commands.emplace_back(zoomed_view(picture, mouse, 1.0, delta));
        return;
    }
    // The camera stays where the hand has put something, until another view is asked for.
    if (!held.has_moved && session.scene().camera() == CameraMode::fit && !session.scene().look())
        commands.emplace_back(zoomed_view(picture, mouse, 1.0, {}));
    held.has_moved = true;
    const double start_time = session.run().options.start_time;
    if (session.time() > start_time) move_time(session, start_time, commands);  // the drag changes the start
    if (held.what == DragTarget::body) drag_body(session, picture, held, commands);
    if (held.what == DragTarget::arrow) drag_arrow(session, picture, held, commands);
}

void mark_places(const Picture& picture, PanelState& state) {
    const auto mark = [&](const std::string& name, const Point& at) {
        state.places[name] = {static_cast<float>(at.x), static_cast<float>(at.y), 0.0F, 0.0F};
    };
    for (std::size_t i = 0; i < picture.centers.size(); ++i)
        mark(i == 0 ? "body" : "body " + std::to_string(i + 1), picture.centers[i]);
    if (!picture.centers.empty()) mark("velocity", picture.tip);
}

void use_mouse(const Session& session, const Picture& picture, PanelState& state, Commands& commands) {
    const Rectangle& a = picture.area;
    ImGui::SetCursorScreenPos({a.x, a.y});
    ImGui::InvisibleButton("mechanism", {a.width, a.height});
    remember(state, "mechanism");
    mark_places(picture, state);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool is_hovered = ImGui::IsItemHovered();
    const Aim under = aim(session, picture, state.held, mouse);
    if (is_hovered && ImGui::GetIO().MouseWheel != 0.0F)
        commands.emplace_back(zoomed_view(picture, mouse, std::pow(0.85, double{ImGui::GetIO().MouseWheel}), {}));
    if (is_hovered && under.what != DragTarget::background) {
        ImGui::GetWindowDrawList()->AddCircle(pixel(under.at), static_cast<float>(under.reach) + units(2.0F),
                                              packed(text_color(), 0.5F), 32, units(1.5F));
        const std::string forces = session.scene().shows("force") ? contact_forces_text(session) : "";
        tooltip(forces + (under.what == DragTarget::arrow ? "drag to set the initial rates"
                                                          : "drag to set the initial position"));
    }
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    if (is_hovered && ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0.0F) && (delta.x != 0.0F || delta.y != 0.0F))
        commands.emplace_back(zoomed_view(picture, mouse, 1.0, delta));
    if (ImGui::IsItemActivated()) take_hold(session, picture, under, state.held);
    if (is_hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && state.held.what == DragTarget::background)
        commands.emplace_back(command::LookAll{});
    if (ImGui::IsItemActive())
        drag(session, picture, state.held, commands);
    else
        state.held = {};
}

// After a zoom that hides the start: what is missing, and the way back.
void show_start_note(const Session& session, const Picture& picture) {
    const Run& run = session.trajectory().run;
    auto grip = session.scene().look() ? session.mechanism().grip(run.parameters) : std::nullopt;
    const auto body = grip ? Body::of(*grip, run.options.start_time, run.start()) : std::nullopt;
    const Rectangle& a = picture.area;
    const Point at = body ? picture.placement.pixel(body->at()) : Point{a.x, a.y};
    if (at.x >= a.x && at.x <= a.x + a.width && at.y >= a.y && at.y <= a.y + a.height) return;
    const char* const note = "the start is outside this view; double click: the whole run";
    cell({a.x + units(12.0F), a.y + units(4.0F)}, note, a.width - units(24.0F), faint_color());
}

// True if the plane replaces the mechanism: by the user's choice, or since the system has no drawing.
bool shows_plane(const Session& session) { return session.scene().shows("plane") || session.mechanism().is_empty(); }

// The layers that can be shown, from right to left. With the plane: the contours, and the plane itself only if there is
// a mechanism. With side views: the trail.
std::vector<const char*> layers_of(const Session& session, const PanelState& state) {
    const bool plane = shows_plane(session), sides = !plane && shows_sides(session);
    const bool has_sides = TwoViews(session.trajectory(), session.samples()).exist();
    std::vector<const char*> layers;
    for (const char* what : {"plane", "contours", "sides", "force", "velocity", "strobe", "trail"}) {
        const std::string_view word = what;
        if (word == "plane" ? session.mechanism().is_empty() : plane != (word == "contours")) continue;
        if (word == "contours" && !has_contours(state.plane)) continue;
        if (word == "sides" ? !has_sides : sides && word != "trail" && word != "plane") continue;
        layers.push_back(what);
    }
    return layers;
}

// Whether these toggles fit between the scale bar and `right`.
bool have_room(const std::vector<const char*>& layers, const Rectangle& line, float right) {
    float width = units(12.0F + min_scale_bar + label_of_scale + 8.0F);
    for (const char* what : layers) width += ImGui::CalcTextSize(what).x + units(between_switches);
    return width <= right - line.x;
}

// Toggles for layers in the line below the picture. Returns their left end.
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

}  // namespace

void show_mechanism(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    if (area.width < 2.0F || area.height < 2.0F) return;
    ImGui::GetWindowDrawList()->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(session.theme().background), units(4.0F));
    const float bottom = switches_height();
    const float strip =
        std::min(state_height(session, area.width), std::max(1.0F, area.height - bottom - least_world()));
    show_state(session, {area.x, area.y, area.width, strip});
    Rectangle world{area.x, area.y + strip, area.width, area.height - strip - bottom};
    if (session.scene().camera() == CameraMode::zeno && !shows_plane(session) && world.height > least_world()) {
        const float high = ImGui::GetTextLineHeightWithSpacing(), wide = area.width - units(24.0F);
        world.height -= 2.0F * high;
        const auto words = zeno_words(session, world);
        for (const std::size_t i : {0U, 1U})
            cell({area.x + units(12.0F), world.y + world.height + units(4.0F) + static_cast<float>(i) * high}, words[i],
                 wide, faint_color());
    }
    if (world.height < 2.0F) return;
    const Rectangle line{area.x, area.y + area.height - bottom, area.width, bottom};
    const float right = line.x + line.width - units(10.0F), y = line.y + units(6.0F);
    const std::vector<const char*> layers = layers_of(session, state);
    if (shows_plane(session)) {
        state.held = {};
        show_plane(session, world, state, commands);
        // With new axes the plane may have contours or none.
        show_switches(session, layers_of(session, state), right, y, state, commands);
        return;
    }
    if (shows_sides(session)) {
        state.held = {};
        const double unit = show_sides(session, world);
        return show_scale_bar(session, line, unit, show_switches(session, layers, right, y, state, commands), state);
    }
    const Picture picture = paint_picture(session, world, state.held);
    show_start_note(session, picture);
    const Point low = picture.placement.world({world.x, double{world.y} + double{world.height}});
    const Point high = picture.placement.world({double{world.x} + double{world.width}, world.y});
    Drawing seen;
    seen.x_low = low.x, seen.x_high = high.x, seen.y_low = low.y, seen.y_high = high.y;
    const bool folds = !have_room(layers, line, right - units(50.0F));
    const float menu =
        show_camera_menu(session, seen, right, y, folds ? layers : std::vector<const char*>(), state, commands) -
        units(between_switches);
    const float left = folds ? menu : show_switches(session, layers, menu, y, state, commands);
    show_scale_bar(session, line, picture.placement.unit, left, state);
    use_mouse(session, picture, state, commands);
}

}  // namespace achilles
