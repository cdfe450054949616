// The kinetic energy as given, by its degree in the rates (theory-gaps.md 1):
//     T = 1/2 v'M(q)v + c(q,t).v + T0(q,t)
// The terms of degree 1 and 0 come from prescribed motion, such as a driven pivot or a rotating frame.
#pragma once

#include <vector>

#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "system/description.hpp"

namespace achilles {

// c and T0. Terms of T0 that contain no coordinate are left out, because no force follows from them.
struct PrescribedMotion {
    std::vector<Expression> c;
    Expression T0;
    bool is_none() const;
};

// Sets M, and kinetic to the part of degree 2, from the kinetic energy as given; `parts` locates the terms of its text.
// Throws Mistake for a T that is not a polynomial of degree 2 or less in the rates, for an M that depends on t, and for
// a coordinate without inertia. An M is free of t if its derivative is proved to vanish, as for sin(om*t)^2 +
// cos(om*t)^2.
PrescribedMotion read_kinetic_energy(const SystemDescription& system, const Layout& layout, const TextParts& parts,
                                     Equations& equations);

// Adds the forces and the potential of the prescribed motion:
//     Q_i += -dc_i/dt - sum_k (dc_i/dq_k - dc_k/dq_i) v_k,   V -= T0
void add_prescribed_motion(const PrescribedMotion& motion, const Layout& layout, Equations& equations);

}  // namespace achilles
