// Where a quantity that is positive first becomes zero, proved for every member of a set at once (theory-enclosure.md 3).
#pragma once

#include "enclose/doubleton.hpp"

namespace achilles {

// The quantity lies in sum_k c_k t^k at every t in [0, length], the last coefficient that of a remainder, and so does its
// derivative in the sum's (the lemma there).
struct FirstRoot {
    enum class Kind {
        none,  // it is positive on [0, length]
        one,   // exactly one zero in `at` in every member, its derivative negative there, and positive before
        doubt  // positive before at.lo(); nothing is known from there on
    };
    Kind kind = Kind::doubt;
    Interval at;
};
FirstRoot first_root(const Intervals& coefficients, double length);

// The sum over an interval of t, and its derivative.
Interval value_over(const Intervals& coefficients, const Interval& t);
Interval slope_over(const Intervals& coefficients, const Interval& t);

}  // namespace achilles
