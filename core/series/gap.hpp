// The gap along a flight, its rate, and error bounds of both.
#pragma once

#include "number/double8.hpp"

namespace achilles {

template <class Number>
struct GapOver {
    Number h = 0.0, hdot = 0.0;
    Number error = 0.0, rate_error = 0.0;  // errors of h and hdot from earlier steps of the flight
    // Error of the state from the steps before the flight, relative to its size. The error of the gap's acceleration is
    // about this, times the sizes of hddot and of its rate. Their sum is limited to `steepest`: a larger value is a
    // narrow bend that is passed almost at once.
    Number state_error = 0.0;
    static constexpr double steepest = 1e3;

    // Error of hddot caused by the error of the state. In flight it is the rate at which the error of hdot grows; in
    // contact it is the error of the event function. `size`: sum of the sizes of hddot (m/s^2) and of its rate
    // (m/s^3). `unit`: scale of a gap that has another unit than the coordinates.
    Number hddot_error(const Number& size, double unit = 1.0) const {
        return state_error * (unit + min(size, Number(steepest * unit)));
    }
    // Error of the gap after a time in flight (s), with the error of hddot.
    Number error_after(const Number& span, const Number& acceleration_error) const {
        return error + (rate_error + 0.5 * acceleration_error * span) * span;
    }
};
using Gap = GapOver<double>;

}  // namespace achilles
