// The derived equations against L, the forces and the gaps themselves: central differences in 50 digits at random states.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace achilles {

class Simplified;

// Whether there are any besides those that the potential gives.
bool has_forces(const Equations& equations);

// The forces as the file gives them, coordinate by coordinate, and the dissipation; 0 where there is none. In `graph`, a
// copy of the model's.
std::vector<Expression> given_forces(const Model& model, Graph& graph);

// The largest |derived - difference| / max(1, |difference|) of M, bias, Q, and of dh, hdot, hddot and lambda of every
// contact, over so many states.
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

// At `states` states with coordinates and rates in their ranges, the time in the run, the run's parameters and a fixed seed. States where
// something is not defined or M is not positive definite do not count; so many more are tried, up to ten for each.
// The simplified hddot on the contact surface is compared where Newton's method, from such a state, finds h = 0.
Disagreement compare_with_differences(const Model& model, const Run& run, const Simplified& simplified,
                                      int states = 20);

}  // namespace achilles
