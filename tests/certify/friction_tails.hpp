// Certificates of bouncing with dry friction (theory-friction.md 4) against bouncing in 34 digits: a body on a sine,
// whose flights are parabolas.
#pragma once

#include <cstdint>
#include <string>

namespace achilles::test {

// The result of many random collisions.
struct FrictionTails {
    int trials = 0, proved = 0;
    int violations = 0;         // the true motion is outside a certified bound, or leaves the certified branch
    double closest = 0.0;       // largest ratio of a true difference and its bound, of position or velocity
    std::string first_failure;  // what was violated first
};

// Random bodies, coefficients (some depend on the sliding speed) and impact speeds from 1e-4 to 0.3. `sticks`: the slip
// stops at every impact; otherwise it keeps its sign.
FrictionTails check_friction_tails(bool sticks, int trials, std::uint32_t seed);

}  // namespace achilles::test
