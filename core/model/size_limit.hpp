// The message about equations that are too large to derive.
#pragma once

#include <string>

#include "model/derive.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

// Names the largest of the expressions given in the file, which is what a user can shorten, and its place. `what` is
// too large, such as "the equations of motion".
Mistake too_large(const SystemDescription& system, const Equations& equations, const std::string& what,
                  const ExpressionTooLarge& problem);

}  // namespace achilles
