// The default output of `simulate`: the result first, then a table of what changed, then the accuracy. summary() has everything.
#pragma once

#include <string>

#include "depend/error_estimate.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// At most 15 lines for a run with up to ten changes of contact. Numbers have the digits that certificates and the estimated error
// support. `prove_command` is the command line that proves this run; the output names it.
std::string answer(const Trajectory& trajectory, const ErrorEstimate& estimate, const std::string& prove_command);

// What to type after a run that stopped early: "Try a smaller --tolerance."; empty for a run that reached its end time.
std::string advice(const Outcome& outcome);

}  // namespace achilles
