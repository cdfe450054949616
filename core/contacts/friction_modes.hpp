// The modes that closed contacts and joints with dry friction may take at an instant (theory-friction.md 2): every
// combination of states is tried, and its forces and accelerations are checked.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "run/mode.hpp"

namespace achilles {

// Rows of gaps and slips: accelerations a without the forces below, and the accelerations W z by forces z along them.
struct FrictionProblem {
    struct Element {
        std::size_t which;                    // contact or joint
        Eigen::Index gap = -1, slip = -1;     // its rows; -1: none. A contact without friction has no slip.
        double sliding = 0.0, resting = 0.0;  // mu or F; mu_s or F_s
        bool slides = false;                  // u is not 0: the sign of its state is that of u
        std::vector<ContactState> states;     // to be tried
        int group = -1;  // of contacts at rest whose slips are equal (group_equal_slips); -1: alone
    };
    std::vector<Element> elements;
    Eigen::MatrixXd W;
    Eigen::VectorXd accelerations;
};

// Groups contacts that do not slide by equal rows of slip, as of the feet of a table. Those of a group stick or slip
// together. They share one friction force while they stick: its distribution is not unique, but the motion is.
void group_equal_slips(FrictionProblem& problem);
// The contacts that stick in this mode because an earlier one of their group does.
ContactSet implied_slips(const FrictionProblem& problem, Mode mode);

// The forces and accelerations in one combination of states.
struct FrictionMotion {
    Mode mode;
    Eigen::VectorXd forces, accelerations;  // by row
    // The smallest of the quantities that must be positive, relative to the size of its terms: a normal force, the
    // acceleration of an open gap or of a starting slip, the distance from the edge of the cone.
    double margin = 0.0;
    bool is_unique = true;  // whether the forces are
};
// Quantities below this relative size count as 0.
inline constexpr double zero_force = 1e-11;

// The motion in a combination of states. Its equations may have no solution; then the margin is NaN.
FrictionMotion motion_in(const FrictionProblem& problem, Mode mode);

struct FrictionChoice {
    enum class Kind {
        one,       // exactly one mode, or several with the same accelerations
        none,      // no mode obeys the laws
        several,   // modes with different accelerations do
        undecided  // the signs of some modes are 0 within rounding
    };
    Kind kind = Kind::none;
    std::vector<FrictionMotion> motions;  // those that obey the laws, the chosen one first; else those in doubt
};
// If several modes obey the laws, those in which most contacts and joints stick count: with mu_s > mu, the cone of rest
// may contain the force although sliding obeys the laws, too.
FrictionChoice choose_mode(const FrictionProblem& problem);

// Newton's impact law in Moreau's form with tangential restitution 0 (theory-friction.md 3), over the closed contacts:
//     0 <= p perpendicular hdot+ + e hdot- >= 0,   p_T in -mu p Sgn(u+),   (hdot+, u+) = (hdot-, u-) + W (p, p_T)
struct FrictionImpactProblem {
    std::vector<FrictionProblem::Element> elements;  // contacts; coefficients and states are set here
    std::vector<double> e;                           // restitution, by element
    Eigen::MatrixXd W;
    Eigen::VectorXd before;  // hdot- and u-, by row
    // mu of an element at a sliding speed, and whether it depends on it.
    std::function<double(std::size_t element, double speed)> coefficient;
    bool is_constant = true;
    bool may_gain_energy = false;  // otherwise restitutions are reduced until no energy is gained
};
struct FrictionImpact {
    FrictionChoice::Kind kind = FrictionChoice::Kind::none;  // none or several: no impulses obey the law, or several do
    Mode mode;                                               // open: no impulse; held: u+ = 0; slip
    Eigen::VectorXd impulses, after;                         // by row
    double energy_change = 0.0;                              // of the kinetic energy relative to the surfaces
    bool gains_energy = false;                               // at some contacts that nothing couples with the others
    // The restitutions of coupled contacts were multiplied by this factor, because the impact would gain energy.
    std::vector<std::pair<std::size_t, double>> caps;  // by element
};
// Solves the law. Contacts that W does not couple are solved apart.
FrictionImpact friction_impact(const FrictionImpactProblem& problem);

}  // namespace achilles
