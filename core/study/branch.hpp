// The branch of a periodic run in a parameter, by pseudo-arclength continuation (theory-derivatives.md 9), with what happens
// along it.
#pragma once

#include <array>

#include "study/orbit.hpp"

namespace achilles {

struct Branch {
    std::size_t parameter = 0;
    std::vector<OrbitPoint> points;   // along it, that where the search has ended among them
    std::vector<OrbitPoint> folds;    // where the parameter turns back
    std::vector<OrbitPoint> flips;    // a multiplier is -1: the period doubles
    std::vector<OrbitPoint> circles;  // two conjugate ones are 1 in size
    std::vector<OrbitPoint> lost;     // a release overtakes a Zeno point, a_inf = 0: here the branch ends
    // Where the sequence of events changes on the way, and the branch goes on: the first point past it.
    std::vector<OrbitPoint> changes;
    std::array<std::string, 2> ends;  // why it goes no further, at its first point and at its last
    double value(const OrbitPoint& point) const { return point.parameters[parameter]; }
};

// Follows it both ways from an orbit that find_orbit() found, while the parameter lies in [low, high], as its value now does.
Branch follow(const std::shared_ptr<const Model>& model, const OrbitAsked& asked, const Orbit& orbit,
              std::size_t parameter, double low, double high);

}  // namespace achilles
