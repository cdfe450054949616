#include "figure/marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

namespace achilles {

namespace {

constexpr std::size_t few_markers = 150;  // up to this number, all are drawn with edges
constexpr std::size_t max_markers = 250;  // maximum in a plot
constexpr std::size_t most_events = 8;    // events per marker; more of them are drawn as a band

// Positions of the markers inside the plot area. Markers are drawn entirely or not at all, because half a marker at the
// edge would look like another shape. Half a pixel of slack allows for rounding.
std::vector<Point> places_of(const Markers& markers, Rectangle plot, const PanelMap& map, const Metrics& m) {
    constexpr double slack = 0.5;  // pixels
    std::vector<Point> places;
    for (const Point& point : markers.points) {
        Point at = map(point);
        at.y -= markers.lift * m.scale;
        if (at.x >= plot.x - slack && at.x <= plot.x + plot.width + slack && at.y >= plot.y - slack &&
            at.y <= plot.y + plot.height + slack)
            places.push_back(at);
    }
    return places;
}

// Markers in squares as wide as the distance that one more must keep from them.
class DrawnMarkers {
 public:
    explicit DrawnMarkers(double distance) : side_(std::max(distance, 1e-3)) {}
    void add(const Point& at) { squares_[square(at)].push_back(at); }
    bool has_near(const Point& at) const {
        const auto [column, row] = square(at);
        for (long i = -1; i <= 1; ++i)
            for (long j = -1; j <= 1; ++j) {
                const auto near = squares_.find({column + i, row + j});
                if (near == squares_.end()) continue;
                for (const Point& other : near->second)
                    if (std::hypot(at.x - other.x, at.y - other.y) < side_) return true;
            }
        return false;
    }

 private:
    std::array<long, 2> square(const Point& at) const {
        return {std::lround(std::floor(at.x / side_)), std::lround(std::floor(at.y / side_))};
    }

    double side_;
    std::map<std::array<long, 2>, std::vector<Point>> squares_;
};

// The markers that are drawn: at these distances from each other and from those of other kinds.
std::vector<Point> spaced_apart(const std::vector<Point>& places, double distance, const std::vector<Point>& others,
                                double from_others) {
    DrawnMarkers drawn(distance), taken(from_others);
    for (const Point& other : others) taken.add(other);
    std::vector<Point> laid;
    for (const Point& at : places) {
        if (drawn.has_near(at) || taken.has_near(at)) continue;
        drawn.add(at);
        laid.push_back(at);
    }
    return laid;
}

// Dot size, different for each kind, so that events at one position, such as the end of one contact phase and the start
// of the next, show as stripes.
double dot_of(Markers::MarkerShape shape) {
    switch (shape) {
        case Markers::MarkerShape::square:
            return 4.0;
        case Markers::MarkerShape::diamond:
            return 2.5;
        default:
            return 1.2;
    }
}

void lay_band(const Markers& markers, const std::vector<Point>& places, Sheet& sheet, Rectangle plot,
              const Metrics& m) {
    const double pen = std::max(1.0, std::round(0.5 * m.scale)), half = 0.5 * dot_of(markers.shape) * m.scale;
    const auto [west, east] =
        std::minmax_element(places.begin(), places.end(), [](auto& a, auto& b) { return a.x < b.x; });
    const auto [north, south] =
        std::minmax_element(places.begin(), places.end(), [](auto& a, auto& b) { return a.y < b.y; });
    const auto before = [&](double pixel, float low) { return low + pen * std::floor((pixel - half - low) / pen); };
    const double left = std::max<double>(before(west->x, plot.x), plot.x),
                 top = std::max<double>(before(north->y, plot.y), plot.y);
    const auto count = [&](double from, double to) {
        return 1 + static_cast<int>(std::max((to + half - from) / pen, 0.0));
    };
    auto cells = std::make_shared<Cells>();
    cells->columns = count(left, std::min<double>(east->x, plot.x + plot.width - half));
    cells->rows = count(top, std::min<double>(south->y, plot.y + plot.height - half));
    cells->colors.assign(static_cast<std::size_t>(cells->columns) * static_cast<std::size_t>(cells->rows),
                         {0, 0, 0, 0});
    const auto cell = [&](double pixel, double low, int all) {
        return std::clamp(static_cast<int>(std::floor((pixel - low) / pen)), 0, all - 1);
    };
    for (const Point& at : places) {
        const int first = cell(at.x - half, left, cells->columns), last = cell(at.x + half, left, cells->columns);
        const int upper = cell(at.y - half, top, cells->rows), lower = cell(at.y + half, top, cells->rows);
        for (int row = upper; row <= lower; ++row)
            for (int column = first; column <= last; ++column)
                cells->colors[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells->columns) +
                              static_cast<std::size_t>(column)] = markers.fill;
    }
    const auto f = [](double x) { return static_cast<float>(x); };
    const Rectangle area{f(left), f(top), f(pen * cells->columns), f(pen * cells->rows)};
    sheet.emplace_back(Tiles{area, plot, std::move(cells)});
}

}  // namespace

