// The Taylor coefficients of a motion at a point, over a box of states, or with their derivatives.
#pragma once

#include <memory>

#include "enclose/coordinates.hpp"
#include "series/series.hpp"

namespace achilles {

class Expansion {
 public:
    virtual ~Expansion() = default;
    // Of hddot the orders 0 .. last, of q and v 0 .. last + 1, over a box of all coordinates.
    virtual void expand(const Intervals& box, int last) = 0;
    // Order k of row i: q and v, then hddot of each contact.
    virtual Interval value(int k, std::size_t i) const = 0;
    // Its derivative by variable j of Coordinates::of_motion().
    virtual Interval slope(int k, std::size_t i, std::size_t j) const = 0;
    // M is positive definite all over the box.
    virtual bool has_mass() = 0;
};

// At a point the numbers are Fine, so that what a step loses there is the rounding of its end alone.
enum class Expanded { at_a_point, over_a_box, with_derivatives };
// `series` is that of Model::hddot_series() and outlives the result.
std::unique_ptr<Expansion> make_expansion(const SeriesProgram& series, const Coordinates& coordinates, Expanded what);

}  // namespace achilles
