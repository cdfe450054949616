#include "figure/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "figure/label.hpp"

namespace achilles {

namespace {

struct TickStep {
    double size = 1.0;
    int minor = 5;  // number of intervals between two ticks that minor ticks mark
};

// The smallest step 1, 2 or 5 times a power of ten with at most `most` multiples between the limits.
TickStep nice_step(double low, double high, int most) {
    const double slack = 1e-9 * (high - low);
    double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));
    for (;; power *= 10.0) {
        for (const TickStep& step : {TickStep{power, 5}, TickStep{2.0 * power, 4}, TickStep{5.0 * power, 5}}) {
            const double first = std::ceil((low - slack) / step.size), last = std::floor((high + slack) / step.size);
            if (last - first + 1.0 <= most) return step;
        }
    }
}

// i * step without the rounding error of the product: 3 * 0.1 is 0.3.
double multiple(double i, double step) {
    if (step >= 1.0) return i * step;
    return i / std::round(1.0 / step);
}

std::string superscript(int exponent) {
    const char* digits[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                            "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string text = exponent < 0 ? "\u207B" : "";
    for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
    return text;
}

std::string with_minus(std::string text) {
    if (text[0] != '-') return text;
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    return zero ? text.substr(1) : "\u2212" + text.substr(1);
}

int decimals_of(double step) { return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9))); }

}  // namespace

std::string power_of_ten(int exponent) { return "10" + superscript(exponent); }

std::string tick_label(double value, double step, double largest) {
    const double size = std::max({std::abs(value), step, largest});
    if (size < 1e6 && (step >= 1e-4 || size >= 1e-2))
        return with_minus(fmt::format("{:.{}f}", value, decimals_of(step)));
    if (value == 0.0) return "0";
    const double scale = std::max(std::abs(value), largest);
    const int finest = static_cast<int>(std::floor(std::log10(step) + 1e-9));
    int exponent = static_cast<int>(std::floor(std::log10(scale) + 1e-12));
    // 2, 4, ... 10 times a power reads better than 0.2, 0.4, ... 1.0 times the next power.
    if (exponent == finest + 1) exponent = finest;
    const double mantissa = value / std::pow(10.0, exponent);
    const int decimals = std::max(0, exponent - finest);
    return with_minus(fmt::format("{:.{}f}", mantissa, std::min(decimals, 12))) + "\u00D710" + superscript(exponent);
}

