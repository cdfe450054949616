// Numbers and sentences as a reader sees them: symbols, real minus signs, and only the digits that are known.
#pragma once

#include <string>

namespace achilles {

// Replaces plain-text notation in a sentence from core by typeset symbols.
std::string typeset_sentence(std::string text);
// "12.3", with a real minus sign.
std::string number(double value, const char* format = "{:.6g}");
// A number with this many digits or decimals, without the digits that its error makes meaningless
// (output/precision.hpp).
std::string number(double value, double error, int digits);
std::string number_with_decimals(double value, double error, int decimals);
// "3 m", "30°": a number and its unit with a nonbreaking space.
std::string number_with_unit(const std::string& number, const std::string& unit);
// Replaces hyphens before numbers by minus signs.
std::string with_minus(std::string text);
// A number for a column of numbers of this size, with fixed decimals; in scientific notation if these would show no
// digit, or if it would be too long. Drops decimals that its error makes meaningless.
std::string number_of_size(double value, double size, int decimals, double error = 0.0);

}  // namespace achilles
