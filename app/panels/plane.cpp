// The configuration plane in place of the mechanism: the plane of two quantities with the region of open gaps shaded,
// the run, and its start, which can be dragged if the axes are coordinates or rates.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "figure/drag.hpp"
#include "figure/label.hpp"
#include "figure/palette.hpp"
#include "figure/plane.hpp"
#include "paint/paint.hpp"
#include "panels/panels.hpp"
#include "panels/widgets.hpp"
#include "system/units.hpp"

namespace achilles {

// The line above the axes: buttons for their menu, and a legend of shading and contours.
void show_plane_heading(const Session& session, const Rectangle& row, PanelState& state, Commands& commands);

// Labels for contours and surfaces, placed where they cover neither the run, other labels nor `places`.
void name_plane_lines(const Session& session, const Panel& panel, const PanelMap& map, const Rectangle& plot,
                      const PlaneView& plane, const std::vector<Point>& places);
void paint_impacts(const Session& session, const PanelMap& map, const PlaneView& plane);

// ---- choice of the axes ----

namespace {

constexpr const char* plane_popup = "plane menu";

std::string name_of(const PlaneTexts& texts) { return typeset(texts.first) + ", " + typeset(texts.second); }

void show_menu(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup(plane_popup)) return;
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
    const bool typed = expression_fields(
        plane.x, plane.y, was_entered && plane.is_wrong, "plane ",
        ". Press Enter to show it. If both are coordinates or rates, you can drag the start, and contours are drawn",
        state);
    if (plane.is_wrong && !session.error().empty()) show_message(session.error(), units(264.0F));
    if (typed) commands.emplace_back(command::ShowPlane{plane.x, plane.y});
    plane.was_entered = typed;
    if (was_entered && !plane.is_wrong) ImGui::CloseCurrentPopup();
    close_by_escape(state);
    ImGui::EndPopup();
}

// Legend of shading and contours, right-aligned. Returns its left end.
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
        ImGui::OpenPopup(plane_popup);
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

// ---- labels and arrows over the plot ----

namespace {

struct LabelBox {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
    bool meets(const LabelBox& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};
LabelBox around(const Point& p, double width, double height) {
    return {p.x - 0.5 * width, p.y - 0.5 * height, p.x + 0.5 * width, p.y + 0.5 * height};
}

// Grid cells of the plot that are covered by the run: by its curve and markers, or by its markers alone.
class OccupiedCells {
 public:
    OccupiedCells(const Panel& panel, const PanelMap& map, const Rectangle& plot, bool by_signs_alone)
        : plot_(plot),
          side_(double{units(9.0F)}),
          columns_(static_cast<int>(double{plot.width} / side_) + 1),
          rows_(static_cast<int>(double{plot.height} / side_) + 1),
          squares_(static_cast<std::size_t>(columns_ * rows_)) {
        for (const Curve& curve : by_signs_alone ? std::span<const Curve>() : std::span(panel.curves))
            for (std::size_t i = 0; i < curve.points.size(); ++i) {
                const Point to = map(curve.points[i]), from = i > 0 ? map(curve.points[i - 1]) : to;
                const double length = std::hypot(to.x - from.x, to.y - from.y) / side_;
                const int steps = length < 1.0 ? 1 : length < 400.0 ? static_cast<int>(length) + 1 : 0;
                for (int k = 0; k < steps; ++k)
                    mark_occupied(to.x + (from.x - to.x) * k / steps, to.y + (from.y - to.y) * k / steps);
            }
        for (const Markers& markers : panel.markers)
            for (const Point& point : markers.points) {
                const Point at = map(point);
                mark_occupied(at.x, at.y);
            }
    }
    bool is_free(const LabelBox& box) const {
        for (double y = box.top; y < box.bottom + side_; y += side_)
            for (double x = box.left; x < box.right + side_; x += side_) {
                const auto at = square(std::min(x, box.right), std::min(y, box.bottom));
                if (at && squares_[*at]) return false;
            }
        return true;
    }

