// Parts of the configuration plane: its heading with the menu, and the signs that are drawn over its plot.
#pragma once

#include "figure/axes.hpp"
#include "panels/panels.hpp"

namespace achilles {

// The line above the axes: what they are, to be pressed for a menu, and what shade and contours mean.
void show_plane_heading(const Session& session, const Rectangle& row, PanelState& state, Commands& commands);

// The present pictures of the plane: how contours and surfaces are named where their lines have room, no name over the
// run, another name or one of these places, and the impacts as arrows that go around the surface.
void name_plane_lines(const Session& session, const Panel& panel, const PanelMap& map, const Rectangle& plot,
                      const PlaneView& plane, const std::vector<Point>& places);
void paint_impacts(const Session& session, const PanelMap& map, const PlaneView& plane);

}  // namespace achilles
