#include "figure/layout.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "figure/grid.hpp"
#include "figure/marks.hpp"

namespace achilles {

namespace {

Rectangle on_pixels(Rectangle r) {
    const float x = std::round(r.x), y = std::round(r.y);
    return {x, y, std::max(std::round(r.x + r.width) - x, 1.0F), std::max(std::round(r.y + r.height) - y, 1.0F)};
}

// Shrinks the plot area until one unit has the same length on both axes. Its center is kept, or, beside several rows,
// its upper left corner.
Rectangle with_equal_units(const Panel& panel, Rectangle plot) {
    const double wide = panel.x.high - panel.x.low, high = panel.y.high - panel.y.low;
    const double unit = std::min(plot.width / wide, plot.height / high);
    if (!panel.equal_axes || !(unit > 0.0) || !std::isfinite(unit) || !std::isfinite(high)) return plot;
    const auto width = static_cast<float>(unit * wide), height = static_cast<float>(unit * high);
    const float before = panel.rows > 1 ? 0.0F : 0.5F;
    return on_pixels({plot.x + before * (plot.width - width), plot.y + before * (plot.height - height), width, height});
}

void lay_bands(const Panel& panel, Sheet& sheet, Rectangle plot) {
    const PanelMap map(panel, plot);
    const double left = plot.x, right = plot.x + plot.width;
    for (const Band& band : panel.bands) {
        const auto from = static_cast<float>(std::round(std::clamp(map.x(band.low), left, right)));
        const auto to = static_cast<float>(std::round(std::clamp(map.x(band.high), left, right)));
        if (to > from) sheet.emplace_back(Fill{{from, plot.y, to - from, plot.height}, band.color});
    }
}

void lay_bars(const Markers& markers, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& m) {
    for (const Point& point : markers.points) {
        const double x = map.x(point.x);
        if (!(x >= plot.x && x <= plot.x + plot.width)) continue;
        const float at = static_cast<float>(std::round(x - m.line / 2.0));
        sheet.emplace_back(Fill{{at, plot.y, m.line, plot.height}, markers.fill});
    }
}

Stroke scaled(Stroke stroke, double scale) {
    stroke.width *= scale;
    for (double& length : stroke.dash) length *= scale;
    return stroke;
}

// Thickness of a strip perpendicular to its direction, pixels. Where the strip is steep this is less than its height.
double thickness(const Strip& strip, std::size_t i) {
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, strip.upper.size() - 1);
    const auto middle = [&](std::size_t k) { return 0.5 * (strip.upper[k].y + strip.lower[k].y); };
    const double along = strip.upper[after].x - strip.upper[before].x, up = middle(after) - middle(before);
    const double way = std::hypot(along, up);
    return way > 0.0 ? (strip.lower[i].y - strip.upper[i].y) * along / way : 0.0;
}

// Adds the parts of a tube that are visible beside its curve. The edges of a thinner tube would look like another
// curve.
void lay_strip(const Strip& strip, const Stroke& edge, double least, Sheet& sheet) {
    const std::size_t n = strip.upper.size();
    std::vector<bool> seen(n, false);
    for (std::size_t i = 0; i < n; ++i)
        if (thickness(strip, i) >= least) seen[i > 0 ? i - 1 : i] = seen[i] = seen[std::min(i + 1, n - 1)] = true;
    for (std::size_t begin = 0, end = 0; begin < n; begin = end + 1) {
        for (end = begin; end < n && seen[end];) ++end;
        if (end < begin + 2) continue;
        const auto part = [&](const std::vector<Point>& all) {
            return std::vector<Point>(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                      all.begin() + static_cast<std::ptrdiff_t>(end));
        };
        const Strip piece{part(strip.upper), part(strip.lower), strip.color, strip.clip};
        sheet.emplace_back(piece);
        for (const auto& line : {piece.upper, piece.lower}) sheet.emplace_back(Path{line, edge, strip.clip});
    }
}

// Points are clamped, because coordinates far outside the plot area would be inaccurate in single precision.
void lay_tube(const Tube& tube, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& m) {
    const double above = plot.y - 2.0 * plot.height, below = plot.y + 3.0 * plot.height, least = 1.2 * m.scale;
    Strip strip{{}, {}, tube.fill, plot};
    const auto end_strip = [&] {
        if (strip.upper.size() > 1) lay_strip(strip, {tube.edge, 0.8 * m.scale, {}}, least, sheet);
        strip.upper.clear();
        strip.lower.clear();
    };
    for (const Tube::Slice& slice : tube.slices) {
        if (!std::isfinite(slice.low + slice.high)) {
            end_strip();
            continue;
        }
        const double x = map.x(slice.x), high = map.y(slice.high), low = map.y(slice.low);
        strip.upper.push_back({x, std::isfinite(high) ? std::clamp(high, above, below) : below});
        strip.lower.push_back({x, std::isfinite(low) ? std::clamp(low, above, below) : below});
    }
    end_strip();
}

// Lines between the cells of a map would be gray noise where the cells are small. A height of 0 is not known yet.
bool has_lines_between_cells(const Panel& panel, float plot_width, float plot_height, const Metrics& m) {
    const double min_cell = 4.0 * m.scale;  // 4 points
    const Raster& raster = panel.raster;
    if (!raster.cells) return false;
    const PanelMap map(panel, {0.0F, 0.0F, plot_width, std::max(plot_height, 1.0F)});
    const double width = std::abs(map.x(raster.right) - map.x(raster.left)) / raster.cells->columns;
    const double height = std::abs(map.y(raster.top) - map.y(raster.bottom)) / raster.cells->rows;
    return width > min_cell && (height > min_cell || plot_height <= 0.0F);
}

void lay_data(const Panel& panel, Sheet& sheet, Rectangle plot, const Metrics& m) {
    const PanelMap map(panel, plot);
    lay_hatch(panel.hatch, sheet, plot, m);
    lay_raster(panel.raster, sheet, plot, map);
    lay_dots(panel.dots, sheet, plot, map, m);
    for (const Tube& tube : panel.tubes) lay_tube(tube, sheet, plot, map, m);
    for (const Markers& markers : panel.markers)
        if (markers.shape == Markers::MarkerShape::bar) lay_bars(markers, sheet, plot, map, m);
    const auto lay = [&](const Curve& curve, double min_width = 0.0) {
        Path path{{}, scaled(curve.stroke, m.scale), plot};
        path.stroke.width = std::max(path.stroke.width, min_width);
        path.points.reserve(curve.points.size());
        for (const Point& point : curve.points) path.points.push_back(map(point));
        sheet.emplace_back(std::move(path));
    };
    if (!panel.boundary.points.empty()) lay(panel.boundary, 1.0);  // a thinner line is invisible on a screen
    for (const Curve& curve : panel.beyond.curves) lay(curve);
    const bool between_cells = has_lines_between_cells(panel, plot.width, plot.height, m);
    for (const Curve& curve : panel.curves)
        if (between_cells || !curve.is_between_cells) lay(curve);
}

// Event markers are drawn above the box, so that the box does not cross out those at the end of an axis.
void lay_events(const Panel& panel, Sheet& sheet, Rectangle plot, const Metrics& m) {
    std::vector<const Markers*> all;
    for (const std::vector<Markers>& some : {std::cref(panel.beyond.markers), std::cref(panel.markers)})
        for (const Markers& markers : some)
            if (markers.shape != Markers::MarkerShape::bar) all.push_back(&markers);
    lay_markers(all, sheet, plot, PanelMap(panel, plot), m);
}

std::vector<Key> keys_of(const Panel& panel, float plot_width, float plot_height, const Metrics& m) {
    std::vector<Key> keys;
    const bool between_cells = has_lines_between_cells(panel, plot_width, plot_height, m);
    for (const Curve& curve : panel.curves)
        if (!curve.label.empty() && (between_cells || !curve.is_between_cells))
            keys.push_back({curve.label, curve.stroke});
    for (const Markers& markers : panel.markers)
        if (!markers.label.empty()) keys.push_back({markers.label, markers});
    if (!panel.hatch.label.empty() && !has_no_fill(panel)) keys.push_back({panel.hatch.label, panel.hatch});
    for (const Tube& tube : panel.tubes)
        if (!tube.label.empty()) keys.push_back({tube.label, Tube{{}, tube.fill, tube.edge, {}}});
    return keys;
}

// Draws the symbol of a legend entry in `length` pixels from x on, vertically centered at y.
void lay_sign(const Key& key, Sheet& sheet, float x, float y, float length, const Metrics& m) {
    if (const auto* stroke = std::get_if<Stroke>(&key.sign)) {
        const Rectangle around{x - m.text, y - m.text, length + 2.0F * m.text, 2.0F * m.text};
        sheet.emplace_back(Path{{{x, y}, {x + length, y}}, scaled(*stroke, m.scale), around});
        return;
    }
    if (const auto* hatch = std::get_if<Hatch>(&key.sign)) {
        const float side = std::round(0.8F * m.text);
        lay_hatched_field(*hatch, sheet,
                          {std::round(x + (length - side) / 2.0F), y - std::round(side / 2.0F), side, side}, m);
        return;
    }
    if (const auto* tube = std::get_if<Tube>(&key.sign)) {
        const double half = 0.28 * double{m.text};
        const std::vector<Point> above{{x, y - half}, {x + length, y - half}},
            below{{x, y + half}, {x + length, y + half}};
        const Rectangle around{x - m.text, y - m.text, length + 2.0F * m.text, 2.0F * m.text};
        const Stroke edge{tube->edge, 0.8 * m.scale, {}};
        sheet.emplace_back(Strip{above, below, tube->fill, around});
        for (const auto& line : {above, below}) sheet.emplace_back(Path{line, edge, around});
        return;
    }
    const Markers& markers = std::get<Markers>(key.sign);
    if (markers.shape == Markers::MarkerShape::bar)
        sheet.emplace_back(
            Fill{{std::round(x + (length - m.line) / 2.0F), y - m.text * 0.45F, m.line, m.text * 0.9F}, markers.fill});
    else
        sheet.emplace_back(mark_of(markers, {x + length / 2.0F, y}, m));
}

// Draws a legend in the corner that the panel specifies.
void lay_legend(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& m) {
    const std::vector<Key> keys = keys_of(panel, plot.width, plot.height, m);
    if (keys.empty()) return;
    const float pad = std::round(m.text * 0.45F), inset = std::round(m.text * 0.6F);
    const float room_x = plot.width - 2.0F * inset, room_y = plot.height - 2.0F * inset;
    float longest = 0.0F;
    for (const Key& key : keys) longest = std::max(longest, m.width(key.label, m.text));
    const auto rows = static_cast<float>(keys.size());
    const float wanted_x = 3.0F * pad + 2.0F * m.text + longest, wanted_y = 2.0F * pad + rows * 1.3F * m.text;
    // In a small panel the legend shrinks to save space for data while it is readable. Without enough space it is left
    // out.
    constexpr float largest_share = 0.3F, readable_pixels = 11.0F;
    const float smallest = std::clamp(readable_pixels / m.text, 0.6F, 1.0F);
    const float share = std::sqrt(largest_share * plot.width * plot.height / (wanted_x * wanted_y));
    const float zoom = std::min({1.0F, room_x / wanted_x, room_y / wanted_y, std::max(share, smallest)});
    if (zoom < smallest) return;
    const float text = m.text * zoom, row = 1.3F * text, sample = 2.0F * text;
    const Rectangle box =
        on_pixels({plot.x + inset + static_cast<float>(panel.legend_at[0]) * (room_x - wanted_x * zoom),
                   plot.y + inset + static_cast<float>(1.0 - panel.legend_at[1]) * (room_y - wanted_y * zoom),
                   wanted_x * zoom, wanted_y * zoom});
    sheet.emplace_back(Fill{box, style.grid});
    sheet.emplace_back(Fill{{box.x + m.line, box.y + m.line, box.width - 2.0F * m.line, box.height - 2.0F * m.line},
                            style.background});
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const float y = box.y + pad * zoom + (static_cast<float>(i) + 0.5F) * row;
        lay_sign(keys[i], sheet, box.x + pad * zoom, std::round(y), sample, m);
        sheet.emplace_back(
            TextRun{box.x + 2.0F * pad * zoom + sample, y - text / 2.0F, 0.0F, keys[i].label, style.ink, text});
    }
}

