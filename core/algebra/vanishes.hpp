// Tests whether an expression is identically 0, or 0 wherever given expressions are 0.
#pragma once

#include <span>

#include "expression/expression.hpp"

namespace achilles {

// True if the expression is proved to be identically 0, such as g m1/m1 - g m2/m2. False if it is not 0, or if
// simplification takes too much work.
bool vanishes(Expression expression);

// The same on the set where all of `zeros` are 0. Each of them is solved for one of the symbols `unknowns`, or else for
// a function, that occurs linearly with a numeric coefficient and nowhere else. The solution is substituted. A zero
// that cannot be solved is ignored, so false may also mean that no proof was found.
bool vanishes_where(Expression expression, std::span<const Expression> zeros, std::span<const std::uint32_t> unknowns);

}  // namespace achilles
