// Keyboard focus. Exactly one part of the surface receives the keys. A menu or dialog in front receives all of them.
// Otherwise the player has them: Space, arrows, Home and End move the time. Tab moves the focus to a control, marked by
// a ring, and then to the next one. Arrows go to the nearest control in their direction, or move a slider; Enter and
// Space press. Escape and the mouse return the keys to the player.
#pragma once

#include <string>
#include <vector>

#include "figure/layout.hpp"

namespace achilles {

// A control of this frame that can have the focus.
struct FocusTarget {
    std::string name;
    Rectangle area;
    unsigned id = 0, window = 0;  // ImGui ids; `window` is the outermost window
};

struct Focus {
    std::string at;                  // the focused control; empty: the player has the keys
    std::vector<FocusTarget> stops;  // in the order of display
    bool is_owned = false;           // the focused control handles this frame's keys itself
    bool scrolls = false;            // scroll until it is visible
    unsigned front = 0;  // front_popup() at the end of the last frame: it receives the keys pressed in this frame
};

// Index of the control that an arrow key leads to from `from` in the same window; -1: none. Of `dx` and `dy` one is 1
// or -1.
int neighbor(const std::vector<FocusTarget>& stops, const FocusTarget& from, int dx, int dy);

}  // namespace achilles
