// Polylines in pixels, made small before they are drawn: thinned, clipped, cut into dashes. No ImGui, no OpenGL.
#pragma once

#include <vector>

#include "figure/figure.hpp"

namespace achilles {

struct Box {
    double x_low = 0.0, y_low = 0.0, x_high = 0.0, y_high = 0.0;
};

// A point that breaks a polyline.
Point gap_point();
bool is_finite(const Point& point);

// Fewer points, never farther than `tolerance` from the line that is left; extremes and corners stay. Breaks (points
// that are not finite) stay too, as gap points.
std::vector<Point> thinned(const std::vector<Point>& points, double tolerance);

// The parts of a polyline inside the box. `dash` is on, off, on, ... in pixels, counted from the first point along the
// whole curve, in and out of the box, so that dashes do not crawl when the view moves; empty: solid. Of dashes a
// `cap` is taken off at either end, because strokes have round ends that stick out by half their width.
std::vector<Point> cut(const std::vector<Point>& points, const Box& box, const std::vector<double>& dash, double cap);

}  // namespace achilles
