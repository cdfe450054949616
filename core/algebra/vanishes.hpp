// Whether an expression is 0 wherever it is defined.
#pragma once

#include "expression/expression.hpp"

namespace achilles {

// True where it is, as g m1/m1 - g m2/m2, however it is written; false where it is not, or simplifying it takes too long.
bool vanishes(Expression expression);

}  // namespace achilles
