// Limits of the comparison with golden texts. Those of pictures are in render/image/comparison.hpp.
#pragma once

namespace achilles::golden {

// Numbers in a text may differ by one unit in the ninth digit, and near zero by rounding errors.
constexpr int digits_compared = 9;
constexpr double absolute_allowed = 1e-12;

}  // namespace achilles::golden
