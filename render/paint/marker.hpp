// The little shapes that mark events.
#pragma once

#include "figure/figure.hpp"

struct ImDrawList;

namespace achilles {

// One marker centred at a pixel; a bar is left to the panel, which knows how high it is.
void paint_marker(ImDrawList* list, const Markers& style, const Point& pixel, double scale);

}  // namespace achilles
