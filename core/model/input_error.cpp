#include <algorithm>

#include "model/description.hpp"

namespace achilles {

namespace {

// At most this much of a line is shown: a file of one megabyte line must not fill the screen.
constexpr std::size_t shown_width = 120;

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// The line and, below it, a caret at a byte column. Control characters are shown as spaces.
std::string with_caret(std::string line, int column) {
    if (column < 1 || line.empty()) return {};
    auto at = std::min(static_cast<std::size_t>(column - 1), line.size());
    std::string before, after;
    if (at > shown_width / 2) {
        std::size_t cut = at - shown_width / 2;
        while (cut < at && is_continuation(line[cut])) ++cut;
        line.erase(0, cut);
        at -= cut;
        before = "...";
    }
    if (line.size() > shown_width) {
        std::size_t cut = shown_width;
        while (cut > 0 && is_continuation(line[cut])) --cut;
        line.erase(cut);
        after = "...";
    }
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    const auto letters = [](std::string_view text) {
        return static_cast<std::size_t>(
            std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
    };
    const std::size_t indent = before.size() + letters(std::string_view(line).substr(0, std::min(at, line.size())));
    return "\n    " + before + line + after + "\n    " + std::string(indent, ' ') + "^";
}

std::string whole_message(const std::string& file, Location at, const std::string& message, const std::string& hint,
                          const std::string& line) {
    std::string text = file;
    if (at.line > 0) text += ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
    text += (text.empty() ? "" : ": ") + message + with_caret(line, at.column);
    if (!hint.empty()) text += "\n" + hint;
    return text;
}

}  // namespace

InputError::InputError(std::string in_file, Location place, std::string what_is_wrong, std::string what_is_right,
                       const std::string& line)
    : std::runtime_error(whole_message(in_file, place, what_is_wrong, what_is_right, line)),
      file(std::move(in_file)),
      message(std::move(what_is_wrong)),
      hint(std::move(what_is_right)),
      at(place) {}

InputError SystemDescription::error(Location at, const std::string& message, const std::string& hint) const {
    std::size_t begin = 0;
    for (int line = 1; line < at.line && begin != std::string::npos; ++line) {
        begin = source_text.find('\n', begin);
        if (begin != std::string::npos) ++begin;
    }
    std::string line;
    if (at.line > 0 && begin != std::string::npos)
        line = source_text.substr(begin, source_text.find('\n', begin) - begin);
    return {file, at, message, hint, line};
}

}  // namespace achilles
