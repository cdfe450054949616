// Explains events of a finished run: why an impact was or was not truncated, why a contact was released. Computed on
// demand.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "run/trajectory.hpp"

namespace achilles {

// Explanation of an impact (index into trajectory.events): its energy, and the reason if the bouncing was not
// truncated.
struct ImpactReason {
    bool cut = false;  // truncated at this impact: the bounces after it are not simulated
    double energy_before = 0.0, energy_after = 0.0;
    // The impacting contact; empty for simultaneous impacts, which are not truncated.
    std::optional<std::size_t> contact;
    Mode mode;  // before the impact
    // hddot of the contact in that mode, at the restart velocity.
    double normal_acceleration = 0.0;
    // The certificate that can be proved here whatever the tolerances. Its first three inequalities compare with the
    // tolerances of the run; one that fails is the reason. Empty if hddot is not proved negative around the collision.
    std::optional<Certificate> attempt;
};
ImpactReason explain_impact(const Trajectory& trajectory, std::size_t event);

// Explanation of a release: lambda = -hddot/W of the contact, in the mode that holds the others, crosses zero.
struct ReleaseReason {
    std::size_t contact = 0;                 // the first of the released contacts
    double lambda = 0.0, lambda_rate = 0.0;  // lambda_rate = -h'''/W
    double jerk = 0.0;                       // h''', positive: the contact opens
    // (t, lambda) since the contact was last held, up to the release. It jumps where other contacts join or leave.
    std::vector<std::pair<double, double>> force;
};
ReleaseReason explain_release(const Trajectory& trajectory, std::size_t event);

}  // namespace achilles
