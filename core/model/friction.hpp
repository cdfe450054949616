// Dry friction in the equations of motion (theory-friction.md 1, 2).
//
//     u = d v + c                                   slip of a contact or joint, affine in the rates
//     slip    tau = -sigma mu lambda,  sigma = sign u,  mu = mu(q, t, |u|)
//     stick   u = 0,  |tau| <= mu_s lambda
//     M a + b = Q + sum g' lambda + d' tau
//
// A joint has no gap: its level F takes the place of mu, and lambda is 1.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "contacts/contact_law.hpp"
#include "expression/expression.hpp"

namespace achilles {

struct Layout;
struct ModeEquations;

// The law of one contact or joint, as read.
struct FrictionLaw {
    Expression slip;            // u = d v + c
    std::vector<Expression> d;  // functions of q and t, as is c
    Expression c;
    Expression level;           // mu or F; the speed |u| is the symbol Layout::sliding_speed()
    Expression static_level;    // mu_s or F_s, without |u|
    bool has_jump = false;      // mu_s may differ from mu at u = 0: accelerations then jump where slip starts
    bool never_slides = false;  // friction = "inf"; the levels are 0 and are not used
};
// By contact number, or joint_number().
using FrictionLaws = std::map<std::size_t, FrictionLaw>;

// The slip of a contact or joint in a mode in which it is open, as ContactEquations for its gap.
struct SlipEquations {
    Expression u, c;  // as in FrictionLaw
    std::vector<Expression> d;
    Expression udot;                             // the acceleration of the slip
    std::vector<Expression> impulse;             // the acceleration of the coordinates by the force tau = 1
    std::vector<Expression> on_gaps;             // the same of every gap
    std::map<std::size_t, Expression> on_slips;  // and of every slip
};

// Sets the slips of the free equations, and on_slips of their contacts. `solve` applies M^-1.
using MassSolver = std::function<std::vector<Expression>(const std::vector<Expression>&)>;
void derive_slips(const FrictionLaws& laws, const Layout& layout, const MassSolver& solve, ModeEquations& free);

// Puts a contact or joint into its state of `mode`: changes the equations of the mode in which it is open, for all
// others.
void add_to_mode(ModeEquations& equations, std::size_t which, Mode mode, const FrictionLaws& laws,
                 const Layout& layout);

// The forces of a contact or joint that is not open in `mode`. `before` is the mode that differs only in that it is
// open. Both forces are multiplied by `scale`, which is positive where there is a motion (theory-friction.md 2).
struct FrictionForce {
    Expression lambda, tau, scale;
};
FrictionForce friction_force(const ModeEquations& before, std::size_t which, Mode mode, const FrictionLaws& laws,
                             const Layout& layout);

// The forces by which a contact or joint that is held, or a contact that slides, cancels these accelerations of its gap
// and slip. A joint has no gap.
struct RowAccelerations {
    Expression gap, slip;
};
FrictionForce reaction(const ModeEquations& before, std::size_t which, Mode mode, const FrictionLaws& laws,
                       const Layout& layout, const RowAccelerations& accelerations);
// The accelerations of gap and slip of `which` by a unit force along the gap of a contact, or along its slip.
RowAccelerations by_normal_force(const ModeEquations& before, std::size_t which, std::size_t contact);
RowAccelerations by_friction_force(const ModeEquations& before, std::size_t which, std::size_t contact);

// The contacts with an implied slip (Mode) whose friction force this sticking contact carries.
ContactSet sharing_with(Mode mode, std::size_t contact, const FrictionLaws& laws);

// What friction watches in a mode, in the order of contacts and joints, with its functions. `without(i)` gives the
// equations of the mode in which i is open.
struct WatchedFriction {
    std::vector<FrictionEvent> events;
    std::vector<Expression> functions;
};
using EquationsWithout = std::function<const ModeEquations&(std::size_t)>;
WatchedFriction watched_friction(const ModeEquations& motion, const FrictionLaws& laws, const Layout& layout,
                                 const EquationsWithout& without);

// The negative force of a held contact, up to a positive factor: what its law watches.
Expression negative_force(const ModeEquations& before, std::size_t contact, Mode mode, const FrictionLaws& laws);

// The heat of a mode per time: sum mu lambda |u| of contacts and joints that slip. Its work per time that friction
// takes from moving surfaces: -sum tau c.
struct FrictionPower {
    Expression heat, work;
};
FrictionPower friction_power(const ModeEquations& motion, const FrictionLaws& laws, const Layout& layout,
                             const EquationsWithout& without);

}  // namespace achilles
