#include "figure/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace achilles {

namespace {

constexpr double apart = 5.0;  // strokes of a hatch, along the x axis

// At 45 degrees, on one lattice for all areas.
Path hatching_of(const Hatch& hatch, Rectangle area, const Metrics& m) {
    Path path{{}, {hatch.color, std::max(0.8 * m.scale, 0.8), {}}, area};
    const double nan = std::numeric_limits<double>::quiet_NaN(), step = apart * m.scale;
    const double left = area.x, top = area.y, right = left + area.width, bottom = top + area.height;
    for (double sum = std::ceil((left + top) / step) * step; sum < right + bottom; sum += step) {
        if (!path.points.empty()) path.points.push_back({nan, nan});
        const double from = std::max(left, sum - bottom), to = std::min(right, sum - top);
        path.points.push_back({from, sum - from});
        path.points.push_back({to, sum - to});
    }
    return path;
}

}  // namespace

void lay_hatch(const Hatch& hatch, Sheet& sheet, Rectangle plot, const Metrics& m) {
    if (hatch.color.a > 0) sheet.emplace_back(hatching_of(hatch, plot, m));
}

bool is_bare(const Panel& panel) {
    const auto has_points = [](const auto& one) { return !one.points.empty(); };
    return !panel.hatch.label.empty() && !panel.raster.cells && panel.dots.points.empty() &&
           std::none_of(panel.curves.begin(), panel.curves.end(), has_points) &&
           std::none_of(panel.markers.begin(), panel.markers.end(), has_points);
}

void lay_word(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& m) {
    if (!is_bare(panel)) return;
    const float x = plot.x + 0.5F * plot.width, y = plot.y + 0.5F * plot.height;
    const float wide = m.width(panel.hatch.label, m.text) + 1.6F * m.text, high = 1.8F * m.text;
    if (style.background.a > 0)
        sheet.emplace_back(
            Fill{{std::round(x - 0.5F * wide), std::round(y - 0.5F * high), wide, high}, style.background});
    sheet.emplace_back(TextRun{x, y - 0.6F * m.text, 0.5F, panel.hatch.label, style.ink, m.text});
}

void lay_hatched_field(const Hatch& hatch, Sheet& sheet, Rectangle field, const Metrics& m) {
    Hatch dense = hatch;
    sheet.emplace_back(hatching_of(dense, field, m));
    const double left = field.x, top = field.y, right = left + field.width, bottom = top + field.height;
    const Rectangle around{field.x - m.line, field.y - m.line, field.width + 2.0F * m.line,
                           field.height + 2.0F * m.line};
    sheet.emplace_back(Path{{{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}},
                            {hatch.color, std::max(m.scale, 1.0), {}},
                            around});
}

void lay_raster(const Raster& raster, Sheet& sheet, Rectangle plot, const PanelMap& map) {
    if (!raster.cells) return;
    const double left = map.x(raster.left), right = map.x(raster.right), top = map.y(raster.top),
                 bottom = map.y(raster.bottom);
    if (!(right > left && bottom > top)) return;
    const auto f = [](double x) { return static_cast<float>(x); };
    sheet.emplace_back(Tiles{{f(left), f(top), f(right - left), f(bottom - top)}, plot, raster.cells});
}

namespace {

// The dots of a plot area: a raster as wide as the places of the points, or as fine as a pen.
struct DotGrid {
    DotGrid(const Dots& dots, Rectangle plot, const PanelMap& map, const Metrics& m) {
        // A dot of 0.7 points is the finest pen of a page 1200 pixels wide. Where places are far apart it is twice as large.
        const double pen = std::max(1.0, std::round(0.7 * m.scale)), widest = 3.0 * pen;
        const double from = map.x(dots.left),
                     place = dots.columns > 0 ? (map.x(dots.right) - from) / dots.columns : 0.0;
        left = plot.x, top = plot.y;
        width = height = place > widest ? 2.0 * pen : pen;
        columns = cells(plot.width / width), rows = cells(plot.height / height);
        if (!(place >= pen && place <= widest)) return;
        left = from, width = place;
        columns = static_cast<std::size_t>(dots.columns);
    }
    // What is on the rim may miss it by rounding.
    std::optional<std::size_t> place(const Point& at) const {
        constexpr double slack = 0.5;
        const double x = (at.x - left) / width, y = (at.y - top) / height;
        if (!(x >= -slack && y >= -slack && x <= static_cast<double>(columns) + slack &&
              y <= static_cast<double>(rows) + slack))
            return std::nullopt;
        const std::size_t column = std::min(static_cast<std::size_t>(std::max(x, 0.0)), columns - 1),
                          row = std::min(static_cast<std::size_t>(std::max(y, 0.0)), rows - 1);
        return row * columns + column;
    }
    Rectangle area() const {
        return {static_cast<float>(left), static_cast<float>(top),
                static_cast<float>(width * static_cast<double>(columns)),
                static_cast<float>(height * static_cast<double>(rows))};
    }

    double left, top, width, height;  // of the area, and of a dot
    std::size_t columns, rows;

 private:
    static std::size_t cells(double count) {
        return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(count)));
    }
};

}  // namespace

void lay_dots(const Dots& dots, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& m) {
    if (dots.points.empty()) return;
    const DotGrid grid(dots, plot, map, m);
    auto cells = std::make_shared<Cells>();
    cells->columns = static_cast<int>(grid.columns);
    cells->rows = static_cast<int>(grid.rows);
    cells->colors.assign(grid.columns * grid.rows, {0, 0, 0, 0});
    std::vector<std::uint32_t> counts(dots.colors.empty() ? grid.columns * grid.rows : 0, 0);
    for (std::size_t i = 0; i < dots.points.size(); ++i) {
        const auto place = grid.place(map(dots.points[i]));
        if (!place) continue;
        if (counts.empty())
            cells->colors[*place] = dots.colors[i];
        else
            ++counts[*place];
    }
    std::uint32_t most = 1;
    for (const std::uint32_t count : counts) most = std::max(most, count);
    constexpr double faintest = 0.5;  // of one point in a dot, where others have more
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        const double share = most > 1 ? std::log(counts[i]) / std::log(most) : 1.0;
        cells->colors[i] = dots.ink;
        cells->colors[i].a = static_cast<std::uint8_t>(std::lround(dots.ink.a * (faintest + (1.0 - faintest) * share)));
    }
    sheet.emplace_back(Tiles{grid.area(), plot, std::move(cells)});
}

}  // namespace achilles
