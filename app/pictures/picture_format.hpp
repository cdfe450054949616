// Picture formats and sizes: format from a file name, PDF output by an external program, and sizes on paper.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pictures/picture_job.hpp"

namespace achilles {

// The file extension in lower case without the dot: "svg"; empty if there is none.
std::string ending_of(const std::string& file);

// "png", "svg" or "pdf", from the extension in any case; empty for other extensions.
std::string ending_of_picture(const std::string& file);

// The format of --out: `wanted` or, if that is empty, the format of the file extension; PNG for standard output, `-`.
// Throws InputError if the extension contradicts `wanted`, or if neither determines a format. `advice` is appended to
// the hint.
std::string format_for(const std::string& out, const std::string& wanted, const std::string& advice = {});

// Optional external programs, looked up at run time.

// The path of a program in the folders of PATH; empty if it is not found.
std::string find_program(const std::string& name);

// PDF output: librsvg's program converts our SVG.

// Throws InputError for `file` if rsvg-convert is not installed. Call it before the work.
void need_pdf_writer(const std::string& file);

// Width on paper of a picture with this many pixels, mm: 1200 pixels are 170 mm, a page width.
constexpr double page_mm(int width) { return width * 170.0 / 1200.0; }

// Converts an SVG file to a PDF of the given width. The same SVG gives the same bytes. Notes of the SVG are not kept.
// The result is PDF 1.4 if rsvg-convert supports that. Throws std::runtime_error if the conversion fails.
std::string pdf_of_svg(const std::string& svg, double width_mm);

// Size of a picture on paper: millimeters and points instead of pixels.

// A field of 0 gets its default. A width of 0: the picture is measured in pixels.
struct PaperSize {
    double width = 0.0, height = 0.0;  // mm
    double font = 0.0;                 // pt, axis text; default_font
    double dpi = 0.0;                  // pixels per inch of a PNG; default_dpi
};
constexpr double default_font = 8.0, default_dpi = 300.0;
constexpr double min_width = 20.0, max_width = 1200.0;  // mm; includes A0
constexpr double min_font = 3.0, max_font = 72.0, min_dpi = 50.0, max_dpi = 1200.0;

// Throws InputError, about `what`, for a size outside these limits.
void check(const PaperSize& page, const std::string& what);

// The size in pixels of a picture in format "png", "svg" or "pdf". Its scale draws text of `text_size` pixels in the
// page's font size. `shape`, width over height, determines the height if the page has none. Vector formats (SVG, PDF)
// use 1200 pixels per 170 mm. Throws InputError if a PNG would have too many pixels.
PictureSize on_page(const PaperSize& page, const std::string& format, double text_size, double shape);

// The page settings that apply to this format: the resolution only to PNG.
PaperSize page_for(PaperSize page, const std::string& format);

// Width over height of the tallest picture whose height follows from its plots.
constexpr double tallest_shape = 0.7;
// Height in mm: the page's own or, if that is 0, the width divided by this shape.
double height_of(const PaperSize& page, double shape);

// "85 × 57 mm, 1004 × 669 px at 300 dpi".
std::string size_text(const PaperSize& page, const std::string& format, double shape);

// Width over height of a figure whose plots have height/width = 2/3, and of a mechanism.
double shape_of(const Figure& figure);
double shape_of(int panels, int columns);
double shape_of(const Drawing& world);

// Column and page widths that journals require.
struct ColumnWidth {
    std::string_view name;
    double width, font;  // mm, pt
};
std::span<const ColumnWidth> column_widths();

}  // namespace achilles
