#include "paint/mechanism.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paint/label.hpp"
#include "surface/curves.hpp"
#include "surface/polyline.hpp"

namespace achilles {

namespace {

constexpr double text_size = 14.0;
constexpr double still_margin = 16.0;  // around the mechanism of a still

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

ImVec2 vec(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

void triangle(ImDrawList* list, const Point& a, const Point& b, const Point& c, ImU32 color) {
    const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
    list->PrimReserve(3, 3);
    for (const Point* p : {&a, &b, &c}) list->PrimVtx(vec(*p), white, color);
}

// Cuts ears off until nothing is left: right for every simple polygon. Its rim is not smoothed here; whoever fills
// strokes the outline too.
void fill_polygon(ImDrawList* list, std::vector<Point> rest, ImU32 color) {
    double area = 0.0;
    for (std::size_t i = 0; i < rest.size(); ++i) area += cross({}, rest[i], rest[(i + 1) % rest.size()]);
    if (area < 0.0) std::reverse(rest.begin(), rest.end());
    std::size_t misses = 0;
    for (std::size_t i = 0; rest.size() >= 3 && misses < rest.size();) {
        const std::size_t n = rest.size();
        const Point &a = rest[i % n], &b = rest[(i + 1) % n], &c = rest[(i + 2) % n];
        const auto inside = [&](const Point& p) {
            return cross(a, b, p) > 0.0 && cross(b, c, p) > 0.0 && cross(c, a, p) > 0.0;
        };
        if (cross(a, b, c) < 0.0 || std::any_of(rest.begin(), rest.end(), inside)) {
            ++misses;
            ++i;
            continue;
        }
        triangle(list, a, b, c, color);
        i %= n;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>((i + 1) % n));
        misses = 0;
    }
}

// The outline in pixels.
std::vector<Point> outline(const Shape& shape, const Placement& placement) {
    std::vector<Point> points;
    if (shape.kind == Shape::Kind::disc) {
        const Point center = placement.pixel(shape.points.front());
        const double radius = shape.radius * placement.unit;
        if (!(radius > 0.0) || !is_finite({radius, 0.0})) return points;
        // Corners stay within 0.02 px of the circle.
        const int corners = std::clamp(static_cast<int>(std::numbers::pi * std::sqrt(radius / 0.04)), 16, 720);
        for (int i = 0; i < corners; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / corners;
            points.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
        }
    } else {
        for (const Point& p : shape.points) points.push_back(placement.pixel(p));
    }
    if ((shape.closed || shape.kind == Shape::Kind::disc) && !points.empty()) points.push_back(points.front());
    return points;
}

void fill(ImDrawList* list, const std::vector<Point>& rim, Color color, double scale) {
    if (!std::all_of(rim.begin(), rim.end(), is_finite)) return;
    // Cutting ears takes the square of the number of corners.
    constexpr std::size_t most_corners = 1000;
    double tolerance = 0.05;
    std::vector<Point> corners = thinned(rim, tolerance);
    while (corners.size() > most_corners && tolerance < 10.0) corners = thinned(rim, tolerance *= 2.0);
    if (corners.size() < 4) return;
    corners.pop_back();  // the first again
    fill_polygon(list, corners, IM_COL32(color.r, color.g, color.b, color.a));
    // A translucent rim would show where it overlaps the inside.
    if (color.a == 255) add_curve(list, rim, {color, scale, {}});
}

void paint_shape(const Shape& shape, ImDrawList* list, const Placement& placement, double scale) {
    if (shape.points.empty()) return;
    if (shape.kind == Shape::Kind::text) {
        const Point at = placement.pixel(shape.points.front());
        if (!is_finite(at)) return;
        const auto size = static_cast<float>(text_size * scale);
        const float width = label_width(shape.text, size);
        paint_label(list, static_cast<float>(at.x) - width / 2.0F, static_cast<float>(at.y) - size / 2.0F, shape.text,
                    shape.stroke.color, size);
        return;
    }
    const std::vector<Point> points = outline(shape, placement);
    if (shape.fill && (shape.closed || shape.kind == Shape::Kind::disc)) fill(list, points, shape.fill_color, scale);
    add_curve(list, points, screen_stroke(shape.stroke, scale));
}

}  // namespace

Placement place(const Drawing& drawing, Rectangle area) {
    const double width = drawing.x_high - drawing.x_low, height = drawing.y_high - drawing.y_low;
    Placement placement;
    placement.unit = std::min(double{area.width} / width, double{area.height} / height);
    // Nothing sensible to show; still draw nothing rather than fail.
    if (!(placement.unit > 0.0) || !std::isfinite(placement.unit)) placement.unit = 1.0;
    placement.x = area.x + area.width / 2.0 - placement.unit * (drawing.x_low + width / 2.0);
    placement.y = area.y + area.height / 2.0 + placement.unit * (drawing.y_low + height / 2.0);
    return placement;
}

Placement paint(const Drawing& drawing, ImDrawList* list, Rectangle area, double scale) {
    const Placement placement = place(drawing, area);
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    for (const Shape& shape : drawing.shapes) paint_shape(shape, list, placement, scale);
    list->PopClipRect();
    return placement;
}

void paint(const Still& still, ImDrawList* list) {
    paint(still.heading, list);
    const auto room = static_cast<float>(std::round(still_margin * still.scale));
    const Rectangle& w = still.areas.world;
    if (still.plane.panels.empty())
        paint(still.world, list, {w.x + room, w.y, w.width - 2.0F * room, w.height - room}, still.scale);
    else
        paint(still.plane, list, w, still.scale);
    if (!still.plots.panels.empty()) paint(still.plots, list, still.areas.plots, still.scale);
}

}  // namespace achilles
