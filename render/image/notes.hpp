// The notes that a picture carries with it, in PNG, PDF and SVG files.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct Note {
    std::string keyword;  // 1 to 79 printable ASCII characters; "Software" and "Title" are PNG's own
    std::string text;     // UTF-8
    friend bool operator==(const Note&, const Note&) = default;
};
using Notes = std::vector<Note>;

// A picture with more of them is refused: those of a stranger take ten times their file's size.
constexpr std::size_t most_notes = std::size_t{1} << 16;

inline bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// In PNG files: text chunks, which stb neither writes nor reads.

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

// In PDF files: entries of the document information dictionary, in an update that stands at the file's end.

// The PDF with the notes, and with what its information dictionary said before: an incremental update (ISO 32000-1,
// 7.5.6), by which no byte of the file changes. "Title" is PDF's own, "Software" its Creator; where a keyword occurs
// again it is numbered. Throws std::runtime_error for broken UTF-8 and for a file whose end is not that of a PDF with a
// cross-reference table, such as cairo's.
std::string with_pdf_notes(std::string_view pdf, const Notes& notes);

// The notes that with_pdf_notes wrote, in order, from a file that may come from anywhere. No notes at all is a valid
// answer. Throws std::runtime_error where they are damaged. Takes time and memory proportional to the file's size.
Notes pdf_notes(std::string_view pdf);

// What an SVG holds besides strokes: escaped text, bytes as letters, and the notes in its <metadata>.

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