// Legend entries in lines: as few lines as fit, of about equal length.
struct KeyLines {
    KeyLines(const std::vector<Key>& wanted, float room, const Metrics& m) : keys(wanted), lines(fill(room, m)) {
        for (float narrower = longest() - m.text; narrower > m.text; narrower -= m.text) {
            const std::vector<Line> even = fill(narrower, m);
            if (even.size() > lines.size()) break;
            lines = even;
        }
    }
    float height(const Metrics& m) const { return static_cast<float>(lines.size()) * row(m); }
    float longest() const {
        float most = 0.0F;
        for (const Line& line : lines) most = std::max(most, line.length);
        return most;
    }
    // Draws from the top down; `anchor` 0.5: centered at x, 1: ending at x.
    void lay(Sheet& sheet, float x, float y, float anchor, const Figure& style, const Metrics& m) const {
        std::size_t next = 0;
        for (const Line& line : lines) {
            float at = std::round(x - anchor * line.length);
            for (std::size_t i = 0; i < line.count; ++i, ++next) {
                lay_sign(keys[next], sheet, at, std::round(y + row(m) / 2.0F), sign(keys[next], m), m);
                sheet.emplace_back(TextRun{at + sample(keys[next], m), y + (row(m) - m.text) / 2.0F, 0.0F,
                                           keys[next].label, style.ink, m.text});
                at += sample(keys[next], m) + m.width(keys[next].label, m.text) + between(m);
            }
            y += row(m);
        }
    }

