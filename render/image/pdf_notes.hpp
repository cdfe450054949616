// Notes in PDF files: entries of the document information dictionary, in an update that stands at the file's end.
#pragma once

#include <string>
#include <string_view>

#include "image/note.hpp"

namespace achilles {

// The PDF with the notes, and with what its information dictionary said before: an incremental update (ISO 32000-1,
// 7.5.6), by which no byte of the file changes. "Title" is PDF's own, "Software" its Creator; where a keyword occurs
// again it is numbered. Throws std::runtime_error for broken UTF-8 and for a file whose end is not that of a PDF with a
// cross-reference table, such as cairo's.
std::string with_pdf_notes(std::string_view pdf, const Notes& notes);

// The notes that with_pdf_notes wrote, in order, from a file that may come from anywhere. No notes at all is a valid
// answer. Throws std::runtime_error where they are damaged. Takes time and memory proportional to the file's size.
Notes pdf_notes(std::string_view pdf);

}  // namespace achilles
