// Strokes only: a figure onto an ImGui draw list. The painter has no memory and decides nothing but where pixels go.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figure/animation.hpp"
#include "figure/figure.hpp"
#include "figure/formula.hpp"
#include "figure/layout.hpp"
#include "surface/curves.hpp"

struct ImDrawList;

namespace achilles {

// Draws the whole figure into the area; scale multiplies text sizes and stroke widths.
void paint(const Figure& figure, ImDrawList* list, Rectangle area, double scale = 1.0);
// What is laid out already.
void paint(const Sheet& sheet, ImDrawList* list);
// One panel: returns the plot area inside the axes, for a cursor or the mouse.
Rectangle paint(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle area, double scale = 1.0);
// A label with its combining dots placed over their letters; returns its width. `angle`: 0, or 90 for a vertical axis
// label.
float paint_label(ImDrawList* list, float x, float y, const std::string& label, Color color, float size, int angle = 0);

// The little shapes that mark events.

// The corners of a marker's shape in pixels; many for a circle. A bar has none: it is as high as its panel.
std::vector<Point> corners(const Mark& mark);

void paint_marker(ImDrawList* list, const Mark& mark);
// One marker centred at a pixel; a bar is left to the panel, which knows how high it is.
void paint_marker(ImDrawList* list, const Markers& style, const Point& pixel, double scale);

// Text on a draw list: measured before it is placed. Labels, upright or turned, their dots over the right letter; formulas with
// the interface's font, drawn where they were set.

// The width paint_label will return.
float label_width(const std::string& label, float size);

// A figure's stroke in pixels.
ScreenStroke screen_stroke(const Stroke& stroke, double scale);

// The font that paint_formula draws with. Of ImGui's current context.
FormulaFont formula_font();
// Draws with the left end of the base line at (x, y).
void paint_formula(ImDrawList* list, const FormulaBox& box, float x, float y, Color color);

// The mechanism onto an ImGui draw list: strokes only, no memory.

// Where the world went: pixel = (x + unit * X, y - unit * Y).
struct Placement {
    double x = 0.0, y = 0.0, unit = 1.0;
    Point pixel(const Point& world) const { return {x + unit * world.x, y - unit * world.y}; }
    Point world(const Point& pixel) const { return {(pixel.x - x) / unit, (y - pixel.y) / unit}; }
};

// The largest placement with equal axes that shows the drawing's limits in the middle of the area.
Placement place(const Drawing& drawing, Rectangle area);

// Of texts that stand in a mechanism, pixels at scale 1.
constexpr double world_text_size = 14.0;

// The outline of a shape that is no text, in pixels; a closed one ends where it begins. Of a large disc the arc that may be
// seen is fine.
std::vector<Point> outline(const Shape& shape, const Placement& placement, const Rectangle& seen);

// Draws the shapes, clipped to the area; scale multiplies text sizes and stroke widths.
Placement paint(const Drawing& drawing, ImDrawList* list, Rectangle area, double scale = 1.0);

// A bar of round length with its label, its left end at the lower left corner given; at most so long. Returns how long it is,
// label and all, in pixels.
double paint_scale_bar(ImDrawList* list, const Point& corner, double most, double unit, const std::string& unit_name,
                       const Color& color, double scale = 1.0);

// A still of an animation.
void paint(const Still& still, ImDrawList* list);

}  // namespace achilles