 private:
    std::optional<std::size_t> square(double x, double y) const {
        const double column = std::floor((x - double{plot_.x}) / side_),
                     row = std::floor((y - double{plot_.y}) / side_);
        if (!(column >= 0.0 && column < columns_ && row >= 0.0 && row < rows_)) return std::nullopt;
        return static_cast<std::size_t>(static_cast<int>(row) * columns_ + static_cast<int>(column));
    }
    void mark_occupied(double x, double y) {
        if (const auto at = square(x, y)) squares_[*at] = true;
    }
    Rectangle plot_;
    double side_;
    int columns_, rows_;
    std::vector<bool> squares_;
};

// A free place for a label on one of these lines, or beside it (1 or -1), far from other labels and off the run.
std::optional<Point> room_for(const std::vector<Point>& line, double beside, const PanelMap& map,
                              const LabelBox& inside, double width, double height, const std::vector<LabelBox>& taken,
                              const OccupiedCells& run) {
    constexpr double far = 1e3;
    constexpr std::size_t looked_at = 60;
    const std::size_t segments = line.size() / 3, step = std::max<std::size_t>(1, segments / looked_at);
    double best = -1.0;
    std::optional<Point> found;
    for (std::size_t k = step / 2; k < segments; k += step) {
        const Point a = map(line[3 * k]), b = map(line[3 * k + 1]);
        Point middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
        if (const double length = std::hypot(b.x - a.x, b.y - a.y); length > 0.0) {
            const double u = (b.y - a.y) / length, v = (a.x - b.x) / length;  // normal of the line
            const double clear = beside * (0.5 * (std::abs(u) * width + std::abs(v) * height) + double{units(6.0F)});
            middle = {middle.x + clear * u, middle.y + clear * v};
        }
        const LabelBox box = around(middle, width, height);
        if (!(box.left > inside.left && box.right < inside.right && box.top > inside.top && box.bottom < inside.bottom))
            continue;
        double nearest = far;
        bool is_taken = false;
        for (const LabelBox& other : taken) {
            is_taken = is_taken || box.meets(other);
            nearest = std::min(nearest, std::hypot(middle.x - 0.5 * (other.left + other.right),
                                                   middle.y - 0.5 * (other.top + other.bottom)));
        }
        if (is_taken || nearest <= best || !run.is_free(box)) continue;
        best = nearest;
        found = middle;
    }
    return found;
}

}  // namespace

void name_plane_lines(const Session& session, const Panel& panel, const PanelMap& map, const Rectangle& plot,
                      const PlaneView& plane, const std::vector<Point>& places) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Theme& theme = session.theme();
    const float size = 0.85F * ImGui::GetFontSize();
    const double edge = double{units(4.0F)}, height = 1.2 * double{size};
    const LabelBox inside{double{plot.x} + edge, double{plot.y} + edge, double{plot.x} + double{plot.width} - edge,
                          double{plot.y} + double{plot.height} - edge};
    std::vector<LabelBox> taken;
    for (const Point& place : places) taken.push_back(around(place, 5.0 * edge, 5.0 * edge));
    const OccupiedCells run(panel, map, plot, false), signs(panel, map, plot, true);
    const auto name = [&](const std::vector<Point>& line, const std::string& text, const Color& color, bool always) {
        const double width = double{label_width(text, size)} + 2.0 * edge;
        const auto room = [&](double beside, const OccupiedCells& clear) {
            return room_for(line, beside, map, inside, width, height, taken, clear);
        };
        std::optional<Point> at = room(0.0, run);
        for (const double beside : {1.0, -1.0})
            if (!at && always) at = room(beside, run);
        if (!at && always) at = room(0.0, signs);
        if (!at) return;
        const LabelBox box = around(*at, width, height);
        const auto left = static_cast<float>(box.left), top = static_cast<float>(box.top);
        list->AddRectFilled({left, top}, {static_cast<float>(box.right), static_cast<float>(box.bottom)},
                            packed(theme.background, 0.8F), units(2.0F));
        paint_label(list, std::floor(left + static_cast<float>(edge)), std::floor(top + 0.1F * size), text, color,
                    size);
        taken.push_back(box);
    };
    const auto& constraints = session.description().constraints;
    if (constraints.size() > 1)
        for (const Plane::Surface& surface : plane.surfaces.lines)
            name(surface.points, constraints[surface.contact].name, text_color(), true);
    for (const Plane::Level& level : plane.levels) name(level.points, level.label, faint_color(), false);
}

void paint_impacts(const Session& session, const PanelMap& map, const PlaneView& plane) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Color color = event_markers(session.theme(), Event::Kind::impact).fill;
    const double unit = double{units(1.0F)};
    const ImVec2 low = list->GetClipRectMin(), high = list->GetClipRectMax();
    const auto pixel = [](const Point& p) { return ImVec2{static_cast<float>(p.x), static_cast<float>(p.y)}; };
    for (const ImpactArrow& arrow : plane.arrows) {
        const Point a = map(arrow.from), b = map(arrow.to), coming = map(arrow.coming);
        const double x = b.x - a.x, y = b.y - a.y, length = std::hypot(x, y);
        // An arc bent away from the incoming motion, so that it does not cross that; longer arcs are flatter.
        constexpr double deepest = 30.0, bend = 80.0;
        const double side = x * (coming.y - a.y) - y * (coming.x - a.x) > 0.0 ? 1.0 : -1.0;
        const double across_x = side * y / length, across_y = -side * x / length;
        const Point middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
        const auto room = [&](double at, double way, double from, double to) {
            return way == 0.0 ? deepest * unit : ((way > 0.0 ? to : from) - at) / way - 2.0 * unit;
        };
        const double deep = std::min({deepest * unit * length / (length + bend * unit),
                                      room(middle.x, across_x, double{low.x}, double{high.x}),
                                      room(middle.y, across_y, double{low.y}, double{high.y})});
        const double depth = 2.0 * std::max(deep, 0.0);  // depth of the control point
        const Point top{middle.x + depth * across_x, middle.y + depth * across_y};
        const double end = std::hypot(b.x - top.x, b.y - top.y);
        const double u = (b.x - top.x) / end, v = (b.y - top.y) / end;  // direction of arrival
        const double head = std::min(8.0 * unit, 0.5 * length), half = 0.4 * head;
        const Point tip{b.x - 3.0 * unit * u, b.y - 3.0 * unit * v};  // at the edge of the event marker
        const Point neck{tip.x - head * u, tip.y - head * v};
        std::vector<Point> bow;
        constexpr int parts = 16;
        for (int i = 0; i <= parts; ++i) {
            const double s = static_cast<double>(i) / parts, r = 1.0 - s;
            bow.push_back({r * r * a.x + 2.0 * r * s * top.x + s * s * neck.x,
                           r * r * a.y + 2.0 * r * s * top.y + s * s * neck.y});
        }
        add_curve(list, bow, screen_stroke({color, 1.3, {}}, unit));
        list->AddTriangleFilled(pixel(tip), pixel({neck.x - half * v, neck.y + half * u}),
                                pixel({neck.x + half * v, neck.y - half * u}), packed(color));
    }
}

