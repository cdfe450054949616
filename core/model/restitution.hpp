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

// A restitution outside of [0, 1] by at most this counts as rounding. A parameter is enclosed to 4 ulp (2^-50) of its
// decimal. An expression of several parameters may double that a few times, so the enclosure of an exact 1 ends above
// 1. A user's mistake is larger. An impact with such a restitution changes the energy by at most 2^-39, less than a
// step does. Doubles and intervals share this bound, so that every system that can be proved can be simulated.
inline constexpr double restitution_rounding = 0x1p-40;

// Clamps a value that is outside of [0, 1] by rounding; returns any other value unchanged.
double without_rounding(double e);

// The error message if a restitution is not in [0, 1]; nullopt if it is.
std::optional<Mistake> mistake_in(const Text& restitution, double e);
std::optional<Mistake> mistake_in(const Text& restitution, const Interval& e);

}  // namespace achilles
