// From the names of a system file to what a journal prints: theta1' becomes a theta with a dot and an index.
#pragma once

#include <string>
#include <string_view>

namespace achilles {

// One name: Greek letters by name, trailing digits as indices, primes as dots (U+0307, U+0308 after their letter), and
// h, lambda, E for gap, lambda, energy.
std::string typeset_name(std::string_view name);
// A whole expression: every name in it typeset, '*' as a middle dot, '-' as a minus sign.
std::string typeset(std::string_view expression);
// "label [unit]", or the label alone.
std::string with_unit(const std::string& label, const std::string& unit);

}  // namespace achilles
