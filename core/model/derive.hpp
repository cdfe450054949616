// The equations of motion from T, V, h and e, symbolically (theory.md 1).
#pragma once

#include <map>
#include <vector>

#include "model/friction.hpp"
#include "model/jump.hpp"
#include "program/program.hpp"
#include "program/terms.hpp"
#include "run/mode.hpp"
#include "series/series.hpp"

namespace achilles {

// Slot of each input of a program: q (n), v (n), the parameters (p), then t, contact, sigma, the parameter of a drawn
// curve, work, loss; with friction also the sliding speed, the friction forces and the heat; where forces depend on
// contact, for each contact whether it is held.
struct Layout {
    std::uint32_t dof = 0, p = 0;  // number of coordinates and of parameters
    std::uint32_t contacts = 1;
    std::uint32_t frictions = 0;      // contacts and joints with friction
    bool forces_see_contact = false;  // held(NAME) stands in a force
    std::uint32_t q(std::size_t i) const { return static_cast<std::uint32_t>(i); }
    std::uint32_t v(std::size_t i) const { return dof + static_cast<std::uint32_t>(i); }
    std::uint32_t parameter(std::size_t i) const { return 2 * dof + static_cast<std::uint32_t>(i); }
    std::uint32_t t() const { return 2 * dof + p; }
    std::uint32_t contact() const { return 2 * dof + p + 1; }  // 1 in contact, 0 in free flight
    std::uint32_t sigma() const { return 2 * dof + p + 2; }    // stands for hdot in v = s + n sigma
    std::uint32_t own() const { return 2 * dof + p + 3; }      // parameter of a drawn curve
    std::uint32_t work() const { return 2 * dof + p + 4; }     // work and loss are shown in views beside the state
    std::uint32_t loss() const { return 2 * dof + p + 5; }
    std::uint32_t second_sigma() const { return 2 * dof + p + 6; }  // for a pair of contacts
    // Acceleration of the gap and force of contact i, if there are several contacts.
    std::uint32_t acceleration(std::size_t i) const { return 2 * dof + p + 7 + static_cast<std::uint32_t>(i); }
    std::uint32_t force(std::size_t i) const { return acceleration(contacts) + static_cast<std::uint32_t>(i); }
    // For friction: |u| in a level, the heat so far, and the force of friction k in the order of the laws.
    std::uint32_t sliding_speed() const { return force(contacts); }
    std::uint32_t heat() const { return force(contacts) + 1; }
    std::uint32_t friction_force(std::size_t k) const { return force(contacts) + 2 + static_cast<std::uint32_t>(k); }
    // p_T/p of the impulses of a contact that sticks at its impacts.
    std::uint32_t impulse_ratio() const { return friction_force(frictions); }
    std::uint32_t held(std::size_t i) const {
        return (frictions == 0 ? force(contacts) : impulse_ratio() + 1) + static_cast<std::uint32_t>(i);
    }
    // Whether views read the accelerations of gaps and the forces as inputs: they depend on the mode.
    bool has_contact_inputs() const { return contacts != 1 || frictions > 0 || forces_see_contact; }
    std::uint32_t count() const { return held(forces_see_contact ? contacts : 0); }
    Slots slots() const { return {count(), 2 * dof, 2 * dof + p}; }
};

// The terms of one contact in a mode that holds others, from which the mode that also holds this contact follows
// (theory-gaps.md 2). In formulas, i is this contact and A the set of held ones.
struct ContactEquations {
    Expression gap, gap_t, hdot;  // h; dh/dt at constant q; the gap rate
    std::vector<Expression> g;  // dh, minus its projection on the gradients of the held contacts (Euclidean projection)
    std::vector<Expression> H;  // second derivatives of h, row by row
    std::vector<Expression> impulse;     // M^-1 (g_i' - G_A' W_AA^-1 W_Ai)
    std::vector<Expression> delassus;    // W_ij - W_iA W_AA^-1 W_Aj for every contact j
    Expression W;                        // the diagonal entry W_i of delassus
    std::vector<Expression> direction;   // n = impulse/W, so that g n = 1
    Expression hddot, lambda;            // the normal acceleration while it is open; the force that holds it, -hddot/W
    std::vector<Expression> s;           // v - n hdot
    std::vector<Expression> f_c;         // the acceleration while this contact is also held
    std::vector<Expression> f_by_force;  // the same acceleration, written as f + impulse lambda
    std::map<std::size_t, Expression> on_slips;  // with friction: the accelerations of all slips by a unit force
};

// The equations of motion in one mode: f is the acceleration, including the forces of the held contacts and of
// friction. The entries of a held contact or joint refer to the mode in which it is open and all others are unchanged.
struct ModeEquations {
    Mode mode;
    std::vector<Expression> f;
    std::vector<ContactEquations> contacts;
    std::map<std::size_t, SlipEquations> slips;  // of contacts and joints with friction
};

// T, V and the forces (including -dR/dv) as given.
struct GivenTerms {
    Expression kinetic, potential;
    std::vector<Expression> Q;
};

// A mode in which this held contact is open, but goes on acting if it is one of those in the forces that acts now.
inline Mode unconstrained(Mode mode, std::size_t contact, ContactSet in_forces) {
    return mode.without(contact).with_acting(ContactSet::of(contact).within(in_forces).without(mode.silent()));
}

// The derived equations, as expressions. Vectors have n entries; M and H are full, row by row.
struct Equations {
    GivenTerms given;
    // If the given T has terms of degree 1 and 0 in the rates, T = T2 + c.v + T0, then kinetic is T2, potential is V -
    // T0, and Q contains the forces from c (theory-gaps.md 1).
    std::vector<Expression> M, bias, Q;
    Expression kinetic, potential, energy;
    std::vector<Expression> gaps, restitutions;  // of every contact
    FrictionLaws friction;
    std::vector<std::optional<Expression>> when;  // of every contact: it counts only where this is positive
    std::vector<JumpLaw> jumps;
    std::vector<std::optional<LatchLaw>> latches;  // of every contact
    // The contacts that act on the forces: Q depends on held(NAME), which is constant within a mode. Those of `free`
    // are 0.
    ContactSet in_forces;
    ModeEquations free;              // the mode in which all contacts are open
    Expression power;                // dE/dt = v'Q + dV/dt in free flight; each held contact adds -lambda dh/dt
    std::vector<Expression> pivots;  // D of M = L D L'; M is positive definite if and only if all pivots are positive
    bool autonomous = true;          // nothing depends on time
    // The forces, and therefore f_c, have degree 2 or less in the rates, and none depends on a sliding speed.
    bool quadratic_in_rates = true;

