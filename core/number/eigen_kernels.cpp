#include "number/eigen_kernels.hpp"

namespace Eigen::internal {

ACHILLES_EIGEN_KERNELS(template)

}  // namespace Eigen::internal
