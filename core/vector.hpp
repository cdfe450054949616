// Vectors and matrices of the coordinates: at most eight, so they live on the stack.
#pragma once

#include <Eigen/Core>

namespace achilles {

inline constexpr int max_coordinates = 8;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_coordinates, 1>;

}  // namespace achilles
