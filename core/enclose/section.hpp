// The crossing of a surface g(z) = 0 by all members of a set, each at its own time (theory-enclosure.md 4).
#pragma once

#include <functional>
#include <optional>
#include <utility>

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

}  // namespace achilles
