// Why an event is what it is: what a person asks of a finished run. Computed from the run when asked, not kept in it.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "run/trajectory.hpp"

namespace achilles {

// Of an impact (index into trajectory.events): what it cost, and why the bouncing was not cut short at it, if it was
// not.
struct ImpactReason {
    bool cut = false;  // it was: the bounces after it are not drawn
    double energy_before = 0.0, energy_after = 0.0;
    // The contact that lands; nothing where several do, whose bouncings are not cut.
    std::optional<std::size_t> contact;
    Mode mode;  // just before it
    // hddot of the contact at the velocity that it would be held with, along the motion in that mode.
    double normal_acceleration = 0.0;
    // What could be proved here whatever the tolerances: its first three inequalities are those of the run's own
    // tolerances, and one that does not hold is the reason. Nothing where hddot is not proved negative around here.
    std::optional<Certificate> attempt;
};
ImpactReason explain_impact(const Trajectory& trajectory, std::size_t event);

// Of a release: lambda = -hddot/W crosses zero, as the motion that holds the other contacts sees it.
struct ReleaseReason {
    std::size_t contact = 0;                 // the first of those that leave
    double lambda = 0.0, lambda_rate = 0.0;  // the rate is -h'''/W
    double jerk = 0.0;                       // h''', positive: the surface falls away
    // Lambda since the contact has been held: (t, lambda), to the release. It jumps where others come or go.
    std::vector<std::pair<double, double>> force;
};
ReleaseReason explain_release(const Trajectory& trajectory, std::size_t event);

}  // namespace achilles
