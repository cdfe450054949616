// The restitution of a contact: a function of the parameters with values in [0, 1], evaluated once per run.
#pragma once

#include <optional>

#include "number/interval.hpp"
#include "system/input_error.hpp"

namespace achilles {

struct Restitution {
    double value = 0.0;
    Interval enclosure;
};

// A restitution that is outside of [0, 1] by at most this counts as rounding. A parameter is enclosed to 4 ulp (2^-50) of its
// decimal, and an expression of several parameters may double that a few times, so the enclosure of an exact 1 ends above 1. A
// person's mistake is larger. An impact with such a restitution changes the energy by at most 2^-39, less than a step does. Doubles
// and intervals have the same bound, so that whatever can be proved can be simulated.
inline constexpr double restitution_rounding = 0x1p-40;

// Moves a value that is outside of [0, 1] by rounding to the end of the interval; returns any other value as it is.
double without_rounding(double e);

// The mistake, if a restitution does not lie in [0, 1].
std::optional<Mistake> mistake_in(const Text& restitution, double e);
std::optional<Mistake> mistake_in(const Text& restitution, const Interval& e);

}  // namespace achilles
