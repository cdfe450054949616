// One value under the hand: dragged, typed after a double click, put back by a right click. A drag takes the roundest number
// that lies within a pixel of the hand; with Shift within a twentieth of one, and goes so much slower.
#pragma once

#include <optional>
#include <string>

#include "panels/panels.hpp"

namespace achilles {

struct Slider {
    std::string label, id, unit, about;
    double value = 0.0, low = 0.0, high = 1.0;  // in the file's units
    double original = 0.0;                      // as the file has it
    double factor = 1.0;                        // to the unit that is shown: 180/pi for an angle
    int digits = 4;                             // that are shown of it, and two more
    std::string varies{};                       // its name along an axis of the sweep; empty: it cannot be there
    // Under it, -1 to 1: what it does to a quantity, beside all others; nothing: nobody asks, or there is no derivative.
    std::optional<float> bar{};
    bool bar_is_old = false;  // it is of the run before
    std::string bar_about{};
};

// The number between two that is written with the fewest digits: 0, else a multiple of the largest 1, 2 or 5 times a power of
// ten, of several the one nearest to the middle.
double roundest(double low, double high);

// Widths of a row's columns at scale 1: what it is, its value. The slider has the rest.
constexpr float row_name_width = 78.0F, value_width = 84.0F;

// The number that is typed where this factor shows what is in the file's unit: one with neither unit nor pi is as it is shown,
// 30 for 30 degrees. Throws ParseError.
double typed_number(const std::string& text, const std::string& unit, double factor);

// The sign beside the name of a row whose value is not the file's.
void mark_changed();
// Shows a row; true where the hand has changed the value, which then is in `value`.
bool moved(Slider& slider, PanelState& state);

}  // namespace achilles
