// Which views of a system a picture shows.
#pragma once

#include <string>
#include <vector>

#include "system/description.hpp"

namespace achilles {

// The views of these names, in this order. If none is named all, those over time first: their panels share an axis.
// Throws InputError for a name that is none.
std::vector<ViewDescription> views_of(const SystemDescription& description, const std::vector<std::string>& names);

}  // namespace achilles