namespace {

// 10^exponent, accurate to rounding.
double decade(int exponent) { return std::pow(10.0, exponent); }

void set_linear(Axis& axis, double low, double high, double margin, int most) {
    // Beyond these magnitudes the width of the range or a step would overflow or underflow.
    low = std::clamp(low, -1e300, 1e300);
    high = std::clamp(high, -1e300, 1e300);
    // A range below the resolution of its numbers is a constant. It is widened so that it shows as one.
    const double size = std::max(std::abs(low), std::abs(high));
    double room = margin * (high - low);
    if (high - low <= std::max(1e-9 * size, 1e-300)) room = size > 1e-290 ? 0.1 * size : 1.0;
    axis.low = low -= room;
    axis.high = high += room;
    const TickStep step = nice_step(low, high, most);
    const double minor = step.size / step.minor, slack = 1e-9 * (high - low);
    const double first = std::ceil((low - slack) / step.size), last = std::floor((high + slack) / step.size);
    const double largest = step.size * std::max(std::abs(first), std::abs(last));
    for (double i = std::ceil((low - slack) / minor); i * minor <= high + slack; ++i) {
        const bool major = std::fmod(std::abs(i), step.minor) == 0.0;
        const double value = major ? multiple(i / step.minor, step.size) : i * minor;
        axis.ticks.push_back({value, major ? tick_label(value, step.size, largest) : ""});
    }
}

// Label of 10^exponent, written out if `plain`.
std::string decade_label(int exponent, bool plain) {
    if (plain) return fmt::format("{:.{}f}", decade(exponent), std::max(0, -exponent));
    return power_of_ten(exponent);
}

// Ticks at powers of ten, every k-th one labeled, with minor ticks at 2 to 9 times each. If there are few powers of
// ten, 2 and 5 are labeled too.
void set_decades(Axis& axis, int first, int last, int most) {
    const double least = axis.low * (1.0 - 1e-12), greatest = axis.high * (1.0 + 1e-12);
    const auto inside = [&](double value) { return value >= least && value <= greatest; };
    const auto at = [](int digit, int k) { return k < 0 ? digit / decade(-k) : digit * decade(k); };
    const int every = std::max(1, static_cast<int>(std::ceil(static_cast<double>(last - first + 1) / most)));
    int fine = 0;
    for (int k = first; k <= last; ++k)
        for (const int digit : {1, 2, 5}) fine += inside(at(digit, k)) ? 1 : 0;
    const bool plain = first >= -4 && last <= 5;
    for (int k = first; k <= last; ++k) {
        for (int digit = 1; digit <= (every > 1 ? 1 : 9); ++digit) {
            if (!inside(at(digit, k))) continue;
            std::string label;
            if (digit == 1 && k % every == 0) label = decade_label(k, plain);
            if (fine <= most && (digit == 2 || digit == 5)) label = tick_label(at(digit, k), decade(k));
            axis.ticks.push_back({at(digit, k), label});
        }
    }
}

void set_logarithmic(Axis& axis, double low, double high, double margin, int most) {
    high = high > 1e-290 ? std::min(high, 1e300) : 1.0;
    // Values that are not positive cannot be shown on this axis.
    low = low > 0.0 ? std::clamp(low, std::min(1e-300, high), high) : 1e-6 * high;
    double from = std::log10(low), to = std::log10(high);
    const double room = to - from < 1e-9 ? 0.5 : margin * (to - from);
    from -= room;
    to += room;
    axis.low = room == 0.0 ? low : std::pow(10.0, from);
    axis.high = room == 0.0 ? high : std::pow(10.0, to);
    set_decades(axis, static_cast<int>(std::floor(from)), static_cast<int>(std::ceil(to)), most);
    const auto labels =
        std::count_if(axis.ticks.begin(), axis.ticks.end(), [](const Tick& t) { return !t.label.empty(); });
    if (labels >= 2) return;
    // A range of less than a factor of about three gets the ticks of a linear axis.
    Axis linear;
    set_linear(linear, axis.low, axis.high, 0.0, most);
    axis.ticks = linear.ticks;
}

}  // namespace

void set_ticks(Axis& axis, double low, double high, double margin, int most) {
    if (!std::isfinite(low) || !std::isfinite(high) || low > high) low = 0.0, high = 1.0;
    most = std::max(2, most);
    axis.ticks.clear();
    if (axis.logarithmic)
        set_logarithmic(axis, low, high, margin, most);
    else
        set_linear(axis, low, high, margin, most);
}

// ---- room and strokes ----

