#include "paint/paint.hpp"

#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "figure/camera.hpp"
#include "figure/label.hpp"
#include "figure/layout.hpp"
#include "surface/curves.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// A regular polygon. `first_angle`: clockwise angle of its first corner from straight up (rad).
std::vector<Point> polygon(const Point& center, double radius, int corners, double first_angle) {
    std::vector<Point> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = first_angle + 2.0 * std::numbers::pi * i / corners;
        points.push_back({center.x + radius * std::sin(angle), center.y - radius * std::cos(angle)});
    }
    return points;
}

}  // namespace

// The shapes have similar visual weight: a diamond as wide as a square would look smaller.
std::vector<Point> corners(const Mark& mark) {
    switch (mark.shape) {
        case Markers::MarkerShape::square:
            return polygon(mark.at, mark.size / std::numbers::sqrt2, 4, std::numbers::pi / 4.0);
        case Markers::MarkerShape::triangle:
            return polygon({mark.at.x, mark.at.y + mark.size * 0.1}, mark.size * 0.68, 3, 0.0);
        case Markers::MarkerShape::inverted_triangle:
            return polygon({mark.at.x, mark.at.y - mark.size * 0.1}, mark.size * 0.68, 3, std::numbers::pi);
        case Markers::MarkerShape::diamond:
            return polygon(mark.at, mark.size * 0.68, 4, 0.0);
        case Markers::MarkerShape::hexagon:
            return polygon(mark.at, mark.size * 0.58, 6, 0.0);
        case Markers::MarkerShape::circle:
        case Markers::MarkerShape::bar:
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
    // Adjacent quadrilaterals without anti-aliasing, because anti-aliased edges would be visible where they meet. The
    // lines along the strip cover its outer edges.
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

namespace {

// Start and direction of a line of text.
struct Baseline {
    ImVec2 start;
    bool upright;  // false: rotated by 90 degrees, reading upward
    ImVec2 at(float along, float down) const {
        return upright ? ImVec2(start.x + along, start.y + down) : ImVec2(start.x + down, start.y - along);
    }
};

// A letter with its font, size and position: `along` the line, `down` from its top.
struct PlacedGlyph {
    const ImFontGlyph* glyph;
    float zoom, along, down, base, slant;  // base: distance of the baseline from the top of the letters
    float advance() const { return glyph->AdvanceX * zoom; }
};

void paint_glyph(ImDrawList* list, const PlacedGlyph& set, const Baseline& line, ImU32 color) {
    const ImFontGlyph& glyph = *set.glyph;
    if (glyph.Visible == 0) return;
    const float left = set.along + glyph.X0 * set.zoom, right = set.along + glyph.X1 * set.zoom;
    const float top = glyph.Y0 * set.zoom, bottom = glyph.Y1 * set.zoom;
    // Italics are slanted about their baseline.
    const float over = (set.base - top) * set.slant, under = (set.base - bottom) * set.slant;
    list->PrimReserve(6, 4);
    list->PrimQuadUV(line.at(left + over, set.down + top), line.at(right + over, set.down + top),
                     line.at(right + under, set.down + bottom), line.at(left + under, set.down + bottom),
                     {glyph.U0, glyph.V0}, {glyph.U1, glyph.V0}, {glyph.U1, glyph.V1}, {glyph.U0, glyph.V1}, color);
}

// Draws dots above a letter as discs, because the font's combining dots touch the taller Greek letters.
void paint_dots(ImDrawList* list, const PlacedGlyph& set, const Baseline& line, float size, int dots, ImU32 color) {
    const float radius = std::max(size * 0.066F, 0.8F);
    const float height = set.glyph->Y0 * set.zoom - 1.9F * radius;
    const float middle =
        set.along + (set.glyph->X0 + set.glyph->X1) / 2.0F * set.zoom + (set.base - height) * set.slant;
    const float apart = dots == 2 ? size * 0.13F : 0.0F;
    for (const float shift : {-apart, apart}) {
        list->AddCircleFilled(line.at(middle + shift, set.down + height), radius, color, 12);
        if (apart == 0.0F) break;
    }
}

// Places one letter after another and returns the length of the line.
template <class Draw>
float set_line(const std::string& label, float size, const Draw& draw) {
    const std::vector<Letter> line = letters(label);
    float along = 0.0F;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Letter& letter = line[i];
        const float own_size = letter.script == 0 ? size : size * script_size;
        ImFont* font = font_for(double{own_size});
        PlacedGlyph set{&glyph_of(font, letter.code), own_size / size_of(font), along, 0.0F, 0.0F, 0.0F};
        set.base = ascent_of(font) * set.zoom;
        if (letter.script != 0) {
            const float shift = letter.script < 0 ? index_drop : -power_rise;
            ImFont* around = font_for(double{size});
            set.down = std::round(ascent_of(around) * size / size_of(around) - set.base + shift * size);
        }
        if (letter.italic) set.slant = italic_slant;
        draw(letter, set);
        along += set.advance();
    }
    return along;
}

}  // namespace

float label_width(const std::string& label, float size) {
    return set_line(label, size, [](const Letter&, const PlacedGlyph&) {});
}

float paint_label(ImDrawList* list, float x, float y, const std::string& label, Color color, float size, int angle) {
    // On whole pixels, letters have the shape with which they were rasterized.
    const Baseline line{{std::round(x), std::round(y)}, angle != 90};
    const ImU32 ink = IM_COL32(color.r, color.g, color.b, color.a);
    push_font_texture(list);
    const float length = set_line(label, size, [&](const Letter& letter, const PlacedGlyph& set) {
        paint_glyph(list, set, line, ink);
        if (letter.dots > 0) paint_dots(list, set, line, size, letter.dots, ink);
    });
    pop_font_texture(list);
    return length;
}

ScreenStroke screen_stroke(const Stroke& stroke, double scale) {
    ScreenStroke result{stroke.color, stroke.width * scale, stroke.dash};
    for (double& length : result.dash) length *= scale;
    return result;
}

FormulaFont formula_font() {
    FormulaFont font;
    font.width = [](const std::string& label, float size) { return label_width(label, size); };
    return font;
}

void paint_formula(ImDrawList* list, const FormulaBox& box, float x, float y, Color color) {
    const ImU32 ink = IM_COL32(color.r, color.g, color.b, color.a);
    for (const FormulaBox::Letters& one : box.letters) {
        ImFont* font = font_for(double{one.size});
        const float base = ascent_of(font) * one.size / size_of(font);
        paint_label(list, x + one.x, y + one.y - base, one.label, color, one.size);
    }
    for (const FormulaBox::FormulaRule& rule : box.rules) {
        const float left = std::round(x + rule.x), top = std::round(y + rule.y);
        list->AddRectFilled({left, top}, {left + std::max(1.0F, rule.width), top + std::max(1.0F, rule.height)}, ink);
    }
    for (const FormulaBox::FormulaStroke& one : box.strokes) {
        std::vector<ImVec2> points;
        for (const Point& p : one.points) points.emplace_back(x + static_cast<float>(p.x), y + static_cast<float>(p.y));
        stroke(list, points, false, ink, one.width);
    }
}

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

// Fills a simple polygon by ear clipping. Its edges are not anti-aliased; callers also stroke the outline.
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
    constexpr double room = 64.0;  // strokes extend beyond their line
    const ImVec2 low = list->GetClipRectMin(), high = list->GetClipRectMax();
    return {{low.x - room, low.y - room}, {high.x + room, high.y + room}};
}

