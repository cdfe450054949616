// What stands where in the explorer: every part of the surface has its rectangle, none covers another.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figure/layout.hpp"
#include "session/scene.hpp"

namespace achilles {

struct Arrangement {
    Rectangle bar, controls, error, caption, mechanism, results, energy, timeline, plots, sweep, events,
        status;  // of no size: not shown
    // What a hand drags to resize a panel: the gap beside it.
    struct Splitter {
        std::string panel;  // as in command::Size
        Rectangle area;
        bool moves_sideways = true;
        // The panel's share of the surface when the middle of the gap is at this pixel.
        double share_at(double x, double y) const {
            return moves_sideways ? (x - origin) / extent : (y - origin) / extent;
        }
        double origin = 0.0, extent = 1.0;  // extent < 0: the panel is on the other side
    };
    std::vector<Splitter> splitters;
};

// The sizes that the text decides, in pixels.
struct Measures {
    float width = 0.0F, height = 0.0F;  // of the surface
    float unit = 1.0F;                  // a pixel at scale 1
    float bar = 30.0F, status = 30.0F, timeline = 90.0F;
    float energy = 0.0F, least_energy = 0.0F;  // with its course and without; 0: it is not shown
    // How high a message, what a tour says, the results, and the numbers over the picture are in so much width; 0: there
    // are none.
    std::function<float(float width)> error, caption, results, state;
};

// Panels keep a width that can be read as long as the surface has room for it.
Arrangement arrange(const Scene& scene, const Measures& measures);

}  // namespace achilles
