#include "figure/marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace achilles {

namespace {

constexpr std::size_t few_markers = 150;   // with edges, each drawn
constexpr std::size_t most_markers = 250;  // in a plot
constexpr std::size_t most_events = 8;     // to a marker: more of them are a band

// Where the markers are that lie inside the plot area: whole or not at all, lest half a marker at the rim be another shape;
// what is on the rim may miss it by rounding.
std::vector<Point> places_of(const Markers& markers, Rectangle plot, const PanelMap& map, const Metrics& m) {
    constexpr double slack = 0.5;
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

// Impacts crowd before a Zeno point; of the last ones on every curve of the panel those that stand apart are drawn.
std::vector<Point> standing_apart(const std::vector<Point>& places, double apart) {
    constexpr std::size_t remembered = 32;
    std::vector<Point> laid;
    for (const Point& at : places) {
        const auto recent = laid.end() - static_cast<std::ptrdiff_t>(std::min(laid.size(), remembered));
        if (std::none_of(recent, laid.end(),
                         [&](const Point& other) { return std::hypot(at.x - other.x, at.y - other.y) < apart; }))
            laid.push_back(at);
    }
    return laid;
}

// The first in each square of this side, unless one in a square beside it is nearer than that.
std::vector<Point> far_apart(const std::vector<Point>& places, double side) {
    std::map<std::array<long, 2>, Point> taken;
    std::vector<Point> laid;
    for (const Point& at : places) {
        const long column = std::lround(std::floor(at.x / side)), row = std::lround(std::floor(at.y / side));
        bool is_free = true;
        for (long i = -1; i <= 1 && is_free; ++i)
            for (long j = -1; j <= 1 && is_free; ++j) {
                const auto other = taken.find({column + i, row + j});
                is_free = other == taken.end() || std::hypot(at.x - other->second.x, at.y - other->second.y) >= side;
            }
        if (!is_free) continue;
        taken.insert({{column, row}, at});
        laid.push_back(at);
    }
    return laid;
}

// Kinds of events that happen at one place, as at the end of a contact and at its beginning, show as stripes.
double dot_of(Markers::Shape shape) {
    switch (shape) {
        case Markers::Shape::square:
            return 4.0;
        case Markers::Shape::diamond:
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

void lay_markers(const Markers& markers, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& m) {
    const std::vector<Point> places = places_of(markers, plot, map, m);
    if (places.size() <= few_markers) {
        for (const Point& at : standing_apart(places, markers.apart * m.scale))
            sheet.emplace_back(mark_of(markers, at, m));
        return;
    }
    constexpr double between = 1.3;  // of a marker's size
    const std::vector<Point> laid = far_apart(places, std::max(between * markers.size, markers.apart) * m.scale);
    if (laid.size() > most_markers || places.size() > most_events * laid.size())
        return lay_band(markers, places, sheet, plot, m);
    Markers bare = markers;
    bare.edge.a = 0;
    for (const Point& at : laid) sheet.emplace_back(mark_of(bare, at, m));
}

}  // namespace achilles
