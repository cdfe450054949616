// The motion of a system while it holds a set of contacts, as programs.
#pragma once

#include "model/derive.hpp"
#include "program/terms.hpp"
#include "run/contact_set.hpp"
#include "series/series.hpp"

namespace achilles {

// Every contact has an event function along a motion: its gap where it is open, and where it is held the hddot of the
// motion that holds the others alone (the force, times -W).
struct Motion {
    ContactSet held;
    ProgramOf<MotionTerms> program;
    SeriesProgram series;  // MotionSeries
};

// Compiles a motion; `equations` has the graph of `motion`, or that it was copied from. Throws TooLarge.
Motion make_motion(const HeldEquations& motion, const Equations& equations, const Layout& layout);
// The series of a motion with hddot of every contact, open or held, for event functions: what proofs follow, in which the gap
// is a coordinate by itself (theory-enclosure.md 1).
SeriesProgram make_hddot_series(const HeldEquations& motion, const Equations& equations, const Layout& layout);

}  // namespace achilles
