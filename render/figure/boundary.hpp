// The boundaries h = 0 in the picture of a path.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "figure/compose.hpp"

namespace achilles {

// The line h = 0 of every gap as a view shows it, less where another gap is negative, in the units that are shown;
// segments, separated by NaN points. The view's axes are two coordinates, of the gaps that depend on them alone, seen
// between the limits of `panel`; or, in a system of two coordinates, any functions of them (a point of a mechanism), seen
// where the run goes and half as far again. Empty for every other view. A gap that depends on time is drawn as it is at t:
// of a whole run, where there is no such time, it is left out, since any line of it would be one that the path may cross.
// `size`: of the plot area.
std::vector<Point> boundary(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                            const Panel& panel, std::optional<double> t = {}, const Resolution& size = {400.0, 300.0});

// Whether a gap of the model depends on time.
bool has_moving_gap(const Model& model);

}  // namespace achilles
