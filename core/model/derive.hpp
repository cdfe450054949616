// The equations of motion from T, V, h and e, symbolically (theory.md 1).
#pragma once

#include <vector>

#include "program/program.hpp"

namespace achilles {

// Where each input of a program stands: q (n), v (n), the parameters (p), then t, contact, sigma, a drawn curve's own, work, loss.
struct Layout {
    std::uint32_t dof = 0, p = 0;  // coordinates, parameters
    std::uint32_t q(std::size_t i) const { return static_cast<std::uint32_t>(i); }
    std::uint32_t v(std::size_t i) const { return dof + static_cast<std::uint32_t>(i); }
    std::uint32_t parameter(std::size_t i) const { return 2 * dof + static_cast<std::uint32_t>(i); }
    std::uint32_t t() const { return 2 * dof + p; }
    std::uint32_t contact() const { return 2 * dof + p + 1; }  // 1 in contact, 0 in flight
    std::uint32_t sigma() const { return 2 * dof + p + 2; }    // stands for hdot where v = s + n sigma
    std::uint32_t own() const { return 2 * dof + p + 3; }      // a drawn curve's own parameter
    std::uint32_t work() const { return 2 * dof + p + 4; }     // what a view shows beside the state
    std::uint32_t loss() const { return 2 * dof + p + 5; }
    std::uint32_t count() const { return 2 * dof + p + 6; }
    Slots slots() const { return {count(), 2 * dof, 2 * dof + p}; }
};

// The derived equations, as expressions. Vectors have n entries; M and H are full, row by row.
struct Equations {
    std::vector<Expression> M, bias, Q, f, g, H, impulse_direction, s, f_c;
    Expression kinetic, potential, gap, restitution;
    std::vector<Expression> f_by_force;                // f_c as f + M^-1 g' lambda
    Expression W, gap_t, hdot, hddot, lambda, energy;  // gap_t: dh/dt where q stands still
    Expression power;                // dE/dt = v'Q + dV/dt of the free motion; in contact less lambda dh/dt
    Expression jerk;                 // h''': the rate of hddot along the constrained motion
    std::vector<Expression> pivots;  // D of M = L D L': all positive exactly where M is positive definite
    bool autonomous = true;          // nothing depends on the time
    bool quadratic_in_rates = true;  // the forces, and with them f_c, are of degree 2 or less in the rates

    bool has_power() const { return !power.is_zero() || !gap_t.is_zero(); }
};

// Completes equations whose M, Q, kinetic, potential, gap and restitution are set.
//     M(q) a + b(q,v,t) = Q(q,v,t),   b_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) v_j v_k + dV/dq_i,   f = M^-1 (Q - b)
//     g = dh,   hdot = g v + h_t,   W = g M^-1 g',   n = M^-1 g'/W,   s = v - n hdot
//     hddot = v'Hv + 2 g_t v + h_tt + g f,   lambda = -hddot/W,   f_c = f - n hddot
//     jerk = hddot_q v + hddot_v f_c + hddot_t
// M^-1 is applied through an L D L' factorisation unrolled in the graph. Throws std::domain_error where a pivot or W is
// 0 everywhere (M is not positive definite, or dh = 0), TooLarge where the graph would be.
void derive(Equations& equations, const Layout& layout, Graph& graph);

}  // namespace achilles
