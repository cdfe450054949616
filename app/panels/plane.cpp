// In place of the mechanism, of any system: the plane of two quantities, shaded where the gap is open, the run in it,
// and where they are coordinates or rates the start to drag.
#include <algorithm>
#include <cmath>

#include "figure/axes.hpp"
#include "figure/boundary.hpp"
#include "figure/values.hpp"
#include "panels/plane.hpp"
#include "panels/print.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

void choose(const Session& session, PlaneView& plane) {
    const auto& chosen = session.scene().plane();
    const PlaneTexts texts = chosen ? PlaneTexts{chosen->x, chosen->y} : planes_of(session.description()).front();
    if (plane.plane && plane.model == session.model() && plane.texts == texts) return;
    plane.plane = std::make_shared<const Plane>(*session.model(), texts);
    plane.model = session.model();
    plane.texts = texts;
    plane.framing = {};
    plane.panel.reset();
}

// The run's picture in the plane, made anew where something of it has changed.
const Panel& panel_of(const Session& session, PlaneView& plane) {
    const Trajectory& trajectory = session.trajectory();
    const bool is_same = plane.panel && plane.run == trajectory.run && plane.end == trajectory.end_time &&
                         plane.horizon == session.horizon() && plane.dark == session.theme().dark &&
                         plane.framed == plane.framing;
    if (is_same) return *plane.panel;
    plane.run = trajectory.run;
    plane.end = trajectory.end_time;
    plane.horizon = session.horizon();
    plane.dark = session.theme().dark;
    plane.framed = plane.framing;
    plane.panel = std::make_shared<const Panel>(
        compose(trajectory, session.samples(), plane.plane->view(), session.theme(), plane.framing, session.horizon()));
    plane.event_places.clear();
    plane.arrows_in = {};
    plane.surfaces_key.clear();
    plane.levels_key.clear();
    return *plane.panel;
}

// Where the hand moves the start, the other coordinates are those of the start; else the present ones.
State slice_of(const Session& session, const PlaneView& plane) {
    if (!plane.is_held) return session.now().state;
    return {session.run().q, session.run().v, session.run().options.start_time};
}

// The part of the plane that is seen.
Drawing seen(const Panel& panel) {
    Drawing limits;
    limits.x_low = panel.x.low, limits.x_high = panel.x.high;
    limits.y_low = panel.y.low, limits.y_high = panel.y.high;
    return limits;
}

// Lines and shade as they are at the present: made anew where what they depend on has changed.
void update_lines(const Session& session, const Panel& panel, PlaneView& plane) {
    const State state = slice_of(session, plane);
    // Those of the run that is seen, be it that another was asked for.
    const auto& parameters = (plane.is_held ? session.run() : session.trajectory().run).parameters;
    const Drawing limits = seen(panel);
    const auto changes = [&](std::vector<double>& key, std::vector<double> now) {
        now.insert(now.end(), parameters.begin(), parameters.end());
        now.insert(now.end(), {limits.x_low, limits.x_high, limits.y_low, limits.y_high});
        if (key == now) return false;
        key = std::move(now);
        return true;
    };
    std::vector<double> of_surfaces = plane.plane->surfaces_key(state);
    const bool by_run = !plane.plane->is_of_states();  // of two functions of two coordinates, seen where the run goes
    if (by_run && has_moving_gap(*session.model())) of_surfaces.push_back(state.t);
    if (changes(plane.surfaces_key, std::move(of_surfaces))) {
        plane.surfaces = plane.plane->surfaces(parameters, state, limits);
        if (by_run && plane.surfaces.lines.empty())
            plane.surfaces.lines.push_back(
                {0, boundary(session.trajectory(), session.samples(), plane.plane->view(), panel, state.t)});
    }
    if (!session.scene().shows("contours"))
        plane.levels.clear(), plane.levels_key.clear();
    else if (changes(plane.levels_key, plane.plane->levels_key(state)))
        plane.levels = plane.plane->levels(parameters, state, limits);
}

