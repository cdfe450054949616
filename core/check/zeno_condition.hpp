// How the Zeno condition of simplified.hpp is found.
#pragma once

#include "check/simplified.hpp"

namespace achilles {

// hddot after h = 0 and hdot = 0 were solved for a coordinate and a rate, where they can be and it makes hddot shorter.
// Nothing where it takes too long. Nodes are made in `graph`, a copy of the model's.
std::optional<ZenoCondition> zeno_condition(const Model& model, const Run& run, Graph& graph);

}  // namespace achilles
