// Machine parts as lines: points in world coordinates, with a NaN point between two lines. Features of fixed size (coil
// width, cup of a damper) shrink only if the part is too short for them.
#pragma once

#include <vector>

#include "figure/figure.hpp"

namespace achilles {

// Corners of a rectangle of this width and height about `middle`, rotated counterclockwise by `angle` (rad).
std::vector<Point> box_corners(const Point& middle, double width, double height, double angle);

// Length of a part at rest, and its width.
struct PartSize {
    double rest = 0.0;
    double across = 0.0;
};

// Width of a part with this rest length in a world of this size. It is the same for all parts that are not short.
double fitting_across(double rest, double world);
// Number of coils that gives a spring at rest its usual slope.
int fitting_coils(const PartSize& size);

// A spring: a straight end, a zigzag with this number of coils, a straight end.
std::vector<Point> spring_line(const Point& from, const Point& to, int coils, const PartSize& size);

// A damper: a rod with a cup that is open toward `to`, and a piston on a rod from `to`. At rest the piston is in the
// middle of the cup; it moves with the length but stays in the cup.
std::vector<Point> damper_line(const Point& from, const Point& to, const PartSize& size);

// Strokes at 45 degrees on the right of from -> to, spaced about `apart`.
std::vector<Point> hatching(const Point& from, const Point& to, double apart);

// The strip of depth `deep` on the right of from -> to, as a polygon.
std::vector<Point> strip_right_of(const Point& from, const Point& to, double deep);

}  // namespace achilles
