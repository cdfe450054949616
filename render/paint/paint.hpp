// Strokes only: a figure onto an ImGui draw list. The painter has no memory and decides nothing but where pixels go.
#pragma once

#include <vector>

#include "figure/layout.hpp"

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

}  // namespace achilles
