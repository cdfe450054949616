// How the mechanism's panel is looked at: where its camera stands, the menu of cameras, the scale bar.
#pragma once

#include "figure/stage.hpp"
#include "paint/mechanism.hpp"
#include "panels/widgets.hpp"

namespace achilles {

// The longest arrow of a run takes this share of the picture's smaller side.
constexpr double longest_arrow = 0.16;

// The height of the line at the bottom: the scale, what is drawn, the camera.
float switches_height();
// What can be seen of the world in this part of the surface, all of it: what the run needs ends above the line at the bottom.
Drawing seen_world(const Session& session, const Rectangle& area);
// The menu of cameras, its right end there. What is seen now is what a camera that is fixed goes on with. Returns its left end.
float show_camera_menu(const Session& session, const Drawing& seen, float right, float y, PanelState& state,
                       Commands& commands);
// In the lower left corner, as long as the line left of `right` has room for; above that where it has none.
void show_scale_bar(const Session& session, const Rectangle& area, double unit, float right, PanelState& state);
// A system in space from two sides, beside one another or one above the other. Pixels for a unit of the world.
bool shows_sides(const Session& session);
double show_sides(const Session& session, const Rectangle& area);

}  // namespace achilles
