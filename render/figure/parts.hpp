// Parts of machines as lines: points in world coordinates, a NaN point between two lines. They look right at any length:
// what keeps its size (a coil's breadth, a cup) shrinks only where there is no room for it.
#pragma once

#include <vector>

#include "figure/figure.hpp"

namespace achilles {

// The corners of a rectangle of this width and height about its middle, turned by an angle (rad) to the left.
std::vector<Point> box_corners(const Point& middle, double width, double height, double angle);

// What a part is measured by: how long it is at rest, and how broad.
struct PartSize {
    double rest = 0.0;
    double across = 0.0;
};

// What fits a part of this length at rest in a world of this size: the same for all parts that are not short.
double fitting_across(double rest, double world);
// As many coils as make a spring's wire at rest about as steep as it is drawn by hand.
int fitting_coils(const PartSize& size);

// A spring: a straight end, a zigzag of so many coils from side to side, a straight end.
std::vector<Point> spring_line(const Point& from, const Point& to, int coils, const PartSize& size);

// A damper: a rod with a cup that is open towards `to`, and the piston in it on a rod from there. At rest the piston is in
// the cup's middle; it moves with the length, and never out of the cup.
std::vector<Point> damper_line(const Point& from, const Point& to, const PartSize& size);

// Strokes at 45 degrees on the right of from -> to, about so far apart.
std::vector<Point> hatching(const Point& from, const Point& to, double apart);

// The strip on that side, so deep, as a polygon.
std::vector<Point> beneath(const Point& from, const Point& to, double deep);

}  // namespace achilles
