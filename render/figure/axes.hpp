// The axes of one panel: their limits and ticks, their room, their strokes.
#pragma once

#include "figure/figure.hpp"
#include "figure/layout.hpp"

namespace achilles {

// Limits and ticks: steps of 1, 2 or 5, exact multiples, the fewest digits that tell neighbours apart; powers of ten on a
// logarithmic axis.

// Sets limits and ticks; axis.logarithmic is set before. `margin` is the share of the range left free at each end; 0
// keeps the limits as they are. At most `most` labels. A range without extent gets one; limits that are not finite
// become [0, 1].
void set_ticks(Axis& axis, double low, double high, double margin, int most = 6);

// A number as a tick label: U+2212 for minus, never "-0", the digits that `step` needs; in powers of ten from 1e6 on.
// `largest` is the greatest size on the axis: it decides the form and the power, so that all labels of an axis agree.
std::string tick_label(double value, double step, double largest = 0.0);

// "10\u207B\u00B3" for -3.
std::string power_of_ten(int exponent);

// How much room the axes of one panel need around the plot area, and the strokes of box, ticks and labels.

// The lengths a panel is built from, in pixels, all from the text size and the scale.
struct Metrics {
    Metrics(const Figure& style, const Measure& width, double scale);
    Measure width;
    float text;  // height of a line
    float smallest_text;
    float tick;  // outside the box
    float minor_tick;
    float gap;   // between a tick and its label, a label and its neighbour
    float line;  // thickness of box, ticks and grid: whole pixels
    double scale;
};

// Room outside the plot area.
struct Margins {
    float left = 0, right = 0, top = 0, bottom = 0;
};
Margins margins(const Panel& panel, const Metrics& metrics);
// Room for either.
Margins both(const Margins& a, const Margins& b);

// From data to pixels along one axis; not finite where the axis has no place for the value.
class AxisMap {
 public:
    // `from` is the pixel of axis.low, `to` of axis.high.
    AxisMap(const Axis& axis, double from, double to);
    double operator()(double value) const;
    // From pixels back to data, for the mouse.
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
// Box, ticks, all labels and, lifted by so much, the title, in the room of the margins; the box is higher than the plot area
// by the strip of the time bars below it.
void lay_axes(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& margins,
              float title_lift, float strip, const Metrics& metrics);

// The colours of numbers in the room at the right of the box, with an axis of their own.
void lay_color_bar(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Margins& margins,
                   const Metrics& metrics);

// What the time bars take from the bottom of an area: a row each, less where there are many; 0 without any.
float strip_height(const Panel& panel, Rectangle area, const Metrics& metrics);
// The time bars in the strip under the plot area, their names where the y axis has its numbers.
void lay_time_bars(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, float strip,
                   const Metrics& metrics);

}  // namespace achilles
