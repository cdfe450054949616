// From the names of a system file to what a journal prints: theta1' becomes a theta with a dot and an index.
//
// A label is UTF-8 text. Combining dots (U+0307, U+0308) stand after the letter they belong to; variables are the
// italic letters of Unicode's mathematical alphabet; raised and lowered letters are Unicode's own, or ^{...} and
// _{...}.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct SystemDescription;

// One name: Greek letters by name, trailing digits as indices, primes as dots, and h, lambda for gap, lambda. Upright:
// fit for any widget.
std::string typeset_name(std::string_view name);
// A whole expression as a label: variables of one letter in italics, '*' as a middle dot, '-' as a minus sign, whole
// powers raised.
std::string typeset(std::string_view expression);
// A label without its italics: fit for any widget.
std::string upright(std::string_view label);
// m/s^2 with the power raised and a middle dot for '*'.
std::string typeset_unit(std::string_view unit);
// "label (unit)", or the label alone.
std::string with_unit(const std::string& label, const std::string& unit);

// Units as they are shown: angles in degrees, and whatever they are divided by.
struct ShownUnit {
    std::string text;     // typeset
    double factor = 1.0;  // of a number in the file's unit
};
ShownUnit shown_unit(std::string unit);
// Of what a slider sets: of a start as above, of a parameter an angle alone; a drive's frequency is known in rad/s.
ShownUnit shown_unit_of_setting(const std::string& unit, bool is_start);
ShownUnit shown_unit_of_setting(const SystemDescription& description, std::string_view name);

// As much of a label as fits, with an ellipsis where its end is left out: whole words as long as there are some, then letters,
// or letters at once. A unit in brackets at its end stays.
enum class Cut { words, letters };
std::string shortened(const std::string& label, const std::function<bool(const std::string&)>& fits,
                      Cut cut = Cut::words);

// A label taken apart, for whoever draws it.
struct Letter {
    char32_t code = 0;  // the plain letter
    bool italic = false;
    int script = 0;  // -1: an index, +1: a power
    int dots = 0;    // above it
    friend bool operator==(const Letter&, const Letter&) = default;
};
// What is no UTF-8 becomes U+FFFD, a byte at a time.
std::vector<Letter> letters(std::string_view label);

// UTF-8 as Unicode defines it: nothing overlong, no surrogates, no U+FFFE, nothing beyond U+10FFFF.
std::string utf8(char32_t code);
// The code that begins at a place, which is moved behind it; U+FFFD for a byte that is no UTF-8.
char32_t next_code_point(std::string_view text, std::size_t& at);
bool is_utf8(std::string_view text);

// How indices and powers are set, as shares of the label's size: their own size, and how far their base line is moved.
constexpr float script_size = 0.72F, index_drop = 0.13F, power_rise = 0.30F;
// How far italics lean: across by height.
constexpr float italic_slant = 0.2F;

}  // namespace achilles
