// Notes in PNG files: text chunks, which stb neither writes nor reads.
#pragma once

#include <string>
#include <string_view>

#include "image/note.hpp"

namespace achilles {

// The PNG with the notes after its header: tEXt where the text is ASCII, else iTXt. Throws std::runtime_error for a
// keyword that is none, a zero byte or broken UTF-8 in a text, more than 65536 notes, or if `png` is no PNG.
std::string with_notes(std::string_view png, const Notes& notes);

// The PNG with so many pixels a millimetre said after its header (pHYs): programs that set pages take its size from there.
// Throws std::runtime_error if `png` is no PNG.
std::string with_resolution(std::string_view png, double pixels_per_mm);

// The notes of a PNG file, in order, before the pixels and after them; the file may come from anywhere. Left out is
// what with_notes could not have written: a compressed text, a keyword that is none, a zero byte or broken UTF-8.
// Throws std::runtime_error that says what is wrong: no PNG, cut off, damaged (every chunk's check sum is verified),
// more than 65536 notes. Takes time and memory proportional to the file's size; pixels are not decoded.
Notes png_notes(std::string_view png);

}  // namespace achilles
