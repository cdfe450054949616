// Functions shared by the sweep panel, the sensitivity panel, their menus and the sliders.
#pragma once

#include "analysis/sweep.hpp"
#include "panels/panels.hpp"
#include "panels/slider.hpp"
#include "session/sweep_choices.hpp"

namespace achilles {

// Drag-and-drop payload type of a slider's name that is dropped onto an axis.
inline constexpr const char* dragged_name = "name";
// A row of menus, up to `right`: the quantities along x and y, and the printed quantity.
void show_sweep_menus(const Session& session, const Rectangle& row, PanelState& state, Commands& commands);

// Below the slider of a parameter or initial value: its effect on the selected quantity.
void put_bar(const Session& session, Slider& slider);
// "15.88 s per m": a derivative, with angles in degrees. "none" if it does not exist.
std::string derivative_text(const SystemDescription& system, const Sensitivities& known,
                            const Sensitivities::Sensitivity& by);
// The sweep over that slider with this quantity.
command::ShowSweep sweep_over(const Session& session, const std::string& name, const std::string& quantity);

}  // namespace achilles
