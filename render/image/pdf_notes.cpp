#include "image/pdf_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <stdexcept>
#include <utility>

#include "figure/label.hpp"

namespace achilles {

namespace {

// The comment in front of our notes, each of which is a line. What is no letter of a word is written as a number.
constexpr std::string_view begin_notes = "\n%Achilles notes\n", end_notes = ">>\n";
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> own_names{
    {{"Software", "Creator"}, {"Title", "Title"}}};
constexpr std::string_view mark = "\xFE\xFF";             // of UTF-16
constexpr std::size_t most_notes = std::size_t{1} << 16;  // those of a stranger take ten times their file's size

std::runtime_error damaged() { return std::runtime_error("its notes are damaged"); }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

std::string name_of(const std::string& keyword) {
    for (const auto& [ours, theirs] : own_names)
        if (keyword == ours) return "/" + std::string(theirs);
    std::string name = "/";
    for (const char c : keyword)
        name += is_letter(c) ? std::string(1, c) : fmt::format("#{:02X}", static_cast<unsigned char>(c));
    return name;
}

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// UTF-16, the larger byte first, behind the mark that says so.
std::string utf16(std::string_view text) {
    std::string bytes(mark);
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

// Back again; what is no UTF-16 is damage.
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

// A string in parentheses, on one line and in ASCII: readable where the text is.
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

// Of a line's rest, from the parenthesis to the one that closes it.
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
        bytes.starts_with(mark) ? utf8_of_utf16(std::string_view(bytes).substr(mark.size())) : bytes;
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
    // A dictionary has a key once: the second is "... 2".
    const std::size_t last = keyword.find_last_not_of("0123456789");
    if (last != std::string::npos && last + 1 < keyword.size() && keyword[last] == ' ') keyword.resize(last);
    return keyword;
}

// What follows the last of these words, up to `end`.
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
    result += begin_notes;
    std::map<std::string, int> times;
    for (const Note& note : notes) {
        const int n = ++times[note.keyword];
        const std::string keyword = n == 1 ? note.keyword : fmt::format("{} {}", note.keyword, n);
        result += name_of(keyword) + " " + written(note.text) + "\n";
    }
    result.append(end_notes).append("endobj\n");
    const std::size_t table = result.size();
    result += fmt::format("xref\n{} 1\n{:010d} 00000 n \ntrailer\n<<", object, at);
    result.append(trailer);
    while (result.ends_with('\n')) result.pop_back();
    return result + fmt::format("\n   /Prev {}\n>>\nstartxref\n{}\n%%EOF\n", before, table);
}

Notes pdf_notes(std::string_view pdf) {
    Notes notes;
    const std::size_t begin = pdf.rfind(begin_notes);
    if (begin == std::string_view::npos) return notes;
    pdf.remove_prefix(begin + begin_notes.size());
    while (!pdf.starts_with(end_notes)) {
        const std::size_t end = pdf.find('\n');
        if (end == std::string_view::npos) throw std::runtime_error("its notes are incomplete");
        const std::string_view line = pdf.substr(0, end);
        const std::size_t space = line.find(' ');
        if (!line.starts_with('/') || space == std::string_view::npos || notes.size() == most_notes) throw damaged();
        notes.push_back({keyword_of(line.substr(1, space - 1)), read_string(line.substr(space + 1))});
        pdf.remove_prefix(end + 1);
    }
    return notes;
}

}  // namespace achilles
