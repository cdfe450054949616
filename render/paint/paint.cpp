#include "paint/paint.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "paint/axes.hpp"
#include "paint/label.hpp"
#include "paint/marker.hpp"
#include "surface/curves.hpp"
#include "surface/polyline.hpp"

namespace achilles {

namespace {

ImU32 packed(Color c) { return IM_COL32(c.r, c.g, c.b, c.a); }

Rectangle on_pixels(Rectangle r) {
    const float x = std::round(r.x), y = std::round(r.y);
    return {x, y, std::max(std::round(r.x + r.width) - x, 1.0F), std::max(std::round(r.y + r.height) - y, 1.0F)};
}

// Shrinks the plot area until one unit is the same length on both axes; its middle stays.
Rectangle with_equal_units(const Panel& panel, Rectangle plot) {
    const double wide = panel.x.high - panel.x.low, high = panel.y.high - panel.y.low;
    const double unit = std::min(plot.width / wide, plot.height / high);
    if (!panel.equal_axes || !(unit > 0.0) || !std::isfinite(unit) || !std::isfinite(high)) return plot;
    const auto width = static_cast<float>(unit * wide), height = static_cast<float>(unit * high);
    return on_pixels({plot.x + (plot.width - width) / 2.0F, plot.y + (plot.height - height) / 2.0F, width, height});
}

void paint_bars(const Markers& markers, ImDrawList* list, Rectangle plot, const PanelMap& map, const Metrics& m) {
    for (const Point& point : markers.points) {
        const double x = map.x(point.x);
        if (!(x >= plot.x && x <= plot.x + plot.width)) continue;
        const float at = static_cast<float>(std::round(x - m.line / 2.0));
        list->AddRectFilled({at, plot.y}, {at + m.line, plot.y + plot.height}, packed(markers.fill));
    }
}

void paint_markers(const Markers& markers, ImDrawList* list, Rectangle plot, const PanelMap& map, const Metrics& m) {
    Point last{std::numeric_limits<double>::infinity(), 0.0};
    for (const Point& point : markers.points) {
        const Point at = map(point);
        // Whole or not at all: half a marker at the rim would be another shape.
        if (!(at.x >= plot.x && at.x <= plot.x + plot.width && at.y >= plot.y && at.y <= plot.y + plot.height))
            continue;
        // Impacts crowd before a Zeno point; what would cover the last one exactly is not drawn again.
        if (std::hypot(at.x - last.x, at.y - last.y) < 0.05) continue;
        paint_marker(list, markers, at, m.scale);
        last = at;
    }
}

void paint_data(const Panel& panel, ImDrawList* list, Rectangle plot, const Metrics& m) {
    const PanelMap map(panel, plot);
    for (const Markers& markers : panel.markers)
        if (markers.shape == Markers::Shape::bar) paint_bars(markers, list, plot, map, m);
    list->PushClipRect({plot.x, plot.y}, {plot.x + plot.width, plot.y + plot.height}, true);
    std::vector<Point> pixels;
    for (const Curve& curve : panel.curves) {
        pixels.clear();
        for (const Point& point : curve.points) pixels.push_back(map(point));
        add_curve(list, pixels, screen_stroke(curve.stroke, m.scale));
    }
    list->PopClipRect();
    for (const Markers& markers : panel.markers)
        if (markers.shape != Markers::Shape::bar) paint_markers(markers, list, plot, map, m);
}

struct Entry {
    const std::string* label;
    const Curve* curve;
    const Markers* markers;
};

std::vector<Entry> legend_entries(const Panel& panel) {
    std::vector<Entry> entries;
    for (const Curve& curve : panel.curves)
        if (!curve.label.empty()) entries.push_back({&curve.label, &curve, nullptr});
    for (const Markers& markers : panel.markers)
        if (!markers.label.empty()) entries.push_back({&markers.label, nullptr, &markers});
    return entries;
}

void paint_sample(const Entry& entry, ImDrawList* list, float x, float y, float length, const Metrics& m) {
    if (entry.curve != nullptr) {
        add_curve(list, {{x, y}, {x + length, y}}, screen_stroke(entry.curve->stroke, m.scale));
    } else if (entry.markers->shape == Markers::Shape::bar) {
        const float at = std::round(x + (length - m.line) / 2.0F);
        list->AddRectFilled({at, y - m.text * 0.45F}, {at + m.line, y + m.text * 0.45F}, packed(entry.markers->fill));
    } else {
        paint_marker(list, *entry.markers, {x + length / 2.0F, y}, m.scale);
    }
}

void paint_legend(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle plot, const Metrics& m) {
    const std::vector<Entry> entries = legend_entries(panel);
    if (entries.empty()) return;
    const float pad = std::round(m.text * 0.45F), inset = std::round(m.text * 0.6F);
    const float room_x = plot.width - 2.0F * inset, room_y = plot.height - 2.0F * inset;
    float longest = 0.0F;
    for (const Entry& entry : entries) longest = std::max(longest, label_width(*entry.label, m.text));
    const auto rows = static_cast<float>(entries.size());
    const float wanted_x = 3.0F * pad + 2.0F * m.text + longest, wanted_y = 2.0F * pad + rows * 1.3F * m.text;
    // In a small panel the legend shrinks rather than hide the data, as long as it can be read; without room it goes.
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
    list->AddRectFilled({box.x, box.y}, {box.x + box.width, box.y + box.height}, packed(style.grid));
    list->AddRectFilled({box.x + m.line, box.y + m.line}, {box.x + box.width - m.line, box.y + box.height - m.line},
                        packed(style.background));
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const float y = box.y + pad * zoom + (static_cast<float>(i) + 0.5F) * row;
        paint_sample(entries[i], list, box.x + pad * zoom, std::round(y), sample, m);
        paint_label(list, box.x + 2.0F * pad * zoom + sample, y - text / 2.0F, *entries[i].label, style.ink, text);
    }
}

// The panel with its plot area given.
Rectangle paint_at(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle plot, const Margins& room,
                   const Metrics& m) {
    const Rectangle inner = with_equal_units(panel, plot);
    list->AddRectFilled({inner.x, inner.y}, {inner.x + inner.width, inner.y + inner.height}, packed(style.background));
    paint_grid(panel, style, list, inner, m);
    paint_data(panel, list, inner, m);
    paint_axes(panel, style, list, inner, room, m);
    if (panel.legend) paint_legend(panel, style, list, inner, m);
    return inner;
}

// Where the plot areas of a figure go: all of one size, in line, with the room the fullest panel of each column and row
// needs.
struct Grid {
    Grid(const Figure& figure, Rectangle area, const Metrics& m) {
        const auto columns = static_cast<std::size_t>(std::max(figure.columns, 1));
        const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
        across.resize(columns);
        down.resize(rows);
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            const Margins room = margins(figure.panels[i], m);
            across[i % columns] = both(across[i % columns], room);
            down[i / columns] = both(down[i / columns], room);
        }
        const float pad = std::round(m.text * 0.7F), between = m.text;
        float width = area.width - 2.0F * pad - between * static_cast<float>(columns - 1);
        float height = area.height - 2.0F * pad - between * static_cast<float>(rows - 1);
        for (const Margins& room : across) width -= room.left + room.right;
        for (const Margins& room : down) height -= room.top + room.bottom;
        width = std::floor(width / static_cast<float>(columns));
        height = std::floor(height / static_cast<float>(rows));
        float x = area.x + pad, y = area.y + pad;
        for (const Margins& room : across) {
            xs.push_back(x + room.left);
            x += room.left + width + room.right + between;
        }
        for (const Margins& room : down) {
            ys.push_back(y + room.top);
            y += room.top + height + room.bottom + between;
        }
        size = {0.0F, 0.0F, width, height};
    }
    std::vector<Margins> across, down;  // of columns, left and right count; of rows, top and bottom
    std::vector<float> xs, ys;
    Rectangle size;
};

}  // namespace

void paint(const Figure& figure, ImDrawList* list, Rectangle area, double scale) {
    list->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height}, packed(figure.background));
    if (figure.panels.empty()) return;
    const Metrics m(figure, scale);
    const Grid grid(figure, area, m);
    // Too small for anything but labels.
    if (grid.size.width < m.text || grid.size.height < m.text) return;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        const std::size_t column = i % grid.xs.size(), row = i / grid.xs.size();
        const Margins room{grid.across[column].left, grid.across[column].right, grid.down[row].top,
                           grid.down[row].bottom};
        paint_at(figure.panels[i], figure, list,
                 on_pixels({grid.xs[column], grid.ys[row], grid.size.width, grid.size.height}), room, m);
    }
}

Rectangle paint(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle area, double scale) {
    const Metrics m(style, scale);
    const Margins room = margins(panel, m);
    const Rectangle plot{area.x + room.left, area.y + room.top, area.width - room.left - room.right,
                         area.height - room.top - room.bottom};
    if (plot.width < m.text || plot.height < m.text) return {plot.x, plot.y, 0.0F, 0.0F};
    return paint_at(panel, style, list, on_pixels(plot), room, m);
}

}  // namespace achilles
