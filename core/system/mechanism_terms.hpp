// The energies and forces that a mechanism stands for. With p_i = dp/dq_i and p_t = dp/dt of the center of mass of each
// body, and w_i and w_t of its angle:
//     M_ij = sum m p_i.p_j + J w_i w_j,   c_i = sum m p_i.p_t + J w_i w_t,   T0 = sum m/2 p_t^2 + J/2 w_t^2
//     kinetic = 1/2 v'M v,   potential = sum -m gravity.p - T0 + springs
//     force_i = dp/dq_i.F + da/dq_i tau - dc_i/dt - sum_k (dc_i/dq_k - dc_k/dq_i) v_k
#pragma once

#include <vector>

#include "system/mechanism.hpp"

namespace achilles {

struct DerivedTerm {
    ProductSum value;
    Location at;  // the table that it is made from
};

struct MechanismTerms {
    DerivedTerm kinetic;
    std::vector<DerivedTerm> potential, dissipation;
    std::vector<std::vector<DerivedTerm>> forces;  // by coordinate
    bool is_prescribed = false;                    // time moves a mass
};

// Adds the mistakes that show up here: a coordinate that moves no mass, inertia that depends on time, and springs,
// dampers and loads that act on no coordinate.
MechanismTerms derive_terms(const PlacedMechanism& mechanism, const SystemDescription& system,
                            ErrorCollector& mistakes);

// The distance between two points, and its rate.
struct PointDistance {
    ProductSum value, rate;
    bool is_signed = false;  // the points stay on one line: positive at the start, and kept when they pass each other
};
// Throws Mistake if the points are always together.
PointDistance distance_between(const PlacedMechanism& mechanism, const NamedPoint& from, const NamedPoint& to,
                               bool may_be_signed, const Location& at);

}  // namespace achilles