    bool has_power() const;
    bool has_prescribed_motion() const { return kinetic != given.kinetic; }
};

// Derives the rest of the equations from M, Q, kinetic, potential, gaps and restitutions, which must be set.
//     M(q) a + b(q,v,t) = Q(q,v,t),   b_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) v_j v_k + dV/dq_i,   f = M^-1 (Q - b)
//     g = dh,   hdot = g v + h_t,   W = g M^-1 g',   n = M^-1 g'/W,   s = v - n hdot
//     hddot = v'Hv + 2 g_t v + h_tt + g f,   lambda = -hddot/W,   f_c = f - n hddot
// M^-1 is applied through an L D L' factorization unrolled in the graph. Throws std::domain_error if a pivot or W is
// identically 0 (M is not positive definite, or dh = 0), and ExpressionTooLarge if the graph would be too large.
void derive(Equations& equations, const Layout& layout, Graph& graph);

// Equations of all modes, each derived at first use from the mode with one contact fewer. For a further contact k that
// keeps its gap
//     f' = f - n_k hddot_k,   impulse_i' = impulse_i - impulse_k W_ik/W_k
//     W_ij' = W_ij - W_ik W_jk/W_k,   hddot_i' = hddot_i - W_ik hddot_k/W_k
class ContactModes {
 public:
    // Works in a copy of the equations' graph.
    ContactModes(const Equations& equations, const Layout& layout);
    const ModeEquations& of(Mode mode);
    // A mode without the constraint of one of its held contacts, which goes on acting on the forces: its acceleration
    // there decides the contact force.
    Mode unconstrained(Mode mode, std::size_t contact) const {
        return achilles::unconstrained(mode, contact, in_forces_);
    }
    Graph& graph() { return graph_; }
    const FrictionLaws& friction() const { return friction_; }  // in this graph
    // `when` of every contact, and the watched guards, in this graph.
    const std::vector<std::optional<Expression>>& when() const { return when_; }
    const std::vector<Expression>& watched_guards() const { return watched_guards_; }

