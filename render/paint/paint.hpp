// Strokes only: a figure onto an ImGui draw list. The painter has no memory and decides nothing but where pixels go.
#pragma once

#include "figure/sheet.hpp"

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

}  // namespace achilles
