#include "image/notes.hpp"

#include <fmt/format.h>
#include <zlib.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "figure/label.hpp"

namespace achilles {

// ---- PNG ----

namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t header_size = 12 + 13;  // of the first chunk, IHDR, with length, name and checksum
constexpr std::size_t longest_chunk = 0x7FFFFFFF, longest_keyword = 79;
// A note in memory is larger than an empty note in a file. Without a limit, a file of 1 GB would take 6 GB.
constexpr const char* too_many = "a PNG file holds at most 65536 notes";

std::uint32_t check_sum(std::string_view bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string big_endian(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
            static_cast<char>(value)};
}

// Requires at least four bytes.
std::uint32_t big_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
}

bool is_keyword(std::string_view word) {
    const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
    return !word.empty() && word.size() <= longest_keyword && std::all_of(word.begin(), word.end(), is_printable);
}

bool is_text(std::string_view text) { return text.find('\0') == std::string_view::npos && is_utf8(text); }

// Offset of the first chunk after the header.
std::size_t header_end(std::string_view png) {
    const std::size_t end = signature.size() + header_size;
    if (png.size() < end || png.substr(0, signature.size()) != signature)
        throw std::runtime_error("notes can be added only to a PNG file");
    return end;
}

std::string chunk(const Note& note) {
    if (!is_keyword(note.keyword))
        throw std::runtime_error("'" + note.keyword + "' is not a valid keyword of a note in a PNG file");
    if (!is_text(note.text)) throw std::runtime_error("only UTF-8 text without zero bytes can be stored in a PNG file");
    const std::string_view zeros("\0\0\0\0\0", 5);
    // iTXt: keyword, zero, not compressed (2 bytes), no language, no translated keyword, text.
    const std::string body = is_ascii(note.text) ? "tEXt" + note.keyword + std::string(zeros.substr(0, 1)) + note.text
                                                 : "iTXt" + note.keyword + std::string(zeros) + note.text;
    if (body.size() - 4 > longest_chunk) throw std::runtime_error("a note is too long for a PNG file");
    return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(check_sum(body));
}

// The text before the next zero byte. Removes both from `bytes`.
std::string_view take_word(std::string_view& bytes) {
    const std::size_t end = bytes.find('\0');
    if (end == std::string_view::npos) throw std::runtime_error("the PNG file is damaged: a text chunk has no keyword");
    const std::string_view word = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return word;
}

std::string utf8_of_latin1(std::string_view text) {
    if (is_ascii(text)) return std::string(text);
    std::string result;
    for (const char c : text) result += utf8(static_cast<unsigned char>(c));
    return result;
}

Note read_text(std::string_view data) {
    const std::string keyword(take_word(data));
    return {keyword, utf8_of_latin1(data)};
}

// Reads an iTXt chunk. Returns nullopt if its text is compressed: this library writes none, and an untrusted one may
// expand to a thousand times its size.
std::optional<Note> read_international_text(std::string_view data) {
    const std::string keyword(take_word(data));
    if (data.size() < 2) throw std::runtime_error("the PNG file is damaged: a text chunk is too short");
    const bool compressed = data[0] != 0;
    data.remove_prefix(2);
    take_word(data);  // language
    take_word(data);  // translated keyword
    if (compressed) return std::nullopt;
    return Note{keyword, std::string(data)};
}

// Skips notes that with_notes() cannot write.
void read_note(std::string_view name, std::string_view data, Notes& notes) {
    std::optional<Note> note;
    if (name == "tEXt") note = read_text(data);
    if (name == "iTXt") note = read_international_text(data);
    if (!note || !is_keyword(note->keyword) || !is_text(note->text)) return;
    if (notes.size() == max_notes) throw std::runtime_error(too_many);
    notes.push_back(*std::move(note));
}

}  // namespace

std::string with_resolution(std::string_view png, double pixels_per_mm) {
    const std::size_t begin = header_end(png);
    const std::string per_metre = big_endian(static_cast<std::uint32_t>(std::lround(1000.0 * pixels_per_mm)));
    const std::string body = "pHYs" + per_metre + per_metre + '\1';
    return std::string(png.substr(0, begin)) + big_endian(9) + body + big_endian(check_sum(body)) +
           std::string(png.substr(begin));
}

