// Whether an expression is 0 wherever it is defined, or wherever others are 0.
#pragma once

#include <span>

#include "expression/expression.hpp"

namespace achilles {

// True where it is, as g m1/m1 - g m2/m2, however it is written; false where it is not, or simplifying it takes too long.
bool vanishes(Expression expression);

// The same wherever all of `zeros` are 0. Each of these is solved for one of the symbols `unknowns`, or else for a function,
// that it has with a number for a coefficient and nowhere else; what is solved for is replaced. False also where that
// proves nothing: a zero that cannot be solved is left out.
bool vanishes_where(Expression expression, std::span<const Expression> zeros, std::span<const std::uint32_t> unknowns);

}  // namespace achilles
