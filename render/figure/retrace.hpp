// A curve that goes over itself.
#pragma once

#include <vector>

#include "figure/figure.hpp"

namespace achilles {

// A curve without the parts that lie on earlier ones, to a four-hundredth of the panel, and go along them: dashes over
// dashes would look like a solid line. Where parts are left out a NaN point breaks it.
std::vector<Point> without_retraced(const std::vector<Point>& points, const Axis& x, const Axis& y);

}  // namespace achilles
