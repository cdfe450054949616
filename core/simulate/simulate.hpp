// The completed execution of a system: past every Zeno point, until the end time.
#pragma once

#include <memory>

#include "trajectory.hpp"

namespace achilles {

// Runs. Never throws for what happens on the way: that is the trajectory's outcome. Throws InputError if the run cannot
// start (Model::check).
Trajectory simulate(std::shared_ptr<const Model> model, const Run& run);

}  // namespace achilles