ImVec2 pixel(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

// Lightly, over everything: what lies under it stays what it is.
void shade(const std::vector<std::vector<Point>>& parts, const PanelMap& map, ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImDrawListFlags flags = list->Flags;
    list->Flags &= ~ImDrawListFlags_AntiAliasedFill;  // its soft edges would show where parts meet
    for (const std::vector<Point>& part : parts) {
        for (const Point& corner : part) list->PathLineTo(pixel(map(corner)));
        list->PathFillConvex(color);
    }
    list->Flags = flags;
}

// The event whose marker is under the mouse, by its number; of a run with very many, no impact.
std::optional<int> event_at(const Session& session, const PanelMap& map, PlaneView& plane) {
    constexpr std::size_t most = 20000;
    const auto& events = session.trajectory().events;
    const bool is_asked_of_all = events.size() <= most;
    if (plane.event_places.size() != events.size()) {
        Values values(plane.plane->view(), session.trajectory());
        plane.event_places.resize(events.size());
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (!is_asked_of_all && events[i].kind == Event::Kind::impact) continue;
            values.set(sample_at(session.trajectory(), events[i]));
            plane.event_places[i] = {values[0], values[1]};
        }
    }
    NearestEvent nearest(ImGui::GetIO().MousePos, units(marker_reach));
    for (std::size_t i = 0; i < events.size(); ++i)
        if (is_asked_of_all || events[i].kind != Event::Kind::impact)
            nearest.ask(static_cast<int>(i) + 1, events[i].kind, map.x(plane.event_places[i].x),
                        map.y(plane.event_places[i].y));
    return nearest.found();
}

// As in a plot: a click on a marker selects that event.
void use_events(const Session& session, const PanelMap& map, PlaneView& plane, Commands& commands) {
    if (ImGui::IsItemHovered() && !ImGui::IsAnyMouseDown())
        if (const auto event = event_at(session, map, plane)) name_event(session, *event);
    if (!ImGui::IsItemActivated()) return;
    if (const auto event = event_at(session, map, plane)) commands.emplace_back(command::Select{*event});
}

// The start under the hand: what it holds stays there, and the axes stand still until it lets go.
void use_mouse(const Session& session, const Panel& panel, const PanelMap& map, const Point& start, PanelState& state,
               Commands& commands) {
    PlaneView& plane = state.plane;
    const ImVec2 mouse = ImGui::GetIO().MousePos, delta = ImGui::GetIO().MouseDelta;
    const bool is_near = plane.plane->is_of_states() &&
                         std::hypot(start.x - double{mouse.x}, start.y - double{mouse.y}) <= double{units(9.0F)};
    if (ImGui::IsItemHovered() && (is_near || plane.is_held)) {
        ImGui::GetWindowDrawList()->AddCircle(pixel(start), units(11.0F), packed(text_color(), 0.5F), 32, units(1.5F));
        tooltip("drag to set the start of the run");
    }
    if (!is_near && !plane.is_held) use_events(session, map, plane, commands);
    if (ImGui::IsItemActivated() && is_near) {
        plane.is_held = true;
        plane.offset = {start.x - mouse.x, start.y - mouse.y};
        plane.framing.x = {panel.x.low, panel.x.high};
        plane.framing.y = {panel.y.low, panel.y.high};
    }
    if (plane.is_held && !ImGui::IsItemActive()) {
        plane.is_held = false;
        plane.framing = {};
    }
    if (!plane.is_held || (delta.x == 0.0F && delta.y == 0.0F)) return;
    const double start_time = session.run().options.start_time;
    if (session.time() > start_time) commands.emplace_back(command::Seek{start_time});
    const Point to = map.data({mouse.x + plane.offset.x, mouse.y + plane.offset.y});
    const PlaneAxis &x = plane.plane->x(), &y = plane.plane->y();
    State wanted{session.run().q, session.run().v};
    x.of(wanted) = to.x / x.factor;
    y.of(wanted) = to.y / y.factor;
    wanted.q = start_towards(session, wanted.q);
    commands.emplace_back(command::Start{{{x.text, x.of(wanted)}, {y.text, y.of(wanted)}}});
}

}  // namespace

