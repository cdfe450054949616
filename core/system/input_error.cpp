#include "system/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "system/description.hpp"

namespace achilles {

namespace {

// Size in bytes of the UTF-8 character at the start of a text; 0 if it is invalid.
std::size_t character_size(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t size = byte(0) < 0x80 ? 1 : byte(0) < 0xC2 ? 0 : byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
    if (size == 0 || byte(0) > 0xF4 || size > text.size()) return 0;
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return 0;
    }
    return size;
}

// Code point of a character of at most three bytes.
unsigned code_point(std::string_view character) {
    unsigned code = static_cast<unsigned char>(character[0]);
    if (character.size() > 1) code &= character.size() == 2 ? 0x1FU : 0x0FU;
    for (const char byte : character.substr(1)) code = code << 6 | (static_cast<unsigned char>(byte) & 0x3FU);
    return code;
}

// True for characters that control a terminal: C0 and C1 control characters, DEL, and U+202A to 202E, U+2066 to 2069,
// which change the writing direction.
bool steers_terminal(std::string_view character) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
    if (character.size() == 1) return byte(0) < 0x20 || byte(0) == 0x7F;
    if (character.size() == 2) return byte(0) == 0xC2 && byte(1) < 0xA0;
    if (character.size() != 3 || byte(0) != 0xE2) return false;
    return (byte(1) == 0x80 && byte(2) >= 0xAA && byte(2) <= 0xAE) ||
           (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9);
}

// The text as printable characters. A tab becomes a space, so that the caret below is aligned; invalid characters
// become '?'.
std::vector<std::string> characters(std::string_view text) {
    std::vector<std::string> list;
    while (!text.empty()) {
        const std::size_t size = character_size(text);
        if (text[0] == '\t') {
            list.emplace_back(" ");
        } else if (size == 0 || steers_terminal(text.substr(0, size))) {
            list.emplace_back("?");
        } else {
            list.emplace_back(text.substr(0, size));
        }
        text.remove_prefix(std::max<std::size_t>(1, size));
    }
    return list;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t size = character_size(text);
        const bool stays = text[0] == '\n' || text[0] == '\t' || (size > 0 && !steers_terminal(text.substr(0, size)));
        result += stays ? text.substr(0, size) : "?";
        text.remove_prefix(std::max<std::size_t>(1, size));
    }
    return result;
}

// Below 0x20 there are only line breaks between values; the JSON writer has escaped those inside strings.
std::string printable_json(std::string_view json) {
    std::string result;
    while (!json.empty()) {
        const std::size_t size = std::max<std::size_t>(1, character_size(json));
        const std::string_view character = json.substr(0, size);
        if (static_cast<unsigned char>(json[0]) >= 0x20 && steers_terminal(character))
            result += fmt::format("\\u{:04x}", code_point(character));
        else
            result += character;
        json.remove_prefix(size);
    }
    return result;
}

namespace {

// The line, and a caret below the column. A long line is cut to the part near the caret.
std::string with_caret(std::string_view line, int column) {
    constexpr std::size_t around = 56;
    const std::size_t target = byte_of_column(line, column);
    // A character has at most four bytes.
    std::size_t first = target > 4 * around ? target - 4 * around : 0;
    while (first > 0 && (static_cast<unsigned char>(line[first]) & 0xC0) == 0x80) --first;
    std::vector<std::string> before = characters(line.substr(first, target - first));
    std::vector<std::string> after = characters(line.substr(target, 4 * around));
    std::string shown_line;
    std::size_t indent = 0;
    if (first > 0 || before.size() > around) {
        before.erase(before.begin(), before.end() - static_cast<std::ptrdiff_t>(std::min(before.size(), around)));
        shown_line = "...";
        indent = 3;
    }
    const bool cut = after.size() > around || target + 4 * around < line.size();
    after.resize(std::min(after.size(), around));
    for (const std::string& character : before) shown_line += character;
    for (const std::string& character : after) shown_line += character;
    return fmt::format("    {}{}\n    {}^", shown_line, cut ? "..." : "", std::string(indent + before.size(), ' '));
}

std::string full_message(const std::string& file, Location at, const std::string& message, const std::string& hint,
                         const std::string& line) {
    std::string full = file.empty()  ? ""
                       : at.line > 0 ? fmt::format("{}:{}:{}: ", file, at.line, at.column)
                                     : file + ": ";
    full += message;
    if (!line.empty() && at.column > 0) full += '\n' + with_caret(line, at.column);
    if (!hint.empty()) full += '\n' + hint;
    return full;
}

std::string joined_messages(const std::vector<InputError>& all, std::size_t more) {
    std::string text;
    for (const InputError& error : all) text += fmt::format("{}{}", text.empty() ? "" : "\n\n", error.what());
    return more == 0 ? text : fmt::format("{}\n\nand {} more", text, more);
}

}  // namespace

