// Certificates of a contact that bounces while another one is held, with dry friction (theory-friction.md 4.3), against
// bouncing in long double: all flights and impacts, one by one.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace achilles::test {

// How one of the two contacts behaves: it has no friction, it slides, or it sticks.
enum class Rubbing : std::uint8_t { none, slides, sticks };

struct BesideHeld {
    int trials = 0, proved = 0;
    int capped = 0;             // of those proved, bouncing whose impacts are all capped
    int violations = 0;         // the true motion is outside a certified bound, or leaves the certified branch
    double closest = 0.0;       // largest ratio of a true difference and its bound, of position or velocity
    std::string first_failure;  // what was violated first
    std::map<std::string, int> obstacles;  // why others were not proved
};

// Random bodies with skew masses, coefficients and impact speeds from 1e-4 to 0.1. `capped`: restitutions and
// coefficients are large, so that impacts that stick may gain energy.
BesideHeld check_bouncing_beside(Rubbing held, Rubbing bouncing, int trials, std::uint32_t seed, bool capped = false);

}  // namespace achilles::test
