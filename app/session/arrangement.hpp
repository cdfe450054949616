// Layout of the explorer: a rectangle for every part of the surface, without overlap.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figure/layout.hpp"
#include "session/scene.hpp"

namespace achilles {

struct Arrangement {
    // A rectangle of size 0: not shown.
    Rectangle bar, controls, error, caption, mechanism, results, energy, timeline, plots, sweep, events, status;
    Rectangle title, sliders;  // of a lecture
    // In a window too small for all panels: their tabs, and the panel in front.
    Rectangle tabs;
    std::string front;
    bool is_alone = false;  // no panel has room beside the mechanism, which then has a tab, too
    // The gap beside a panel, which can be dragged to resize it.
    struct Splitter {
        std::string panel;  // as in command::Size
        Rectangle area;
        bool moves_sideways = true;
        // The panel's share of the surface when the middle of the gap is at this pixel.
        double share_at(double x, double y) const {
            return moves_sideways ? (x - origin) / extent : (y - origin) / extent;
        }
        double origin = 0.0, extent = 1.0;  // extent < 0: the panel is on the right or lower side of the gap
    };
    std::vector<Splitter> splitters;
};

// Sizes that depend on the text, in pixels.
struct Measures {
    float width = 0.0F, height = 0.0F;  // the surface
    float unit = 1.0F;                  // one pixel at scale 1
    float bar = 30.0F, status = 30.0F, timeline = 90.0F;
    float tabs = 30.0F;                      // height of the row of tabs in a small window
    float title = 0.0F, sliders = 0.0F;      // of a lecture; 0: not shown
    float energy = 0.0F, min_energy = 0.0F;  // with and without its time plot; 0: not shown
    // Heights, for a given width, of the error message, the tour caption, the results, and the numbers over the
    // mechanism; 0: not shown.
    std::function<float(float width)> error, caption, results, state;
};

// Panels keep a readable width as long as the surface is large enough.
Arrangement arrange(const Scene& scene, const Measures& measures);

}  // namespace achilles