    // What friction watches in this mode (model/friction.hpp).
    WatchedFriction watched_friction(const ModeEquations& motion);
    // The work per time that a motion takes up from forces and moving surfaces; with friction, followed by its heat per
    // time. `work` is that of free flight.
    Expressions powers(Mode mode, Expression work);
    // The forces of a contact or joint that is not open in this mode.
    FrictionForce force_of(std::size_t which, Mode mode);
    // hddot of a held contact, or with friction its negative force up to a positive factor.
    Expression watched_force(std::size_t contact, Mode mode);

 private:
    ModeEquations derive(Mode mode);
    ModeEquations derive_with_friction(Mode mode);
    ModeEquations derive_free(ContactSet acting);
    Graph graph_;
    Layout layout_;
    FrictionLaws friction_;  // in this graph
    std::vector<std::optional<Expression>> when_;
    std::vector<Expression> watched_guards_;
    ContactSet in_forces_;
    std::vector<Expression> M_, Q_;  // where forces see contact
    std::map<Mode, ModeEquations> known_;
};

// The rate of an expression in q, v and t along a motion: x_q v + x_v a + x_t.
Expression rate_of(Expression x, const std::vector<Expression>& acceleration, const Layout& layout);
// h''' of a contact in the mode that holds it and others: hddot_q v + hddot_v f_c + hddot_t.
Expression jerk_of(const ContactEquations& contact, const Layout& layout);

// ---- the equations of motion in one mode, as programs ----

// In a mode, every contact has an event function, the function that its law watches (contacts/contact_law.hpp). It is
// the gap, or for the force the hddot of the mode in which the contact is open (the force is -hddot/W). The event
// functions of friction follow, then the watched guards. In the series, the powers() of a mode with friction are its
// last event functions: they are integrated along a step, not watched.
struct ModeDynamics {
    Mode mode;
    std::vector<Expression> f, event_functions;  // as in the series; event functions of the contacts only
    TypedProgram<MotionTerms> program;
    SeriesProgram series;                 // MotionSeries
    std::vector<FrictionEvent> friction;  // event function contacts + k is friction[k]
    std::size_t guards = 0;               // how many watched guards follow
    std::size_t powers = 0;               // how many powers follow in the series: none, or work and heat

    // How many event functions follow those of the contacts.
    std::size_t further_events() const { return friction.size() + guards; }
};

// Compiles a mode. `equations` belongs to the graph of `motion`, or to the graph that it was copied from. Throws
// ExpressionTooLarge.
ModeDynamics make_motion(const ModeEquations& motion, const Equations& equations, const Layout& layout,
                         ContactModes& modes);
// The series of a mode with hddot of every contact, open or held, as event functions. Proofs use it, because the gap is
// a coordinate of its own there (theory-enclosure.md 1).
SeriesProgram make_hddot_series(const ModeEquations& motion, const Equations& equations, const Layout& layout);

}  // namespace achilles
