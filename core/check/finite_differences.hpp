// Compares the derived equations with L, the forces and the gaps, by central differences with 50 digits at random
// states.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace achilles {

class SimplifiedEquations;

// True if the system has generalized forces other than those of the potential.
bool has_forces(const Equations& equations);

// The forces given in the file, by coordinate (0 if none), then the dissipation function. Creates nodes in `graph`, a
// copy of the model's.
std::vector<Expression> given_forces(const Model& model, Graph& graph);

// The largest |derived - difference| / max(1, |difference|) of M, bias, Q, and of dh, hdot, hddot and lambda of every
// contact, over all states.
struct MaxDifference {
    struct CheckedQuantity {
        std::string name;
        double largest = 0.0;
    };
    std::vector<CheckedQuantity> derived;     // equations() compared with differences
    std::vector<CheckedQuantity> simplified;  // printed equations compared with equations()
    int states = 0;
    double largest() const;
};

// Compares at `states` random states: coordinates and rates in their ranges, the time within the run, the parameters of
// the run, a fixed seed. States at which something is undefined or M is not positive definite are skipped; up to ten
// states are tried for each. The simplified hddot on the contact surface is compared if Newton's method finds h = 0
// from such a state.
MaxDifference compare_with_differences(const Model& model, const Run& run, const SimplifiedEquations& simplified,
                                       int states = 20);

}  // namespace achilles
