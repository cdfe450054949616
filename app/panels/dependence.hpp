// What the panel of a quantity's derivatives and the sliders share.
#pragma once

#include "panels/panels.hpp"
#include "panels/slider.hpp"

namespace achilles {

// Under the slider of a parameter or a start, whose name it varies by, what that does to the quantity that is asked about.
void put_bar(const Session& session, Slider& slider);
// "15.88 s per m": the derivative by one of its influences, angles in degrees. "none" where there is none.
std::string derivative_text(const SystemDescription& system, const Influences& known, const Influences::Of& by);
// The sweep over that slider which asks for the quantity.
command::ShowSweep sweep_over(const Session& session, const std::string& name, const std::string& quantity);

}  // namespace achilles
