// The formats of pictures: which one a file's name says, and PDF, which another program writes.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pictures/picture_job.hpp"

namespace achilles {

// The ending of a name in small letters, without its dot: "svg"; empty where it has none.
std::string ending_of(const std::string& file);

// "png", "svg" or "pdf", by the ending, in letters of either case; empty: the name says none of these.
std::string ending_of_picture(const std::string& file);

// What --out will hold: `wanted`, or where that is empty what its name says. Standard output, `-`, says nothing and is a PNG
// then. Throws InputError where the name says another kind than is wanted, or none is wanted and it says none; `advice` is
// added to what would be right.
std::string format_for(const std::string& out, const std::string& wanted, const std::string& advice = {});

// Programs that others have written and that may be installed: asked for at run time, never needed.

// The path of a program of that name, in the folders of PATH; empty where there is none.
std::string find_program(const std::string& name);

// A picture for print as PDF, by librsvg's program from the SVG that we write.

// Throws InputError for `file` where rsvg-convert is not installed: before the work.
void need_pdf_writer(const std::string& file);

// How wide a picture of so many pixels is on paper: 1200 pixels are 170 mm, as on a page.
constexpr double page_mm(int width) { return width * 170.0 / 1200.0; }

// The PDF of an SVG file, so many millimetres wide. The same SVG gives the same bytes; notes of the SVG are not in them. It is PDF 1.4 where rsvg-convert can be asked for that. Throws
// std::runtime_error if rsvg-convert cannot do it.
std::string pdf_of_svg(const std::string& svg, double width_mm);

// How large a picture is on paper: millimetres and points in place of pixels.

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
