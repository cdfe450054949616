#include "figure/animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "figure/label.hpp"
#include "figure/plane.hpp"
#include "figure/publication.hpp"
#include "sensitivity/error_estimate.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

// Opacity (of 255) of curves that are still to come.
constexpr std::uint8_t pale_alpha = 70;

// Pixels per unit of length, in a world of height 1 and width `shape`.
double unit_in(const Rectangle& area, double shape) { return std::min(area.width / shape, double{area.height}); }

float heading_height(double scale) { return static_cast<float>(std::round(2.0 * still_title_size * scale)); }

// Decimals of the clock. Successive frames differ at least in the last one.
int decimals_for(double step) { return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 2, 9); }

bool has_units(const SystemDescription& description) {
    return std::any_of(description.coordinates.begin(), description.coordinates.end(),
                       [](const CoordinateDescription& c) { return !c.unit.empty(); });
}

template <class Thing>
void append(std::vector<Thing>& all, const std::vector<Thing>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

// Figure of a whole run in pale colors, without events.
Figure pale_figure(const Trajectory& trajectory, std::span<const ViewDescription> views, int columns, bool dark,
                   std::optional<double> horizon) {
    PublicationStyle style;
    style.columns = columns;
    style.dark = dark;
    Figure figure = publication(trajectory, views, style, nullptr, horizon);
    for (Panel& panel : figure.panels) {
        for (Markers& markers : panel.markers) markers.points.clear();
        for (Curve& curve : panel.curves) curve.stroke.color.a = pale_alpha;
        panel.beyond.markers.clear();
        for (Curve& curve : panel.beyond.curves) curve.stroke.color.a = pale_alpha / 2;
        for (TimeBar& one : panel.time_bars)
            for (TimeBar::TimeMark& mark : one.marks) mark.color.a = pale_alpha;
    }
    return figure;
}

// The number of columns that gives plots nearly the preferred shape and leaves few cells empty.
int columns_in(const Rectangle& area, std::size_t plots) {
    constexpr double pleasant = 1.6, empty = 0.3;  // width / height; cost of an empty cell
    std::size_t best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t columns = 1; columns <= plots; ++columns) {
        const std::size_t rows = (plots + columns - 1) / columns;
        const double shape =
            double{area.width} / static_cast<double>(columns) * static_cast<double>(rows) / area.height;
        const double cost = std::abs(std::log(shape / pleasant)) + empty * static_cast<double>(rows * columns - plots);
        if (!(cost < least)) continue;
        least = cost;
        best = columns;
    }
    return static_cast<int>(best);
}

}  // namespace

ViewDescription plane_of(const SystemDescription& description) {
    const std::string& first = description.coordinates[0].name;
    ViewDescription view;
    view.x.text = first;
    view.y.push_back({description.coordinates.size() > 1 ? description.coordinates[1].name : first + "'", {}});
    return view;
}

double still_scale(const StillSize& size) {
    constexpr double wide = 1600.0, high = 1000.0, at_that = 1.3, least = 0.5, most = 11.0;
    const double fitting = std::max(at_that * std::min(size.width / wide, size.height / high), least);
    return std::min(size.scale * fitting, most);
}

StillAreas still_areas(double shape, std::size_t plots, Rectangle area) {
    StillAreas areas;
    areas.world = area;
    if (plots == 0) return areas;
    constexpr float least = 0.4F, most = 0.62F, beside = 0.56F;  // fractions of the picture, for the mechanism
    const float right = std::round(beside * area.width);
    const float below =
        std::round(std::clamp(static_cast<float>(area.width / shape), least * area.height, most * area.height));
    const Rectangle left_world{area.x, area.y, right, area.height}, upper_world{area.x, area.y, area.width, below};
    if (unit_in(left_world, shape) >= unit_in(upper_world, shape)) {
        areas.world = left_world;
        areas.plots = {area.x + right, area.y, area.width - right, area.height};
    } else {
        areas.world = upper_world;
        areas.plots = {area.x, area.y + below, area.width, area.height - below};
    }
    areas.columns = columns_in(areas.plots, plots);
    return areas;
}

Animation::Animation(const Trajectory& trajectory, std::span<const ViewDescription> views, const StillSize& size,
                     double step, CameraMode camera, const std::optional<ViewAngles>& direction)
    : trajectory_(trajectory),
      horizon_(horizon_before_end(trajectory, estimate_error(trajectory))),
      size_(size),
      decimals_(decimals_for(step)),
      sampler_(trajectory),
      samples_(plot_samples(trajectory)),
      mechanism_(*trajectory.model, direction),
      stage_(mechanism_, trajectory, samples_),
      camera_(camera) {
    for (const ViewDescription& view : views) views_.emplace_back(*trajectory.model, view);
    const float heading = heading_height(still_scale(size));
    const Drawing& limits = stage_.limits();
    const double shape = (limits.x_high - limits.x_low) / (limits.y_high - limits.y_low);
    areas_ = still_areas(shape, views.size(),
                         {0.0F, heading, static_cast<float>(size.width), static_cast<float>(size.height) - heading});
    figure_ = pale_figure(trajectory, views, areas_.columns, size.dark, horizon_);
    if (!mechanism_.is_empty()) return;
    const ViewDescription plane = plane_of(trajectory.model->description());
    plane_view_.emplace(*trajectory.model, plane);
    plane_ = pale_figure(trajectory, {&plane, 1}, 1, size.dark, horizon_);
    if (!views.empty()) plane_.keys.clear();
}

