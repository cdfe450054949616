#include "figure/label.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "number/angle.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// End of the number that begins at i, including its exponent: the e of 1e3 is not a name with an index.
std::size_t end_of_number(std::string_view text, std::size_t i) {
    while (i < text.size() && (is_digit(text[i]) || text[i] == '.')) ++i;
    std::size_t exponent = i;
    if (exponent < text.size() && (text[exponent] == 'e' || text[exponent] == 'E')) ++exponent;
    if (exponent == i) return i;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    if (exponent == text.size() || !is_digit(text[exponent])) return i;
    while (exponent < text.size() && is_digit(text[exponent])) ++exponent;
    return exponent;
}

}  // namespace

namespace {

// theta1'' is the letter theta, the index 1 and two primes; x_ball has a subscript of letters.
struct Name {
    explicit Name(std::string_view text) {
        const std::size_t primes_at = std::min(text.find('\''), text.size());
        primes = text.size() - primes_at;
        word = text.substr(0, primes_at);
        std::size_t digits_at = word.size();
        while (digits_at > 1 && is_digit(word[digits_at - 1])) --digits_at;
        digits = word.substr(digits_at);
        word = word.substr(0, digits_at);
        while (!digits.empty() && word.size() > 1 && word.back() == '_') word.remove_suffix(1);
    }
    std::string_view word, digits;
    std::size_t primes;
};

std::string display_letter(std::string_view word) {
    if (word == "gap") return "h";
    for (const auto& [name, letter] : greek_letters)
        if (name == word) return std::string(letter);
    return std::string(word);
}

std::string dots_of(const Name& name) { return name.primes == 1 ? "\u0307" : name.primes == 2 ? "\u0308" : ""; }

std::string index_of(std::string_view digits) {
    std::string text;
    for (const char digit : digits)
        text += std::string("\u2080").replace(2, 1, 1, static_cast<char>(0x80 + (digit - '0')));
    return text;
}

// Unicode's italic alphabets: first code, and the plain letter that it stands for.
struct Alphabet {
    char32_t italic, first;
    char32_t count;
};
constexpr std::array<Alphabet, 5> alphabets{{{0x1D434, 'A', 26},
                                             {0x1D44E, 'a', 26},
                                             {0x210E, 'h', 1},  // older than the others, whose position for it is
                                                                // unassigned
                                             {0x1D6E2, 0x0391, 25},
                                             {0x1D6FC, 0x03B1, 25}}};

// A one-letter word in italics; longer words and the number pi stay upright.
std::string italic(const std::string& word) {
    const std::vector<Letter> all = letters(word);
    if (all.size() != 1 || word == "\u03C0") return word;
    const char32_t code = all[0].code;
    if (code == 'h') return utf8(0x210E);
    for (const Alphabet& alphabet : alphabets)
        if (code >= alphabet.first && code < alphabet.first + alphabet.count)
            return utf8(alphabet.italic + (code - alphabet.first));
    return word;
}

// Position of the underscore before a subscript of letters, as in x_ball or lambda_knee; 0 if there is none. Exactly
// one letter must precede it: other words with an underscore are kept as words.
std::size_t bar_of(const Name& name) {
    const std::size_t bar = name.word.find('_');
    if (bar == std::string_view::npos || bar + 1 == name.word.size()) return 0;
    return letters(display_letter(name.word.substr(0, bar))).size() == 1 ? bar : 0;
}

// Quantities of dry friction in views (system/description.hpp, sliding_names): of one contact or joint, and before the
// name of one of several, which becomes a subscript.
struct FrictionWord {
    std::string_view name, alone, of_several;
};
constexpr std::array<FrictionWord, 2> friction_words{
    {{"friction_force", "friction force", "friction"}, {"slip", "slip", "slip"}}};

// A name as a label.
std::string variable(std::string_view text) {
    for (const FrictionWord& word : friction_words) {
        if (text == word.name) return std::string(word.alone);
        if (text.starts_with(word.name) && text.substr(word.name.size()).starts_with('_'))
            return std::string(word.of_several) + "_{" + std::string(text.substr(word.name.size() + 1)) + "}";
    }
    const Name name(text);
    const std::size_t bar = bar_of(name);
    if (bar == 0) return italic(display_letter(name.word)) + dots_of(name) + index_of(name.digits);
    const std::string index = display_letter(name.word.substr(bar + 1)) + std::string(name.digits);
    return italic(display_letter(name.word.substr(0, bar))) + dots_of(name) + "_{" + index + "}";
}

constexpr std::array<std::string_view, 10> powers{"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                  "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};

// End of an integer power that begins at i ('^' and digits only); i if there is none.
std::size_t end_of_power(std::string_view text, std::size_t i) {
    std::size_t end = i + 1;
    while (text[i] == '^' && end < text.size() && is_digit(text[end])) ++end;
    const bool whole =
        end > i + 1 && (end == text.size() || (text[end] != '.' && text[end] != 'e' && text[end] != 'E'));
    return whole ? end : i;
}

}  // namespace

