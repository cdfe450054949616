// A sweep over one axis: numbers as curves, classes as bars.
#include <algorithm>
#include <cmath>
#include <limits>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "figure/sweep_panels.hpp"

namespace achilles {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool has_room(const SweepData& data, std::uint32_t row) { return row != no_row && row < data.count(); }

bool is_same(const SweepData& data, std::uint32_t a, std::uint32_t b) {
    return has_room(data, a) && has_room(data, b) && data.rows.signatures[a] == data.rows.signatures[b];
}

// The points that stand alone between breaks are dots.
struct Traced {
    Curve curve;
    Markers alone;
};

Traced trace(const SweepData& data, const SweepColumn& column, const std::vector<std::uint32_t>& rows) {
    const ShownUnit x = shown_unit_of_axis(data, 0);
    Traced traced;
    traced.alone.shape = Markers::Shape::circle;
    std::vector<Point>& points = traced.curve.points;
    std::uint32_t before = no_row;
    std::size_t length = 0;  // of the piece so far
    const auto end_piece = [&] {
        if (length == 0) return;
        if (length == 1) traced.alone.points.push_back(points.back());
        points.push_back({nan, nan});
        length = 0;
    };
    for (const std::uint32_t row : rows) {
        if (!has_room(data, row) || !column.has_value(row)) {
            end_piece();
            before = no_row;
            continue;
        }
        const bool is_step = before != no_row && column.is_count() && column.number(before) != column.number(row);
        if (is_step || (before != no_row && !is_same(data, before, row))) end_piece();
        points.push_back({x.factor * data.value(0, row), column.number(row)});
        ++length;
        before = row;
    }
    end_piece();
    return traced;
}

// Between neighbours of different sequences that have a value.
Markers changes(const SweepData& data, std::span<const SweepColumn> columns, const std::vector<std::uint32_t>& rows,
                const Theme& theme) {
    Markers bars;
    bars.label = sequence_changes;
    bars.shape = Markers::Shape::bar;
    bars.fill = theme.surface;
    const auto has_value = [&](std::uint32_t row) {
        return std::any_of(columns.begin(), columns.end(), [&](const SweepColumn& one) { return one.has_value(row); });
    };
    const SweepAxis axis = shown_axis(data, 0);
    for (std::size_t i = 1; i < rows.size(); ++i)
        if (has_room(data, rows[i - 1]) && has_room(data, rows[i]) && !is_same(data, rows[i - 1], rows[i]) &&
            (has_value(rows[i - 1]) || has_value(rows[i])))
            bars.points.push_back({edge_of(axis, static_cast<double>(i)), 0.0});
    return bars;
}

// More bars could not be told apart: then the curve says why it is broken.
void show_changes(Markers bars, const Color& color, Panel& panel) {
    constexpr std::size_t most = 30;
    if (bars.points.empty()) return;
    if (bars.points.size() <= most) {
        panel.markers.insert(panel.markers.begin(), std::move(bars));
        return;
    }
    Curve broken;
    broken.label = broken_at_changes;
    broken.stroke = {color, 1.6, {11.0, 9.0}};
    panel.curves.push_back(std::move(broken));
}

}  // namespace

Panel curves_panel(const SweepData& data, std::span<const SweepColumn> columns, const Theme& theme,
                   const SweepLook& look) {
    Panel panel;
    panel.x = axis_of(data, 0);
    const std::vector<std::uint32_t> rows = rows_of_points(data);
    std::array<double, 2> range{nan, nan};
    const bool several = columns.size() > 1;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::array<double, 2> own = columns[i].range();
        range = {std::fmin(range[0], own[0]), std::fmax(range[1], own[1])};
        Traced traced = trace(data, columns[i], rows);
        traced.curve.stroke.color = phase_stroke(theme, Phase::Kind::constrained, i, columns.size()).color;
        if (!several) traced.curve.stroke.color = phase_color(theme, Phase::Kind::hybrid);
        traced.curve.stroke.width = 1.6;
        if (several) traced.curve.label = columns[i].name() + (std::isnan(own[0]) ? std::string(": ") + no_value : "");
        traced.alone.fill = traced.curve.stroke.color;
        traced.alone.edge.a = 0;
        traced.alone.size = 3.0;
        if (!traced.alone.points.empty()) panel.markers.push_back(std::move(traced.alone));
        panel.curves.push_back(std::move(traced.curve));
        panel.y.label += (i > 0 ? ", " : "") + (several ? columns[i].name() : columns[i].label());
    }
    if (several) panel.y.label = with_unit(panel.y.label, columns[0].unit().text);
    const bool is_given = look.range.has_value();
    if (is_given) range = *look.range;
    show_changes(changes(data, columns, rows, theme), several ? theme.ink : panel.curves.front().stroke.color, panel);
    set_limits(panel.y, range, is_given ? 0.0 : 0.05);
    panel.legend = panel.legend_above = several || panel.curves.size() > 1 || !panel.markers.empty();
    const auto is_empty = [](const SweepColumn& column) { return column.numbers().empty(); };
    if (data.count() > 0 && std::all_of(columns.begin(), columns.end(), is_empty)) panel.hatch = nothing(theme);
    return panel;
}

Panel classes_panel(const SweepData& data, const SweepColumn& column, const Theme& theme) {
    Panel panel;
    panel.x = axis_of(data, 0);
    const std::vector<std::uint32_t> rows = rows_of_points(data);
    const SweepClasses classes(column, theme);
    const std::size_t lines = classes.named + (classes.named < classes.all.size() ? 1 : 0);
    const std::vector<Markers> keys = classes.keys();
    const SweepAxis axis = shown_axis(data, 0);
    // The first class stands at the top.
    const auto height = [&](std::size_t place) { return static_cast<double>(lines - 1 - place); };
    panel.y.label = column.label();
    panel.y.low = -0.6;
    panel.y.high = std::max(static_cast<double>(lines) - 0.4, 0.6);
    for (std::size_t i = 0; i < lines; ++i) {
        panel.y.ticks.push_back({height(i), keys[i].label});
        Curve curve;
        curve.stroke = {keys[i].fill, 7.0, {}};
        panel.curves.push_back(std::move(curve));
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!has_room(data, rows[i])) continue;
        const auto code = column.code(rows[i]);
        if (!code) continue;
        const std::size_t place = classes.place(*code);
        std::vector<Point>& points = panel.curves[place].points;
        const double from = edge_of(axis, static_cast<double>(i)), to = edge_of(axis, static_cast<double>(i + 1));
        if (!points.empty() && points.back().x == from)
            points.back().x = to;
        else {
            if (!points.empty()) points.push_back({nan, nan});
            points.push_back({from, height(place)});
            points.push_back({to, height(place)});
        }
    }
    if (data.count() > 0 && lines == 0) panel.hatch = nothing(theme);
    return panel;
}

}  // namespace achilles
