// Formulas on a draw list: measured with the interface's font, drawn where they were set.
#pragma once

#include <functional>

#include "figure/formula.hpp"

struct ImDrawList;

namespace achilles {

// The font that paint_formula draws with. Of ImGui's current context.
FormulaFont formula_font();
// Draws with the left end of the base line at (x, y).
void paint_formula(ImDrawList* list, const FormulaBox& box, float x, float y, Color color);

}  // namespace achilles
