// Panels of a sweep: curves and bars over one axis, maps over two axes, points of sections and of random samples.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "figure/palette.hpp"
#include "figure/sweep_panels.hpp"

namespace achilles {

// ---- over one axis: numbers as curves, classes as bars ----

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool has_room(const SweepData& data, std::uint32_t row) { return row != no_row && row < data.count(); }

bool is_same(const SweepData& data, std::uint32_t a, std::uint32_t b) {
    return has_room(data, a) && has_room(data, b) && data.rows.signatures[a] == data.rows.signatures[b];
}

// A curve, and markers for its points that are isolated between breaks.
struct CurveWithDots {
    Curve curve;
    Markers alone;
};

CurveWithDots trace(const SweepData& data, const ColumnView& column, const std::vector<std::uint32_t>& rows) {
    const ShownUnit x = shown_unit_of_axis(data, 0);
    CurveWithDots traced;
    traced.alone.shape = Markers::MarkerShape::circle;
    std::vector<Point>& points = traced.curve.points;
    std::uint32_t before = no_row;
    std::size_t length = 0;  // number of points since the last break
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

// Bars between neighbors with different sequences that both have a value.
Markers changes(const SweepData& data, std::span<const ColumnView> columns, const std::vector<std::uint32_t>& rows,
                const Theme& theme) {
    Markers bars;
    bars.label = sequence_changes;
    bars.shape = Markers::MarkerShape::bar;
    bars.fill = theme.surface;
    const auto has_value = [&](std::uint32_t row) {
        return std::any_of(columns.begin(), columns.end(), [&](const ColumnView& one) { return one.has_value(row); });
    };
    const SweepAxis axis = shown_axis(data, 0);
    for (std::size_t i = 1; i < rows.size(); ++i)
        if (has_room(data, rows[i - 1]) && has_room(data, rows[i]) && !is_same(data, rows[i - 1], rows[i]) &&
            (has_value(rows[i - 1]) || has_value(rows[i])))
            bars.points.push_back({edge_of(axis, static_cast<double>(i)), 0.0});
    return bars;
}

// Shows the changes as bars. If they are too many to be distinguished, the legend says why the curve is broken.
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

Panel curves_panel(const SweepData& data, std::span<const ColumnView> columns, const Theme& theme,
                   const SweepLook& look) {
    Panel panel;
    panel.x = axis_of(data, 0);
    const std::vector<std::uint32_t> rows = rows_of_points(data);
    std::array<double, 2> range{nan, nan};
    const bool several = columns.size() > 1;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::array<double, 2> own = columns[i].range();
        range = {std::fmin(range[0], own[0]), std::fmax(range[1], own[1])};
        CurveWithDots traced = trace(data, columns[i], rows);
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
    const auto is_empty = [](const ColumnView& column) { return column.numbers().empty(); };
    if (data.count() > 0 && std::all_of(columns.begin(), columns.end(), is_empty)) panel.hatch = nothing(theme);
    return panel;
}

Panel classes_panel(const SweepData& data, const ColumnView& column, const Theme& theme) {
    Panel panel;
    panel.x = axis_of(data, 0);
    const std::vector<std::uint32_t> rows = rows_of_points(data);
    const SweepClasses classes(column, theme);
    const std::size_t lines = classes.named + (classes.named < classes.all.size() ? 1 : 0);
    const std::vector<Markers> keys = classes.keys();
    const SweepAxis axis = shown_axis(data, 0);
    // The first class is at the top.
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

// ---- over two axes: a cell for each point ----

namespace {

// The points of a grid over two axes, each axis in increasing order.
class Grid2 {
 public:
    explicit Grid2(const SweepData& data)
        : x(shown_axis(data, 0)), y(shown_axis(data, 1)), rows_(rows_of_points(data)), count_(data.count()) {
        x_turned_ = x.low > x.high, y_turned_ = y.low > y.high;
        if (x_turned_) std::swap(x.low, x.high);
        if (y_turned_) std::swap(y.low, y.high);
    }
    std::size_t columns() const { return x.count; }
    std::size_t lines() const { return y.count; }
    // no_row if the point is not computed yet.
    std::uint32_t row(std::size_t i, std::size_t j) const {
        if (x_turned_) i = x.count - 1 - i;
        if (y_turned_) j = y.count - 1 - j;
        return rows_[i * y.count + j];
    }

    SweepAxis x, y;

 private:
    std::vector<std::uint32_t> rows_;
    std::size_t count_;
    bool x_turned_ = false, y_turned_ = false;
};

// Lines between cells with different sequences of events; collinear segments are joined. nullopt if more than a fifth
// of the neighbors differ.
std::optional<std::vector<Point>> changes(const SweepData& data, const Grid2& grid) {
    std::vector<Point> lines;
    std::size_t changed = 0;
    const auto differ = [&](std::uint32_t a, std::uint32_t b) {
        return a != no_row && b != no_row && data.rows.signatures[a] != data.rows.signatures[b];
    };
    const auto add = [&](Point from, Point to) {
        if (!lines.empty()) lines.push_back({nan, nan});
        lines.insert(lines.end(), {from, to});
    };
    const auto follow = [&](std::size_t count, const auto& is_changed, const auto& draw) {
        for (std::size_t k = 0, end = 0; k < count; k = end + 1) {
            for (end = k; end < count && is_changed(end);) ++end;
            changed += end - k;
            if (end > k) draw(static_cast<double>(k), static_cast<double>(end));
        }
    };
    for (std::size_t i = 1; i < grid.columns(); ++i) {
        const double x = edge_of(grid.x, static_cast<double>(i));
        follow(
            grid.lines(), [&](std::size_t j) { return differ(grid.row(i - 1, j), grid.row(i, j)); },
            [&](double from, double to) {
                add({x, edge_of(grid.y, from)}, {x, edge_of(grid.y, to)});
            });
    }
    for (std::size_t j = 1; j < grid.lines(); ++j) {
        const double y = edge_of(grid.y, static_cast<double>(j));
        follow(
            grid.columns(), [&](std::size_t i) { return differ(grid.row(i, j - 1), grid.row(i, j)); },
            [&](double from, double to) {
                add({edge_of(grid.x, from), y}, {edge_of(grid.x, to), y});
            });
    }
    constexpr double most = 0.2;
    const double neighbors = 2.0 * static_cast<double>(grid.columns() * grid.lines());
    if (static_cast<double>(changed) > most * neighbors) return std::nullopt;
    return lines;
}

void add_contours(const SweepData& data, const Grid2& grid, const Theme& theme, Panel& panel) {
    Curve line;
    line.stroke = {theme.ink, 0.8, {}};
    line.is_between_cells = true;
    const auto points = changes(data, grid);
    if (!points) {
        line.is_between_cells = false;  // only its label is shown
        line.label = changes_too_often;
        panel.curves.push_back(std::move(line));
        return;
    }
    if (points->empty()) return;
    line.points = *points;
    // The rim makes the line visible on dark and on bright cells.
    Curve rim = line;
    rim.stroke = {{theme.background.r, theme.background.g, theme.background.b, 150}, 2.0, {}};
    line.label = sequence_changes;
    panel.curves.push_back(std::move(rim));
    panel.curves.push_back(std::move(line));
}

}  // namespace

namespace {

// Limits of the color scale. A few outliers would use up most of the colors. Therefore the outermost 0.1 percent at
// each end are left out if they extend the range by more than half.
std::array<double, 2> limits_of_colors(const ColumnView& column) {
    constexpr double share = 1e-3, stretch = 1.5;
    const std::array<double, 2> all = column.range();
    std::vector<double> numbers = column.numbers();
    const auto few = static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size()));
    if (few < 1) return all;
    std::nth_element(numbers.begin(), numbers.begin() + few, numbers.end());
    const double low = numbers[static_cast<std::size_t>(few)];
    std::nth_element(numbers.begin(), numbers.end() - 1 - few, numbers.end());
    const double high = *(numbers.end() - 1 - few);
    return high > low && all[1] - all[0] > stretch * (high - low) ? std::array<double, 2>{low, high} : all;
}

}  // namespace

NumberColors::NumberColors(const ColumnView& column, const SweepLook& look) : table(number_colors(256)) {
    const std::array<double, 2> range = look.range ? *look.range : limits_of_colors(column);
    bar.axis.label = column.label();
    set_limits(bar.axis, range, 0.0);
    if (!bar.axis.ticks.empty()) bar.colors = table;
    const std::array<double, 2> all = column.range();
    if (all[0] < bar.axis.low) bar.axis.label += fmt::format(", min {:.4g}", all[0]);
    if (all[1] > bar.axis.high) bar.axis.label += fmt::format(", max {:.4g}", all[1]);
}

Color NumberColors::operator()(double value) const {
    const double share = std::clamp((value - bar.axis.low) / (bar.axis.high - bar.axis.low), 0.0, 1.0);
    return table[static_cast<std::size_t>(std::lround(share * static_cast<double>(table.size() - 1)))];
}

ColumnColors::ColumnColors(const ColumnView& column, const Theme& theme, const SweepLook& look) : column_(&column) {
    if (column.is_number())
        numbers.emplace(column, look);
    else
        classes.emplace(column, theme);
}

Color ColumnColors::operator()(std::size_t row) const {
    return numbers ? (*numbers)(column_->number(row)) : classes->color(*column_->code(row));
}

void ColumnColors::explain(Panel& panel) const {
    if (numbers) panel.color_bar = numbers->bar;
    if (panel.color_bar.colors.empty()) panel.title = column_->label();
    if (!classes) return;
    for (Markers& key : classes->keys()) panel.markers.push_back(std::move(key));
}

Panel map_panel(const SweepData& data, const ColumnView& column, const Theme& theme, const SweepLook& look) {
    Panel panel;
    const Grid2 grid(data);
    panel.x = axis_of(data, 0);
    panel.y = axis_of(data, 1);
    const ColumnColors color(column, theme, look);
    auto cells = std::make_shared<Cells>();
    cells->columns = static_cast<int>(grid.columns());
    cells->rows = static_cast<int>(grid.lines());
    cells->colors.reserve(grid.columns() * grid.lines());
    bool lacks = false;
    for (std::size_t j = grid.lines(); j-- > 0;)
        for (std::size_t i = 0; i < grid.columns(); ++i) {
            const std::uint32_t row = grid.row(i, j);
            if (row == no_row)
                cells->colors.push_back(theme.background);
            else if (!column.has_value(row))
                lacks = true, cells->colors.push_back({0, 0, 0, 0});
            else
                cells->colors.push_back(color(row));
        }
    const auto last = [](const SweepAxis& axis) { return edge_of(axis, static_cast<double>(axis.count)); };
    panel.raster = {std::move(cells), edge_of(grid.x, 0.0), last(grid.x), edge_of(grid.y, 0.0), last(grid.y)};
    if (lacks) panel.hatch = nothing(theme);
    if (look.contours) add_contours(data, grid, theme, panel);
    color.explain(panel);
    panel.legend = panel.legend_above = lacks || color.classes || !panel.curves.empty();
    return panel;
}

// ---- points instead of a grid: section diagrams, section planes, random samples ----

namespace {

constexpr std::size_t max_row_markers = 3000;  // more points are drawn as dots

std::string word_of(const Section& section) {
    return section.event ? std::string(names_of(*section.event).name) : "upward zero of " + typeset(section.expression);
}

// Adds points of one color: as markers if they are few.
void add_points(std::vector<Point> points, const Color& color, const Theme& theme, Panel& panel,
                const std::string& what) {
    const bool has_rows = !points.empty();
    std::erase_if(points, [](const Point& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); });
    if (has_rows && points.empty()) {
        panel.hatch = nothing(theme);
        return;
    }
    Markers markers;
    markers.shape = Markers::MarkerShape::circle;
    markers.fill = color;
    markers.edge.a = 0;
    markers.size = points.size() > 500 ? 2.2 : 3.5;
    const bool are_few = points.size() <= max_row_markers;
    if (are_few)
        markers.points = std::move(points);
    else
        panel.dots = {std::move(points), {}, color, 0, 0.0, 0.0};
    if (!what.empty()) {
        markers.label = are_few ? what : what + "; color strength: number of points (log scale)";
        panel.legend = panel.legend_above = true;
    }
    panel.markers.push_back(std::move(markers));
}

void fit(Axis& axis, const ColumnView& column, const std::optional<std::array<double, 2>>& given) {
    axis.label = column.label();
    set_limits(axis, given ? *given : column.range(), given ? 0.0 : 0.04);
}

}  // namespace

