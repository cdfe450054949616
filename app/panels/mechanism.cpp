// The mechanism view: the mechanism at the current time with trail, velocity and contact force. The wheel zooms,
// dragging the background pans or turns a system in space, a double click fits. Dragging any point of a body changes
// the initial position, dragging the tip of the velocity arrow the initial velocity.
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
#include "panels/mechanism_line.hpp"
#include "panels/widgets.hpp"
#include "session/event_text.hpp"
#include "session/mechanism_view.hpp"

namespace achilles {

// Two side views of a 3D system, beside or above one another. Returns pixels per world unit.
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

// The state in numbers leaves this height to the picture.
float least_world() { return units(60.0F); }

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
    struct ForceArrow {
        Point from, to;                      // pixels
        std::optional<std::size_t> contact;  // empty: the sum of all contacts
    };
    std::vector<ForceArrow> forces;
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
        if (session.scene().direction())
            session.mechanism_scene().rest(ghost, then.t, then.state);
        else
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
        if (const auto F = body.force(contact_force(session.trajectory(), session.now()))) {
            const Point to = inside(center, {center.x + scale * F->x, center.y - scale * F->y}, picture.area);
            arrow(center, to, phase_color(session.theme(), Phase::Kind::constrained));
            picture.forces.push_back({center, to, {}});
        }
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
    Picture picture{area, paint(drawing, list, area, units(1.0F)), {}, {}, {}, 0.0, {}};
    if (scene.shows("force"))
        for (const auto& force : session.mechanism_scene().force_arrows(seen, now))
            picture.forces.push_back(
                {picture.placement.pixel(force.from), picture.placement.pixel(force.to), force.which});
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
            session.trail().strongest,
            session.is_in_space() ? std::optional(session.direction()) : std::nullopt};
}

void drag(const Session& session, const Picture& picture, MechanismDrag& held, Commands& commands) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta, mouse = ImGui::GetIO().MousePos;
    if (delta.x == 0.0F && delta.y == 0.0F) return;
    if (held.what == DragTarget::background) {
        if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left)) return;
        if (held.direction) {
            const ImVec2 way = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0.0F);
            return turn_by_hand(session, *held.direction, way.x / units(1.0F), way.y / units(1.0F), commands);
        }
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

// The forces whose arrow is under the mouse, with their values; empty: none is.
std::string forces_under(const Session& session, const Picture& picture, const ImVec2& mouse) {
    double least = units(6.0F);
    std::string text;
    for (const Picture::ForceArrow& force : picture.forces) {
        const double x = force.to.x - force.from.x, y = force.to.y - force.from.y, square = x * x + y * y;
        const double along = (mouse.x - force.from.x) * x + (mouse.y - force.from.y) * y;
        const double s = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
        const double far = distance({force.from.x + s * x, force.from.y + s * y}, mouse);
        if (!(far <= least)) continue;
        least = far;
        text = contact_forces_text(session, force.contact);
    }
    if (!text.empty()) text.pop_back();  // the last new line
    return text;
}

void mark_places(const Picture& picture, PanelState& state) {
    const auto mark = [&](const std::string& name, const Point& at) {
        state.places[name] = {static_cast<float>(at.x), static_cast<float>(at.y), 0.0F, 0.0F};
    };
    for (std::size_t i = 0; i < picture.centers.size(); ++i)
        mark(i == 0 ? "body" : "body " + std::to_string(i + 1), picture.centers[i]);
    if (!picture.centers.empty()) mark("velocity", picture.tip);
    for (const Picture::ForceArrow& force : picture.forces)
        mark("force", {0.5 * (force.from.x + force.to.x), 0.5 * (force.from.y + force.to.y)});
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
    } else if (is_hovered) {
        tooltip(forces_under(session, picture, mouse));
    }
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    const bool is_moved =
        ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0.0F) || ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0.0F);
    if (is_hovered && is_moved && (delta.x != 0.0F || delta.y != 0.0F))
        commands.emplace_back(zoomed_view(picture, mouse, 1.0, delta));
    if (ImGui::IsItemActivated()) take_hold(session, picture, under, state.held);
    if (is_hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && state.held.what == DragTarget::background) {
        commands.emplace_back(command::LookAll{});
        if (session.scene().direction()) commands.emplace_back(command::TurnBack{});
    }
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
    const std::vector<const char*> layers = layers_of(session, has_contours(state.plane));
    if (shows_plane(session)) {
        state.held = {};
        show_plane(session, world, state, commands);
        // With new axes the plane may have contours or none.
        show_switches(session, layers_of(session, has_contours(state.plane)), right, y, state, commands);
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
