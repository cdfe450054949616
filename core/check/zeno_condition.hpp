// How the Zeno condition of simplified.hpp is found.
#pragma once

#include "check/simplified.hpp"

namespace achilles {

// hddot of the first of these contacts after h = 0 and hdot = 0, of all of them, were solved for a coordinate and a rate,
// where they can be and it makes hddot shorter: the others are held. Nothing where it takes too long. Nodes are made in
// `graph`, a copy of the model's.
std::optional<ZenoCondition> zeno_condition(const Model& model, const Run& run,
                                            const std::vector<const ContactEquations*>& contacts, Graph& graph);

// A product of factors as one expression, factor by factor.
Expression expression_of(const Factored& product, Algebra& algebra);

}  // namespace achilles
