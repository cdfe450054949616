// Typesets names and expressions of a system file: theta1' becomes a theta with a dot and an index.
//
// A label is UTF-8 text. Combining dots (U+0307, U+0308) follow their letter. Variables are italic letters of Unicode's
// mathematical alphabet. Superscripts and subscripts are Unicode's own characters, or ^{...} and _{...}.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct SystemDescription;

// Typesets one name: Greek letters by name, trailing digits as indices, primes as dots, "gap" as h. The letters are
// upright, which every widget can show.
std::string typeset_name(std::string_view name);
// Typesets an expression: one-letter variables in italics, '*' as a middle dot, '-' as a minus sign, integer powers as
// superscripts.
std::string typeset(std::string_view expression);
// A label without italics, which every widget can show.
std::string upright(std::string_view label);
// m/s^2 with a superscript, and '*' as a middle dot.
std::string typeset_unit(std::string_view unit);
// "label (unit)", or the label alone.
std::string with_unit(const std::string& label, const std::string& unit);

// Displayed units: angles are in degrees, also per second, meter and so on.
struct ShownUnit {
    std::string text;     // typeset
    double factor = 1.0;  // multiplies a number in the file's unit
};
ShownUnit shown_unit(std::string unit);
// Displayed unit of a slider. For an initial value it is as above. For a parameter only an angle is converted: the
// frequency of a drive stays in rad/s.
ShownUnit shown_unit_of_setting(const std::string& unit, bool is_start);
ShownUnit shown_unit_of_setting(const SystemDescription& description, std::string_view name);

// Shortens a label until it fits, with an ellipsis at its end: by whole words while any are left, then by letters, or
// by letters at once. A unit in parentheses at the end is kept.
enum class EllipsisMode { words, letters };
std::string shortened(const std::string& label, const std::function<bool(const std::string&)>& fits,
                      EllipsisMode cut = EllipsisMode::words);

// One character of a label, for renderers.
struct Letter {
    char32_t code = 0;  // the plain letter
    bool italic = false;
    int script = 0;  // -1: subscript, +1: superscript
    int dots = 0;    // number of dots above it
    friend bool operator==(const Letter&, const Letter&) = default;
};
// Bytes that are not valid UTF-8 become U+FFFD each.
std::vector<Letter> letters(std::string_view label);

// UTF-8 as Unicode defines it: no overlong forms, surrogates, U+FFFE, or codes beyond U+10FFFF.
std::string utf8(char32_t code);
// Code point at position `at`, which is advanced past it; U+FFFD for an invalid byte.
char32_t next_code_point(std::string_view text, std::size_t& at);
bool is_utf8(std::string_view text);

// Size of subscripts and superscripts and the shift of their baseline, as fractions of the label size.
constexpr float script_size = 0.72F, index_drop = 0.13F, power_rise = 0.30F;
// Slant of italics: horizontal shift per height.
constexpr float italic_slant = 0.2F;

}  // namespace achilles