std::string with_notes(std::string_view png, const Notes& notes) {
    const std::size_t begin = header_end(png);
    if (notes.size() > max_notes) throw std::runtime_error(too_many);
    std::string result(png.substr(0, begin));
    for (const Note& note : notes) result += chunk(note);
    return result.append(png.substr(begin));
}

// libpng would take more code: it keeps a copy of the pixels that must be skipped, and it decompresses texts.
Notes png_notes(std::string_view png) {
    if (png.substr(0, signature.size()) != signature) throw std::runtime_error("this is not a PNG file");
    png.remove_prefix(signature.size());
    Notes notes;
    for (;;) {
        if (png.size() < 12) throw std::runtime_error("the PNG file is incomplete");
        const std::size_t length = big_endian(png);
        if (length > png.size() - 12) throw std::runtime_error("the PNG file is incomplete");
        const std::string_view body = png.substr(4, 4 + length), name = body.substr(0, 4);
        if (check_sum(body) != big_endian(png.substr(8 + length)))
            throw std::runtime_error("the PNG file is damaged: a checksum is wrong");
        if (name == "IEND") return notes;
        read_note(name, body.substr(4), notes);
        png.remove_prefix(12 + length);
    }
}

// ---- PDF ----

namespace {

// The comment before the notes, each of which is one line. Characters other than letters and digits are written as
// numbers.
constexpr std::string_view notes_begin = "\n%Achilles notes\n", notes_end = ">>\n";
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> own_names{
    {{"Software", "Creator"}, {"Title", "Title"}}};
constexpr std::string_view utf16_mark = "\xFE\xFF";  // byte order mark

std::runtime_error damaged() {
    return std::runtime_error("the PDF file is damaged: the command and parameters stored in it cannot be read");
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

std::string name_of(const std::string& keyword) {
    for (const auto& [ours, theirs] : own_names)
        if (keyword == ours) return "/" + std::string(theirs);
    std::string name = "/";
    for (const char c : keyword)
        name += is_letter(c) ? std::string(1, c) : fmt::format("#{:02X}", static_cast<unsigned char>(c));
    return name;
}

// UTF-16, big-endian, with a byte order mark.
std::string utf16(std::string_view text) {
    std::string bytes(utf16_mark);
    const auto add = [&](char32_t unit) {
        bytes += static_cast<char>(unit >> 8);
        bytes += static_cast<char>(unit & 0xFF);
    };
    for (std::size_t at = 0; at < text.size();) {
        const char32_t code = next_code_point(text, at);
        if (code < 0x10000) {
            add(code);
        } else {
            add(0xD800 + ((code - 0x10000) >> 10));
            add(0xDC00 + ((code - 0x10000) & 0x3FF));
        }
    }
    return bytes;
}

// Inverse of utf16(), without the byte order mark. Throws for an incomplete code unit or surrogate pair.
std::string utf8_of_utf16(std::string_view bytes) {
    std::string text;
    const auto next = [&] {
        if (bytes.size() < 2) throw damaged();
        const char32_t unit = static_cast<unsigned char>(bytes[0]) * 256U + static_cast<unsigned char>(bytes[1]);
        bytes.remove_prefix(2);
        return unit;
    };
    while (!bytes.empty()) {
        char32_t code = next();
        if (code >= 0xD800 && code < 0xDC00) {
            const char32_t low = next();
            if (low < 0xDC00 || low >= 0xE000) throw damaged();
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        }
        text += utf8(code);
    }
    return text;
}

// A PDF string in parentheses, on one line and in ASCII: readable if the text is ASCII.
std::string written(std::string_view text) {
    if (!is_utf8(text)) throw std::runtime_error("text that is not UTF-8 cannot be stored in a PDF file");
    std::string result = "(";
    for (const char c : is_ascii(text) ? std::string(text) : utf16(text)) {
        if (c == '(' || c == ')' || c == '\\')
            result += std::string("\\") + c;
        else if (c >= ' ' && c <= '~')
            result += c;
        else
            result += c == '\n' ? "\\n" : fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    }
    return result + ")";
}

// The bytes of a PDF string that fills the rest of a line.
std::string read_string(std::string_view line) {
    if (line.size() < 2 || line.front() != '(' || line.back() != ')') throw damaged();
    line = line.substr(1, line.size() - 2);
    std::string bytes;
    while (!line.empty()) {
        std::size_t taken = 1;
        char c = line[0];
        if (c == '\\') {
            if (line.size() < 2) throw damaged();
            c = line[1];
            taken = 2;
            if (c >= '0' && c <= '3') {
                unsigned value = 0;
                if (line.size() < 4) throw damaged();
                if (std::from_chars(line.data() + 1, line.data() + 4, value, 8).ptr != line.data() + 4) throw damaged();
                c = static_cast<char>(value);
                taken = 4;
            } else if (c == 'n') {
                c = '\n';
            }
        }
        bytes += c;
        line.remove_prefix(taken);
    }
    const std::string text =
        bytes.starts_with(utf16_mark) ? utf8_of_utf16(std::string_view(bytes).substr(utf16_mark.size())) : bytes;
    if (!is_utf8(text)) throw damaged();
    return text;
}

// "Achilles#20System" is "Achilles System".
std::string keyword_of(std::string_view name) {
    for (const auto& [ours, theirs] : own_names)
        if (name == theirs) return std::string(ours);
    std::string keyword;
    while (!name.empty()) {
        std::size_t taken = 1;
        char c = name[0];
        if (c == '#') {
            unsigned code = 0;
            if (name.size() < 3 || std::from_chars(name.data() + 1, name.data() + 3, code, 16).ptr != name.data() + 3)
                throw damaged();
            c = static_cast<char>(code);
            taken = 3;
        }
        keyword += c;
        name.remove_prefix(taken);
    }
    // A dictionary has unique keys: the second occurrence of a keyword is "... 2".
    const std::size_t last = keyword.find_last_not_of("0123456789");
    if (last != std::string::npos && last + 1 < keyword.size() && keyword[last] == ' ') keyword.resize(last);
    return keyword;
}

// The text after the last occurrence of `word`, up to `end`.
std::string_view after_last(std::string_view text, std::string_view word, std::string_view end) {
    const std::size_t at = text.rfind(word);
    const std::size_t stop = at == std::string_view::npos ? at : text.find(end, at + word.size());
    if (stop == std::string_view::npos) throw std::runtime_error("notes cannot be added to this form of PDF file");
    return text.substr(at + word.size(), stop - at - word.size());
}

std::size_t number(std::string_view text) {
    std::size_t value = 0;
    text.remove_prefix(std::min(text.find_first_not_of(" \n"), text.size()));
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

}  // namespace

std::string with_pdf_notes(std::string_view pdf, const Notes& notes) {
    const std::string_view trailer = after_last(pdf, "trailer\n<<", ">>");
    const std::size_t before = number(after_last(pdf, "startxref\n", "\n"));
    const std::size_t object = number(after_last(trailer, "/Info", "R"));
    const std::string begin = fmt::format("\n{} 0 obj\n<<", object);
    const std::string_view said = after_last(pdf, begin, ">>\nendobj");
    std::string result(pdf);
    if (!result.ends_with('\n')) result += '\n';
    const std::size_t at = result.size();
    result += begin.substr(1);
    result.append(said);
    while (result.ends_with('\n')) result.pop_back();
    result += notes_begin;
    std::map<std::string, int> times;
    for (const Note& note : notes) {
        const int n = ++times[note.keyword];
        const std::string keyword = n == 1 ? note.keyword : fmt::format("{} {}", note.keyword, n);
        result += name_of(keyword) + " " + written(note.text) + "\n";
    }
    result.append(notes_end).append("endobj\n");
    const std::size_t table = result.size();
    result += fmt::format("xref\n{} 1\n{:010d} 00000 n \ntrailer\n<<", object, at);
    result.append(trailer);
    while (result.ends_with('\n')) result.pop_back();
    return result + fmt::format("\n   /Prev {}\n>>\nstartxref\n{}\n%%EOF\n", before, table);
}

Notes pdf_notes(std::string_view pdf) {
    Notes notes;
    const std::size_t begin = pdf.rfind(notes_begin);
    if (begin == std::string_view::npos) return notes;
    pdf.remove_prefix(begin + notes_begin.size());
    while (!pdf.starts_with(notes_end)) {
        const std::size_t end = pdf.find('\n');
        if (end == std::string_view::npos) throw std::runtime_error("its notes are incomplete");
        const std::string_view line = pdf.substr(0, end);
        const std::size_t space = line.find(' ');
        if (!line.starts_with('/') || space == std::string_view::npos || notes.size() == max_notes) throw damaged();
        notes.push_back({keyword_of(line.substr(1, space - 1)), read_string(line.substr(space + 1))});
        pdf.remove_prefix(end + 1);
    }
    return notes;
}

namespace {

constexpr std::string_view metadata_begin = "<metadata xmlns:a=\"urn:achilles:origin\">\n",
                           metadata_end = "</metadata>\n";
constexpr std::string_view begin_note = "<a:note keyword=\"", end_keyword = "\">", end_note = "</a:note>\n";

// A literal carriage return would be read as a line feed.
constexpr std::array<std::pair<char, std::string_view>, 5> entities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\r', "&#13;"}}};

std::string unescaped(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        std::string_view taken = text.substr(0, 1);
        char c = text[0];
        if (c == '&') {
            for (const auto& [plain, entity] : entities)
                if (text.substr(0, entity.size()) == entity) c = plain, taken = entity;
            if (taken.size() == 1)
                throw std::runtime_error("the SVG file is damaged: an unknown entity in what is stored in it");
        }
        result += c;
        text.remove_prefix(taken.size());
    }
    return result;
}

// The text before `mark`. Removes both from `text`.
std::string_view take_until(std::string_view& text, std::string_view mark) {
    const std::size_t end = text.find(mark);
    if (end == std::string_view::npos) throw std::runtime_error("its notes are incomplete");
    const std::string_view taken = text.substr(0, end);
    text.remove_prefix(end + mark.size());
    return taken;
}

}  // namespace

std::string xml_escaped(std::string_view text) {
    // Replacing invalid UTF-8 would change the text.
    if (!is_utf8(text)) throw std::runtime_error("text that is not UTF-8 cannot be stored in an SVG file");
    std::string result;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 && c != '\t' && c != '\n' && c != '\r')
            throw std::runtime_error("a control character cannot be stored in an SVG file");
        std::string_view written(&c, 1);
        for (const auto& [plain, entity] : entities)
            if (c == plain) written = entity;
        result += written;
    }
    return result;
}

std::string xml_notes(const Notes& notes) {
    std::string text(metadata_begin);
    for (const Note& note : notes) {
        text.append(begin_note).append(xml_escaped(note.keyword)).append(end_keyword);
        text.append(xml_escaped(note.text)).append(end_note);
    }
    return text.append(metadata_end);
}

Notes xml_notes_of(std::string_view text) {
    Notes notes;
    const std::size_t begin = text.find(metadata_begin);
    if (begin == std::string_view::npos) return notes;
    text.remove_prefix(begin + metadata_begin.size());
    while (text.substr(0, begin_note.size()) == begin_note) {
        text.remove_prefix(begin_note.size());
        Note& note = notes.emplace_back();
        note.keyword = unescaped(take_until(text, end_keyword));
        note.text = unescaped(take_until(text, end_note));
    }
    if (text.substr(0, metadata_end.size()) != metadata_end) throw std::runtime_error("its notes are incomplete");
    return notes;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::string_view three = bytes.substr(i, 3);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (k < three.size() ? static_cast<unsigned char>(three[k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= three.size() ? letters[bits >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

}  // namespace achilles
