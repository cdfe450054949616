// How an error in a text file is shown: the lines of the text, columns that count characters, names that stay short.
#pragma once

#include <string>
#include <string_view>

namespace achilles {

// The line with that number, from 1, without its line break; "" where there is none.
std::string line_of(std::string_view text, int line);

// The byte at which the character of that column (from 1, UTF-8 characters) starts; the line's size if there is none.
std::size_t byte_of_column(std::string_view line, int column);

// What a person typed, fit for a message: control characters and broken UTF-8 become '?', and at most about 60
// characters stay.
std::string shown(std::string_view text);

// Text from a file, a journal or a picture, fit for a terminal: what would steer it becomes '?' (control characters but
// the line break and the tab, broken UTF-8, marks that turn the direction of reading). The rest stays.
std::string printable(std::string_view text);

// JSON in UTF-8, fit for a terminal and still the same value: what would steer one is written as \u009b.
std::string printable_json(std::string_view json);

// What is wrong with a subnormal parameter, and what would be right.
std::string subnormal_parameter(std::string_view name, double value);
inline constexpr const char* subnormal_hint = "use 0, or choose units in which it is at least 2.3e-308 in size";

}  // namespace achilles
