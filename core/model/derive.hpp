// The equations of motion from T, V, h and e, symbolically (theory.md 1).
#pragma once

#include <map>
#include <vector>

#include "program/program.hpp"
#include "program/terms.hpp"
#include "run/mode.hpp"
#include "series/series.hpp"

namespace achilles {

// Where each input of a program stands: q (n), v (n), the parameters (p), then t, contact, sigma, a drawn curve's own, work, loss.
struct Layout {
    std::uint32_t dof = 0, p = 0;  // coordinates, parameters
    std::uint32_t contacts = 1;
    std::uint32_t q(std::size_t i) const { return static_cast<std::uint32_t>(i); }
    std::uint32_t v(std::size_t i) const { return dof + static_cast<std::uint32_t>(i); }
    std::uint32_t parameter(std::size_t i) const { return 2 * dof + static_cast<std::uint32_t>(i); }
    std::uint32_t t() const { return 2 * dof + p; }
    std::uint32_t contact() const { return 2 * dof + p + 1; }  // 1 in contact, 0 in flight
    std::uint32_t sigma() const { return 2 * dof + p + 2; }    // stands for hdot where v = s + n sigma
    std::uint32_t own() const { return 2 * dof + p + 3; }      // a drawn curve's own parameter
    std::uint32_t work() const { return 2 * dof + p + 4; }     // what a view shows beside the state
    std::uint32_t loss() const { return 2 * dof + p + 5; }
    std::uint32_t second_sigma() const { return 2 * dof + p + 6; }  // of a pair of contacts
    // Of a contact, where there are several.
    std::uint32_t acceleration(std::size_t i) const { return 2 * dof + p + 7 + static_cast<std::uint32_t>(i); }
    std::uint32_t force(std::size_t i) const { return acceleration(contacts) + static_cast<std::uint32_t>(i); }
    std::uint32_t count() const { return force(contacts); }
    Slots slots() const { return {count(), 2 * dof, 2 * dof + p}; }
};

// One contact along a motion that holds others: what the motion that holds it as well follows from (theory-gaps.md 2). In
// formulas i is the contact, A the held ones.
struct ContactEquations {
    Expression gap, gap_t, hdot;         // h; dh/dt where q stands still; its rate
    std::vector<Expression> g;           // dh, less what lies in the gradients of what is held (Euclidean projection)
    std::vector<Expression> H;           // the second derivatives of h, row by row
    std::vector<Expression> impulse;     // M^-1 (g_i' - G_A' W_AA^-1 W_Ai)
    std::vector<Expression> delassus;    // W_ij of every contact j, less W_iA W_AA^-1 W_Aj
    Expression W;                        // of them, its own: W_i
    std::vector<Expression> direction;   // n = impulse/W, so that g n = 1
    Expression hddot, lambda;            // its acceleration while it is free; the force that holds it, -hddot/W
    std::vector<Expression> s;           // v - n hdot
    std::vector<Expression> f_c;         // the acceleration while it is held, too
    std::vector<Expression> f_by_force;  // the same as f + impulse lambda
};

// The motion in one mode: the acceleration f with the forces of its contacts. A held contact is seen from the mode in
// which it is open and all others are as they are.
struct ModeEquations {
    Mode mode;
    std::vector<Expression> f;
    std::vector<ContactEquations> contacts;
};

// The derived equations, as expressions. Vectors have n entries; M and H are full, row by row.
struct Equations {
    std::vector<Expression> M, bias, Q;
    Expression kinetic, potential, energy;
    std::vector<Expression> gaps, restitutions;  // of each contact
    ModeEquations free;                          // the motion that holds none
    Expression power;                // dE/dt = v'Q + dV/dt of the free motion; less lambda dh/dt of what is held
    std::vector<Expression> pivots;  // D of M = L D L': all positive exactly where M is positive definite
    bool autonomous = true;          // nothing depends on the time
    bool quadratic_in_rates = true;  // the forces, and with them f_c, are of degree 2 or less in the rates

    bool has_power() const;
};

// Completes equations whose M, Q, kinetic, potential, gaps and restitutions are set.
//     M(q) a + b(q,v,t) = Q(q,v,t),   b_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) v_j v_k + dV/dq_i,   f = M^-1 (Q - b)
//     g = dh,   hdot = g v + h_t,   W = g M^-1 g',   n = M^-1 g'/W,   s = v - n hdot
//     hddot = v'Hv + 2 g_t v + h_tt + g f,   lambda = -hddot/W,   f_c = f - n hddot
// M^-1 is applied through an L D L' factorisation unrolled in the graph. Throws std::domain_error where a pivot or W is
// 0 everywhere (M is not positive definite, or dh = 0), TooLarge where the graph would be.
void derive(Equations& equations, const Layout& layout, Graph& graph);

// The motions of all modes, derived from one another when they are asked for. With one contact k more that keeps its gap
//     f' = f - n_k hddot_k,   impulse_i' = impulse_i - impulse_k W_ik/W_k
//     W_ij' = W_ij - W_ik W_jk/W_k,   hddot_i' = hddot_i - W_ik hddot_k/W_k
class ContactModes {
 public:
    // In a copy of the equations' graph.
    ContactModes(const Equations& equations, const Layout& layout);
    const ModeEquations& of(Mode mode);
    Graph& graph() { return graph_; }

 private:
    ModeEquations derive(Mode mode);
    Graph graph_;
    Layout layout_;
    std::map<Mode, ModeEquations> known_;
};

// h''' of a contact along the motion that holds it and others: hddot_q v + hddot_v f_c + hddot_t.
Expression jerk_of(const ContactEquations& contact, const Layout& layout);

// The motion of a system in one mode, as programs.

// Every contact has an event function along a motion, for what its law watches (contacts/contact_law.hpp): its gap, or
// for its force the hddot of the mode in which it is open (the force, times -W).
struct Motion {
    Mode mode;
    ProgramOf<MotionTerms> program;
    SeriesProgram series;  // MotionSeries
};

// Compiles a motion; `equations` has the graph of `motion`, or that it was copied from. Throws TooLarge.
Motion make_motion(const ModeEquations& motion, const Equations& equations, const Layout& layout);
// The series of a motion with hddot of every contact, open or held, for event functions: what proofs follow, in which the gap
// is a coordinate by itself (theory-enclosure.md 1).
SeriesProgram make_hddot_series(const ModeEquations& motion, const Equations& equations, const Layout& layout);

}  // namespace achilles
