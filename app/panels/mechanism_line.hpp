// The line below the picture of the mechanism: scale bar, layers, camera.
#pragma once

#include <vector>

#include "panels/panels.hpp"

namespace achilles {

constexpr float between_switches = 14.0F;  // pixels at scale 1

float switches_height();
// Shows the menu of cameras with its right end at `right` and returns its left end. A fixed camera keeps the current
// view, `seen`. The menu has the layers that have no room beside it.
float show_camera_menu(const Session& session, const Drawing& seen, float right, float y,
                       const std::vector<const char*>& layers, PanelState& state, Commands& commands);
// At the left end of the line, up to `right`.
void show_scale_bar(const Session& session, const Rectangle& line, double unit, float right, PanelState& state);
// Whether these toggles fit between the scale bar and `right`.
bool have_room(const std::vector<const char*>& layers, const Rectangle& line, float right);
// Toggles for layers. Returns their left end.
float show_switches(const Session& session, const std::vector<const char*>& layers, float right, float y,
                    PanelState& state, Commands& commands);

}  // namespace achilles
