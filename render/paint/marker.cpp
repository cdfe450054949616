#include "paint/marker.hpp"

#include <imgui.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace achilles {

namespace {

// A regular polygon, its first corner at the given angle from straight up.
std::vector<ImVec2> polygon(const Point& center, double radius, int corners, double first_angle) {
    std::vector<ImVec2> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = first_angle + 2.0 * std::numbers::pi * i / corners;
        points.emplace_back(static_cast<float>(center.x + radius * std::sin(angle)),
                            static_cast<float>(center.y - radius * std::cos(angle)));
    }
    return points;
}

// Shapes of about equal weight: a diamond as wide as a square would look smaller.
std::vector<ImVec2> corners(Markers::Shape shape, const Point& center, double size) {
    switch (shape) {
        case Markers::Shape::square:
            return polygon(center, size / std::numbers::sqrt2, 4, std::numbers::pi / 4.0);
        case Markers::Shape::triangle:
            return polygon({center.x, center.y + size * 0.1}, size * 0.68, 3, 0.0);
        case Markers::Shape::diamond:
            return polygon(center, size * 0.68, 4, 0.0);
        case Markers::Shape::circle:
        case Markers::Shape::bar:
            break;
    }
    return polygon(center, size / 2.0, 24, 0.0);
}

}  // namespace

void paint_marker(ImDrawList* list, const Markers& style, const Point& pixel, double scale) {
    const std::vector<ImVec2> points = corners(style.shape, pixel, style.size * scale);
    const int count = static_cast<int>(points.size());
    const auto color = [](Color c) { return IM_COL32(c.r, c.g, c.b, c.a); };
    if (style.fill.a > 0) list->AddConvexPolyFilled(points.data(), count, color(style.fill));
    if (style.edge.a > 0)
        list->AddPolyline(points.data(), count, color(style.edge), ImDrawFlags_Closed, static_cast<float>(scale));
}

}  // namespace achilles
