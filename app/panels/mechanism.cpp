// The centre: the mechanism as it is now, with its trail, its velocity and the contact force. The wheel zooms, dragging
// the ground moves the picture, a double click shows all; the body is dragged to where the run shall start, the tip of
// its velocity to how fast.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "paint/label.hpp"
#include "paint/mechanism.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

// The state at this instant in numbers, above the picture: the phase and the coordinates, their rates below. Returns
// the height it took.
float show_state(const Session& session, ImVec2 at, float width) {
    const bool narrow = width < units(390.0F);
    const float first = narrow ? 104.0F : 130.0F, column = narrow ? 112.0F : 130.0F;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing();
    const Phase::Kind phase = session.now().phase;
    const Color color = phase_color(session.theme(), phase);
    list->AddRectFilled({at.x, at.y + 0.25F * size}, {at.x + units(10.0F), at.y + 0.25F * size + units(10.0F)},
                        packed(color), units(2.0F));
    paint_label(list, at.x + units(16.0F), at.y, legend_text(phase), text_color(), size);
    const auto& coordinates = session.description().coordinates;
    const auto columns = static_cast<std::size_t>(std::max(1.0F, (width - units(first)) / units(column)));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? degrees(1.0) : 1.0;
        const auto index = static_cast<Eigen::Index>(i);
        const std::string unit = is_angle ? "\u00b0" : coordinates[i].unit.empty() ? "" : " " + coordinates[i].unit;
        const std::string rate_unit = unit.empty() ? "" : unit + "/s";
        const float x = at.x + units(first + column * static_cast<float>(i % columns));
        const float y = at.y + 2.0F * line * static_cast<float>(i / columns);
        const auto text = [&](const std::string& name, double value, const std::string& of) {
            return typeset_name(name) + " = " + number(value * factor, "{:.3f}") + of;
        };
        paint_label(list, x, y, text(coordinates[i].name, session.now().state.q[index], unit), text_color(), size);
        paint_label(list, x, y + line, text(coordinates[i].name + "'", session.now().state.v[index], rate_unit),
                    faint_color(), size);
    }
    const std::size_t rows = (coordinates.size() + columns - 1) / columns;
    return 2.0F * line * static_cast<float>(std::max<std::size_t>(rows, 1)) + units(8.0F);
}

