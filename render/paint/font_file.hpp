// The measures of the one font as its file has them, for drawings whose letters somebody else will set. The only file
// that includes FreeType.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace achilles {

// All lengths are shares of the em but those of width().
class FontFile {
 public:
    // `fonts`: the folder that holds DejaVuSans.ttf. Throws std::runtime_error if it cannot be read.
    explicit FontFile(const std::filesystem::path& fonts);
    ~FontFile();
    FontFile(const FontFile&) = delete;
    FontFile& operator=(const FontFile&) = delete;

    struct Glyph {
        double advance = 0.0, left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;  // the ink's box, up from the base line
    };
    const Glyph& glyph(char32_t code) const;
    // Of a line of text of that height, as a painter with this font would set it.
    float width(const std::string& label, float size) const;
    // Of a line of text: the em by its height, and the base line from its top by its height.
    double em() const { return em_; }
    double base() const { return base_; }

 private:
    struct Face;
    std::unique_ptr<Face> face_;
    mutable std::map<char32_t, Glyph> glyphs_;
    double em_ = 1.0, base_ = 1.0;
};

}  // namespace achilles
