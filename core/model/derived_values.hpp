// The values of the parameters that follow from others.
#pragma once

#include <span>
#include <vector>

#include "model/model.hpp"

namespace achilles {

// In the order of the description's `derived`, for these values of the parameters.
std::vector<double> derived_values(const Model& model, std::span<const double> parameters);

}  // namespace achilles