std::string utf8(char32_t c) {
    const auto tail = [c](int shift) { return static_cast<char>(0x80 | (c >> shift & 0x3F)); };
    if (c < 0x80) return {static_cast<char>(c)};
    if (c < 0x800) return {static_cast<char>(0xC0 | c >> 6), tail(0)};
    if (c < 0x10000) return {static_cast<char>(0xE0 | c >> 12), tail(6), tail(0)};
    return {static_cast<char>(0xF0 | c >> 18), tail(12), tail(6), tail(0)};
}

std::string typeset_name(std::string_view text) {
    const Name name(text);
    const std::size_t bar = bar_of(name);
    if (bar == 0) return display_letter(name.word) + dots_of(name) + index_of(name.digits);
    return display_letter(name.word.substr(0, bar)) + dots_of(name) + "_" + std::string(name.word.substr(bar + 1)) +
           index_of(name.digits);
}

std::string typeset(std::string_view expression) {
    std::string text;
    for (std::size_t i = 0; i < expression.size();) {
        const char c = expression[i];
        std::size_t end = i;
        if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
            while (end < expression.size() && is_name_part(expression[end])) ++end;
            while (end < expression.size() && expression[end] == '\'') ++end;
            text += variable(expression.substr(i, end - i));
        } else if (is_digit(c) || c == '.') {
            end = end_of_number(expression, i);
            for (const char part : expression.substr(i, end - i)) text += part == '-' ? "\u2212" : std::string(1, part);
        } else if (end_of_power(expression, i) > i) {
            end = end_of_power(expression, i);
            for (const char digit : expression.substr(i + 1, end - i - 1))
                text += powers[static_cast<std::size_t>(digit - '0')];
        } else {
            ++end;
            text += c == '*' ? "\u00B7" : c == '-' ? "\u2212" : std::string(1, c);
        }
        i = end;
    }
    return text;
}

std::string typeset_unit(std::string_view unit) {
    std::string text;
    for (std::size_t i = 0; i < unit.size();) {
        const std::size_t end = end_of_power(unit, i);
        for (std::size_t k = i + 1; k < end; ++k) text += powers[static_cast<std::size_t>(unit[k] - '0')];
        if (end == i) text += unit[i] == '*' ? "\u00B7" : std::string(1, unit[i]);
        i = std::max(end, i + 1);
    }
    return text;
}

std::string with_unit(const std::string& label, const std::string& unit) {
    return unit.empty() ? label : label + " (" + unit + ")";
}

namespace {

// The first `size` bytes of a label with an ellipsis. A truncated subscript is closed.
std::string beginning(const std::string& label, std::size_t size) {
    std::string text = label.substr(0, size);
    const std::size_t open = text.rfind('{');
    const bool inside = open != std::string::npos && text.find('}', open) == std::string::npos;
    if (inside && open + 1 == text.size()) return text.substr(0, open - 1) + "\u2026";
    return text + "\u2026" + (inside ? "}" : "");
}

}  // namespace

std::string shortened(const std::string& label, const std::function<bool(const std::string&)>& fits, EllipsisMode cut) {
    if (fits(label)) return label;
    const std::size_t open = label.ends_with(')') ? label.rfind(" (") : std::string::npos;
    const std::string words = label.substr(0, open), unit = open == std::string::npos ? "" : label.substr(open);
    std::string shorter;
    for (std::size_t end = words.rfind(' '); cut == EllipsisMode::words && end != std::string::npos && end > 0;
         end = words.rfind(' ', end - 1))
        if (shorter = beginning(words, end) + unit; fits(shorter)) return shorter;
    for (std::size_t end = words.size(); end > 0;) {
        do --end;
        while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0) == 0x80);
        if (end == 0) break;
        const bool in_sign = words[end] == '{' || (end + 1 < words.size() && words[end + 1] == '{');
        if (in_sign) continue;
        if (shorter = beginning(words, end) + unit; fits(shorter)) return shorter;
    }
    return shorter.empty() ? label : shorter;
}