 private:
    struct Line {
        std::size_t count;
        float length;
    };
    // Fills line by line and starts a new line when the width is used up. A single entry may be longer.
    std::vector<Line> fill(float room, const Metrics& m) const {
        std::vector<Line> filled;
        for (const Key& key : keys) {
            const float length = sample(key, m) + m.width(key.label, m.text);
            if (filled.empty() || filled.back().length + between(m) + length > room) filled.push_back({0, 0.0F});
            Line& line = filled.back();
            line.length += length + (line.count > 0 ? between(m) : 0.0F);
            ++line.count;
        }
        return filled;
    }
    static float sign(const Key& key, const Metrics& m) {
        const bool is_long = std::holds_alternative<Stroke>(key.sign) || std::holds_alternative<Tube>(key.sign);
        return std::round((is_long ? 2.2F : 0.8F) * m.text);
    }
    static float sample(const Key& key, const Metrics& m) { return sign(key, m) + std::round(0.4F * m.text); }
    static float between(const Metrics& m) { return std::round(1.4F * m.text); }
    static float row(const Metrics& m) { return std::round(1.35F * m.text); }

    std::vector<Key> keys;
    std::vector<Line> lines;
};

// Whether the title fits on the left of the legend above the plot, which ends at its right side; else the title is
// above the legend.
bool title_beside(const Panel& panel, const KeyLines& keys, float plot_width, const Metrics& m) {
    const float title = panel.title.empty() ? 0.0F : m.width(panel.title, m.text) + m.text;
    return title + keys.longest() <= plot_width;
}

