// Gaps that touch 0 without crossing it, x^2 in place of x: where h = 0 there is no normal.
#pragma once

#include <span>

#include "model/model.hpp"

namespace achilles {

// Whether dh vanishes with h near a state, as far as can be seen there: |dh|^2 <= 4 |h| |D^2 h| (2 at x^2, 3/2 at x^3; of a gap
// whose normal stays, |dh|^2 / |h| grows without bound towards h = 0). True where dh = 0.
bool is_flat(const Model& model, std::span<const double> parameters, const State& state, std::size_t contact = 0);

// What would be right.
inline constexpr const char* flat_hint =
    "the gap comes to 0 without crossing it: write one whose dh is not 0 there, as x in place of x^2";

}  // namespace achilles
