// The icon of the program: a ball that bounces and comes to rest, from a run of the gallery.
#pragma once

#include <vector>

#include "figure/figure.hpp"

namespace achilles {

// Sizes of the PNG files in assets/icons, in pixels: those of the freedesktop icon theme.
inline constexpr int icon_sizes[] = {16, 24, 32, 48, 64, 128, 256, 512};

// The icon for a size in pixels: small ones have thicker strokes.
Drawing icon(int pixels);

}  // namespace achilles
