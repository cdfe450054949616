// A system in space from two sides: of coordinates x, y and z the planes x-z and y-z, cut where the point is.
//
// A [[drawing]] has two coordinates; what it shows of a system in space is a picture that its file made up. Here every
// system of three Cartesian coordinates is seen as it is: what is solid is the side h < 0 of its gaps, in the plane through
// the point; the way is seen from there whole.
#pragma once

#include <array>
#include <span>

#include "figure/body.hpp"
#include "figure/field.hpp"

namespace achilles {

class Sides {
 public:
    // Refers to what it is given.
    Sides(const Trajectory& trajectory, std::span<const Sample> samples);
    // Whether the system has these coordinates, and no others.
    bool exist() const { return exist_; }
    struct Side {
        std::string name;  // "x", "z": what is across, what is up
        std::array<std::size_t, 2> pair;
    };
    static std::array<Side, 2> all();
    // What the whole run needs of both, of the same size.
    std::array<Drawing, 2> limits() const;
    // One of them in the part of its plane that is seen.
    Drawing draw(std::size_t side, const Sample& now, const Drawing& seen, const Theme& theme, bool with_way) const;

 private:
    const Trajectory& trajectory_;
    std::span<const Sample> samples_;
    bool exist_ = false;
};

}  // namespace achilles