namespace {

// A rectangle on whole pixels. It is sharp, while an anti-aliased line would be gray.
void bar(Sheet& sheet, float x, float y, float width, float height, Color color) {
    sheet.emplace_back(Fill{{x, y, width, height}, color});
}

float widest_label(const Axis& axis, const Metrics& m) {
    float width = 0.0F;
    for (const Tick& tick : axis.ticks) width = std::max(width, m.width(tick.label, m.text));
    return width;
}

bool has_tick_labels(const Axis& axis) {
    return axis.labeled &&
           std::any_of(axis.ticks.begin(), axis.ticks.end(), [](const Tick& tick) { return !tick.label.empty(); });
}

// Minimum distance between ticks, as a fraction of the text size.
constexpr float closest_ticks = 0.38F;

// A tick with its position on the screen, pixels.
struct PlacedTick {
    const Tick* tick;
    float at;      // the first pixel of its line
    bool labeled;  // false also if its label would touch another one
};

// Drops labels so that only every second, third, ... tick keeps its label, if labels of this length need it. Zero keeps
// its label, unless it would be the only one: a scale needs two.
void drop_labels(std::vector<PlacedTick>& ticks, float length) {
    std::vector<PlacedTick*> labeled;
    for (PlacedTick& p : ticks)
        if (p.labeled) labeled.push_back(&p);
    float nearest = std::numeric_limits<float>::infinity();
    std::size_t zero = 0;
    for (std::size_t i = 0; i < labeled.size(); ++i) {
        if (i > 0) nearest = std::min(nearest, std::abs(labeled[i]->at - labeled[i - 1]->at));
        if (labeled[i]->tick->value == 0.0) zero = i;
    }
    const auto every = static_cast<std::size_t>(std::clamp(std::ceil(length / std::max(nearest, 1.0F)), 1.0F,
                                                           std::max(static_cast<float>(labeled.size()), 1.0F)));
    std::size_t first = zero % every;
    if (first + every >= labeled.size() && every < labeled.size()) first = 0;
    for (std::size_t i = 0; i < labeled.size(); ++i) labeled[i]->labeled = i % every == first;
}

// Drops ticks without labels if they are too dense.
void drop_minor(std::vector<PlacedTick>& ticks, float closest) {
    bool crowded = false;
    for (std::size_t i = 1; i < ticks.size(); ++i)
        crowded = crowded || (ticks[i].at - ticks[i - 1].at < closest && ticks[i - 1].at - ticks[i].at < closest);
    if (!crowded) return;
    std::erase_if(ticks, [](const PlacedTick& p) { return p.tick->label.empty(); });
}

// The ticks within the side of the plot from `from` to `to`, pixels. `length`: of labels along the axis. `closest`:
// minimum distance between ticks. No label lies beyond `last`.
std::vector<PlacedTick> placed(const Axis& axis, const AxisMap& map, float from, float to, float line, float length,
                               float closest, float last = std::numeric_limits<float>::infinity()) {
    std::vector<PlacedTick> result;
    for (const Tick& tick : axis.ticks) {
        const double at = map(tick.value);
        if (!(at >= from - 0.5 && at <= to + 0.5)) continue;
        // Near a corner a tick continues the line of the box instead of lying beside it.
        const auto first = static_cast<float>(std::round(at - line / 2.0));
        const float snapped = first < from + line ? from - line : first > to - 2.0F * line ? to : first;
        result.push_back({&tick, snapped, !tick.label.empty() && snapped <= last});
    }
    drop_labels(result, length);
    drop_minor(result, closest);
    return result;
}

std::vector<PlacedTick> ticks_x(const Panel& panel, Rectangle plot, const Metrics& m) {
    return placed(panel.x, PanelMap(panel, plot).x, plot.x, plot.x + plot.width, m.line,
                  widest_label(panel.x, m) + m.text * 0.7F, m.text * closest_ticks);
}

// Above time bars, the lowest labels must not touch the first name.
std::vector<PlacedTick> ticks_y(const Panel& panel, Rectangle plot, const Metrics& m) {
    const float bottom = plot.y + plot.height;
    return placed(panel.y, PanelMap(panel, plot).y, plot.y, bottom, m.line, m.text * 1.2F, m.text * closest_ticks,
                  panel.time_bars.empty() ? bottom + m.text : bottom - 0.35F * m.text);
}

// Text size of the names of time bars, smaller than on the axes.
float name_size(const Metrics& m) { return std::max(std::round(0.9F * m.text), m.smallest_text); }

// Long names are shortened so that the plot keeps its width.
std::string bar_name(const TimeBar& one, const Metrics& m) {
    const float most = 6.0F * m.text;
    return shortened(one.label, [&](const std::string& label) { return m.width(label, name_size(m)) <= most; });
}

float widest_name(const Panel& panel, const Metrics& m) {
    float width = 0.0F;
    for (const TimeBar& one : panel.time_bars) width = std::max(width, m.width(bar_name(one, m), name_size(m)));
    return width;
}

// Width of the color scale, and its distance from the box.
float bar_width(const Metrics& m) { return std::round(1.1F * m.text); }
float bar_distance(const Metrics& m) { return std::round(1.1F * m.text); }

// A label shortened or shrunk to a given length.
struct FittedLabel {
    std::string label;
    float size;
};

// Fits a label into `room` pixels. First it shrinks to the size of subscripts, which the font has; only below that to
// other sizes, for which glyphs are scaled. At the minimum size it is shortened.
FittedLabel fitting(const std::string& label, const Metrics& m, float room) {
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
    for (const PlacedTick& p : ticks_x(panel, plot, m)) {
        bar(sheet, p.at, bottom, m.line, p.labeled ? m.tick : m.minor_tick, style.ink);
        if (p.labeled && panel.x.labeled)
            sheet.emplace_back(TextRun{p.at + m.line / 2.0F, below, 0.5F, p.tick->label, style.ink, m.text});
    }
    if (panel.x.label.empty() || !panel.x.labeled) return;
    const auto [label, size] = fitting(panel.x.label, m, plot.width + room.left + room.right);
    const float half = m.width(label, size) / 2.0F;
    // Centered below the plot, but within the panel.
    const float least = plot.x - room.left + half, most = plot.x + plot.width + room.right - half;
    const float at = std::clamp(plot.x + plot.width / 2.0F, least, std::max(most, least));
    sheet.emplace_back(
        TextRun{at, plot.y + plot.height + strip + room.bottom - m.text * 1.1F, 0.5F, label, style.ink, size});
}

void lay_y(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& room, float strip,
           const Metrics& m) {
    const float left = plot.x - m.line;
    for (const PlacedTick& p : ticks_y(panel, plot, m)) {
        const float length = p.labeled ? m.tick : m.minor_tick;
        bar(sheet, left - length, p.at, length, m.line, style.ink);
        // Digits have no descenders, so that their center is slightly above the center of the line.
        if (p.labeled && panel.y.labeled)
            sheet.emplace_back(TextRun{left - m.tick - m.gap, p.at - m.text * 0.52F + m.line / 2.0F, 1.0F,
                                       p.tick->label, style.ink, m.text});
    }
    if (panel.y.label.empty() || !panel.y.labeled) return;
    const auto [label, size] = fitting(panel.y.label, m, plot.height + strip + room.top);
    const float half = m.width(label, size) / 2.0F;
    // The label ends above the x axis' label.
    const bool above = panel.x.label.empty() || !panel.x.labeled;
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
    if (!panel.y.label.empty() && panel.y.labeled) room.left += m.text * 1.1F + 2.0F * m.gap;
    room.bottom = m.line + m.tick;
    if (has_tick_labels(panel.x)) room.bottom += m.gap + m.text;
    if (!panel.x.label.empty() && panel.x.labeled) room.bottom += m.text * 1.1F + m.gap;
    // The outermost labels extend by half their width.
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
    // No grid line beside the box, which has lines of its own.
    for (const PlacedTick& p : ticks_x(panel, plot, m))
        if (p.labeled && p.at >= plot.x && p.at < plot.x + plot.width)
            bar(sheet, p.at, plot.y, m.line, plot.height, style.grid);
    for (const PlacedTick& p : ticks_y(panel, plot, m))
        if (p.labeled && p.at >= plot.y && p.at < plot.y + plot.height)
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
    for (const PlacedTick& p : ticks_y(beside, area, m)) {
        bar(sheet, right, p.at, p.labeled ? m.tick : m.minor_tick, m.line, style.ink);
        if (p.labeled)
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
    constexpr float most = 0.4F;  // maximum fraction of the area
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
    const auto place = [&](double value) {  // values that a logarithmic axis cannot show are to the left of it
        const double at = map(value);
        return std::round(at >= left ? static_cast<float>(std::min(at, double{right})) : left);
    };
    float y = plot.y + plot.height + 2.0F * m.line;
    if (style.background.a > 0) bar(sheet, left, y - m.line, plot.width, strip - m.line, style.background);
    for (const TimeBar& one : panel.time_bars) {
        const float top = std::round(y + 0.5F * (row - thick));
        for (const TimeBar::TimeMark& mark : one.marks) {
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
