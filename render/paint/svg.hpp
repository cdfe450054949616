// Writes a figure as SVG from the same sheet as a PNG, with text as text. Also reads the notes of such a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"
#include "figure/layout.hpp"
#include "image/notes.hpp"

namespace achilles {

struct SvgSize {
    int width, height;      // in units of the file, which viewers take as pixels
    double scale;           // of text and strokes
    double width_mm = 0.0;  // width on paper, written to the file; 0: sizes are in pixels
    std::string prefix{};   // of the names in the file, if a page contains several
};

// The text of an SVG file. `fonts`: folder of the font that determines the widths of labels. Throws std::runtime_error
// if the font is missing or a note cannot be stored in XML (control characters, invalid UTF-8).
std::string svg(const Figure& figure, const SvgSize& size, const std::filesystem::path& fonts, const Notes& notes);
// The same for a mechanism, with equal axes and centered in the picture.
std::string svg(const Drawing& world, const Color& background, const SvgSize& size, const std::filesystem::path& fonts,
                const Notes& notes);

// The areas of the plots in the file of a figure, in units of the file.
std::vector<PlotArea> plot_areas(const Figure& figure, const SvgSize& size, const std::filesystem::path& fonts);

// The notes that svg() wrote, in order. Throws std::runtime_error with the reason if they are damaged.
Notes svg_notes(std::string_view text);

}  // namespace achilles
