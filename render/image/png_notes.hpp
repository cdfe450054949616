// Notes in PNG files: text chunks, which stb neither writes nor reads.
#pragma once

#include <string>
#include <string_view>

#include "image/note.hpp"

namespace achilles {

// The PNG with the notes after its header: tEXt where the text is ASCII, else iTXt. Throws std::runtime_error for a
// keyword that is none, a zero byte or broken UTF-8 in a text, or if `png` is no PNG.
std::string with_notes(std::string_view png, const Notes& notes);

// The uncompressed notes of a PNG file, in order; the file may come from anywhere. Throws std::runtime_error that says
// what is wrong with it: no PNG, cut off, damaged (every chunk's check sum is verified).
Notes png_notes(std::string_view png);

}  // namespace achilles
