// When each contact is held, under what is plotted over time.
#pragma once

#include "figure/palette.hpp"

namespace achilles {

// A bar for each contact of a run until a time: filled in the colour of constrained phases while it is held, ticked at
// its impacts. What is nearer together than can be seen on this axis is one.
std::vector<TimeBar> contact_bars(const Trajectory& trajectory, double end, const Axis& time, const Theme& theme);

}  // namespace achilles
