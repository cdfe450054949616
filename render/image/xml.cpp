#include "image/xml.hpp"

#include <array>
#include <stdexcept>
#include <utility>

#include "figure/label.hpp"

namespace achilles {

namespace {

constexpr std::string_view begin_notes = "<metadata xmlns:a=\"urn:achilles:origin\">\n", end_notes = "</metadata>\n";
constexpr std::string_view begin_note = "<a:note keyword=\"", end_keyword = "\">", end_note = "</a:note>\n";

// A carriage return written as itself would come back as a line feed.
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
            if (taken.size() == 1) throw std::runtime_error("its notes are damaged: an unknown entity");
        }
        result += c;
        text.remove_prefix(taken.size());
    }
    return result;
}

// What stands before `mark`, which is taken off together with it.
std::string_view take_until(std::string_view& text, std::string_view mark) {
    const std::size_t end = text.find(mark);
    if (end == std::string_view::npos) throw std::runtime_error("its notes are incomplete");
    const std::string_view taken = text.substr(0, end);
    text.remove_prefix(end + mark.size());
    return taken;
}

}  // namespace

std::string xml_escaped(std::string_view text) {
    // A sign of its own for broken UTF-8 would come back as another text.
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
    std::string text(begin_notes);
    for (const Note& note : notes) {
        text.append(begin_note).append(xml_escaped(note.keyword)).append(end_keyword);
        text.append(xml_escaped(note.text)).append(end_note);
    }
    return text.append(end_notes);
}

Notes xml_notes_of(std::string_view text) {
    Notes notes;
    const std::size_t begin = text.find(begin_notes);
    if (begin == std::string_view::npos) return notes;
    text.remove_prefix(begin + begin_notes.size());
    while (text.substr(0, begin_note.size()) == begin_note) {
        text.remove_prefix(begin_note.size());
        Note& note = notes.emplace_back();
        note.keyword = unescaped(take_until(text, end_keyword));
        note.text = unescaped(take_until(text, end_note));
    }
    if (text.substr(0, end_notes.size()) != end_notes) throw std::runtime_error("its notes are incomplete");
    return notes;
}

}  // namespace achilles
