// What the sweep's panel and its menus share.
#pragma once

#include "panels/panels.hpp"
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

}  // namespace achilles
