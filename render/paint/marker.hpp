// The little shapes that mark events.
#pragma once

#include <vector>

#include "figure/sheet.hpp"

struct ImDrawList;

namespace achilles {

// The corners of a marker's shape in pixels; many for a circle. A bar has none: it is as high as its panel.
std::vector<Point> corners(const Mark& mark);

void paint_marker(ImDrawList* list, const Mark& mark);
// One marker centred at a pixel; a bar is left to the panel, which knows how high it is.
void paint_marker(ImDrawList* list, const Markers& style, const Point& pixel, double scale);

}  // namespace achilles
