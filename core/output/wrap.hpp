// Long formulas on several lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "expression/notation.hpp"

namespace achilles {

// About how many characters a formula shows: LaTeX commands count as one, braces as none.
std::size_t visible_length(std::string_view formula, Notation notation);

// The formula cut before the signs of sums into lines of at most `width` visible characters where that can be: outside
// brackets first, inside where it must, never inside LaTeX arguments.
std::vector<std::string> wrap(const std::string& formula, std::size_t width, Notation notation);

}  // namespace achilles
