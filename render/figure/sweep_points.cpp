// What of a sweep stands at points rather than on a grid: diagrams and planes of sections, random samples.
#include <algorithm>
#include <cmath>
#include <limits>

#include "figure/label.hpp"
#include "figure/sweep_panels.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_markers = 3000;  // more points are dots

std::string word_of(const Section& section) {
    switch (section.kind) {
        case Section::Kind::impact:
            return "impact";
        case Section::Kind::zeno:
            return "Zeno point";
        case Section::Kind::release:
            return "release";
        default:
            return "upward zero of " + typeset(section.expression);
    }
}

// Points of one kind: markers where they are few.
void add_points(std::vector<Point> points, const Color& color, const Theme& theme, Panel& panel,
                const std::string& what) {
    const bool has_rows = !points.empty();
    std::erase_if(points, [](const Point& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); });
    if (has_rows && points.empty()) {
        panel.hatch = nothing(theme);
        return;
    }
    Markers markers;
    markers.shape = Markers::Shape::circle;
    markers.fill = color;
    markers.edge.a = 0;
    markers.size = points.size() > 500 ? 2.2 : 3.5;
    const bool are_few = points.size() <= most_markers;
    if (are_few) markers.points = std::move(points);
    if (!what.empty()) {
        markers.label = are_few ? what : what + "; color strength: number of points (log scale)";
        panel.legend = panel.legend_above = true;
    }
    if (!are_few) panel.dots = {std::move(points), {}, color, 0, 0.0, 0.0};
    panel.markers.push_back(std::move(markers));
}

void fit(Axis& axis, const SweepColumn& column, const std::optional<std::array<double, 2>>& given) {
    axis.label = column.label();
    set_limits(axis, given ? *given : column.range(), given ? 0.0 : 0.04);
}

}  // namespace

Panel diagram_panel(const SweepData& data, const SweepColumn& column, const Theme& theme, const SweepLook& look) {
    Panel panel;
    panel.x = axis_of(data, 0);
    fit(panel.y, column, look.range);
    std::vector<Point> points;
    points.reserve(data.count());
    const double along = shown_unit_of_axis(data, 0).factor;
    for (std::size_t row = 0; row < data.count(); ++row)
        points.push_back({along * data.value(0, row), column.number(row)});
    add_points(std::move(points), theme.ink, theme, panel, "at every " + word_of(*data.sweep.at));
    const SweepAxis axis = shown_axis(data, 0);
    if (axis.count > 0) {
        panel.dots.columns = static_cast<int>(std::min<std::uint64_t>(axis.count, most_map_side));
        const double first = edge_of(axis, 0.0), last = edge_of(axis, static_cast<double>(axis.count));
        panel.dots.left = std::min(first, last);
        panel.dots.right = std::max(first, last);
    }
    return panel;
}

Panel section_panel(const SweepData& data, const SweepColumn& x, const SweepColumn& y, const Theme& theme) {
    Panel panel;
    fit(panel.x, x, std::nullopt);
    fit(panel.y, y, std::nullopt);
    std::vector<Point> points;
    points.reserve(data.count());
    for (std::size_t row = 0; row < data.count(); ++row) points.push_back({x.number(row), y.number(row)});
    add_points(std::move(points), theme.ink, theme, panel, "at every " + word_of(*data.sweep.at));
    return panel;
}

namespace {

// Those of one colour are markers together.
struct Painted {
    std::vector<Point> points;
    std::vector<Color> colors;

    void add_to(Panel& panel) {
        if (points.size() > most_markers) {
            panel.dots = {std::move(points), std::move(colors), {}, 0, 0.0, 0.0};
            return;
        }
        Markers markers;
        markers.shape = Markers::Shape::circle;
        markers.edge.a = 0;
        markers.size = points.size() > 500 ? 4.0 : 6.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto has_color = [&](const Markers& one) { return one.label.empty() && one.fill == colors[i]; };
            auto found = std::find_if(panel.markers.begin(), panel.markers.end(), has_color);
            if (found == panel.markers.end()) {
                markers.fill = colors[i];
                found = panel.markers.insert(panel.markers.end(), markers);
            }
            found->points.push_back(points[i]);
        }
    }
};

}  // namespace

Panel samples_panel(const SweepData& data, const SweepColumn& column, const Theme& theme, const SweepLook& look) {
    Panel panel;
    panel.x = axis_of(data, 0);
    const bool is_plane = data.sweep.axes.size() > 1;
    const double along = shown_unit_of_axis(data, 0).factor, up = is_plane ? shown_unit_of_axis(data, 1).factor : 1.0;
    if (!is_plane && column.is_number()) {
        fit(panel.y, column, look.range);
        std::vector<Point> points;
        for (std::size_t row = 0; row < data.count(); ++row)
            points.push_back({along * data.value(0, row), column.number(row)});
        add_points(std::move(points), phase_color(theme, Phase::Kind::hybrid), theme, panel, "");
        return panel;
    }
    const ColumnColors color(column, theme, look);
    const std::optional<SweepClasses>& classes = color.classes;
    if (is_plane) {
        panel.y = axis_of(data, 1);
    } else {
        panel.y.label = column.label();
        panel.y.low = -0.6;
        panel.y.high = std::max(static_cast<double>(classes->all.size()) - 0.4, 0.6);
        for (std::size_t i = 0; i < classes->all.size(); ++i)
            panel.y.ticks.push_back({static_cast<double>(i), classes->all[i].name});
    }
    Painted painted;
    bool lacks = false;
    for (std::size_t row = 0; row < data.count(); ++row) {
        const bool has_value = column.has_value(row);
        if (!has_value && !is_plane) continue;
        lacks = lacks || !has_value;
        const double y = is_plane ? up * data.value(1, row) : static_cast<double>(classes->place(*column.code(row)));
        painted.points.push_back({along * data.value(0, row), y});
        painted.colors.push_back(has_value ? color(row) : theme.border);
    }
    painted.add_to(panel);
    if (is_plane) color.explain(panel);
    if (lacks) {
        Markers none;
        none.label = no_value;
        none.shape = Markers::Shape::circle;
        none.fill = theme.border;
        none.edge.a = 0;
        panel.markers.push_back(std::move(none));
    }
    panel.legend = panel.legend_above = lacks || (classes && is_plane);
    return panel;
}

}  // namespace achilles