// The part of a polygon inside the clip rectangle, as one polygon. Its edges may run along the clip rectangle back and
// forth.
std::vector<Point> clipped(std::vector<Point> polygon, const Clip& clip) {
    const auto is_inside = [&](const Point& p) {
        return p.x >= clip.low.x && p.x <= clip.high.x && p.y >= clip.low.y && p.y <= clip.high.y;
    };
    if (std::all_of(polygon.begin(), polygon.end(), is_inside)) return polygon;
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

// A circle in pixels as a polygon. Within the visible part its chords are within 0.02 pixels of the circle.
std::vector<Point> circle(const Point& center, double radius, const Clip& clip) {
    std::vector<Point> points;
    if (!(radius > 0.0) || !is_finite({radius, 0.0}) || !is_finite(center)) return points;
    const auto add = [&](double angle) {
        points.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
    };
    constexpr double large = 2000.0;  // pixels
    // A chord over the angle a deviates by radius a^2 / 8.
    const double corners = std::max(16.0, std::numbers::pi * std::sqrt(radius / 0.04));
    if (radius <= large) {
        const int count = static_cast<int>(std::ceil(corners));
        for (int i = 0; i < count; ++i) add(2.0 * std::numbers::pi * i / count);
        return points;
    }
    // The arc that may be visible is fine, `half` (rad) to either side of the middle of the view. Elsewhere only few
    // points are needed, because those chords are invisible.
    const double x = clip.middle().x - center.x, y = clip.middle().y - center.y;
    const double half = clip.reach() < radius ? 2.0 * clip.reach() / radius : std::numbers::pi;
    const double towards = std::atan2(y, x), step = 2.0 * std::numbers::pi / corners;
    const int fine = std::clamp(static_cast<int>(std::ceil(2.0 * half / step)), 8, 4000);
    for (int i = 0; i <= fine; ++i) add(towards - half + 2.0 * half * i / fine);
    for (int i = 1; i < 64; ++i) add(towards + half + 2.0 * (std::numbers::pi - half) * i / 64);
    return points;
}

// The outline in pixels.
std::vector<Point> outline(const DrawnShape& shape, const Placement& placement, const Clip& clip) {
    std::vector<Point> points;
    if (shape.kind == DrawnShape::Kind::disc)
        points = circle(placement.pixel(shape.points.front()), shape.radius * placement.unit, clip);
    else
        for (const Point& p : shape.points) points.push_back(placement.pixel(p));
    if ((shape.closed || shape.kind == DrawnShape::Kind::disc) && !points.empty()) points.push_back(points.front());
    return points;
}

void fill(ImDrawList* list, const std::vector<Point>& rim, Color color, double scale, const Clip& clip) {
    if (rim.size() < 4 || !std::all_of(rim.begin(), rim.end(), is_finite)) return;
    // Ear clipping takes quadratic time in the number of corners.
    constexpr std::size_t max_corners = 1000;
    double tolerance = 0.05;
    std::vector<Point> corners = thinned(rim, tolerance);
    while (corners.size() > max_corners && tolerance < 10.0) corners = thinned(rim, tolerance *= 2.0);
    if (corners.size() < 4) return;
    corners.pop_back();  // it repeats the first point
    const auto is_outside = [&](const Point& p) {
        return p.x < clip.low.x || p.x > clip.high.x || p.y < clip.low.y || p.y > clip.high.y;
    };
    if (std::any_of(corners.begin(), corners.end(), is_outside)) corners = clipped(std::move(corners), clip);
    if (corners.size() < 3) return;
    fill_polygon(list, corners, IM_COL32(color.r, color.g, color.b, color.a));
    // A translucent stroke would be visible where it overlaps the interior.
    if (color.a == 255) add_curve(list, rim, {color, scale, {}});
}

// Fills convex polygons as triangle fans. Edges are not anti-aliased: interior edges must be invisible, and the outer
// edge has a line.
void fill_area(ImDrawList* list, const DrawnShape& shape, const Placement& placement, const Clip& clip) {
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

void paint_shape(const DrawnShape& shape, ImDrawList* list, const Placement& placement, double scale) {
    if (shape.points.empty()) return;
    if (shape.kind == DrawnShape::Kind::text) {
        const Point at = placement.pixel(shape.points.front());
        if (!is_finite(at)) return;
        const auto size = static_cast<float>(world_text_size * scale);
        const float width = label_width(shape.text, size);
        float left = static_cast<float>(at.x) - width / 2.0F, top = static_cast<float>(at.y) - size / 2.0F;
        // A note beside the mechanism stays whole where a large text would be cut at the edge of the picture.
        const ImVec2 low = list->GetClipRectMin(), high = list->GetClipRectMax();
        const double line = 1.2 * double{size};
        const bool is_seen =
            at.x > double{low.x} && at.x < double{high.x} && at.y > double{low.y} && at.y < double{high.y};
        if (!shape.moves && is_seen && width < high.x - low.x && line < double{high.y - low.y}) {
            left = std::clamp(left, low.x, high.x - width);
            top = std::clamp(top, low.y, high.y - static_cast<float>(line));
        }
        paint_label(list, left, top, shape.text, shape.stroke.color, size);
        return;
    }
    const Clip clip = clip_of(list);
    if (shape.kind == DrawnShape::Kind::area) return fill_area(list, shape, placement, clip);
    const std::vector<Point> points = outline(shape, placement, clip);
    if (shape.fill && (shape.closed || shape.kind == DrawnShape::Kind::disc))
        fill(list, points, shape.fill_color, scale, clip);
    add_curve(list, points, screen_stroke(shape.stroke, scale));
}

}  // namespace

std::vector<Point> outline(const DrawnShape& shape, const Placement& placement, const Rectangle& seen) {
    return outline(shape, placement, Clip{{seen.x, seen.y}, {seen.x + seen.width, seen.y + seen.height}});
}

Placement place(const Drawing& drawing, Rectangle area) {
    const double width = drawing.x_high - drawing.x_low, height = drawing.y_high - drawing.y_low;
    Placement placement;
    placement.unit = std::min(double{area.width} / width, double{area.height} / height);
    // The limits are degenerate; still draw nothing instead of failing.
    if (!(placement.unit > 0.0) || !std::isfinite(placement.unit)) placement.unit = 1.0;
    placement.x = area.x + area.width / 2.0 - placement.unit * (drawing.x_low + width / 2.0);
    placement.y = area.y + area.height / 2.0 + placement.unit * (drawing.y_low + height / 2.0);
    return placement;
}

Placement paint(const Drawing& drawing, ImDrawList* list, Rectangle area, double scale) {
    const Placement placement = place(drawing, area);
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    for (const DrawnShape& shape : drawing.shapes) paint_shape(shape, list, placement, scale);
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

void paint(const AnimationFrame& still, ImDrawList* list) {
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
