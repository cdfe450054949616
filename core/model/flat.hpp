// Gaps whose dh vanishes where h = 0, x^2 or x^3 in place of x: there is no normal there.
#pragma once

#include <span>
#include <string>

#include "model/model.hpp"

namespace achilles {

// Whether dh vanishes with h near a state, as far as can be seen there: |dh|^2 <= 4 |h| |D^2 h| (2 at x^2, 3/2 at x^3; of a gap
// whose normal stays, |dh|^2 / |h| grows without bound towards h = 0). True where dh = 0.
bool is_flat(const Model& model, std::span<const double> parameters, const State& state, std::size_t contact = 0);

// What would be right.
inline constexpr const char* flat_hint =
    "write a gap whose dh is not 0 where h = 0, for example x instead of x^2 or x^3";

// Where a gap is a product of several factors that move, as y*(y - x): one for each of them. Empty for other gaps.
std::string product_hint(const Model& model, std::size_t contact);

}  // namespace achilles