Mark mark_of(const Markers& markers, const Point& pixel, const Metrics& m) {
    return {markers.shape, pixel, markers.fill, markers.edge, markers.size * m.scale, m.scale};
}

namespace {

// Markers of one kind; those laid are added to `drawn`.
void lay_kind(const Markers& markers, std::vector<Point>& drawn, Sheet& sheet, Rectangle plot, const PanelMap& map,
              const Metrics& m) {
    const std::vector<Point> places = places_of(markers, plot, map, m);
    const bool are_few = places.size() <= few_markers;
    constexpr double between = 1.3;  // distance in marker sizes
    const double distance = are_few ? markers.apart : std::max(between * markers.size, markers.apart);
    const std::vector<Point> laid = spaced_apart(places, distance * m.scale, drawn, markers.apart * m.scale);
    if (!are_few && (laid.size() > max_markers || places.size() > most_events * std::max<std::size_t>(laid.size(), 1)))
        return lay_band(markers, places, sheet, plot, m);
    Markers drawn_as = markers;
    if (!are_few) drawn_as.edge.a = 0;
    for (const Point& at : laid) sheet.emplace_back(mark_of(drawn_as, at, m));
    drawn.insert(drawn.end(), laid.begin(), laid.end());
}

}  // namespace

void lay_markers(const std::vector<const Markers*>& all, Sheet& sheet, Rectangle plot, const PanelMap& map,
                 const Metrics& m) {
    // A larger marker is more important, such as that of a Zeno point among impacts: it is chosen first.
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return all[a]->size > all[b]->size; });
    std::vector<Point> drawn;
    std::vector<Sheet> laid(all.size());
    for (const std::size_t i : order) lay_kind(*all[i], drawn, laid[i], plot, map, m);
    for (Sheet& one : laid) std::move(one.begin(), one.end(), std::back_inserter(sheet));
}

// ---- hatching, rasters, points ----

namespace {

constexpr double apart = 5.0;  // distance of hatch strokes along the x axis, layout points

// Strokes at 45 degrees, on one lattice for all areas.
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

bool has_no_fill(const Panel& panel) {
    const auto has_points = [](const auto& one) { return !one.points.empty(); };
    return !panel.hatch.label.empty() && !panel.raster.cells && panel.dots.points.empty() &&
           std::none_of(panel.curves.begin(), panel.curves.end(), has_points) &&
           std::none_of(panel.markers.begin(), panel.markers.end(), has_points);
}

void layout_word(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& m) {
    if (!has_no_fill(panel)) return;
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

// Grid of dots in a plot area: as wide as the spacing of the points, or as fine as a pen.
struct DotGrid {
    DotGrid(const Dots& dots, Rectangle plot, const PanelMap& map, const Metrics& m) {
        // A dot of 0.7 points is the finest pen on a page 1200 pixels wide. If positions are far apart, it is twice as
        // large.
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
    // Positions at the edge may miss it by rounding.
    std::optional<std::size_t> place(const Point& at) const {
        constexpr double slack = 0.5;  // pixels
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

    double left, top, width, height;  // of the area; of a dot
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
    constexpr double faintest = 0.5;  // opacity of a dot with one point, if others have more
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        const double share = most > 1 ? std::log(counts[i]) / std::log(most) : 1.0;
        cells->colors[i] = dots.ink;
        cells->colors[i].a = static_cast<std::uint8_t>(std::lround(dots.ink.a * (faintest + (1.0 - faintest) * share)));
    }
    sheet.emplace_back(Tiles{grid.area(), plot, std::move(cells)});
}

}  // namespace achilles
