#include "paint/label.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// A frame of reference for a line of text: where it starts and which way it runs.
struct Baseline {
    ImVec2 start;
    bool upright;  // false: turned by 90 degrees, reading upwards
    ImVec2 at(float along, float down) const {
        return upright ? ImVec2(start.x + along, start.y + down) : ImVec2(start.x + down, start.y - along);
    }
};

// A letter with its font, size and place: `along` the line, `down` from its top.
struct Set {
    const ImFontGlyph* glyph;
    float zoom, along, down, base, slant;  // base: of its base line from the top of the letters
    float advance() const { return glyph->AdvanceX * zoom; }
};

void paint_glyph(ImDrawList* list, const Set& set, const Baseline& line, ImU32 color) {
    const ImFontGlyph& glyph = *set.glyph;
    if (glyph.Visible == 0) return;
    const float left = set.along + glyph.X0 * set.zoom, right = set.along + glyph.X1 * set.zoom;
    const float top = glyph.Y0 * set.zoom, bottom = glyph.Y1 * set.zoom;
    // Italics lean about their base line.
    const float over = (set.base - top) * set.slant, under = (set.base - bottom) * set.slant;
    list->PrimReserve(6, 4);
    list->PrimQuadUV(line.at(left + over, set.down + top), line.at(right + over, set.down + top),
                     line.at(right + under, set.down + bottom), line.at(left + under, set.down + bottom),
                     {glyph.U0, glyph.V0}, {glyph.U1, glyph.V0}, {glyph.U1, glyph.V1}, {glyph.U0, glyph.V1}, color);
}

// Dots over a letter, drawn as discs: the font's own combining dots touch the taller Greek letters.
void paint_dots(ImDrawList* list, const Set& set, const Baseline& line, float size, int dots, ImU32 color) {
    const float radius = std::max(size * 0.066F, 0.8F);
    const float height = set.glyph->Y0 * set.zoom - 1.9F * radius;
    const float middle =
        set.along + (set.glyph->X0 + set.glyph->X1) / 2.0F * set.zoom + (set.base - height) * set.slant;
    const float apart = dots == 2 ? size * 0.13F : 0.0F;
    for (const float shift : {-apart, apart}) {
        list->AddCircleFilled(line.at(middle + shift, set.down + height), radius, color, 12);
        if (apart == 0.0F) break;
    }
}

// Sets one letter after the other; returns the length of the line.
template <class Draw>
float set_line(const std::string& label, float size, const Draw& draw) {
    const std::vector<Letter> line = letters(label);
    float along = 0.0F;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Letter& letter = line[i];
        const float own_size = letter.script == 0 ? size : size * script_size;
        ImFont* font = font_for(double{own_size});
        Set set{&glyph_of(font, letter.code), own_size / size_of(font), along, 0.0F, 0.0F, 0.0F};
        set.base = ascent_of(font) * set.zoom;
        if (letter.script != 0) {
            const float shift = letter.script < 0 ? index_drop : -power_rise;
            ImFont* around = font_for(double{size});
            set.down = std::round(ascent_of(around) * size / size_of(around) - set.base + shift * size);
        }
        if (letter.italic) set.slant = italic_slant;
        draw(letter, set);
        along += set.advance();
    }
    return along;
}

}  // namespace

float label_width(const std::string& label, float size) {
    return set_line(label, size, [](const Letter&, const Set&) {});
}

float paint_label(ImDrawList* list, float x, float y, const std::string& label, Color color, float size, int angle) {
    // On whole pixels letters keep the shape they were made with.
    const Baseline line{{std::round(x), std::round(y)}, angle != 90};
    const ImU32 ink = IM_COL32(color.r, color.g, color.b, color.a);
    push_font_texture(list);
    const float length = set_line(label, size, [&](const Letter& letter, const Set& set) {
        paint_glyph(list, set, line, ink);
        if (letter.dots > 0) paint_dots(list, set, line, size, letter.dots, ink);
    });
    pop_font_texture(list);
    return length;
}

ScreenStroke screen_stroke(const Stroke& stroke, double scale) {
    ScreenStroke result{stroke.color, stroke.width * scale, stroke.dash};
    for (double& length : result.dash) length *= scale;
    return result;
}

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
