#include "paint/marker.hpp"

#include <imgui.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// A regular polygon, its first corner at the given angle from straight up.
std::vector<Point> polygon(const Point& center, double radius, int corners, double first_angle) {
    std::vector<Point> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = first_angle + 2.0 * std::numbers::pi * i / corners;
        points.push_back({center.x + radius * std::sin(angle), center.y - radius * std::cos(angle)});
    }
    return points;
}

}  // namespace

// Shapes of about equal weight: a diamond as wide as a square would look smaller.
std::vector<Point> corners(const Mark& mark) {
    switch (mark.shape) {
        case Markers::Shape::square:
            return polygon(mark.at, mark.size / std::numbers::sqrt2, 4, std::numbers::pi / 4.0);
        case Markers::Shape::triangle:
            return polygon({mark.at.x, mark.at.y + mark.size * 0.1}, mark.size * 0.68, 3, 0.0);
        case Markers::Shape::diamond:
            return polygon(mark.at, mark.size * 0.68, 4, 0.0);
        case Markers::Shape::circle:
        case Markers::Shape::bar:
            break;
    }
    return polygon(mark.at, mark.size / 2.0, 24, 0.0);
}

void paint_marker(ImDrawList* list, const Mark& mark) {
    std::vector<ImVec2> points;
    for (const Point& p : corners(mark)) points.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y));
    const auto color = [](Color c) { return IM_COL32(c.r, c.g, c.b, c.a); };
    if (mark.fill.a > 0) list->AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), color(mark.fill));
    if (mark.edge.a > 0) stroke(list, points, true, color(mark.edge), static_cast<float>(mark.edge_width));
}

void paint_marker(ImDrawList* list, const Markers& style, const Point& pixel, double scale) {
    paint_marker(list, Mark{style.shape, pixel, style.fill, style.edge, style.size * scale, scale});
}

}  // namespace achilles
