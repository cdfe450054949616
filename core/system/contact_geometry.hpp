// Gaps and slips of contacts between shapes.
//
// The gap is the distance of what touches from what is touched, except on a curve. The slip is the tangential velocity of
// the point of what touches that is nearest, minus that of the touched body at the same place. The tangent is the normal
// (towards what touches) turned right. The slip is scaled like the gap.
#pragma once

#include <string>

#include "system/mechanism.hpp"

namespace achilles {

struct ShapeContact {
    ProductSum gap, slip;
    ProductSum scale;                      // of both: the gap is this times a distance; 0 stands for 1
    bool has_slip = true;                  // false: a string
    std::string name;                      // "shank.end on floor"
    std::string force;                     // what lambda is: "a distance: lambda is the force"
    std::string behind, hint;              // message and advice for a negative gap at the start; {} is its size
    const PlacedShape* touches = nullptr;  // null: a point of the world
    const PlacedShape* touched = nullptr;  // null: a string, or a point of the world
    NamedPoint point;                      // what touches: a point, or the center of a disc
    std::optional<NamedPoint> other;       // string: its other end
    ProductSum longest;                    // string: its length
};

// The geometry of a [[constraint]] with `between`. Throws Mistake.
ShapeContact read_contact(PlacedMechanism& mechanism, const Fields& fields);

}  // namespace achilles