bool has_contours(const PlaneView& plane) { return plane.plane && plane.plane->is_of_states(); }

namespace {

// The run over the lines, and the arrows of its impacts.
Rectangle paint_lines(const Session& session, const Rectangle& area, Panel panel, PlaneView& plane) {
    const Theme& theme = session.theme();
    std::vector<Curve> lines;
    for (const Plane::Level& level : plane.levels) {
        Color faint = theme.faint;
        faint.a = 140;
        lines.push_back({"", {faint, 1.0, {}}, level.points});
    }
    for (const Plane::Surface& surface : plane.surfaces.lines)
        lines.push_back({"", {theme.surface, 2.0, {}}, surface.points});
    panel.curves.insert(panel.curves.begin(), lines.begin(), lines.end());
    return paint(panel, screen_style(theme), ImGui::GetWindowDrawList(), area, units(1.0F));
}

void update_arrows(const Session& session, const Panel& panel, const Rectangle& plot, PlaneView& plane) {
    if (plane.arrows_in.x == double{plot.width} && plane.arrows_in.y == double{plot.height}) return;
    plane.arrows_in = {plot.width, plot.height};
    constexpr double least = 7.0;
    plane.arrows = impact_arrows(session.trajectory(), plane.plane->view(), panel, plot.width, plot.height,
                                 least * double{units(1.0F)});
}

// Where a sample is in the plane: a circle each for the start and the present.
Point place_of(const Session& session, const PanelMap& map, const PlaneView& plane, const Sample& sample) {
    if (plane.plane->is_of_states()) return map(plane.plane->at(sample.state));
    const std::vector<double> values = values_at(session.trajectory(), sample, plane.plane->view());
    return map({values[0], values[1]});
}

}  // namespace

void show_plane(const Session& session, const Rectangle& area, PanelState& state, Commands& commands) {
    PlaneView& plane = state.plane;
    choose(session, plane);
    const float edge = units(12.0F), line = ImGui::GetTextLineHeight() + units(4.0F);
    const Panel& panel = panel_of(session, plane);
    update_lines(session, panel, plane);
    show_plane_heading(session, {area.x + edge, area.y, area.width - 2.0F * edge, line}, state, commands);
    const Rectangle inner{area.x + edge, area.y + line, area.width - 2.0F * edge, area.height - line};
    if (inner.width < units(80.0F) || inner.height < units(60.0F)) return;
    const Rectangle plot = paint_lines(session, inner, panel, plane);
    if (plot.width < 2.0F || plot.height < 2.0F) return;
    const PanelMap map(panel, plot);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect({plot.x, plot.y}, {plot.x + plot.width, plot.y + plot.height}, true);
    const Theme& theme = session.theme();
    shade(plane.surfaces.open, map, packed(theme.accent, theme.dark ? 0.16F : 0.09F));
    update_arrows(session, panel, plot, plane);
    paint_impacts(session, map, plane);
    Sample first = session.at(session.run().options.start_time);
    if (plane.plane->is_of_states()) first.state = {session.run().q, session.run().v};  // while another run is made
    const Point start = place_of(session, map, plane, first), now = place_of(session, map, plane, session.now());
    name_plane_lines(session, panel, map, plot, plane, {start, now});
    list->AddCircleFilled(pixel(start), units(6.0F), packed(theme.background), 24);
    list->AddCircle(pixel(start), units(6.0F), packed(theme.accent), 24, units(2.0F));
    list->AddCircleFilled(pixel(now), units(5.0F), packed(theme.background), 20);
    list->AddCircleFilled(pixel(now), units(3.5F), packed(text_color()), 20);
    ImGui::SetCursorScreenPos({plot.x, plot.y});
    ImGui::InvisibleButton("plane", {plot.width, plot.height});
    remember(state, "plane");
    state.places["start"] = {static_cast<float>(start.x), static_cast<float>(start.y), 0.0F, 0.0F};
    use_mouse(session, panel, map, start, state, commands);
    list->PopClipRect();
}

}  // namespace achilles
