// Friction as read from a system file (theory-friction.md 1).
#pragma once

#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "system/description.hpp"

namespace achilles {

// Sets the slip row d and the speed c of law.slip = d v + c. `text` is the slip as written, and `parts` locates its
// terms. Throws Mistake if the slip is not affine in the rates, or contains no rate.
void split_slip(const SystemDescription& system, const Layout& layout, const Text& text, const TextParts& parts,
                FrictionLaw& law);

// A level of friction at slip 0. Throws Mistake, at its text, if it divides by 0 there.
Expression at_slip_zero(Expression level, const Layout& layout, const Text& text);

// Removes friction whose levels are the number 0 from the description and the equations: it is no friction.
void drop_zero_friction(SystemDescription& system, Equations& equations);

}  // namespace achilles
