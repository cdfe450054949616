// Conversion of angles from radians to degrees, and a cached sine and cosine, the functions that mechanical systems
// evaluate most often.
#pragma once

#include <numbers>

namespace achilles {

// radians * 180 / pi, rounded after each operation. Converts an angle (rad) to degrees, or a rate (rad/s) to degrees
// per second. degrees(1.0) is the conversion factor; multiplying by it may round differently than degrees(x).
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

// Sine and cosine of one angle (rad), with the values of std::sin and std::cos. Recent results are cached for each
// thread, because the programs of one model evaluate the same state one after the other.
struct SineCosine {
    double sine = 0.0, cosine = 1.0;
};
SineCosine sine_and_cosine(double angle);
// The sine alone, from the cache or else computed and not cached: accelerations need it many times in a step of dopri5.
// A cosine alone is mostly that of a potential energy, at a state where the next step needs the sine too.
double sine(double angle);
inline void sine_and_cosine(double angle, double& sine, double& cosine) {
    const SineCosine wave = sine_and_cosine(angle);
    sine = wave.sine;
    cosine = wave.cosine;
}

}  // namespace achilles
