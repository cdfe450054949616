// A picture for print as PDF, by librsvg's program from the SVG that we write.
#pragma once

#include <string>

namespace achilles {

// Throws InputError for `file` where rsvg-convert is not installed: before the work.
void need_pdf_writer(const std::string& file);

// How wide a picture of so many pixels is on paper: 1200 pixels are 170 mm, as on a page.
constexpr double page_mm(int width) { return width * 170.0 / 1200.0; }

// The PDF of an SVG file, so many millimetres wide. The same SVG gives the same bytes; notes of the SVG are not in them. It is PDF 1.4 where rsvg-convert can be asked for that. Throws
// std::runtime_error if rsvg-convert cannot do it.
std::string pdf_of_svg(const std::string& svg, double width_mm);

}  // namespace achilles
