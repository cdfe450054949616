// A sweep over two axes: a cell for each of its points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "figure/color_table.hpp"
#include "figure/sweep_panels.hpp"

namespace achilles {

namespace {

// The points of a grid over two axes, each axis from its lower end.
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
    // no_row where it is not there yet.
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

// Where neighbours have different sequences: lines between their cells, as long as they go straight on. Nothing where every
// fifth neighbour is another.
std::optional<std::vector<Point>> changes(const SweepData& data, const Grid2& grid) {
    std::vector<Point> lines;
    std::size_t changed = 0;
    const auto differ = [&](std::uint32_t a, std::uint32_t b) {
        return a != no_row && b != no_row && data.rows.signatures[a] != data.rows.signatures[b];
    };
    const auto add = [&](Point from, Point to) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
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
    const double neighbours = 2.0 * static_cast<double>(grid.columns() * grid.lines());
    if (static_cast<double>(changed) > most * neighbours) return std::nullopt;
    return lines;
}

void add_contours(const SweepData& data, const Grid2& grid, const Theme& theme, Panel& panel) {
    Curve line;
    line.stroke = {theme.ink, 0.8, {}};
    const auto points = changes(data, grid);
    if (!points) {
        line.label = changes_too_often;
        panel.curves.push_back(std::move(line));
        return;
    }
    if (points->empty()) return;
    line.points = *points;
    // Seen on dark cells and on bright ones.
    Curve rim = line;
    rim.stroke = {{theme.background.r, theme.background.g, theme.background.b, 150}, 2.0, {}};
    line.label = sequence_changes;
    panel.curves.push_back(std::move(rim));
    panel.curves.push_back(std::move(line));
}

}  // namespace

namespace {

// The limits that colours are given to. A few numbers far from all others would take them from the rest: where the last in a
// thousand at either end stretch what there is by more than a half, they are left beyond.
std::array<double, 2> limits_of_colors(const SweepColumn& column) {
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

NumberColors::NumberColors(const SweepColumn& column, const SweepLook& look) : table(number_colors(256)) {
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

ColumnColors::ColumnColors(const SweepColumn& column, const Theme& theme, const SweepLook& look) : column_(&column) {
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

Panel map_panel(const SweepData& data, const SweepColumn& column, const Theme& theme, const SweepLook& look) {
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

}  // namespace achilles
