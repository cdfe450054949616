// A figure as SVG: the same sheet as in a PNG, with text as text. And the notes such a file carries.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "figure/figure.hpp"
#include "image/notes.hpp"

namespace achilles {

struct SvgSize {
    int width, height;      // in units of the file: pixels, as whoever opens it takes them
    double scale;           // of text and strokes
    double width_mm = 0.0;  // on paper, which the file says then; 0: it says pixels
};

// The file's text. `fonts`: the folder of the font that decides how much room a label gets. Throws std::runtime_error
// if the font is missing, or a note holds what XML cannot (control characters, broken UTF-8).
std::string svg(const Figure& figure, const SvgSize& size, const std::filesystem::path& fonts, const Notes& notes);
// The same of a mechanism, with equal axes in the middle of the picture.
std::string svg(const Drawing& world, const Color& background, const SvgSize& size, const std::filesystem::path& fonts,
                const Notes& notes);

// The notes that svg() put into a text, in order. Throws std::runtime_error that says what is wrong.
Notes svg_notes(std::string_view text);

}  // namespace achilles
