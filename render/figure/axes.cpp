#include "figure/axes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "figure/label.hpp"

namespace achilles {

namespace {

// A rectangle on whole pixels: sharp, where a smoothed line would be grey.
void bar(Sheet& sheet, float x, float y, float width, float height, Color color) {
    sheet.emplace_back(Fill{{x, y, width, height}, color});
}

float widest_label(const Axis& axis, const Metrics& m) {
    float width = 0.0F;
    for (const Tick& tick : axis.ticks) width = std::max(width, m.width(tick.label, m.text));
    return width;
}

bool has_tick_labels(const Axis& axis) {
    return axis.labelled &&
           std::any_of(axis.ticks.begin(), axis.ticks.end(), [](const Tick& tick) { return !tick.label.empty(); });
}

// How near ticks may stand, as a share of the text.
constexpr float closest_ticks = 0.38F;

// A tick with its place on the screen.
struct Placed {
    const Tick* tick;
    float at;       // the first pixel of its line
    bool labelled;  // false also where its label would touch another
};

// Of ticks with labels `length` long only every second, third, ... keeps its label, as room demands; zero does, unless it
// would be the only one: two tell the scale.
void drop_labels(std::vector<Placed>& ticks, float length) {
    std::vector<Placed*> labelled;
    for (Placed& p : ticks)
        if (p.labelled) labelled.push_back(&p);
    float nearest = std::numeric_limits<float>::infinity();
    std::size_t zero = 0;
    for (std::size_t i = 0; i < labelled.size(); ++i) {
        if (i > 0) nearest = std::min(nearest, std::abs(labelled[i]->at - labelled[i - 1]->at));
        if (labelled[i]->tick->value == 0.0) zero = i;
    }
    const auto every = static_cast<std::size_t>(std::clamp(std::ceil(length / std::max(nearest, 1.0F)), 1.0F,
                                                           std::max(static_cast<float>(labelled.size()), 1.0F)));
    std::size_t first = zero % every;
    if (first + every >= labelled.size() && every < labelled.size()) first = 0;
    for (std::size_t i = 0; i < labelled.size(); ++i) labelled[i]->labelled = i % every == first;
}

// Ticks without labels go where they would be a comb.
void drop_minor(std::vector<Placed>& ticks, float closest) {
    bool crowded = false;
    for (std::size_t i = 1; i < ticks.size(); ++i)
        crowded = crowded || (ticks[i].at - ticks[i - 1].at < closest && ticks[i - 1].at - ticks[i].at < closest);
    if (!crowded) return;
    std::erase_if(ticks, [](const Placed& p) { return p.tick->label.empty(); });
}

// The ticks within the plot's side, which runs from `from` to `to` in pixels.
// `length`: of the labels along the axis. `closest`: how near ticks may be. No label stands beyond `last`.
std::vector<Placed> placed(const Axis& axis, const AxisMap& map, float from, float to, float line, float length,
                           float closest, float last = std::numeric_limits<float>::infinity()) {
    std::vector<Placed> result;
    for (const Tick& tick : axis.ticks) {
        const double at = map(tick.value);
        if (!(at >= from - 0.5 && at <= to + 0.5)) continue;
        // Next to a corner a tick continues the box, rather than lie beside its line.
        const auto first = static_cast<float>(std::round(at - line / 2.0));
        const float snapped = first < from + line ? from - line : first > to - 2.0F * line ? to : first;
        result.push_back({&tick, snapped, !tick.label.empty() && snapped <= last});
    }
    drop_labels(result, length);
    drop_minor(result, closest);
    return result;
}

std::vector<Placed> ticks_x(const Panel& panel, Rectangle plot, const Metrics& m) {
    return placed(panel.x, PanelMap(panel, plot).x, plot.x, plot.x + plot.width, m.line,
                  widest_label(panel.x, m) + m.text * 0.7F, m.text * closest_ticks);
}

// Above time bars the lowest numbers keep clear of the first name.
std::vector<Placed> ticks_y(const Panel& panel, Rectangle plot, const Metrics& m) {
    const float bottom = plot.y + plot.height;
    return placed(panel.y, PanelMap(panel, plot).y, plot.y, bottom, m.line, m.text * 1.2F, m.text * closest_ticks,
                  panel.time_bars.empty() ? bottom + m.text : bottom - 0.35F * m.text);
}

// Of the names of time bars: smaller than what is on the axes.
float name_size(const Metrics& m) { return std::max(std::round(0.9F * m.text), m.smallest_text); }

// Long ones are cut: the plot is what the room is for.
std::string bar_name(const TimeBar& one, const Metrics& m) {
    const float most = 6.0F * m.text;
    return shortened(one.label, [&](const std::string& label) { return m.width(label, name_size(m)) <= most; });
}

float widest_name(const Panel& panel, const Metrics& m) {
    float width = 0.0F;
    for (const TimeBar& one : panel.time_bars) width = std::max(width, m.width(bar_name(one, m), name_size(m)));
    return width;
}

// Of the colours of numbers, and from the box to them.
float bar_width(const Metrics& m) { return std::round(1.1F * m.text); }
float bar_distance(const Metrics& m) { return std::round(1.1F * m.text); }

// A label that is at most `room` long.
struct Fitted {
    std::string label;
    float size;
};

// Smaller, if need be: the size of indices, for which there are letters, and other sizes, for which letters are
// stretched, only below it. What is too long at the smallest size is shortened.
Fitted fitting(const std::string& label, const Metrics& m, float room) {
    const float width = m.width(label, m.text), small = std::round(m.text * script_size);
    if (width <= room) return {label, m.text};
    if (small >= m.smallest_text && m.width(label, small) <= room) return {label, small};
    const float size = std::max(m.text * room / width, m.smallest_text);
    return {shortened(label, [&](const std::string& text) { return m.width(text, size) <= room; }), size};
}

void lay_x(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& room, float strip,
           const Metrics& m) {
    const float bottom = plot.y + plot.height + strip + m.line;
    const float below = bottom + m.tick + m.gap;
    for (const Placed& p : ticks_x(panel, plot, m)) {
        bar(sheet, p.at, bottom, m.line, p.labelled ? m.tick : m.minor_tick, style.ink);
        if (p.labelled && panel.x.labelled)
            sheet.emplace_back(TextRun{p.at + m.line / 2.0F, below, 0.5F, p.tick->label, style.ink, m.text});
    }
    if (panel.x.label.empty() || !panel.x.labelled) return;
    const auto [label, size] = fitting(panel.x.label, m, plot.width + room.left + room.right);
    const float half = m.width(label, size) / 2.0F;
    // Centred below the plot, but never beyond the panel.
    const float least = plot.x - room.left + half, most = plot.x + plot.width + room.right - half;
    const float at = std::clamp(plot.x + plot.width / 2.0F, least, std::max(most, least));
    sheet.emplace_back(
        TextRun{at, plot.y + plot.height + strip + room.bottom - m.text * 1.1F, 0.5F, label, style.ink, size});
}

void lay_y(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& room, float strip,
           const Metrics& m) {
    const float left = plot.x - m.line;
    for (const Placed& p : ticks_y(panel, plot, m)) {
        const float length = p.labelled ? m.tick : m.minor_tick;
        bar(sheet, left - length, p.at, length, m.line, style.ink);
        // Digits have no descenders: their middle is a little above the middle of the line.
        if (p.labelled && panel.y.labelled)
            sheet.emplace_back(TextRun{left - m.tick - m.gap, p.at - m.text * 0.52F + m.line / 2.0F, 1.0F,
                                       p.tick->label, style.ink, m.text});
    }
    if (panel.y.label.empty() || !panel.y.labelled) return;
    const auto [label, size] = fitting(panel.y.label, m, plot.height + strip + room.top);
    const float half = m.width(label, size) / 2.0F;
    // It ends above the line of the x axis' label.
    const bool above = panel.x.label.empty() || !panel.x.labelled;
    const float lowest = plot.y + plot.height + strip + room.bottom - (above ? 0.0F : m.text * 1.3F) - half;
    const float at = std::clamp(plot.y + plot.height / 2.0F, std::min(plot.y - room.top + half, lowest), lowest);
    sheet.emplace_back(TextRun{plot.x - room.left, at, 0.5F, label, style.ink, size, true});
}

}  // namespace

Metrics::Metrics(const Figure& style, const Measure& measure, double scale_)
    : width(measure),
      text(static_cast<float>(std::round(style.text_size * scale_))),
      smallest_text(text * static_cast<float>(style.smallest_text)),
      tick(static_cast<float>(std::round(5.0 * scale_))),
      minor_tick(static_cast<float>(std::round(3.0 * scale_))),
      gap(static_cast<float>(std::round(3.0 * scale_))),
      line(static_cast<float>(std::max(std::round(scale_), 1.0))),
      scale(scale_) {}

Margins margins(const Panel& panel, const Metrics& m) {
    Margins room;
    room.left = m.line + m.tick;
    const float widest = std::max(has_tick_labels(panel.y) ? widest_label(panel.y, m) : 0.0F, widest_name(panel, m));
    if (has_tick_labels(panel.y) || !panel.time_bars.empty()) room.left += m.gap + widest;
    if (!panel.y.label.empty() && panel.y.labelled) room.left += m.text * 1.1F + 2.0F * m.gap;
    room.bottom = m.line + m.tick;
    if (has_tick_labels(panel.x)) room.bottom += m.gap + m.text;
    if (!panel.x.label.empty() && panel.x.labelled) room.bottom += m.text * 1.1F + m.gap;
    // The outermost labels stand out by half their size.
    room.right = std::max(widest_label(panel.x, m) / 2.0F, m.line);
    room.left = std::max(room.left, room.right);
    if (!panel.color_bar.colors.empty()) {
        const Axis& bar_axis = panel.color_bar.axis;
        room.right =
            std::max(room.right, bar_distance(m) + bar_width(m) + m.line + m.tick + m.gap + widest_label(bar_axis, m) +
                                     m.gap + (bar_axis.label.empty() ? 0.0F : m.text * 1.1F + m.gap));
    }
    room.top = panel.title.empty() ? m.text * 0.55F : m.text * 1.45F;
    room.bottom = std::max(room.bottom, m.text * 0.55F);
    return {std::ceil(room.left), std::ceil(room.right), std::ceil(room.top), std::ceil(room.bottom)};
}

Margins both(const Margins& a, const Margins& b) {
    return {std::max(a.left, b.left), std::max(a.right, b.right), std::max(a.top, b.top), std::max(a.bottom, b.bottom)};
}

AxisMap::AxisMap(const Axis& axis, double from, double to) : logarithmic_(axis.logarithmic), from_(from) {
    low_ = logarithmic_ ? std::log10(axis.low) : axis.low;
    factor_ = (to - from) / ((logarithmic_ ? std::log10(axis.high) : axis.high) - low_);
}

double AxisMap::operator()(double value) const {
    return from_ + ((logarithmic_ ? std::log10(value) : value) - low_) * factor_;
}

double AxisMap::value(double pixel) const {
    const double value = low_ + (pixel - from_) / factor_;
    return logarithmic_ ? std::pow(10.0, value) : value;
}

PanelMap::PanelMap(const Panel& panel, Rectangle plot)
    : x(panel.x, plot.x, double{plot.x} + plot.width), y(panel.y, double{plot.y} + plot.height, plot.y) {}

void lay_grid(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& m) {
    if (style.grid.a == 0) return;
    // Not beside the box, which has lines of its own.
    for (const Placed& p : ticks_x(panel, plot, m))
        if (p.labelled && p.at >= plot.x && p.at < plot.x + plot.width)
            bar(sheet, p.at, plot.y, m.line, plot.height, style.grid);
    for (const Placed& p : ticks_y(panel, plot, m))
        if (p.labelled && p.at >= plot.y && p.at < plot.y + plot.height)
            bar(sheet, plot.x, p.at, plot.width, m.line, style.grid);
}

void lay_color_bar(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& room,
                   const Metrics& m) {
    const ColorBar& colors = panel.color_bar;
    if (colors.colors.empty()) return;
    const Rectangle area{plot.x + plot.width + m.line + bar_distance(m), plot.y, bar_width(m), plot.height};
    bar(sheet, area.x - m.line, area.y - m.line, area.width + 2.0F * m.line, area.height + 2.0F * m.line, style.ink);
    auto cells = std::make_shared<Cells>(Cells{1, static_cast<int>(colors.colors.size()), colors.colors});
    std::reverse(cells->colors.begin(), cells->colors.end());
    sheet.emplace_back(Tiles{area, area, std::move(cells)});
    Panel beside;
    beside.y = colors.axis;
    const float right = area.x + area.width + m.line;
    for (const Placed& p : ticks_y(beside, area, m)) {
        bar(sheet, right, p.at, p.labelled ? m.tick : m.minor_tick, m.line, style.ink);
        if (p.labelled)
            sheet.emplace_back(TextRun{right + m.tick + m.gap, p.at - m.text * 0.52F + m.line / 2.0F, 0.0F,
                                       p.tick->label, style.ink, m.text});
    }
    if (colors.axis.label.empty()) return;
    const auto [label, size] = fitting(colors.axis.label, m, plot.height + room.top + room.bottom);
    const float half = m.width(label, size) / 2.0F;
    const float lowest = plot.y + plot.height + room.bottom - half;
    const float at = std::clamp(plot.y + plot.height / 2.0F, std::min(plot.y - room.top + half, lowest), lowest);
    sheet.emplace_back(
        TextRun{plot.x + plot.width + room.right - m.text * 1.1F, at, 0.5F, label, style.ink, size, true});
}

float strip_height(const Panel& panel, Rectangle area, const Metrics& m) {
    if (panel.time_bars.empty()) return 0.0F;
    constexpr float most = 0.4F;  // of the area
    const auto count = static_cast<float>(panel.time_bars.size());
    const float row = std::min(std::round(1.1F * name_size(m)), std::floor(most * area.height / count));
    return row < 2.0F * m.line ? 0.0F : count * row + 3.0F * m.line;
}

void lay_time_bars(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, float strip,
                   const Metrics& m) {
    if (!(strip > 0.0F)) return;
    const AxisMap map = PanelMap(panel, plot).x;
    const float left = plot.x, right = plot.x + plot.width, size = name_size(m);
    const float row = (strip - 3.0F * m.line) / static_cast<float>(panel.time_bars.size());
    const float thick = std::max(std::round(0.55F * row), m.line);
    const auto place = [&](double value) {  // what has no place on a logarithmic axis is left of it
        const double at = map(value);
        return std::round(at >= left ? static_cast<float>(std::min(at, double{right})) : left);
    };
    float y = plot.y + plot.height + 2.0F * m.line;
    if (style.background.a > 0) bar(sheet, left, y - m.line, plot.width, strip - m.line, style.background);
    for (const TimeBar& one : panel.time_bars) {
        const float top = std::round(y + 0.5F * (row - thick));
        for (const TimeBar::Mark& mark : one.marks) {
            if (mark.high < panel.x.low || mark.low > panel.x.high) continue;
            const float from = place(mark.low), to = place(mark.high);
            if (mark.high > mark.low)
                bar(sheet, from, top, std::max(to - from, m.line), thick, mark.color);
            else
                bar(sheet, std::clamp(std::round(from - 0.5F * m.line), left, right - m.line), top, m.line, thick,
                    mark.color);
        }
        if (row >= 0.75F * size)
            sheet.emplace_back(TextRun{left - m.line - m.tick - m.gap, y + 0.5F * (row - size), 1.0F, bar_name(one, m),
                                       style.ink, size});
        y += row;
    }
}

void lay_axes(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& room, float lift,
              float strip, const Metrics& m) {
    const float width = plot.width + 2.0F * m.line;
    bar(sheet, plot.x - m.line, plot.y - m.line, width, m.line, style.ink);
    bar(sheet, plot.x - m.line, plot.y + plot.height, width, m.line, style.ink);
    if (strip > 0.0F) bar(sheet, plot.x - m.line, plot.y + plot.height + strip, width, m.line, style.ink);
    bar(sheet, plot.x - m.line, plot.y, m.line, plot.height + strip, style.ink);
    bar(sheet, plot.x + plot.width, plot.y, m.line, plot.height + strip, style.ink);
    lay_x(panel, style, sheet, plot, room, strip, m);
    lay_y(panel, style, sheet, plot, room, strip, m);
    if (panel.title.empty()) return;
    const auto [title, size] = fitting(panel.title, m, plot.width + room.right);
    sheet.emplace_back(TextRun{plot.x - m.line, plot.y - m.line - m.gap - m.text - lift, 0.0F, title, style.ink, size});
}

}  // namespace achilles