// ---- the plane ----

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

// The panel of the run in the plane, recomputed after changes.
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

// The values of the other coordinates: those of the start while it is dragged, else the current ones.
State slice_of(const Session& session, const PlaneView& plane) {
    if (!plane.is_held) return session.now().state;
    return {session.run().q, session.run().v, session.run().options.start_time};
}

// The visible part of the plane.
Drawing limits_of(const Panel& panel) {
    Drawing limits;
    limits.x_low = panel.x.low, limits.x_high = panel.x.high;
    limits.y_low = panel.y.low, limits.y_high = panel.y.high;
    return limits;
}

// Recomputes contours and surfaces if their inputs have changed.
void update_lines(const Session& session, const Panel& panel, PlaneView& plane) {
    const State state = slice_of(session, plane);
    // Parameters of the run that is shown, even if another was requested.
    const auto& parameters = (plane.is_held ? session.run() : session.trajectory().run).parameters;
    const Drawing limits = limits_of(panel);
    const auto changes = [&](std::vector<double>& key, std::vector<double> now) {
        now.insert(now.end(), parameters.begin(), parameters.end());
        now.insert(now.end(), {limits.x_low, limits.x_high, limits.y_low, limits.y_high});
        if (key == now) return false;
        key = std::move(now);
        return true;
    };
    std::vector<double> of_surfaces = plane.plane->surfaces_key(state);
    const bool by_run = !plane.plane->is_of_states();  // axes are functions of the coordinates: evaluated along the run
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

ImVec2 screen_point(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

// A translucent overlay.
void shade(const std::vector<std::vector<Point>>& parts, const PanelMap& map, ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImDrawListFlags flags = list->Flags;
    list->Flags &= ~ImDrawListFlags_AntiAliasedFill;  // antialiasing would show seams between the parts
    for (const std::vector<Point>& part : parts) {
        for (const Point& corner : part) list->PathLineTo(screen_point(map(corner)));
        list->PathFillConvex(color);
    }
    list->Flags = flags;
}

// Number of the event whose marker is under the mouse; without impacts if the run has very many events.
std::optional<int> event_at(const Session& session, const PanelMap& map, PlaneView& plane) {
    constexpr std::size_t most = 20000;
    const auto& events = session.trajectory().events;
    const bool is_asked_of_all = events.size() <= most;
    if (plane.event_places.size() != events.size()) {
        Values values(plane.plane->view(), session.trajectory());
        plane.event_places.resize(events.size());
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (!is_asked_of_all && events[i].is_impact()) continue;
            values.set(sample_at(session.trajectory(), events[i]));
            plane.event_places[i] = {values[0], values[1]};
        }
    }
    NearestEvent nearest(ImGui::GetIO().MousePos, units(marker_reach));
    for (std::size_t i = 0; i < events.size(); ++i)
        if (is_asked_of_all || !events[i].is_impact())
            nearest.ask(static_cast<int>(i) + 1, events[i], map.x(plane.event_places[i].x),
                        map.y(plane.event_places[i].y));
    return nearest.found();
}

// A click on a marker selects that event, as in a plot.
void use_events(const Session& session, const PanelMap& map, PlaneView& plane, Commands& commands) {
    if (ImGui::IsItemHovered() && !ImGui::IsAnyMouseDown())
        if (const auto event = event_at(session, map, plane)) name_event(session, *event);
    if (!ImGui::IsItemActivated()) return;
    if (const auto event = event_at(session, map, plane)) commands.emplace_back(command::Select{*event});
}

// Drag of the start. The axes stay fixed while it lasts.
void use_mouse(const Session& session, const Panel& panel, const PanelMap& map, const Point& start, PanelState& state,
               Commands& commands) {
    PlaneView& plane = state.plane;
    const ImVec2 mouse = ImGui::GetIO().MousePos, delta = ImGui::GetIO().MouseDelta;
    const bool is_near = plane.plane->is_of_states() &&
                         std::hypot(start.x - double{mouse.x}, start.y - double{mouse.y}) <= double{units(9.0F)};
    if (ImGui::IsItemHovered() && (is_near || plane.is_held)) {
        ImGui::GetWindowDrawList()->AddCircle(screen_point(start), units(11.0F), packed(text_color(), 0.5F), 32,
                                              units(1.5F));
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
    if (session.time() > start_time) move_time(session, start_time, commands);
    const Point to = map.data({mouse.x + plane.offset.x, mouse.y + plane.offset.y});
    const PlaneAxis &x = plane.plane->x(), &y = plane.plane->y();
    State wanted{session.run().q, session.run().v};
    x.of(wanted) = to.x / x.factor;
    y.of(wanted) = to.y / y.factor;
    wanted.q = start_towards(*session.model(), session.run(), wanted.q);
    commands.emplace_back(command::SetStart{{{x.text, x.of(wanted)}, {y.text, y.of(wanted)}}});
}

}  // namespace

bool has_contours(const PlaneView& plane) { return plane.plane && plane.plane->is_of_states(); }

namespace {

// Draws the run over contours and surfaces, and the arrows of its impacts.
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

// The position of a sample in the plane; used for the start and the current state.
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
    if (plane.plane->is_of_states()) first.state = {session.run().q, session.run().v};  // while another run is computed
    const Point start = place_of(session, map, plane, first), now = place_of(session, map, plane, session.now());
    name_plane_lines(session, panel, map, plot, plane, {start, now});
    list->AddCircleFilled(screen_point(start), units(6.0F), packed(theme.background), 24);
    list->AddCircle(screen_point(start), units(6.0F), packed(theme.accent), 24, units(2.0F));
    list->AddCircleFilled(screen_point(now), units(5.0F), packed(theme.background), 20);
    list->AddCircleFilled(screen_point(now), units(3.5F), packed(text_color()), 20);
    ImGui::SetCursorScreenPos({plot.x, plot.y});
    ImGui::InvisibleButton("plane", {plot.width, plot.height});
    remember(state, "plane");
    state.places["start"] = {static_cast<float>(start.x), static_cast<float>(start.y), 0.0F, 0.0F};
    use_mouse(session, panel, map, start, state, commands);
    list->PopClipRect();
}

}  // namespace achilles
