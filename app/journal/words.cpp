#include "journal/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "expression/parse.hpp"
#include "expression/read_number.hpp"

namespace achilles {

namespace {

constexpr std::string_view spaces = " \t\r";

// What would end the line or the word, and how it is written: \n.
constexpr std::array<std::pair<char, char>, 3> escapes{{{'n', '\n'}, {'t', '\t'}, {'r', '\r'}}};

char meant_by(char letter) {
    for (const auto& [written, meant] : escapes)
        if (written == letter) return meant;
    return letter;
}

std::size_t skip_space(std::string_view text, std::size_t at) {
    return std::min(text.find_first_not_of(spaces, at), text.size());
}

}  // namespace

Line::Line(std::string_view text, const std::string& file, int number) : text_(text), file_(file), number_(number) {
    for (std::size_t at = skip_space(text, 0); at < text.size() && text[at] != '#'; at = skip_space(text, at)) {
        const int column = static_cast<int>(at) + 1;
        words_.push_back({text[at] == '"' ? quoted(at) : plain(at), column});
    }
}

InputError Line::error(int column, const std::string& message, const std::string& hint) const {
    return {file_, {number_, column}, message, hint, std::string(text_)};
}

void Line::expect_arguments(std::size_t least, std::size_t most, const std::string& usage) const {
    const int end = static_cast<int>(text_.find_last_not_of(spaces)) + 2;
    if (count() < least + 1) throw error(end, fmt::format("'{}' needs more arguments", words_[0].text), usage);
    if (count() > most + 1)
        throw error(words_[most + 1].column, fmt::format("unexpected argument '{}'", words_[most + 1].text), usage);
}

double Line::number(std::size_t i) const {
    try {
        return read_number(words_[i].text).value;
    } catch (const ParseError& problem) {
        throw error(words_[i].column, problem.what());
    }
}

int Line::whole_number(std::size_t i) const {
    const double value = number(i);
    if (value != std::floor(value) || std::abs(value) > 1e9)
        throw error(words_[i].column, fmt::format("'{}' is not a whole number", words_[i].text));
    return static_cast<int>(value);
}

std::string Line::plain(std::size_t& at) const {
    const std::size_t begin = at;
    at = std::min(text_.find_first_of(spaces, at), text_.size());
    return std::string(text_.substr(begin, at - begin));
}

std::string Line::quoted(std::size_t& at) const {
    const int column = static_cast<int>(at) + 1;
    std::string result;
    for (++at; at < text_.size() && text_[at] != '"'; ++at) {
        const bool escaped = text_[at] == '\\' && at + 1 < text_.size();
        if (escaped) ++at;
        result += escaped ? meant_by(text_[at]) : text_[at];
    }
    if (at == text_.size()) throw error(column, "the quotes are not closed");
    ++at;
    return result;
}

std::string quoted(const std::string& word) {
    std::string text = "\"";
    for (const char c : word) {
        const auto* special =
            std::find_if(escapes.begin(), escapes.end(), [c](const auto& e) { return e.second == c; });
        if (special != escapes.end() || c == '"' || c == '\\') text += '\\';
        text += special != escapes.end() ? special->first : c;
    }
    return text + '"';
}

std::string quoted_where_needed(const std::string& word) {
    const bool is_plain = !word.empty() && word[0] != '#' && word.find_first_of(" \t\r\n\"\\") == std::string::npos;
    return is_plain ? word : quoted(word);
}

bool is_blank(std::string_view line) {
    const std::size_t first = skip_space(line, 0);
    return first == line.size() || line[first] == '#';
}

}  // namespace achilles
