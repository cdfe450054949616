// What the panels of a sweep and of a quantity's derivatives, their menus and the sliders share.
#pragma once

#include "panels/panels.hpp"
#include "panels/slider.hpp"
#include "study/sweep.hpp"

namespace achilles {

// The name of a slider that is dragged from its row onto an axis.
inline constexpr const char* dragged_name = "name";
// The command that shows this sweep of the present run.
command::ShowSweep showing(const Sweep& sweep, const SystemDescription& description);
// A value, a rate or an option that this name stands for along an axis, over the range of its slider; nothing where there is
// none.
std::optional<SweepAxis> axis_for(const Session& session, const std::string& name);
// What varies along x, what along y, and what is asked: a row of menus, up to `right`.
void show_sweep_menus(const Session& session, const Rectangle& row, PanelState& state, Commands& commands);

// Under the slider of a parameter or a start, whose name it varies by, what that does to the quantity that is asked about.
void put_bar(const Session& session, Slider& slider);
// "15.88 s per m": the derivative by one of its influences, angles in degrees. "none" where there is none.
std::string derivative_text(const SystemDescription& system, const Influences& known, const Influences::Of& by);
// The sweep over that slider which asks for the quantity.
command::ShowSweep sweep_over(const Session& session, const std::string& name, const std::string& quantity);

}  // namespace achilles
