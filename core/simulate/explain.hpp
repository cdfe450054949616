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
    double normal_acceleration = 0.0;  // hddot of the free motion at the velocity that contact would start with
    // What could be proved here whatever the tolerances: its first three inequalities are those of the run's own
    // tolerances, and one that does not hold is the reason. Nothing where hddot is not proved negative around here.
    std::optional<Certificate> attempt;
};
ImpactReason explain_impact(const Trajectory& trajectory, std::size_t event);

// Of a release: lambda = -hddot/W crosses zero, as the constrained motion sees it.
struct ReleaseReason {
    double lambda = 0.0, lambda_rate = 0.0;  // the rate is -h'''/W
    double jerk = 0.0;                       // h''', positive: the surface falls away
    // Lambda over the last part of the contact: (t, lambda), to the release.
    std::vector<std::pair<double, double>> force;
};
ReleaseReason explain_release(const Trajectory& trajectory, std::size_t event);

}  // namespace achilles
