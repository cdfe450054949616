// Where dh vanishes with a gap, as of y^2 or y^3: there is no normal, and no impact can be computed.
#pragma once

#include <optional>

#include "model/model.hpp"

namespace achilles {

// A place with h = 0 and dh = 0 of a contact, found by Newton's method for h = 0 from the start and from some states in the ranges
// of the coordinates: at such a place its steps stop doubling the digits. Nothing where none was found.
std::optional<State> flat_place(const Model& model, const Run& run, std::size_t contact);

}  // namespace achilles
