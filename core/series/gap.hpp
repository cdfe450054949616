// The gap along a flight, its rate, and how well they are known.
#pragma once

#include "number/eight.hpp"

namespace achilles {

template <class Number>
struct GapOver {
    Number h = 0.0, hdot = 0.0;
    Number error = 0.0, rate_error = 0.0;  // what earlier steps of the flight may have made them wrong by
    // What the steps before the flight may have made the state wrong by, relative to its size. The acceleration of the
    // gap is then wrong by about as much as it and its rate are large; what is beyond `steepest` is a narrow bend,
    // passed in an instant.
    Number state_error = 0.0;
    static constexpr double steepest = 1e3;

    // How fast the error of the state moves what an event is looked for in: the gap's rate in flight, hddot itself in
    // contact. `size`: the sizes of hddot and of its rate together (m/s^2 and m/s^3, as the two are added).
    // `unit`: the size of what 1 is said of, of a gap that is written in another unit than the coordinates.
    Number drift(const Number& size, double unit = 1.0) const {
        return state_error * (unit + min(size, Number(steepest * unit)));
    }
    // What all this has made the gap wrong by after a time in flight (s), the state's error drifting so fast.
    Number error_after(const Number& span, const Number& drifting) const {
        return error + (rate_error + 0.5 * drifting * span) * span;
    }
};
using Gap = GapOver<double>;

}  // namespace achilles
