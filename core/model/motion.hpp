// The motion of a system in one mode, as programs.
#pragma once

#include "model/derive.hpp"
#include "program/terms.hpp"
#include "run/mode.hpp"
#include "series/series.hpp"

namespace achilles {

// Every contact has an event function along a motion, for what its law watches (contacts/contact_law.hpp): its gap, or
// for its force the hddot of the mode in which it is open (the force, times -W).
struct Motion {
    Mode mode;
    ProgramOf<MotionTerms> program;
    SeriesProgram series;  // MotionSeries
};

// Compiles a motion; `equations` has the graph of `motion`, or that it was copied from. Throws TooLarge.
Motion make_motion(const ModeEquations& motion, const Equations& equations, const Layout& layout);
// The series of a motion with hddot of every contact, open or held, for event functions: what proofs follow, in which the gap
// is a coordinate by itself (theory-enclosure.md 1).
SeriesProgram make_hddot_series(const ModeEquations& motion, const Equations& equations, const Layout& layout);

}  // namespace achilles
