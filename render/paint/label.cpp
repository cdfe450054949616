#include "paint/label.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr unsigned one_dot = 0x0307, two_dots = 0x0308, replacement = 0xFFFD;

// The next code point; what is no UTF-8 becomes the replacement sign, a byte at a time.
unsigned next_code_point(const std::string& text, std::size_t& at) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const unsigned lead = byte(at++);
    if (lead < 0x80) return lead;
    const std::size_t more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    if (more == 0) return replacement;
    unsigned value = lead & (0x3FU >> more);
    for (std::size_t i = 0; i < more; ++i) {
        if ((byte(at + i) & 0xC0U) != 0x80U) return replacement;
        value = value << 6 | (byte(at + i) & 0x3FU);
    }
    at += more;
    return value <= 0xFFFF ? value : replacement;  // ImGui's letters have 16 bits
}

// A frame of reference for a line of text: where it starts and which way it runs.
struct Baseline {
    ImVec2 start;
    bool upright;  // false: turned by 90 degrees, reading upwards
    ImVec2 at(float along, float down) const {
        return upright ? ImVec2(start.x + along, start.y + down) : ImVec2(start.x + down, start.y - along);
    }
};

void paint_glyph(ImDrawList* list, const ImFontGlyph& glyph, const Baseline& line, float along, float zoom,
                 ImU32 color) {
    if (glyph.Visible == 0) return;
    const float left = along + glyph.X0 * zoom, right = along + glyph.X1 * zoom;
    const float top = glyph.Y0 * zoom, bottom = glyph.Y1 * zoom;
    list->PrimReserve(6, 4);
    list->PrimQuadUV(line.at(left, top), line.at(right, top), line.at(right, bottom), line.at(left, bottom),
                     {glyph.U0, glyph.V0}, {glyph.U1, glyph.V0}, {glyph.U1, glyph.V1}, {glyph.U0, glyph.V1}, color);
}

// Dots over the letter before, drawn as discs: the font's own combining dots touch the taller Greek letters.
void paint_dots(ImDrawList* list, const ImFontGlyph& letter, const Baseline& line, float along, float size, float zoom,
                unsigned sign, ImU32 color) {
    const float middle = along + (letter.X0 + letter.X1) / 2.0F * zoom;
    const float radius = std::max(size * 0.066F, 0.8F);
    const float height = letter.Y0 * zoom - 1.9F * radius;
    const float apart = sign == two_dots ? size * 0.13F : 0.0F;
    for (const float shift : {-apart, apart}) {
        list->AddCircleFilled(line.at(middle + shift, height), radius, color, 12);
        if (apart == 0.0F) break;
    }
}

}  // namespace

float label_width(const std::string& label, float size) {
    const ImFont* font = font_for(double{size});
    const float zoom = size / font->FontSize;
    float width = 0.0F;
    for (std::size_t i = 0; i < label.size();) {
        const unsigned c = next_code_point(label, i);
        if (c != one_dot && c != two_dots) width += font->FindGlyph(static_cast<ImWchar>(c))->AdvanceX * zoom;
    }
    return width;
}

float paint_label(ImDrawList* list, float x, float y, const std::string& label, Color color, float size, int angle) {
    ImFont* font = font_for(double{size});
    const float zoom = size / font->FontSize;
    // On whole pixels letters keep the shape they were made with.
    const Baseline line{{std::round(x), std::round(y)}, angle != 90};
    const ImU32 ink = IM_COL32(color.r, color.g, color.b, color.a);
    list->PushTextureID(font->ContainerAtlas->TexID);
    float along = 0.0F, letter_at = 0.0F;
    const ImFontGlyph* letter = nullptr;
    for (std::size_t i = 0; i < label.size();) {
        const unsigned c = next_code_point(label, i);
        if (c == one_dot || c == two_dots) {
            if (letter != nullptr) paint_dots(list, *letter, line, letter_at, size, zoom, c, ink);
            continue;
        }
        letter = font->FindGlyph(static_cast<ImWchar>(c));
        letter_at = along;
        paint_glyph(list, *letter, line, along, zoom, ink);
        along += letter->AdvanceX * zoom;
    }
    list->PopTextureID();
    return along;
}

ScreenStroke screen_stroke(const Stroke& stroke, double scale) {
    ScreenStroke result{stroke.color, stroke.width * scale, stroke.dash};
    for (double& length : result.dash) length *= scale;
    return result;
}

}  // namespace achilles
