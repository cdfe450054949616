// In place of the mechanism, of any system: the plane of two coordinates, shaded where the gap is open, the run in it,
// and the start to drag. A system of one coordinate has its phase plane.
#include <algorithm>
#include <cmath>

#include "figure/axes.hpp"
#include "figure/boundary.hpp"
#include "figure/field.hpp"
#include "figure/label.hpp"
#include "paint/label.hpp"
#include "panels/print.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

// What an axis shows: a coordinate, or its rate.
struct PlaneAxis {
    std::string name;
    Eigen::Index coordinate = 0;
    bool is_rate = false;
    double& of(State& state) const { return (is_rate ? state.v : state.q)[coordinate]; }
};
using Axes = std::pair<PlaneAxis, PlaneAxis>;

std::vector<Axes> all_axes(const Session& session) {
    const auto& coordinates = session.description().coordinates;
    const auto axis = [&](std::size_t i, bool is_rate) {
        return PlaneAxis{coordinates[i].name + (is_rate ? "'" : ""), static_cast<Eigen::Index>(i), is_rate};
    };
    std::vector<Axes> all;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        for (std::size_t j = i + 1; j < coordinates.size(); ++j) all.emplace_back(axis(i, false), axis(j, false));
    if (all.empty()) all.emplace_back(axis(0, false), axis(0, true));
    return all;
}

// The run's picture in the plane, made anew where something of it has changed.
const Panel& panel_of(const Session& session, const Axes& axes, PlaneView& plane) {
    const Trajectory& trajectory = session.trajectory();
    if (plane.model != session.model() || plane.view_pair != plane.pair || !plane.view) {
        ViewDescription view;
        view.x.text = axes.first.name;
        view.y.push_back({axes.second.name, {}});
        plane.view = std::make_shared<const PreparedView>(*session.model(), view);
        plane.model = session.model();
        plane.view_pair = plane.pair;
        plane.panel.reset();
    }
    const bool is_same = plane.panel && plane.run == trajectory.run && plane.end == trajectory.end_time &&
                         plane.dark == session.theme().dark && plane.framed == plane.framing;
    if (is_same) return *plane.panel;
    plane.run = trajectory.run;
    plane.end = trajectory.end_time;
    plane.dark = session.theme().dark;
    plane.framed = plane.framing;
    plane.panel = std::make_shared<const Panel>(
        compose(trajectory, session.samples(), *plane.view, session.theme(), plane.framing));
    return *plane.panel;
}

// Where the hand moves the start, the other coordinates are those of the start; else the present ones.
State slice_of(const Session& session, const PlaneView& plane) {
    return plane.is_held ? State{session.run().q, session.run().v} : session.now().state;
}

// The least gap over the part of the plane that is seen, in the units that are shown, and the border of what is open.
const Field& gap_of(const Session& session, const Panel& panel, const Axes& axes, PlaneView& plane) {
    State state = slice_of(session, plane);
    std::vector<double> key{panel.x.low, panel.x.high, panel.y.low, panel.y.high};
    const double t = plane.is_held ? session.run().options.start_time : session.now().t;
    const Model& model = *session.model();
    if (has_moving_gap(model)) key.push_back(t);
    const auto& parameters = session.run().parameters;
    key.insert(key.end(), parameters.begin(), parameters.end());
    for (Eigen::Index i = 0; i < state.q.size(); ++i)
        if (i != axes.first.coordinate && i != axes.second.coordinate) key.push_back(state.q[i]);
    if (plane.gap && plane.gap_key == key && plane.gap_of == plane.view.get()) return *plane.gap;
    const auto& quantities = plane.view->quantities();
    Drawing limits;
    limits.x_low = panel.x.low, limits.x_high = panel.x.high;
    limits.y_low = panel.y.low, limits.y_high = panel.y.high;
    plane.gap_key = key;
    plane.gap_of = plane.view.get();
    std::vector<PlaneFunction> gaps;
    for (std::size_t contact = 0; contact < model.contacts(); ++contact) {
        auto gap = model.evaluator(model.gap(contact), parameters);
        gap.input(model.layout().t()) = t;
        gaps.emplace_back([&state, &axes, &quantities, gap](const Point& p) mutable {
            axes.first.of(state) = p.x / quantities[0].factor;
            axes.second.of(state) = p.y / quantities[1].factor;
            for (Eigen::Index i = 0; i < state.q.size(); ++i) gap.input(static_cast<std::size_t>(i)) = state.q[i];
            gap.run();
            return gap.output(0);
        });
    }
    plane.border = border(limits, gaps);
    plane.gap = std::make_shared<const Field>(limits, [&](const Point& p) {
        double least = gaps.front()(p);
        for (std::size_t i = 1; i < gaps.size(); ++i) least = std::min(least, gaps[i](p));
        return least;
    });
    return *plane.gap;
}

