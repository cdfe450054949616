// Content of a plot area besides curves: event markers, hatching, rasters of cells, and large point clouds.
#pragma once

#include "figure/axes.hpp"

namespace achilles {

// ---- event markers ----
// Markers must not hide the curves. Of markers closer than Markers::apart the largest is drawn, such as that of a Zeno
// point among impacts. Many markers lose their edges; very many become a band of small dots.

Mark mark_of(const Markers& markers, const Point& pixel, const Metrics& metrics);

// Adds markers of any shape except bars.
void lay_markers(const std::vector<const Markers*>& all, Sheet& sheet, Rectangle plot, const PanelMap& map,
                 const Metrics& metrics);

void lay_hatch(const Hatch& hatch, Sheet& sheet, Rectangle plot, const Metrics& metrics);
// The hatching symbol of a legend.
void lay_hatched_field(const Hatch& hatch, Sheet& sheet, Rectangle field, const Metrics& metrics);
// Whether a panel shows nothing but hatching. Its meaning is then written in the middle instead of a legend.
bool has_no_fill(const Panel& panel);
void layout_word(const Panel& panel, const Figure& style, Sheet& sheet, Rectangle plot, const Metrics& m);
void lay_raster(const Raster& raster, Sheet& sheet, Rectangle plot, const PanelMap& map);
// Draws dots as cells about one layout point wide.
void lay_dots(const Dots& dots, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& metrics);

}  // namespace achilles
