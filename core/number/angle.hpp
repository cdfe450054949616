// Angles: computed in radians, shown in degrees.
#pragma once

#include <numbers>

namespace achilles {

// radians * 180 / pi, rounded after each operation: an angle in degrees, or a rate in degrees per second. degrees(1.0)
// is the factor of a unit; x times it may be rounded otherwise than degrees(x).
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

}  // namespace achilles
