#include "paint/mechanism.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "figure/camera.hpp"
#include "paint/label.hpp"
#include "surface/curves.hpp"
#include "surface/polyline.hpp"

namespace achilles {

namespace {

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

struct Clip {
    Point low, high;
    double reach() const { return 0.5 * std::hypot(high.x - low.x, high.y - low.y); }
    Point middle() const { return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}; }
};

Clip clip_of(const ImDrawList* list) {
    constexpr double room = 64.0;  // strokes reach beyond their line
    const ImVec2 low = list->GetClipRectMin(), high = list->GetClipRectMax();
    return {{low.x - room, low.y - room}, {high.x + room, high.y + room}};
}

// What of a polygon is inside, as one polygon; its edge may run along the clip's in two directions.
std::vector<Point> clipped(std::vector<Point> polygon, const Clip& clip) {
    for (int side = 0; side < 4; ++side) {
        const auto inside = [&](const Point& p) {
            return side == 0   ? p.x - clip.low.x
                   : side == 1 ? clip.high.x - p.x
                   : side == 2 ? p.y - clip.low.y
                               : clip.high.y - p.y;
        };
        std::vector<Point> rest;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double from = inside(a), to = inside(b);
            if (from >= 0.0) rest.push_back(a);
            if ((from < 0.0) == (to < 0.0)) continue;
            const double s = from / (from - to);
            rest.push_back({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)});
        }
        polygon = std::move(rest);
    }
    return polygon;
}

// A circle in pixels, whose corners stay within 0.02 px of it where it is seen.
std::vector<Point> circle(const Point& center, double radius, const Clip& clip) {
    std::vector<Point> points;
    if (!(radius > 0.0) || !is_finite({radius, 0.0}) || !is_finite(center)) return points;
    const auto add = [&](double angle) {
        points.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
    };
    constexpr double large = 2000.0;
    const double corners = std::max(16.0, std::numbers::pi * std::sqrt(radius / 0.04));
    if (radius <= large) {
        const int count = static_cast<int>(corners);
        for (int i = 0; i < count; ++i) add(2.0 * std::numbers::pi * i / count);
        return points;
    }
    // The arc that may be seen finely, the others as far as it takes for none of their chords to be seen.
    const double x = clip.middle().x - center.x, y = clip.middle().y - center.y;
    const double half = std::min(0.25 * std::numbers::pi, 2.0 * clip.reach() / radius);
    const double towards = std::atan2(y, x), step = 2.0 * half * radius > 0.0 ? 2.0 * std::numbers::pi / corners : half;
    const int fine = std::clamp(static_cast<int>(2.0 * half / step), 8, 2000);
    for (int i = 0; i <= fine; ++i) add(towards - half + 2.0 * half * i / fine);
    for (int i = 1; i < 64; ++i) add(towards + half + 2.0 * (std::numbers::pi - half) * i / 64);
    return points;
}

// The outline in pixels.
std::vector<Point> outline(const Shape& shape, const Placement& placement, const Clip& clip) {
    std::vector<Point> points;
    if (shape.kind == Shape::Kind::disc)
        points = circle(placement.pixel(shape.points.front()), shape.radius * placement.unit, clip);
    else
        for (const Point& p : shape.points) points.push_back(placement.pixel(p));
    if ((shape.closed || shape.kind == Shape::Kind::disc) && !points.empty()) points.push_back(points.front());
    return points;
}

void fill(ImDrawList* list, const std::vector<Point>& rim, Color color, double scale, const Clip& clip) {
    if (rim.size() < 4 || !std::all_of(rim.begin(), rim.end(), is_finite)) return;
    // Cutting ears takes the square of the number of corners.
    constexpr std::size_t most_corners = 1000;
    double tolerance = 0.05;
    std::vector<Point> corners = thinned(rim, tolerance);
    while (corners.size() > most_corners && tolerance < 10.0) corners = thinned(rim, tolerance *= 2.0);
    if (corners.size() < 4) return;
    corners.pop_back();  // the first again
    const auto is_outside = [&](const Point& p) {
        return p.x < clip.low.x || p.x > clip.high.x || p.y < clip.low.y || p.y > clip.high.y;
    };
    if (std::any_of(corners.begin(), corners.end(), is_outside)) corners = clipped(std::move(corners), clip);
    if (corners.size() < 3) return;
    fill_polygon(list, corners, IM_COL32(color.r, color.g, color.b, color.a));
    // A translucent rim would show where it overlaps the inside.
    if (color.a == 255) add_curve(list, rim, {color, scale, {}});
}

