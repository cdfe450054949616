// The crossing of a surface g(z) = 0 by all members of a set, each at its own time (theory-enclosure.md 4).
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "enclose/doubleton.hpp"
#include "enclose/step.hpp"

namespace achilles {

struct Section {
    // g over a box that contains T at one instant, its derivatives by all coordinates over one that contains the crossings
    // too.
    std::function<Interval(const Intervals&)> value;
    std::function<Intervals(const Intervals&)> slope;
    // A coordinate that every member has exactly this value of on the surface; its rate is that of g.
    std::optional<std::pair<std::size_t, double>> exact;
    bool rises = false;  // g along the motion; else it falls

    static Section of_gap(const Coordinates& coordinates, std::size_t contact);
    static Section of_time(const Coordinates& coordinates, double time);
};

// Takes the set to the surface, which every member is known to cross in tau, and narrows tau. Throws Undecided where the
// crossing is not transversal.
void cross(Doubleton& set, const Step& step, const Section& section, Interval& tau);

// Where a quantity that is positive first becomes zero, proved for every member of a set at once (theory-enclosure.md 3).

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
