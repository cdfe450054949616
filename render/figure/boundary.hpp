// The boundary h = 0 in the picture of a path.
#pragma once

#include <span>
#include <vector>

#include "figure/compose.hpp"

namespace achilles {

// The line h = 0 as a view shows it, in the units that are shown; segments, separated by NaN points. The view's axes are
// two coordinates on which alone the gap depends, seen between the limits of `panel`; or, in a system of two
// coordinates, any functions of them (a point of a mechanism), seen where the run goes and half as far again. Empty for
// every other view.
std::vector<Point> boundary(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                            const Panel& panel);

}  // namespace achilles
