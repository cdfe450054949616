#include "image/png_notes.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "figure/label.hpp"

namespace achilles {

namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t header_size = 12 + 13;  // of the first chunk, IHDR, with length, name and check sum
constexpr std::size_t longest_chunk = 0x7FFFFFFF, longest_keyword = 79;
// A note in memory is larger than an empty one in a file: without a limit a file of a gigabyte would take six.
constexpr std::size_t most_notes = std::size_t{1} << 16;
constexpr const char* too_many = "a PNG file holds at most 65536 notes";

std::uint32_t check_sum(std::string_view bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string big_endian(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
            static_cast<char>(value)};
}

// At least four bytes are there.
std::uint32_t big_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
}

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

bool is_keyword(std::string_view word) {
    const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
    return !word.empty() && word.size() <= longest_keyword && std::all_of(word.begin(), word.end(), is_printable);
}

bool is_text(std::string_view text) { return text.find('\0') == std::string_view::npos && is_utf8(text); }

// Where the chunks after the header begin.
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
    // iTXt: keyword, end, not compressed (2 bytes), no language, no translated keyword, text.
    const std::string body = is_ascii(note.text) ? "tEXt" + note.keyword + std::string(zeros.substr(0, 1)) + note.text
                                                 : "iTXt" + note.keyword + std::string(zeros) + note.text;
    if (body.size() - 4 > longest_chunk) throw std::runtime_error("a note is too long for a PNG file");
    return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(check_sum(body));
}

// What stands before the next zero byte, which is taken off together with it.
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

// Nothing for a compressed one: we write none, and a stranger's may unpack to a thousand times its size.
std::optional<Note> read_international_text(std::string_view data) {
    const std::string keyword(take_word(data));
    if (data.size() < 2) throw std::runtime_error("the PNG file is damaged: a text chunk is too short");
    const bool compressed = data[0] != 0;
    data.remove_prefix(2);
    take_word(data);  // the language
    take_word(data);  // the keyword in it
    if (compressed) return std::nullopt;
    return Note{keyword, std::string(data)};
}

// What with_notes could not have written is left out: it is nobody's but the stranger's who wrote it.
void read_note(std::string_view name, std::string_view data, Notes& notes) {
    std::optional<Note> note;
    if (name == "tEXt") note = read_text(data);
    if (name == "iTXt") note = read_international_text(data);
    if (!note || !is_keyword(note->keyword) || !is_text(note->text)) return;
    if (notes.size() == most_notes) throw std::runtime_error(too_many);
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
    if (notes.size() > most_notes) throw std::runtime_error(too_many);
    std::string result(png.substr(0, begin));
    for (const Note& note : notes) result += chunk(note);
    return result.append(png.substr(begin));
}

// libpng would be longer: it has to be led past the pixels, which it keeps a copy of, and kept from unpacking.
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

}  // namespace achilles
