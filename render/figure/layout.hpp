// From a figure to a sheet: where the axes, legends and labels of every panel stand. The only home of a figure's
// typography, for the window, PNG and SVG alike.
#pragma once

#include "figure/sheet.hpp"

namespace achilles {

// The whole figure in the area; scale multiplies text sizes and stroke widths.
Sheet layout(const Figure& figure, const Measure& width, Rectangle area, double scale);

// The plot area inside the axes of every panel, and the place that it could have filled.
struct PlotArea {
    Rectangle plot, place;
};
std::vector<PlotArea> plot_areas(const Figure& figure, const Measure& width, Rectangle area, double scale);

// One panel in the style of a figure, added to the sheet; returns the plot area inside the axes.
Rectangle layout(const Panel& panel, const Figure& style, const Measure& width, Rectangle area, double scale,
                 Sheet& sheet);

}  // namespace achilles