// What can be seen of the world: all that the run needs, or what the user looks at.
Drawing world(const Session& session, const Rectangle& area) {
    Drawing drawing = session.limits();
    if (const auto& look = session.scene().look()) {
        const double height = look->width * double{area.height} / double{area.width};
        drawing.x_low = look->x - 0.5 * look->width;
        drawing.x_high = look->x + 0.5 * look->width;
        drawing.y_low = look->y - 0.5 * height;
        drawing.y_high = look->y + 0.5 * height;
    }
    return drawing;
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

// The longest arrow of a run takes this share of the picture.
constexpr double longest = 0.16;

// Pixels for a unit of velocity or force.
double arrow_scale(const Rectangle& area, double largest) {
    return largest > 0.0 ? longest * double{std::min(area.width, area.height)} / largest : 0.0;
}

// What the mouse needs to know of the picture.
struct Picture {
    Rectangle area;
    Placement placement;
    std::optional<Body> body;
    Point center, tip;   // pixels: of the body, and of its velocity
    double scale = 0.0;  // pixels for a unit of velocity
};

Picture paint_picture(const Session& session, const Rectangle& area) {
    Drawing drawing =
        session.mechanism().draw(session.now().state, session.run().parameters, world(session, area), session.theme());
    if (session.scene().shows("trail"))
        add_trail(drawing.shapes, session.trail(), session.samples(), session.time(), session.theme());
    // Behind everything the pinned run at the same instant.
    if (const auto then = session.pinned_now()) {
        const Drawing ghost =
            session.mechanism().draw(then->state, session.pinned()->run.parameters, drawing, session.theme());
        for (std::size_t i = ghost.shapes.size(); i-- > 0;) {
            Shape shape = ghost.shapes[i];
            if (shape.kind == Shape::Kind::text) continue;
            shape.stroke.color.a = shape.fill_color.a = 70;
            drawing.shapes.insert(drawing.shapes.begin(), shape);
        }
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    Picture picture{area, paint(drawing, list, area, units(1.0F)), {}, {}, {}, 0.0};
    if (auto grip = session.mechanism().grip(session.trajectory().run.parameters))
        picture.body = Body::of(*grip, session.now().state);
    if (!picture.body) return picture;
    picture.center = picture.placement.pixel(picture.body->at());
    picture.scale = arrow_scale(area, session.trail().fastest);
    const Point v = picture.body->velocity(session.now().state.v);
    picture.tip = {picture.center.x + picture.scale * v.x, picture.center.y - picture.scale * v.y};
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    if (session.scene().shows("force") && session.now().contact) {
        const double scale = arrow_scale(area, session.trail().strongest);
        if (const auto F = picture.body->force(contact_force(session.trajectory(), session.now())))
            arrow(picture.center, {picture.center.x + scale * F->x, picture.center.y - scale * F->y},
                  phase_color(session.theme(), Phase::Kind::constrained));
    }
    if (session.scene().shows("velocity")) arrow(picture.center, picture.tip, text_color());
    list->PopClipRect();
    return picture;
}

bool is_near(const Point& a, const ImVec2& b, double reach) {
    return std::hypot(a.x - double{b.x}, a.y - double{b.y}) <= reach;
}

// Looks so that the world at the mouse stays there while `factor` times as much is seen, moved by some pixels.
command::Look look_again(const Picture& picture, const ImVec2& mouse, double factor, const ImVec2& moved) {
    const Rectangle& a = picture.area;
    const Point middle{a.x + 0.5 * a.width, a.y + 0.5 * a.height};
    const Point center = picture.placement.world(
        {mouse.x + (middle.x - mouse.x) * factor - moved.x, mouse.y + (middle.y - mouse.y) * factor - moved.y});
    return {center.x, center.y, factor * double{a.width} / picture.placement.unit};
}

// Start values as a command; coordinates, rates or both.
command::Start start_of(const Session& session, const Vector* q, const Vector* v) {
    command::Start start;
    const auto& coordinates = session.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        if (q != nullptr) start.values.emplace_back(coordinates[i].name, (*q)[at]);
        if (v != nullptr) start.values.emplace_back(coordinates[i].name + "'", (*v)[at]);
    }
    return start;
}

void drag_body(const Session& session, const Picture& picture, Commands& commands) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta, mouse = ImGui::GetIO().MousePos;
    if (delta.x == 0.0F && delta.y == 0.0F) return;
    auto grip = session.mechanism().grip(session.run().parameters);
    if (const auto q = held_at(*grip, {session.run().q, session.run().v}, picture.placement.world({mouse.x, mouse.y})))
        commands.emplace_back(start_of(session, &*q, nullptr));
}

void drag_arrow(const Session& session, const Picture& picture, Commands& commands) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta, mouse = ImGui::GetIO().MousePos;
    if ((delta.x == 0.0F && delta.y == 0.0F) || !(picture.scale > 0.0)) return;
    const Point velocity{(mouse.x - picture.center.x) / picture.scale, (picture.center.y - mouse.y) / picture.scale};
    if (const auto v = picture.body->rates(session.run().v, velocity))
        commands.emplace_back(start_of(session, nullptr, &*v));
}

