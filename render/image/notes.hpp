// Notes stored in PNG, PDF and SVG files, such as the origin of a picture.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct Note {
    std::string keyword;  // 1 to 79 printable ASCII characters; "Software" and "Title" are standard keywords of PNG
    std::string text;     // UTF-8
    friend bool operator==(const Note&, const Note&) = default;
};
using Notes = std::vector<Note>;

// Limit on the notes of a picture. Notes of an untrusted file can take ten times its size in memory.
constexpr std::size_t max_notes = std::size_t{1} << 16;

inline bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// ---- PNG files: text chunks, which stb neither reads nor writes ----

// Inserts the notes after the header: tEXt for ASCII text, else iTXt. Throws std::runtime_error for an invalid keyword,
// a zero byte or invalid UTF-8 in a text, more than 65536 notes, or if `png` is not a PNG file.
std::string with_notes(std::string_view png, const Notes& notes);

// Inserts the resolution in pixels per millimeter (pHYs) after the header. Typesetting programs take the size of a
// picture from it. Throws std::runtime_error if `png` is not a PNG file.
std::string with_resolution(std::string_view png, double pixels_per_mm);

// The notes of a PNG file, in order, before and after the pixels. The file may be untrusted. Notes that with_notes()
// cannot write are skipped: compressed texts, invalid keywords, zero bytes, invalid UTF-8.
// Throws std::runtime_error with the reason for a file that is not PNG, truncated, damaged (the checksum of every chunk
// is verified), or has more than 65536 notes. Time and memory are proportional to the size of the file; pixels are not
// decoded.
Notes png_notes(std::string_view png);

// ---- PDF files: entries of the document information dictionary, in an update at the end of the file ----

// Appends the notes to the PDF and keeps the existing entries of its information dictionary. It is an incremental
// update (ISO 32000-1, 7.5.6), which changes no byte of the file. "Title" is a standard key of PDF, "Software" becomes
// Creator; repeated keywords are numbered.
// Throws std::runtime_error for invalid UTF-8, and for a file that does not end like a PDF with a cross-reference
// table, such as one written by cairo.
std::string with_pdf_notes(std::string_view pdf, const Notes& notes);

// The notes written by with_pdf_notes(), in order; the file may be untrusted. The result may be empty. Throws
// std::runtime_error if the notes are damaged. Time and memory are proportional to the size of the file.
Notes pdf_notes(std::string_view pdf);

// ---- SVG files: escaped text, base64, and the notes in <metadata> ----

// Escapes text for XML. Throws std::runtime_error for control characters and invalid UTF-8.
std::string xml_escaped(std::string_view text);

// A <metadata> element with the notes, whose elements are in a namespace of their own.
std::string xml_notes(const Notes& notes);

// The notes written by xml_notes(), in a text with any other content. The result may be empty. Throws
// std::runtime_error if the notes are damaged.
Notes xml_notes_of(std::string_view text);

// Base64 encoding (RFC 4648).

std::string base64(std::string_view bytes);

}  // namespace achilles
