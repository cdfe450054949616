// How large a picture is on paper: millimetres and points in place of pixels.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pictures/picture_job.hpp"

namespace achilles {

// What is 0 follows from the rest; a width of 0: the picture is measured in pixels, as ever.
struct PaperSize {
    double width = 0.0, height = 0.0;  // mm
    double font = 0.0;                 // pt, of the text of axes; default_font
    double dpi = 0.0;                  // pixels an inch, of a PNG; default_dpi
};
constexpr double default_font = 8.0, default_dpi = 300.0;
constexpr double least_width = 20.0, most_width = 1200.0;  // mm; A0 lies within
constexpr double least_font = 3.0, most_font = 72.0, least_dpi = 50.0, most_dpi = 1200.0;

// Throws InputError, about `what`, for a number that no page has.
void check(const PaperSize& page, const std::string& what);

// The size in pixels of such a picture as "png", "svg" or "pdf"; its scale makes a text of `text_size` pixels as large as the
// page's font. `shape`, width over height, makes a height where the page has none. What is drawn once for all sizes (SVG,
// PDF) counts 1200 pixels for 170 mm. Throws InputError for more pixels than a PNG may have.
PictureSize on_page(const PaperSize& page, const std::string& format, double text_size, double shape);

// The page as such a picture has it: a resolution is for pixels alone.
PaperSize page_for(PaperSize page, const std::string& format);

// Width over height of the highest picture that gets its height from its plots.
constexpr double tallest_shape = 0.7;
// mm: the page's own, or where that is 0 what its width and this shape make.
double height_of(const PaperSize& page, double shape);

// "85 × 57 mm, 1004 × 669 px at 300 dpi".
std::string told(const PaperSize& page, const std::string& format, double shape);

// The shape of a figure whose plots are two thirds as high as wide, and of a mechanism.
double shape_of(const Figure& figure);
double shape_of(int panels, int columns);
double shape_of(const Drawing& world);

// The widths of columns and pages that journals ask for.
struct ColumnWidth {
    std::string_view name;
    double width, font;  // mm, pt
};
std::span<const ColumnWidth> column_widths();

}  // namespace achilles