float room_of_legend(const Panel& panel, float plot_width, const Metrics& m) {
    if (!panel.legend || !panel.legend_above) return 0.0F;
    const KeyLines keys(keys_of(panel, plot_width, 0.0F, m), plot_width, m);
    const float spare = title_beside(panel, keys, plot_width, m) ? m.text * 1.35F : 0.0F;
    return std::max(keys.height(m) - spare, 0.0F);
}

// Lays out a panel whose plot area is given.
Rectangle lay_at(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& room,
                 const Metrics& m) {
    Rectangle inner = with_equal_units(panel, plot);
    const float strip = strip_height(panel, inner, m);
    inner.height -= strip;
    if (style.background.a > 0) sheet.emplace_back(Fill{inner, style.background});
    lay_bands(panel, sheet, inner);
    lay_grid(panel, style, sheet, inner, m);
    lay_data(panel, sheet, inner, m);
    layout_word(panel, style, sheet, inner, m);
    float lift = 0.0F;
    if (panel.legend && panel.legend_above) {
        const KeyLines keys(keys_of(panel, inner.width, inner.height, m), inner.width, m);
        keys.lay(sheet, inner.x + inner.width, inner.y - m.gap - keys.height(m), 1.0F, style, m);
        if (!title_beside(panel, keys, inner.width, m)) lift = keys.height(m);
    }
    lay_time_bars(panel, style, sheet, inner, strip, m);
    for (const Markers& markers : panel.markers)  // a bar marker at an instant continues across the time bars
        if (strip > 0.0F && markers.shape == Markers::MarkerShape::bar)
            lay_bars(markers, sheet, {inner.x, inner.y + inner.height + m.line, inner.width, strip - m.line},
                     PanelMap(panel, inner), m);
    lay_axes(panel, style, sheet, inner, room, lift, strip, m);
    lay_color_bar(panel, style, sheet, inner, room, m);
    lay_events(panel, sheet, inner, m);
    if (panel.legend && !panel.legend_above) lay_legend(panel, style, sheet, inner, m);
    return inner;
}

