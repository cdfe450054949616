// A curve that goes over itself.
#pragma once

#include <vector>

#include "figure/trace.hpp"

namespace achilles {

// A curve without the parts that lie within half a pixel of earlier ones and go along them: dashes over dashes would look like a
// solid line. Where parts are left out a NaN point breaks it. `size` is that of the plot area.
std::vector<Point> without_retraced(const std::vector<Point>& points, const Axis& x, const Axis& y,
                                    const Resolution& size);

}  // namespace achilles