// Adds the curves and events up to the present in full color, and a dot at the present state.
void Animation::add_present(Panel& panel, const PreparedView& view, const Sample& now) const {
    const Theme theme = size_.dark ? dark_theme() : light_theme();
    const auto end = std::upper_bound(samples_.begin(), samples_.end(), now.t,
                                      [](double t, const Sample& sample) { return t < sample.t; });
    if (!view.quantities()[0].is_time && has_moving_gap(*trajectory_.model)) {
        panel.boundary.stroke = {theme.surface, 1.0, {}};
        panel.boundary.points = boundary(trajectory_, samples_, view, panel, now.t);
    }
    std::vector<Sample> past(samples_.begin(), end);
    past.push_back(now);
    Framing framing;
    framing.x = {panel.x.low, panel.x.high};
    framing.y = {panel.y.low, panel.y.high};
    framing.legend = false;
    const Panel present = compose(trajectory_, past, view, theme, framing, horizon_);
    append(panel.beyond.curves, present.beyond.curves);
    append(panel.beyond.markers, present.beyond.markers);
    for (std::size_t i = 0; i < present.curves.size(); ++i) {
        // The legend shows the full color.
        panel.curves.push_back(present.curves[i]);
        panel.curves.back().label = panel.curves[i].label;
        panel.curves[i].label.clear();
    }
    for (std::size_t i = 0; i < panel.markers.size(); ++i) append(panel.markers[i].points, present.markers[i].points);
    for (std::size_t i = 0; i < panel.time_bars.size(); ++i)
        append(panel.time_bars[i].marks, present.time_bars[i].marks);

    const std::vector<double> values = values_at(trajectory_, now, view);
    if (view.quantities()[0].is_time) {
        Markers cursor;
        cursor.shape = Markers::MarkerShape::bar;
        cursor.fill = theme.surface;
        cursor.points = {{values[0], 0.0}};
        panel.markers.push_back(cursor);
    }
    Markers dot;
    dot.shape = Markers::MarkerShape::circle;
    dot.fill = theme.body;
    dot.edge = theme.background;
    dot.size = 10.0;
    for (std::size_t i = 1; i < values.size(); ++i)
        if (std::isfinite(values[0]) && std::isfinite(values[i])) dot.points.push_back({values[0], values[i]});
    panel.markers.push_back(dot);
}

AnimationFrame Animation::at(double t) {
    const Sample now = sampler_.at(t);
    const Theme theme = size_.dark ? dark_theme() : light_theme();
    const SystemDescription& description = trajectory_.model->description();
    AnimationFrame still;
    still.areas = areas_;
    const double scale = still.scale = still_scale(size_);
    const double room = std::round(still_margin * scale);
    const double wide = double{areas_.world.width} - 2.0 * room, high = double{areas_.world.height} - room;
    Drawing seen = widened(stage_.camera().at(camera_, now, {wide, high}), wide, high);
    const double edge = room * (seen.x_high - seen.x_low) / wide;  // this margin shows only the continuation of the
                                                                   // ground
    seen.x_low -= edge, seen.x_high += edge, seen.y_low -= edge;
    still.world = stage_.draw(now, seen, theme, {});
    still.unit = stage_.unit();
    still.faint = theme.faint;
    still.plane = plane_;
    for (Panel& panel : still.plane.panels) add_present(panel, *plane_view_, now);
    still.plots = figure_;
    for (std::size_t i = 0; i < views_.size(); ++i) add_present(still.plots.panels[i], views_[i], now);

    const auto width = static_cast<float>(size_.width), height = static_cast<float>(size_.height);
    const auto text = static_cast<float>(std::round(still_title_size * scale));
    still.heading.emplace_back(Fill{{0.0F, 0.0F, width, height}, theme.background});
    still.heading.emplace_back(TextRun{text, 0.5F * text, 0.0F, description.title, theme.ink, text});
    const std::string clock = fmt::format("{} = {:.{}f}", typeset("t"), t, decimals_);
    still.heading.emplace_back(
        TextRun{width - text, 0.5F * text, 1.0F, clock + (has_units(description) ? " s" : ""), theme.ink, text});
    // To the left of the longest clock text.
    const float clock_room = text * (6.5F + 0.65F * static_cast<float>(decimals_));
    const PhaseLabel phase = phase_label(*trajectory_.model, now);
    still.heading.emplace_back(
        TextRun{width - text - clock_room, 0.5F * text, 1.0F, phase.text, phase_color(theme, phase.color), text});
    return still;
}

std::string to_text(const AnimationFrame& still) {
    std::string text;
    for (const auto& item : still.heading)
        if (const auto* words = std::get_if<TextRun>(&item)) text += words->label + "\n";
    for (const DrawnShape& shape : still.world.shapes) {
        if (shape.points.empty()) continue;
        const Point& last = shape.points.back();
        text += fmt::format("shape of {} points to {:.9g} {:.9g}\n", shape.points.size(), last.x, last.y);
    }
    return text + (still.plane.panels.empty() ? "" : to_text(still.plane)) + to_text(still.plots);
}

}  // namespace achilles