Grid grid_of(const Figure& figure, Rectangle area, const Metrics& m) {
    // The first line of a legend takes the place of a title; panels in cards have space for it.
    const auto instead_of_title = [&](const Panel& panel) {
        return panel.legend && panel.legend_above && panel.title.empty() ? 0.8F * m.text + m.gap : 0.0F;
    };
    return {figure, area, m,
            [&](const Panel& panel, float width) { return room_of_legend(panel, width, m) + instead_of_title(panel); }};
}

// Reserves the lines of the figure's own legend at the top of the area.
KeyLines take_legend(const Figure& figure, Rectangle& area, const Metrics& m) {
    const KeyLines keys(figure.keys, area.width - 2.0F * m.text, m);
    // A small picture shows data rather than a legend.
    constexpr float max_of_height = 0.3F;
    if (figure.keys.empty() || keys.height(m) >= max_of_height * area.height) return KeyLines({}, area.width, m);
    const float above = std::round(m.text * 0.5F) + keys.height(m);
    area.y += above;
    area.height -= above;
    return keys;
}

}  // namespace

Sheet layout(const Figure& figure, const Measure& width, Rectangle area, double scale) {
    Sheet sheet;
    if (figure.background.a > 0) sheet.emplace_back(Fill{area, figure.background});
    if (figure.panels.empty()) return sheet;
    const Metrics m(figure, width, scale);
    const float top = area.y + std::round(m.text * 0.5F);
    take_legend(figure, area, m).lay(sheet, area.x + area.width / 2.0F, top, 0.5F, figure, m);
    const Grid grid = grid_of(figure, area, m);
    if (grid.min_side() < m.text) return sheet;  // too small for anything but labels
    for (std::size_t i = 0; i < figure.panels.size(); ++i)
        lay_at(figure.panels[i], figure, sheet, on_pixels(grid.plot(i)), grid.room(i), m);
    return sheet;
}

std::vector<PlotArea> plot_areas(const Figure& figure, const Measure& width, Rectangle area, double scale) {
    if (figure.panels.empty()) return {};
    const Metrics m(figure, width, scale);
    take_legend(figure, area, m);
    const Grid grid = grid_of(figure, area, m);
    std::vector<PlotArea> areas;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        const Rectangle place = on_pixels(grid.plot(i));
        const Rectangle plot = with_equal_units(figure.panels[i], place);
        Rectangle inner = plot;
        inner.height -= strip_height(figure.panels[i], plot, m);
        areas.push_back({plot, place, inner});
    }
    return areas;
}

Rectangle layout(const Panel& panel, const Figure& style, const Measure& width, Rectangle area, double scale,
                 Sheet& sheet) {
    const Metrics m(style, width, scale);
    Margins room = margins(panel, m);
    room.top += room_of_legend(panel, area.width - room.left - room.right, m);
    const Rectangle plot{area.x + room.left, area.y + room.top, area.width - room.left - room.right,
                         area.height - room.top - room.bottom};
    if (plot.width < m.text || plot.height < m.text) return {plot.x, plot.y, 0.0F, 0.0F};
    return lay_at(panel, style, sheet, on_pixels(plot), room, m);
}

}  // namespace achilles
