// Angles: computed in radians, shown in degrees; their sine and cosine, which mechanical systems ask for more than for anything
// else.
#pragma once

#include <numbers>

namespace achilles {

// radians * 180 / pi, rounded after each operation: an angle in degrees, or a rate in degrees per second. degrees(1.0)
// is the factor of a unit; x times it may be rounded otherwise than degrees(x).
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

// Both at once; and those of an angle asked for a moment ago are at hand: the programs of one model look at the same
// state one after the other. The values are those of std::sin and std::cos.
struct SineCosine {
    double sine = 0.0, cosine = 1.0;
};
SineCosine sine_and_cosine(double angle);
inline void sine_and_cosine(double angle, double& sine, double& cosine) {
    const SineCosine wave = sine_and_cosine(angle);
    sine = wave.sine;
    cosine = wave.cosine;
}

}  // namespace achilles
