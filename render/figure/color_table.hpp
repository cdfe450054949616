// Colours for numbers: equal steps of the number look equally far apart, and brighter is more, to people with any colour
// vision and in grey.
#pragma once

#include <vector>

#include "figure/figure.hpp"

namespace achilles {

// Of a share of the way from the least number to the greatest, clamped to [0, 1]. In OKLab (Ottosson 2020) the table is a
// screw line: the lightness rises evenly from 0.25 to 0.92 while the hue turns evenly at chroma 0.125 from blue through
// red to yellow,
//     L = 0.25 + 0.67 s,   a = 0.125 sin(190 deg s),   b = -0.125 cos(190 deg s),
// so that every step has the same length. To who lacks a kind of cone (simulated after Machado, Oliveira and Fernandes 2009)
// the lightness rises in every step, too, and the shortest step is 0.50 (protan), 0.68 (deutan) and 0.41 (tritan) of the
// longest.
Color number_color(double share);

// The table in so many steps.
std::vector<Color> number_colors(std::size_t count);

// From OKLab to sRGB, clamped.
Color oklab(double lightness, double a, double b);

}  // namespace achilles
