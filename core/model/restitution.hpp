// The restitution of a contact, a function of the parameters: evaluated once for a run, with values in [0, 1].
#pragma once

#include <optional>

#include "number/interval.hpp"
#include "system/mistakes.hpp"

namespace achilles {

struct Restitution {
    double value = 0.0;
    Interval enclosure;
};

// Outside of [0, 1] by no more than this is rounding. A parameter as it was written is known to 4 ulp, 2^-50, and an expression of
// several may double that a few times: where it is 1, its enclosure reaches so far above. What a person types is farther off,
// and an impact with it would change less of the energy, 2^-39, than steps do. It is the same for doubles: what can be proved
// can be simulated.
inline constexpr double restitution_rounding = 0x1p-40;

// The value without what rounding has added: the end of [0, 1] where it lies so little outside.
double without_rounding(double e);

// What is wrong with a restitution that does not lie in [0, 1].
std::optional<Mistake> mistake_in(const Text& restitution, double e);
std::optional<Mistake> mistake_in(const Text& restitution, const Interval& e);

}  // namespace achilles
