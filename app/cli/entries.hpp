// What the explorer's lists have to choose from.
#pragma once

#include <vector>

#include "panels/panels.hpp"

namespace achilles {

// The systems of the assets by their titles, in the order of the gallery.
std::vector<SystemEntry> known_systems();
// The tours: "The paper's ball" for a journal that begins with the comment "# The paper's ball".
std::vector<SystemEntry> known_tours();

}  // namespace achilles
