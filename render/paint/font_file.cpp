#include "paint/font_file.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <stdexcept>

#include "figure/label.hpp"

namespace achilles {

struct FontFile::Face {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    ~Face() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_FreeType(library);
    }
};

FontFile::FontFile(const std::filesystem::path& fonts) : face_(std::make_unique<Face>()) {
    const std::string file = (fonts / "DejaVuSans.ttf").string();
    if (FT_Init_FreeType(&face_->library) != 0 || FT_New_Face(face_->library, file.c_str(), 0, &face_->face) != 0)
        throw std::runtime_error(file + ": the font cannot be read; install the package fonts-dejavu-core");
    // A line is as high as the font's ascent and descent together: so do painters of interfaces count.
    const FT_Face face = face_->face;
    const double height = face->ascender - face->descender;
    em_ = face->units_per_EM / height;
    base_ = face->ascender / height;
}

FontFile::~FontFile() = default;

const FontFile::Glyph& FontFile::glyph(char32_t code) const {
    const auto [entry, is_new] = glyphs_.try_emplace(code);
    Glyph& glyph = entry->second;
    const FT_Face face = face_->face;
    if (!is_new || FT_Load_Char(face, code, FT_LOAD_NO_SCALE) != 0) return glyph;
    const FT_Glyph_Metrics& m = face->glyph->metrics;
    const double em = face->units_per_EM;
    glyph = {static_cast<double>(m.horiAdvance) / em, static_cast<double>(m.horiBearingX) / em,
             static_cast<double>(m.horiBearingX + m.width) / em, static_cast<double>(m.horiBearingY - m.height) / em,
             static_cast<double>(m.horiBearingY) / em};
    return glyph;
}

float FontFile::width(const std::string& label, float size) const {
    double width = 0.0;
    for (const Letter& letter : letters(label))
        width += glyph(letter.code).advance * (letter.script == 0 ? 1.0 : double{script_size});
    return static_cast<float>(width * em_) * size;
}

}  // namespace achilles
