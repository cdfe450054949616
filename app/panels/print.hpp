// How plots and words look on the screen, wherever they stand.
#pragma once

#include <string>

#include "figure/figure.hpp"
#include "figure/palette.hpp"

namespace achilles {

constexpr double screen_text_size = 13.0;  // of a plot, at scale 1

// Colours and text of a panel: the rest of the figure is not drawn.
Figure screen_style(const Theme& theme);
// Words broken to a width, pixels.
void paragraph(const std::string& text, float width, const Color& color);

}  // namespace achilles
