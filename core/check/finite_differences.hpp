// The derived equations against L and h themselves: central differences in 50 digits at random states.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace achilles {

class Simplified;

// The largest |derived - difference| / max(1, |difference|) of M, bias, dh, hddot and lambda over so many states.
struct Disagreement {
    struct Quantity {
        std::string name;
        double largest = 0.0;
    };
    std::vector<Quantity> derived;     // equations() against differences
    std::vector<Quantity> simplified;  // what is printed against equations()
    int states = 0;
    double largest() const;
};

// At `states` states with coordinates and rates in their ranges, the run's parameters and a fixed seed. States where
// something is not defined or M is not positive definite do not count; so many more are tried, up to ten for each.
// The simplified hddot on the contact surface is compared where Newton's method, from such a state, finds h = 0.
Disagreement compare_with_differences(const Model& model, const Run& run, const Simplified& simplified,
                                      int states = 20);

}  // namespace achilles
