// What an SVG holds besides strokes: escaped text, bytes as letters, and the notes in its <metadata>.
#pragma once

#include <string>
#include <string_view>

#include "image/notes.hpp"

namespace achilles {

// Throws std::runtime_error for what XML cannot hold: control characters, broken UTF-8.
std::string xml_escaped(std::string_view text);

// A <metadata> element with the notes; the elements in it belong to a name space of our own.
std::string xml_notes(const Notes& notes);

// Reads what xml_notes wrote, in a text that may hold anything else. No notes at all is a valid answer. Throws
// std::runtime_error where they are damaged.
Notes xml_notes_of(std::string_view text);

// Bytes as letters, 6 bits in each (RFC 4648).

std::string base64(std::string_view bytes);

}  // namespace achilles
