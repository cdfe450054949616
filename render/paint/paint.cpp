#include "paint/paint.hpp"

#include <imgui.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "figure/layout.hpp"
#include "paint/label.hpp"
#include "surface/curves.hpp"
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

namespace {

class Brush {
 public:
    explicit Brush(ImDrawList* list) : list_(list) {}
    void operator()(const Fill& fill) const {
        const Rectangle& r = fill.area;
        const Color& c = fill.color;
        list_->AddRectFilled({r.x, r.y}, {r.x + r.width, r.y + r.height}, IM_COL32(c.r, c.g, c.b, c.a));
    }
    void operator()(const Path& path) const {
        const Rectangle& r = path.clip;
        list_->PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, true);
        add_curve(list_, path.points, screen_stroke(path.stroke, 1.0));
        list_->PopClipRect();
    }
    // Pieces side by side, whose edges are not smoothed: they would be seen where they meet. Lines along it hide the rest.
    void operator()(const Strip& strip) const {
        const Rectangle& r = strip.clip;
        const Color& c = strip.color;
        list_->PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, true);
        const ImDrawListFlags before = list_->Flags;
        list_->Flags &= ~ImDrawListFlags_AntiAliasedFill;
        const auto at = [](const Point& p) { return ImVec2(static_cast<float>(p.x), static_cast<float>(p.y)); };
        for (std::size_t i = 0; i + 1 < strip.upper.size(); ++i)
            list_->AddQuadFilled(at(strip.upper[i]), at(strip.upper[i + 1]), at(strip.lower[i + 1]), at(strip.lower[i]),
                                 IM_COL32(c.r, c.g, c.b, c.a));
        list_->Flags = before;
        list_->PopClipRect();
    }
    void operator()(const Tiles& tiles) const {
        const Rectangle& r = tiles.clip;
        list_->PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, true);
        add_tiles(list_, tiles.area, *tiles.cells);
        list_->PopClipRect();
    }
    void operator()(const Mark& mark) const { paint_marker(list_, mark); }
    void operator()(const TextRun& words) const {
        const float before = words.anchor == 0.0F ? 0.0F : words.anchor * label_width(words.label, words.size);
        paint_label(list_, words.x - (words.upwards ? 0.0F : before), words.y + (words.upwards ? before : 0.0F),
                    words.label, words.color, words.size, words.upwards ? 90 : 0);
    }

 private:
    ImDrawList* list_;
};

}  // namespace

void paint(const Sheet& sheet, ImDrawList* list) {
    const Brush brush(list);
    for (const auto& item : sheet) std::visit(brush, item);
}

void paint(const Figure& figure, ImDrawList* list, Rectangle area, double scale) {
    paint(layout(figure, label_width, area, scale), list);
}

Rectangle paint(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle area, double scale) {
    Sheet sheet;
    const Rectangle plot = layout(panel, style, label_width, area, scale, sheet);
    paint(sheet, list);
    return plot;
}

}  // namespace achilles
