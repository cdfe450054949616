// A collision at which truncation is considered: everything the conditions may look at.
#pragma once

#include "trajectory.hpp"

namespace achilles {

struct Collision {
    double t = 0.0;      // tau_k
    State before;        // (q, v-), h(q) = 0
    double speed = 0.0;  // w = |hdot| before
    Vector restart;      // v* or s: the velocity after re-initialisation
};

}  // namespace achilles