InputError::InputError(std::string file_, Location at_, std::string message_, std::string hint_,
                       const std::string& line)
    : std::runtime_error(full_message(file_, at_, message_, hint_, line)),
      file(std::move(file_)),
      message(std::move(message_)),
      hint(std::move(hint_)),
      at(at_) {}

InputError::InputError(const InputError& first, const std::string& what)
    : std::runtime_error(what), file(first.file), message(first.message), hint(first.hint), at(first.at) {}

InputErrors::InputErrors(std::vector<InputError> all_, std::size_t more_)
    : InputError(all_.front(), joined_messages(all_, more_)), all(std::move(all_)), more(more_) {}

std::vector<InputError> each_of(const InputError& error) {
    const auto* several = dynamic_cast<const InputErrors*>(&error);
    return several == nullptr ? std::vector<InputError>{error} : several->all;
}

std::string line_of(std::string_view text, int line) {
    std::size_t begin = 0;
    for (int i = 1; i < line; ++i) {
        begin = text.find('\n', begin);
        if (begin == text.npos) return "";
        ++begin;
    }
    std::string_view found = text.substr(begin, text.find('\n', begin) - begin);
    if (found.ends_with('\r')) found.remove_suffix(1);
    return std::string(found);
}

std::size_t byte_of_column(std::string_view line, int column) {
    std::size_t byte = 0;
    for (int i = 1; i < column && byte < line.size(); ++i) {
        byte += std::max<std::size_t>(1, character_size(line.substr(byte)));
    }
    return std::min(byte, line.size());
}

std::string shown(std::string_view text) {
    constexpr std::size_t max_characters = 60;
    const std::vector<std::string> list = characters(text.substr(0, 4 * max_characters));
    std::string result;
    for (std::size_t i = 0; i < std::min(list.size(), max_characters); ++i) result += list[i];
    return list.size() > max_characters || text.size() > 4 * max_characters ? result + "..." : result;
}

std::string subnormal_parameter(std::string_view name, double value) {
    return fmt::format("the parameter '{}' is {}: such a small number is not represented with full precision", name,
                       value);
}

Location place_in(const Text& text, std::size_t offset) {
    TextPiece piece{0, text.at, text.is_written};
    for (const TextPiece& each : text.pieces)
        if (each.begin <= offset) piece = each;
    Location at = piece.at;
    if (!piece.is_written) return at;
    for (std::size_t i = piece.begin; i < offset && i < text.text.size(); ++i) {
        if ((static_cast<unsigned char>(text.text[i]) & 0xC0) == 0x80) continue;  // inside a UTF-8 character
        ++at.column;
        if (text.text[i] == '\n') at = {at.line + 1, 1};
    }
    return at;
}

namespace {

constexpr std::size_t max_stored = 1000;  // in the order of reading; more are of no use
constexpr std::size_t max_printed = 10;

}  // namespace

void ErrorCollector::add(Mistake mistake) {
    ++count_;
    if (stored_.size() < max_stored) stored_.push_back(std::move(mistake));
}

void ErrorCollector::raise(const SystemDescription& system) const {
    if (count_ == 0) return;
    std::vector<Mistake> sorted = stored_;
    const auto place = [](const Mistake& mistake) { return std::tuple(mistake.at.line, mistake.at.column); };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Mistake& a, const Mistake& b) { return place(a) < place(b); });
    std::vector<InputError> reported;
    for (std::size_t i = 0; i < std::min(sorted.size(), max_printed); ++i)
        reported.emplace_back(system.file, sorted[i].at, sorted[i].message, sorted[i].hint,
                              sorted[i].has_line ? line_of(system.source_text, sorted[i].at.line) : "");
    const std::size_t more = count_ - reported.size();
    throw InputErrors(std::move(reported), more);
}

}  // namespace achilles
