// The bouncing in coordinates that impacts do not disturb: (q, s) with s the tangential velocity (theory.md 5.1).
//
//     q' = s + n sigma,   s' = A(q,s) + B(q,s) sigma + D(q,s) sigma^2,   sigma = hdot
//
// A is the constrained acceleration f_c(q, s). Since f_c is a polynomial of degree 2 in the velocity,
//     B = df_c/dv n - dn/dq s,     D = 1/2 n' (d2f_c/dv2) n - dn/dq n      (v at s)
// In every program here the slots of v hold s, and the slot sigma holds hdot.
#pragma once

#include "model/derive.hpp"
#include "program/program.hpp"

namespace achilles {

struct Bouncing {
    Program hddot;     // hddot(q, s + n sigma)
    Program gradient;  // its derivatives with respect to q (n), s (n), sigma
    Program motion;    // v = s + n sigma (n), s' (n)
    // At sigma = 0: hddot, its rate along the constrained motion (P below), its derivative with respect to sigma.
    Program trend;
    // The gradient again (it shares most of its work with what follows); A (n), n (n), B (n), D (n), ndot (n), Bdot
    // (n), dA/dq (n x n), dA/ds (n x n), row by row; then P, Phi, Xi, by which hddot(q, s) moves along the bouncing,
    // d/dt = P + Phi sigma + Xi sigma^2 (theory-truncation.md 4):
    //     P = hddot_q s + hddot_s A,   Phi = hddot_q n + hddot_s B,   Xi = hddot_s D
    Program shadow;
};

// Derives and compiles the programs, in a copy of the equations' graph.
Bouncing derive_bouncing(const Equations& equations, const Layout& layout);

}  // namespace achilles
