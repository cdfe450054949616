// The markers of events in a plot. They never hide the curves: where there are many they are thinned and lose their edges, and
// of very many a band of small dots shows where they are.
#pragma once

#include "figure/axes.hpp"

namespace achilles {

Mark mark_of(const Markers& markers, const Point& pixel, const Metrics& metrics);

// Markers of any shape but bars.
void lay_markers(const Markers& markers, Sheet& sheet, Rectangle plot, const PanelMap& map, const Metrics& metrics);

}  // namespace achilles
