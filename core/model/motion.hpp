// The motion of a system while it holds a set of contacts, as programs.
#pragma once

#include "model/derive.hpp"
#include "program/terms.hpp"
#include "run/contact_set.hpp"
#include "series/series.hpp"

namespace achilles {

// Every contact has an event function along a motion: its gap where it is open, hddot of the free motion where it is
// held (the force, times -W).
struct Motion {
    ContactSet held;
    ProgramOf<MotionTerms> program;
    SeriesProgram series;  // MotionSeries
};

// Compiles the motion that holds these contacts. Throws std::out_of_range for a contact that the system does not have.
Motion make_motion(ContactSet held, const Equations& equations, const Layout& layout);

}  // namespace achilles
