// The crossing of a surface g(z) = 0 by all members of a set, each at its own time (theory-enclosure.md 4).
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "enclose/doubleton.hpp"
#include "enclose/step.hpp"

namespace achilles {

struct CrossingSurface {
    // g over a box that contains the set at one time; and its derivatives by all coordinates, over a box that also
    // contains the crossings.
    std::function<Interval(const Intervals&)> value;
    std::function<Intervals(const Intervals&)> slope;
    // A coordinate that has exactly this value for every member on the surface; its derivative by time is that of g.
    std::optional<std::pair<std::size_t, double>> exact;
    bool rises = false;  // g increases along the motion; otherwise it decreases

    static CrossingSurface of_gap(const Coordinates& coordinates, std::size_t contact);
    static CrossingSurface of_time(const Coordinates& coordinates, double time);
};

// Maps the set to the surface. Every member must be known to cross it in tau, which is narrowed. Throws ProofStopped if
// the crossing is not transversal.
void cross(Doubleton& set, const EnclosureStep& step, const CrossingSurface& section, Interval& tau);

// ---- first zero of a positive quantity, proved for every member of a set (theory-enclosure.md 3) ----

// The quantity lies in sum_k c_k t^k for every t in [0, length], where the last coefficient is that of the remainder.
// Its derivative lies in the derivative of the sum (by the lemma there).
struct FirstRoot {
    enum class Kind {
        none,      // positive on [0, length]
        one,       // each member has exactly one zero, in `at`, with negative derivative, and is positive before
        undecided  // positive before at.lo(); unknown from there on
    };
    Kind kind = Kind::undecided;
    Interval at;
};
FirstRoot first_root(const Intervals& coefficients, double length);

// The sum over an interval of t, and its derivative.
Interval value_over(const Intervals& coefficients, const Interval& t);
Interval slope_over(const Intervals& coefficients, const Interval& t);

}  // namespace achilles
