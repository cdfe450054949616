// The formats of pictures: which one a file's name says, and PDF, which another program writes.
#pragma once

#include <string>

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

}  // namespace achilles