void use_mouse(const Session& session, const Picture& picture, PanelState& state, Commands& commands) {
    using Hand = PanelState::Hand;
    const Rectangle& a = picture.area;
    ImGui::SetCursorScreenPos({a.x, a.y});
    ImGui::InvisibleButton("mechanism", {a.width, a.height});
    remember(state, "mechanism");
    const auto mark = [&](const char* name, const Point& at) {
        state.places[name] = {static_cast<float>(at.x), static_cast<float>(at.y), 0.0F, 0.0F};
    };
    if (picture.body) mark("body", picture.center), mark("velocity", picture.tip);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double reach = units(9.0F);
    const double body_reach = picture.body ? std::max(reach, picture.body->radius() * picture.placement.unit) : 0.0;
    const bool over_tip =
        picture.body && session.scene().shows("velocity") && is_near(picture.tip, mouse, reach) &&
        !is_near(picture.tip, {static_cast<float>(picture.center.x), static_cast<float>(picture.center.y)}, reach);
    const bool over_body = picture.body && !over_tip && is_near(picture.center, mouse, body_reach);
    if (ImGui::IsItemHovered() && ImGui::GetIO().MouseWheel != 0.0F)
        commands.emplace_back(look_again(picture, mouse, std::pow(0.85, double{ImGui::GetIO().MouseWheel}), {}));
    if (ImGui::IsItemHovered() && (over_tip || over_body)) {
        ImGui::GetWindowDrawList()->AddCircle({static_cast<float>(over_tip ? picture.tip.x : picture.center.x),
                                               static_cast<float>(over_tip ? picture.tip.y : picture.center.y)},
                                              static_cast<float>(over_tip ? reach : body_reach) + units(2.0F),
                                              packed(text_color(), 0.5F), 32, units(1.5F));
        if (state.hand == Hand::free)
            tooltip(over_tip ? "drag: the rates to start with" : "drag: where the run starts");
    }
    if (ImGui::IsItemActivated()) {
        state.hand = over_tip ? Hand::arrow : over_body ? Hand::body : Hand::world;
        if (state.hand != Hand::world && session.time() > 0.0) commands.emplace_back(command::Seek{0.0});
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && state.hand == Hand::world)
        commands.emplace_back(command::LookAll{});
    if (!ImGui::IsItemActive()) {
        state.hand = Hand::free;
        return;
    }
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    if (state.hand == Hand::body) drag_body(session, picture, commands);
    if (state.hand == Hand::arrow) drag_arrow(session, picture, commands);
    if (state.hand == Hand::world && ImGui::IsMouseDragging(ImGuiMouseButton_Left) &&
        (delta.x != 0.0F || delta.y != 0.0F))
        commands.emplace_back(look_again(picture, mouse, 1.0, delta));
}

// What is drawn besides the mechanism, in the corner.
void show_switches(const Session& session, const Rectangle& area, PanelState& state, Commands& commands) {
    float x = area.x + area.width - units(10.0F);
    const float y = area.y + area.height - ImGui::GetTextLineHeight() - units(8.0F);
    for (const char* what : {"force", "velocity", "trail"}) {
        const bool shown = session.scene().shows(what);
        const ImVec2 size = ImGui::CalcTextSize(what);
        x -= size.x;
        ImGui::SetCursorScreenPos({x, y});
        ImGui::PushID(what);
        if (ImGui::InvisibleButton("switch", size)) commands.emplace_back(command::Show{what, !shown});
        ImGui::PopID();
        remember(state, std::string("show ") + what);
        const bool lit = ImGui::IsItemHovered();
        tooltip(std::string(shown ? "hide the " : "show the ") + what);
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddText({x, y}, packed(lit ? text_color() : faint_color(), shown || lit ? 1.0F : 0.6F), what);
        if (shown) list->AddLine({x, y + size.y}, {x + size.x, y + size.y}, packed(faint_color()), units(1.0F));
        x -= units(14.0F);
    }
}

}  // namespace

void show_mechanism(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    if (area.width < 2.0F || area.height < 2.0F) return;
    ImGui::GetWindowDrawList()->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(session.theme().background), units(4.0F));
    const float strip = show_state(session, {area.x + units(12.0F), area.y + units(8.0F)}, area.width - units(24.0F));
    const Rectangle rest{area.x, area.y + strip, area.width, area.height - strip};
    if (rest.height < 2.0F) return;
    const Picture picture = paint_picture(session, rest);
    show_switches(session, rest, state, commands);
    use_mouse(session, picture, state, commands);
}

}  // namespace achilles
