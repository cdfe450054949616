// Paints figures, sheets and mechanisms onto an ImGui draw list. The painter has no state; layout is decided elsewhere.
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

// Draws the whole figure into the area; `scale` multiplies text sizes and stroke widths.
void paint(const Figure& figure, ImDrawList* list, Rectangle area, double scale = 1.0);
// Draws a sheet, whose layout is already done.
void paint(const Sheet& sheet, ImDrawList* list);
// Draws one panel. Returns the plot area inside the axes, for a cursor or the mouse.
Rectangle paint(const Panel& panel, const Figure& style, ImDrawList* list, Rectangle area, double scale = 1.0);
// Draws a label with combining dots above their letters. Returns its width in pixels. `angle`: 0, or 90 for the label
// of a vertical axis.
float paint_label(ImDrawList* list, float x, float y, const std::string& label, Color color, float size, int angle = 0);

// ---- event markers ----

// Corners of a marker's shape in pixels; many for a circle. Empty for a bar, which is as high as its panel.
std::vector<Point> corners(const Mark& mark);

void paint_marker(ImDrawList* list, const Mark& mark);
// Draws one marker centered at a pixel. Bars are drawn by the panel, which knows its height.
void paint_marker(ImDrawList* list, const Markers& style, const Point& pixel, double scale);

// ---- text: measured before it is placed ----
// Labels are horizontal or rotated, with dots above the right letters. Formulas use the font of the interface and are
// drawn where they were typeset.

// The width that paint_label() returns.
float label_width(const std::string& label, float size);

// Stroke of a figure in pixels.
ScreenStroke screen_stroke(const Stroke& stroke, double scale);

// The font of ImGui's current context that paint_formula() uses.
FormulaFont formula_font();
// Draws a formula with the left end of its baseline at (x, y).
void paint_formula(ImDrawList* list, const FormulaBox& box, float x, float y, Color color);

// ---- the mechanism ----

// Map from the world to pixels: pixel = (x + unit * X, y - unit * Y).
struct Placement {
    double x = 0.0, y = 0.0, unit = 1.0;
    Point pixel(const Point& world) const { return {x + unit * world.x, y - unit * world.y}; }
    Point world(const Point& pixel) const { return {(pixel.x - x) / unit, (y - pixel.y) / unit}; }
};

// The largest placement with equal axes that shows the limits of the drawing, centered in the area.
Placement place(const Drawing& drawing, Rectangle area);

// Size of texts in a mechanism, pixels at scale 1.
constexpr double world_text_size = 14.0;

// Outline of a shape other than text, in pixels. A closed outline repeats its first point. For a large disc, only the
// arc that may be visible is fine.
std::vector<Point> outline(const DrawnShape& shape, const Placement& placement, const Rectangle& seen);

// Draws the shapes, clipped to the area; `scale` multiplies text sizes and stroke widths.
Placement paint(const Drawing& drawing, ImDrawList* list, Rectangle area, double scale = 1.0);

// Draws a scale bar of a round length, at most `most` pixels, with its label. `corner` is its lower left corner.
// Returns the length including the label, in pixels.
double paint_scale_bar(ImDrawList* list, const Point& corner, double most, double unit, const std::string& unit_name,
                       const Color& color, double scale = 1.0);

// Draws a frame of an animation.
void paint(const AnimationFrame& still, ImDrawList* list);

}  // namespace achilles
