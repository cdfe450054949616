// Where a search for a periodic run begins, and where a lap of one may begin as well.
#pragma once

#include "study/return_map.hpp"

namespace achilles {

// Where to begin, once the run has gone on for so many periods: in a flight; of which period, if that is not known, from one
// release to that which is most like it, or from where the run comes back to most nearly. Throws NoOrbit.
Lap guess_of(const ReturnMap& map, int periods = 0);
// Lengths that the state, the period and a parameter are measured by along such a run.
Eigen::VectorXd scale_of(const ReturnMap& map, const Lap& lap, double of_parameter);

// A lap that closes as many periods earlier, as far as the start time.
Lap earlier(const ReturnMap& map, Lap lap);
// A lap that closes from the middle of its flight, or where that is too short of the longest; or past a release, where there is one.
Lap rebased(const ReturnMap& map, const Lap& lap, bool past_a_release = false);

}  // namespace achilles
