// Curves as smooth as a picture needs: dense where it looks, coarse elsewhere.
#pragma once

#include <functional>
#include <vector>

#include "figure/drawing.hpp"

namespace achilles {

using ParametricCurve = std::function<Point(double)>;

// Points of a curve over [low, high]: `pieces` + 1 at equal steps of its parameter, and between those in or near what is
// seen as many more as bring the chords within 5e-5 of the picture's diagonal, so that no corner shows at any zoom. What is
// seen: the drawing's limits.
std::vector<Point> refined(const ParametricCurve& curve, double low, double high, int pieces, const Drawing& seen);

}  // namespace achilles
