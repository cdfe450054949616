// What is laid into a plot area besides curves: the markers of events, and what fills it: hatching, rasters of cells, points by
// the million.
#pragma once

#include "figure/axes.hpp"

namespace achilles {

// The markers of events never hide the curves: where there are many they are thinned and lose their edges, and of very many a
// band of small dots shows where they are.

Mark mark_of(const Markers& markers, const Point& pixel, const Metrics& metrics);

// Markers of any shape but bars.
void lay_markers(const Markers& markers, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& metrics);

void lay_hatch(const Hatch& hatch, Sheet& sheet, Rectangle plot, const Metrics& metrics);
// Its sign in a legend.
void lay_hatched_field(const Hatch& hatch, Sheet& sheet, Rectangle field, const Metrics& metrics);
// Whether there is nothing else in a panel: then its middle says why, and no legend.
bool is_bare(const Panel& panel);
void lay_word(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& m);
void lay_raster(const Raster& raster, Sheet& sheet, Rectangle plot, const PanelMap& map);
// As cells of about a point of the layout.
void lay_dots(const Dots& dots, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& metrics);

}  // namespace achilles