// Convex polygons, each as a fan. Their edges are not smoothed: none shows, but that of all together, which has a line.
void fill_area(ImDrawList* list, const Shape& shape, const Placement& placement, const Clip& clip) {
    const Color& c = shape.fill_color;
    const ImU32 color = IM_COL32(c.r, c.g, c.b, c.a);
    std::vector<Point> polygon;
    const auto put = [&] {
        polygon = clipped(std::move(polygon), clip);
        for (std::size_t i = 2; i < polygon.size(); ++i) triangle(list, polygon[0], polygon[i - 1], polygon[i], color);
        polygon.clear();
    };
    for (const Point& p : shape.points) {
        if (is_finite(p))
            polygon.push_back(placement.pixel(p));
        else
            put();
    }
    put();
}

void paint_shape(const Shape& shape, ImDrawList* list, const Placement& placement, double scale) {
    if (shape.points.empty()) return;
    if (shape.kind == Shape::Kind::text) {
        const Point at = placement.pixel(shape.points.front());
        if (!is_finite(at)) return;
        const auto size = static_cast<float>(world_text_size * scale);
        const float width = label_width(shape.text, size);
        paint_label(list, static_cast<float>(at.x) - width / 2.0F, static_cast<float>(at.y) - size / 2.0F, shape.text,
                    shape.stroke.color, size);
        return;
    }
    const Clip clip = clip_of(list);
    if (shape.kind == Shape::Kind::area) return fill_area(list, shape, placement, clip);
    const std::vector<Point> points = outline(shape, placement, clip);
    if (shape.fill && (shape.closed || shape.kind == Shape::Kind::disc))
        fill(list, points, shape.fill_color, scale, clip);
    add_curve(list, points, screen_stroke(shape.stroke, scale));
}

}  // namespace

std::vector<Point> outline(const Shape& shape, const Placement& placement, const Rectangle& seen) {
    return outline(shape, placement, Clip{{seen.x, seen.y}, {seen.x + seen.width, seen.y + seen.height}});
}

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

double paint_scale_bar(ImDrawList* list, const Point& corner, double most, double unit, const std::string& unit_name,
                       const Color& color, double scale) {
    const double length = round_length(most / unit), pixels = std::round(length * unit), tooth = 4.0 * scale;
    if (!(length > 0.0) || !std::isfinite(pixels)) return 0.0;
    const double x = std::round(corner.x), y = std::round(corner.y);
    const ImU32 ink = IM_COL32(color.r, color.g, color.b, color.a);
    const auto thick = static_cast<float>(std::max(1.0, std::round(1.5 * scale)));
    const auto bar = [&](double left, double top, double right, double bottom) {
        list->AddRectFilled(vec({left, top}), vec({right, bottom}), ink);
    };
    bar(x, y - thick, x + pixels, y);
    bar(x, y - tooth - thick, x + thick, y);
    bar(x + pixels - thick, y - tooth - thick, x + pixels, y);
    const auto size = static_cast<float>(world_text_size * scale);
    const std::string label = length_label(length, unit_name);
    const double gap = 6.0 * scale;
    paint_label(list, static_cast<float>(x + pixels + gap), static_cast<float>(y) - 0.85F * size, label, color, size);
    return pixels + gap + label_width(label, size);
}

void paint(const Still& still, ImDrawList* list) {
    paint(still.heading, list);
    const auto room = static_cast<float>(std::round(still_margin * still.scale));
    const Rectangle& w = still.areas.world;
    if (still.plane.panels.empty()) {
        const Placement placement = paint(still.world, list, w, still.scale);
        paint_scale_bar(list, {w.x + room, double{w.y} + double{w.height} - room}, 0.2 * double{w.width},
                        placement.unit, still.unit, still.faint, still.scale);
    } else {
        paint(still.plane, list, w, still.scale);
    }
    if (!still.plots.panels.empty()) paint(still.plots, list, still.areas.plots, still.scale);
}

}  // namespace achilles
