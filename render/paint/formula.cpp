#include "paint/formula.hpp"

#include <imgui.h>

#include <cmath>

#include "paint/label.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

FormulaFont formula_font() {
    FormulaFont font;
    font.width = [](const std::string& label, float size) { return label_width(label, size); };
    return font;
}

void paint_formula(ImDrawList* list, const FormulaBox& box, float x, float y, Color color) {
    const ImU32 ink = IM_COL32(color.r, color.g, color.b, color.a);
    for (const FormulaBox::Letters& one : box.letters) {
        ImFont* font = font_for(double{one.size});
        const float base = ascent_of(font) * one.size / size_of(font);
        paint_label(list, x + one.x, y + one.y - base, one.label, color, one.size);
    }
    for (const FormulaBox::Rule& rule : box.rules) {
        const float left = std::round(x + rule.x), top = std::round(y + rule.y);
        list->AddRectFilled({left, top}, {left + std::max(1.0F, rule.width), top + std::max(1.0F, rule.height)}, ink);
    }
    for (const FormulaBox::Stroke& one : box.strokes) {
        std::vector<ImVec2> points;
        for (const Point& p : one.points) points.emplace_back(x + static_cast<float>(p.x), y + static_cast<float>(p.y));
        stroke(list, points, false, ink, one.width);
    }
}

}  // namespace achilles
