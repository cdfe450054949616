// The owner of the keys: exactly one at a time. A menu or a dialog in front has all of them. Without one the player has them at
// first: Space, the arrows, Home and End move the time. Tab gives them to a control, with a ring round it, and on to the next
// one; arrows go to the nearest in their direction, or move a slider; Enter and Space press. Escape and the mouse give them
// back to the player.
#pragma once

#include <string>
#include <vector>

#include "figure/layout.hpp"

namespace achilles {

// A control of this frame that can have the keys.
struct Stop {
    std::string name;
    Rectangle area;
    unsigned id = 0, window = 0;  // ImGui's; of the window that is not part of another
};

struct Focus {
    std::string at;           // the control that has the keys; empty: the player has them
    std::vector<Stop> stops;  // in the order in which they are shown
    bool is_owned = false;    // the control does with this frame's keys what it wants
    bool scrolls = false;     // until it is seen
    unsigned front = 0;       // front_popup() when the last frame ended: the keys of this frame were pressed for it
};

// The stop that an arrow key leads to from another, of those in its window; -1: none. `dx`, `dy`: one of them 1 or -1.
int neighbour(const std::vector<Stop>& stops, const Stop& from, int dx, int dy);

}  // namespace achilles
