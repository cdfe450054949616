// Dragging: the coordinates of a start with which a point of the mechanism is where the mouse wants it.
#pragma once

#include "figure/body.hpp"

namespace achilles {

// Moves the start of a run toward `q` as far as the run can start, so that what is dragged into the ground stays on it.
Vector start_towards(const Model& model, const Run& run, const Vector& q);

// The coordinates of a start, from those of the run, with which the point is as near to `place` as the coordinates and
// the gaps let it come. A contact that would be penetrated is kept at gap 0 (1e-9 above it), so that the point slides
// along the surface. Every result is one from which the run can start; the start of the run itself if there is no
// nearer one.
Vector dragged_start(const Model& model, const Run& run, AnchorPoint& point, const Point& place);

// The change of each coordinate that moves a body by a pixel. `unit`: pixels per length; for the rates that change its
// velocity arrow by a pixel, pixels per velocity.
Vector change_per_pixel(const Body& body, Eigen::Index count, double unit);
// Values that a hand sets are round. Each coordinate or rate keeps only the decimals that move the point by a pixel or
// more, in degrees for angles. `per_pixel`: its change for a pixel.
Vector rounded_values(const Model& model, const Vector& values, const Vector& per_pixel);
// The same for the coordinates of a start. One that lies on a surface, or could not start if it were rounded, is kept.
Vector rounded_start(const Model& model, const Run& run, const Vector& q, const Vector& per_pixel);

}  // namespace achilles
