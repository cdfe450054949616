// The mechanism onto an ImGui draw list: strokes only, no memory.
#pragma once

#include <string>

#include "figure/animation.hpp"
#include "figure/figure.hpp"
#include "paint/paint.hpp"

namespace achilles {

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