ImVec2 pixel(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

// Lightly, over everything: what lies under it stays what it is.
void shade(const Field& gap, const PanelMap& map, ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImDrawListFlags flags = list->Flags;
    list->Flags &= ~ImDrawListFlags_AntiAliasedFill;  // its soft edges would show where parts meet
    for (const std::vector<Point>& part : gap.not_negative()) {
        for (const Point& corner : part) list->PathLineTo(pixel(map(corner)));
        list->PathFillConvex(color);
    }
    list->Flags = flags;
}

// The line above the axes: what they are, to be pressed for the next two, and what the shade means.
void show_heading(const Session& session, const std::vector<Axes>& all, const Rectangle& row, PanelState& state) {
    PlaneView& plane = state.plane;
    const Axes& axes = all[plane.pair];
    const float size = ImGui::GetFontSize();
    const std::string names = typeset_name(axes.first.name) + ", " + typeset_name(axes.second.name),
                      next = all.size() > 1 ? "  (next)" : "";
    const std::string title = fitted(names, row.width - label_width(next, size)) + next;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float width = label_width(title, size);
    ImGui::SetCursorScreenPos({row.x, row.y});
    const bool pressed = ImGui::InvisibleButton("axes", {width, row.height}) && all.size() > 1;
    remember(state, "plane axes");
    if (all.size() > 1 || title != names)
        tooltip((title == names + next ? "" : names + "\n") +
                (all.size() > 1 ? "a click: the next two coordinates" : ""));
    const bool lit = all.size() > 1 && ImGui::IsItemHovered();
    paint_label(list, row.x, row.y, title, lit ? text_color() : faint_color(), size);
    if (pressed) {
        plane.pair = (plane.pair + 1) % all.size();
        plane.framing = {};
    }
    const std::string meaning =
        session.description().coordinates.size() > 2 ? "h \u2265 0, the others as now" : "h \u2265 0";
    const float left = row.x + row.width - label_width(meaning, size), box = units(11.0F);
    if (left - 2.0F * box < row.x + width) return;
    const float y = std::floor(row.y + 0.5F * (ImGui::GetTextLineHeight() - box));
    list->AddRectFilled({left - box - units(6.0F), y}, {left - units(6.0F), y + box},
                        packed(session.theme().accent, 0.25F));
    paint_label(list, left, row.y, meaning, faint_color(), size);
}

// The event whose marker is under the mouse, by its number; of a run with very many, no impact.
std::optional<int> event_at(const Session& session, const Axes& axes, const PanelMap& map, const PlaneView& plane) {
    constexpr std::size_t most = 20000;
    const auto& events = session.trajectory().events;
    const auto& quantities = plane.view->quantities();
    NearestEvent nearest(ImGui::GetIO().MousePos, units(marker_reach));
    for (std::size_t i = 0; i < events.size(); ++i) {
        if (events.size() > most && events[i].kind == Event::Kind::impact) continue;
        State state = sample_at(session.trajectory(), events[i]).state;
        nearest.ask(static_cast<int>(i) + 1, events[i].kind, map.x(axes.first.of(state) * quantities[0].factor),
                    map.y(axes.second.of(state) * quantities[1].factor));
    }
    return nearest.found();
}

// As in a plot: a click on a marker selects that event.
void use_events(const Session& session, const Axes& axes, const PanelMap& map, const PlaneView& plane,
                Commands& commands) {
    if (ImGui::IsItemHovered() && !ImGui::IsAnyMouseDown())
        if (const auto event = event_at(session, axes, map, plane)) name_event(session, *event);
    if (!ImGui::IsItemActivated()) return;
    if (const auto event = event_at(session, axes, map, plane)) commands.emplace_back(command::Select{*event});
}

// The start under the hand: what it holds stays there, and the axes stand still until it lets go.
void use_mouse(const Session& session, const Axes& axes, const Panel& panel, const PanelMap& map, const Point& start,
               PanelState& state, Commands& commands) {
    PlaneView& plane = state.plane;
    const ImVec2 mouse = ImGui::GetIO().MousePos, delta = ImGui::GetIO().MouseDelta;
    const bool is_near = std::hypot(start.x - double{mouse.x}, start.y - double{mouse.y}) <= double{units(9.0F)};
    if (ImGui::IsItemHovered() && (is_near || plane.is_held)) {
        ImGui::GetWindowDrawList()->AddCircle(pixel(start), units(11.0F), packed(text_color(), 0.5F), 32, units(1.5F));
        tooltip("drag: where the run starts");
    }
    if (!is_near && !plane.is_held) use_events(session, axes, map, plane, commands);
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
    const auto& quantities = plane.view->quantities();
    State wanted{session.run().q, session.run().v};
    axes.first.of(wanted) = to.x / quantities[0].factor;
    axes.second.of(wanted) = to.y / quantities[1].factor;
    wanted.q = start_towards(session, wanted.q);
    commands.emplace_back(
        command::Start{{{axes.first.name, axes.first.of(wanted)}, {axes.second.name, axes.second.of(wanted)}}});
}

}  // namespace

