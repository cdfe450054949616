// The derivatives of a finished run, through all of its impacts and Zeno points (theory-derivatives.md 1).
//
//     const Derivatives d = differentiate(trajectory);
//     d.end->q(i, k)             of coordinate i at the end time, by direction k
//     d.events[j].t[k]           of the time of event j
//     d.events[j].q(i, k)        of where it happens, following the event
//
// What a search for periodic runs asks, the map from a start to the k-th release and its Jacobian, are the state and the entry of
// that event, by directions of its own: differentiate(trajectory, directions).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

// How near a run comes to where it has no derivative (theory-derivatives.md 8).
struct DerivativeMargins {
    std::optional<double> grazing_speed;  // the least speed of an impact with hddot > 0
    std::optional<double> gap_minimum;    // the least minimum of a gap along a flight
    std::optional<double> a_inf;          // the least -hddot at a Zeno point
    std::optional<double> release_jerk;   // the least h''' at a release
};

struct Derivatives {
    // Names: starts, rates, parameters in the file's order; K of them. Of directions of one's own there are none.
    std::vector<std::string> directions;
    // Of each direction why it has none, or "": then its columns are no numbers. On a surface on which the run starts at rest
    // only directions along it have.
    std::vector<std::string> refused;

    // Following the event: of its time, s, and of the state there, coordinate by direction.
    struct AtEvent {
        Eigen::VectorXd t;
        Eigen::MatrixXd q, v_before, v_after;  // before and after are the same where nothing jumps
        Eigen::VectorXd impact_speed;          // of an impact, else empty
    };
    std::vector<AtEvent> events;  // of the trajectory, as many of the first as have derivatives
    // At fixed time.
    struct AtEnd {
        Eigen::MatrixXd q, v;
    };
    std::optional<AtEnd> end;
    // Why there are none beyond the last of `events`, else empty; and from when on.
    std::string broken;
    double broken_from = 0.0;
    DerivativeMargins margins;
};

// By every start, rate and parameter. Throws InputError as Chain does; never for what happens on the way.
Derivatives differentiate(const Trajectory& trajectory);
// By these directions, one a column: q, v, the parameters and the start time (s) are its rows.
Derivatives differentiate(const Trajectory& trajectory, const Eigen::MatrixXd& directions);

}  // namespace achilles
