// Detects gaps whose gradient vanishes on the contact surface, such as x^2 or x^3 instead of x: they have no normal
// there.
#pragma once

#include <span>
#include <string>

#include "model/model.hpp"

namespace achilles {

// Whether dh appears to vanish together with h near a state, by values at this state: |dh|^2 <= 4 |h| |D^2 h|. (The
// factor is 2 for x^2 and 3/2 for x^3; for a gap with a normal, |dh|^2 / |h| is unbounded as h -> 0.) True if dh = 0.
bool is_flat(const Model& model, std::span<const double> parameters, const State& state, std::size_t contact = 0);

// Hint for the message: how to write such a gap.
inline constexpr const char* flat_hint =
    "write a gap whose dh is not 0 where h = 0, for example x instead of x^2 or x^3";

// Hint if a gap is a product of several varying factors, such as y*(y - x): one constraint for each factor. Otherwise
// empty.
std::string product_hint(const Model& model, std::size_t contact);

}  // namespace achilles