void show_plane(const Session& session, const Rectangle& area, PanelState& state, Commands& commands) {
    const std::vector<Axes> all = all_axes(session);
    PlaneView& plane = state.plane;
    if (plane.pair >= all.size()) plane.pair = 0;
    const float edge = units(12.0F), line = ImGui::GetTextLineHeight() + units(4.0F);
    show_heading(session, all, {area.x + edge, area.y, area.width - 2.0F * edge, line}, state);
    const Axes& axes = all[plane.pair];
    const Rectangle inner{area.x + edge, area.y + line, area.width - 2.0F * edge, area.height - line};
    if (inner.width < units(80.0F) || inner.height < units(60.0F)) return;
    Panel panel = panel_of(session, axes, plane);
    const Field& gap = gap_of(session, panel, axes, plane);
    Stroke line_of_border;
    line_of_border.color = session.theme().surface;
    line_of_border.width = 2.0;
    panel.curves.insert(panel.curves.begin(), Curve{"", line_of_border, plane.border});
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Rectangle plot = paint(panel, screen_style(session.theme()), list, inner, units(1.0F));
    if (plot.width < 2.0F || plot.height < 2.0F) return;
    const PanelMap map(panel, plot);
    list->PushClipRect({plot.x, plot.y}, {plot.x + plot.width, plot.y + plot.height}, true);
    shade(gap, map, packed(session.theme().accent, session.theme().dark ? 0.16F : 0.09F));
    const auto& quantities = plane.view->quantities();
    const auto place = [&](State of) {
        return map({axes.first.of(of) * quantities[0].factor, axes.second.of(of) * quantities[1].factor});
    };
    const Point start = place({session.run().q, session.run().v}), now = place(session.now().state);
    list->AddCircleFilled(pixel(start), units(6.0F), packed(session.theme().background), 24);
    list->AddCircle(pixel(start), units(6.0F), packed(session.theme().accent), 24, units(2.0F));
    list->AddCircleFilled(pixel(now), units(5.0F), packed(session.theme().background), 20);
    list->AddCircleFilled(pixel(now), units(3.5F), packed(text_color()), 20);
    ImGui::SetCursorScreenPos({plot.x, plot.y});
    ImGui::InvisibleButton("plane", {plot.width, plot.height});
    remember(state, "plane");
    state.places["start"] = {static_cast<float>(start.x), static_cast<float>(start.y), 0.0F, 0.0F};
    use_mouse(session, axes, panel, map, start, state, commands);
    list->PopClipRect();
}

}  // namespace achilles
