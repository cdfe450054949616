// How near the run came to the surfaces, at any time. Computed from the run when asked, not kept in it.
#pragma once

#include "run/trajectory.hpp"

namespace achilles {

// The least gap of all contacts over the run: at its start, where steps end, and at the minima inside steps, of contacts
// that the step does not hold. In the gap's unit. A trajectory of which the end alone was kept has no steps to look into.
double least_gap(const Trajectory& trajectory);

}  // namespace achilles