char32_t next_code_point(std::string_view text, std::size_t& at) {
    constexpr char32_t replacement = 0xFFFD;
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const unsigned lead = byte(at++);
    if (lead < 0x80) return lead;
    const std::size_t more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    if (more == 0) return replacement;
    char32_t value = lead & (0x3FU >> more);
    for (std::size_t i = 0; i < more; ++i) {
        if ((byte(at + i) & 0xC0U) != 0x80U) return replacement;
        value = value << 6 | (byte(at + i) & 0x3FU);
    }
    at += more;
    return value;
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        if (static_cast<unsigned char>(text[i]) < 0x80) {  // most bytes of any text
            ++i;
            continue;
        }
        const std::size_t begin = i;
        const char32_t code = next_code_point(text, i);
        const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
        // Encoding it again must give the same bytes. This rejects invalid and overlong forms and codes out of range.
        if (is_surrogate || code > 0x10FFFF || (code & 0xFFFE) == 0xFFFE || utf8(code) != text.substr(begin, i - begin))
            return false;
    }
    return true;
}

namespace {

// The plain letter of one of Unicode's styled letters.
Letter plain(char32_t c) {
    for (const Alphabet& alphabet : alphabets)
        if (c >= alphabet.italic && c < alphabet.italic + alphabet.count)
            return {alphabet.first + (c - alphabet.italic), true, 0, 0};
    if (c >= 0x2080 && c <= 0x2089) return {'0' + (c - 0x2080), false, -1, 0};
    if (c == 0x00B9) return {'1', false, 1, 0};
    if (c == 0x00B2 || c == 0x00B3) return {'2' + (c - 0x00B2), false, 1, 0};
    if (c == 0x2070 || (c >= 0x2074 && c <= 0x2079)) return {'0' + (c - 0x2070), false, 1, 0};
    if (c == 0x207A || c == 0x207B) return {c == 0x207A ? U'+' : U'\u2212', false, 1, 0};
    return {c, false, 0, 0};
}

}  // namespace

std::string upright(std::string_view label) {
    std::string result;
    for (std::size_t i = 0; i < label.size();) {
        const std::size_t begin = i;
        const Letter letter = plain(next_code_point(label, i));
        result += letter.italic ? utf8(letter.code) : std::string(label.substr(begin, i - begin));
    }
    return result;
}

std::vector<Letter> letters(std::string_view label) {
    std::vector<Letter> result;
    int script = 0;  // inside braces
    for (std::size_t i = 0; i < label.size();) {
        const char c = label[i];
        if (script == 0 && (c == '_' || c == '^') && i + 1 < label.size() && label[i + 1] == '{' &&
            label.find('}', i) != std::string_view::npos) {
            script = c == '_' ? -1 : 1;
            i += 2;
        } else if (script != 0 && c == '}') {
            script = 0;
            ++i;
        } else {
            Letter letter = plain(next_code_point(label, i));
            const bool dot = letter.code == 0x0307 || letter.code == 0x0308;
            if (dot && !result.empty()) result.back().dots = letter.code == 0x0307 ? 1 : 2;
            if (dot) continue;
            if (script != 0) letter.script = script;
            result.push_back(letter);
        }
    }
    return result;
}

ShownUnit shown_unit(std::string unit) {
    const bool is_angle = unit == "rad" || unit.starts_with("rad/");
    if (is_angle) unit.replace(0, 3, "\u00B0");
    return {typeset_unit(unit), is_angle ? degrees(1.0) : 1.0};
}

ShownUnit shown_unit_of_setting(const std::string& unit, bool is_start) {
    return is_start || unit == "rad" ? shown_unit(unit) : ShownUnit{typeset_unit(unit)};
}

ShownUnit shown_unit_of_setting(const SystemDescription& description, std::string_view name) {
    const bool is_start = std::none_of(description.parameters.begin(), description.parameters.end(),
                                       [&](const ParameterDescription& p) { return p.name == name; });
    return shown_unit_of_setting(std::string(unit_of(description, name)), is_start);
}

}  // namespace achilles
