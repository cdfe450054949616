// Text on a draw list: measured before it is placed, upright or turned, its dots over the right letter.
#pragma once

#include <string>

#include "paint/paint.hpp"
#include "surface/curves.hpp"

namespace achilles {

// The width paint_label will return.
float label_width(const std::string& label, float size);

// A figure's stroke in pixels.
ScreenStroke screen_stroke(const Stroke& stroke, double scale);

}  // namespace achilles
