// What an explorer is made from, in a window or in a picture.
#pragma once

#include <vector>

#include "cli/explore.hpp"
#include "panels/panels.hpp"
#include "surface/frame.hpp"

namespace achilles {

inline constexpr double largest_scale = 20.0;  // that a surface takes

// What leads from the file alone to the session just opened: with it in front, a recorded journal needs no command
// line.
std::vector<Command> opening(const Session& session, const ExploreOptions& options);
SurfaceOptions surface_options(const ExploreOptions& options);
PanelState panel_state(bool in_window);

}  // namespace achilles
