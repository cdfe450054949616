// Axes of one panel: limits and ticks, margins, strokes.
#pragma once

#include "figure/figure.hpp"
#include "figure/layout.hpp"

namespace achilles {

// ---- limits and ticks ----
// Linear axes have steps of 1, 2 or 5 times a power of ten, at exact multiples, with the fewest digits that distinguish
// neighbors. Logarithmic axes have powers of ten.

// Sets limits and ticks. axis.logarithmic must be set before. `margin`: fraction of the range left free at each end; 0
// keeps the limits. `most`: maximum number of labels. An empty range is widened; limits that are not finite become [0,
// 1].
void set_ticks(Axis& axis, double low, double high, double margin, int most = 6);

// A number as a tick label: U+2212 for minus, never "-0", as many digits as `step` needs, powers of ten from 1e6 on.
// `largest` is the largest magnitude on the axis. It decides format and power, so that all labels of an axis agree.
std::string tick_label(double value, double step, double largest = 0.0);

// "10\u207B\u00B3" for -3.
std::string power_of_ten(int exponent);

// ---- margins and strokes ----

// Lengths that a panel is built from, in pixels. All follow from the text size and the scale.
struct Metrics {
    Metrics(const Figure& style, const Measure& width, double scale);
    Measure width;
    float text;  // line height
    float smallest_text;
    float tick;  // length, outside the box
    float minor_tick;
    float gap;   // between a tick and its label, and between neighboring labels
    float line;  // thickness of box, ticks and grid, in whole pixels
    double scale;
};

// Margins outside the plot area, pixels.
struct Margins {
    float left = 0, right = 0, top = 0, bottom = 0;
};
Margins margins(const Panel& panel, const Metrics& metrics);
// The larger of the two margins on each side.
Margins both(const Margins& a, const Margins& b);

// Maps data to pixels along one axis. The result is not finite for values that the axis cannot show.
class AxisMap {
 public:
    // `from` is the pixel of axis.low, `to` of axis.high.
    AxisMap(const Axis& axis, double from, double to);
    double operator()(double value) const;
    // Inverse map from pixels to data, for the mouse.
    double value(double pixel) const;

 private:
    bool logarithmic_;
    double low_, factor_, from_;
};

struct PanelMap {
    PanelMap(const Panel& panel, Rectangle plot);
    AxisMap x, y;
    Point operator()(const Point& data) const { return {x(data.x), y(data.y)}; }
    Point data(const Point& pixel) const { return {x.value(pixel.x), y.value(pixel.y)}; }
};

void lay_grid(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& metrics);
// Adds the box, ticks, labels and the title, all within the margins. `title_lift`: how far the title is raised.
// `strip`: height of the time bars below the plot area, by which the box is higher.
void lay_axes(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& margins,
              float title_lift, float strip, const Metrics& metrics);

// Color scale with its own axis, in the margin at the right of the box.
void lay_color_bar(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& margins,
                   const Metrics& metrics);

// Height of the time bars at the bottom of an area: one row each, thinner rows if there are many; 0 without time bars.
float strip_height(const Panel& panel, Rectangle area, const Metrics& metrics);
// The time bars in the strip below the plot area, with their names where the y axis has its numbers.
void lay_time_bars(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, float strip,
                   const Metrics& metrics);

}  // namespace achilles
