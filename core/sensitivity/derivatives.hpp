// The derivatives of a finished run, through all of its impacts and Zeno points (theory-derivatives.md 1).
//
//     const Derivatives d = differentiate(trajectory);
//     d.end->q(i, k)             of coordinate i at the end time, by direction k
//     d.events[j].t[k]           of the time of event j
//     d.events[j].q(i, k)        of coordinate i at event j, following the event
//
// A search for periodic orbits uses the map from a start to the k-th release. The state at that event and its entry
// here are this map and its Jacobian, by user-defined directions: differentiate(trajectory, directions).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

// Distances of a run from situations without derivative (theory-derivatives.md 8).
struct DerivativeMargins {
    std::optional<double> grazing_speed;  // smallest speed of an impact with hddot > 0
    std::optional<double> gap_minimum;    // smallest minimum of a gap in flight
    std::optional<double> a_inf;          // smallest -hddot at a Zeno point
    std::optional<double> release_jerk;   // smallest h''' at a release
};

struct Derivatives {
    // Names: initial coordinates, initial rates, parameters in the file's order; K of them. Empty for user-defined
    // directions.
    std::vector<std::string> directions;
    // For each direction, the reason why it has no derivatives, or ""; if not "", its columns are NaN. If the run
    // starts at rest on a contact surface, only directions along the surface have derivatives.
    std::vector<std::string> refused;

    // Following the event: derivatives of its time (s) and of the state there, coordinate by direction.
    struct EventSensitivity {
        Eigen::VectorXd t;
        Eigen::MatrixXd q, v_before, v_after;  // equal unless the velocity jumps
        Eigen::VectorXd impact_speed;          // for impacts, else empty
    };
    std::vector<EventSensitivity> events;  // the first events of the trajectory, as far as they have derivatives
    // At a fixed time.
    struct FinalSensitivity {
        Eigen::MatrixXd q, v;
    };
    std::optional<FinalSensitivity> end;
    // The reason why there are none beyond the last of `events`, and the time from which on; else empty.
    std::string broken;
    double broken_from = 0.0;
    DerivativeMargins margins;
};

// By all initial coordinates and rates and all parameters. Throws InputError as Chain does; problems during the run are
// reported in `broken`.
Derivatives differentiate(const Trajectory& trajectory);
// By these directions, one per column; the rows are q, v, the parameters and the start time (s).
Derivatives differentiate(const Trajectory& trajectory, const Eigen::MatrixXd& directions);

}  // namespace achilles