Panel diagram_panel(const SweepData& data, const ColumnView& column, const Theme& theme, const SweepLook& look) {
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
        panel.dots.columns = static_cast<int>(std::min<std::uint64_t>(axis.count, max_map_side));
        const double first = edge_of(axis, 0.0), last = edge_of(axis, static_cast<double>(axis.count));
        panel.dots.left = std::min(first, last);
        panel.dots.right = std::max(first, last);
    }
    return panel;
}

Panel section_panel(const SweepData& data, const ColumnView& x, const ColumnView& y, const Theme& theme) {
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

// Points grouped by color into markers.
struct ColoredMarkers {
    std::vector<Point> points;
    std::vector<Color> colors;

    void add_to(Panel& panel) {
        if (points.size() > max_row_markers) {
            panel.dots = {std::move(points), std::move(colors), {}, 0, 0.0, 0.0};
            return;
        }
        Markers markers;
        markers.shape = Markers::MarkerShape::circle;
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

Panel samples_panel(const SweepData& data, const ColumnView& column, const Theme& theme, const SweepLook& look) {
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
    ColoredMarkers painted;
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
        none.shape = Markers::MarkerShape::circle;
        none.fill = theme.border;
        none.edge.a = 0;
        panel.markers.push_back(std::move(none));
    }
    panel.legend = panel.legend_above = lacks || (classes && is_plane);
    return panel;
}

}  // namespace achilles
