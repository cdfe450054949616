// Parameters that follow from others.
#pragma once

#include <vector>

#include "system/read_tables.hpp"

namespace achilles {

// Brings each after those that its definition names. Adds a mistake for every circle of them, and leaves out who is in it.
void order_derived(std::vector<DerivedDescription>& derived, Names& names, Mistakes& mistakes);

}  // namespace achilles
