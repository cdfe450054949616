// Text on a draw list: measured before it is placed. Labels, upright or turned, their dots over the right letter; formulas with
// the interface's font, drawn where they were set.
#pragma once

#include <functional>
#include <string>

#include "figure/formula.hpp"
#include "paint/paint.hpp"
#include "surface/curves.hpp"

struct ImDrawList;

namespace achilles {

// The width paint_label will return.
float label_width(const std::string& label, float size);

// A figure's stroke in pixels.
ScreenStroke screen_stroke(const Stroke& stroke, double scale);

// The font that paint_formula draws with. Of ImGui's current context.
FormulaFont formula_font();
// Draws with the left end of the base line at (x, y).
void paint_formula(ImDrawList* list, const FormulaBox& box, float x, float y, Color color);

}  // namespace achilles
