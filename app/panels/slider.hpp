// Slider for one value: drag it, double-click to type, right-click to restore the file's value. A drag selects the
// roundest number within one pixel of the mouse. With Shift the mouse is 20 times less sensitive.
#pragma once

#include <optional>
#include <string>

#include "panels/panels.hpp"

namespace achilles {

struct Slider {
    std::string label, id, unit, about;
    double value = 0.0, low = 0.0, high = 1.0;  // in the file's units
    double original = 0.0;                      // value in the file
    double factor = 1.0;                        // from the file's unit to the displayed unit: 180/pi for an angle
    int digits = 4;                             // digits of a dragged value; two more are displayed
    std::string varies{};                       // its name as a sweep axis; empty: it cannot be one
    // Bar below the slider, -1 to 1: the sensitivity of a quantity, relative to the largest; empty: not shown or no
    // derivative.
    std::optional<float> bar{};
    bool bar_is_old = false;  // it belongs to an earlier run
    std::string bar_about{};
};

// The number in [low, high] with the fewest digits: 0 if possible, else a multiple of the largest possible 1, 2 or 5
// times a power of ten; of several, the one nearest the middle.
double roundest(double low, double high);

// Widths of a row's name and value columns at scale 1. The slider takes the rest.
constexpr float row_name_width = 78.0F, value_width = 84.0F;

// Parses a typed number and returns it in the file's unit. A number without unit or pi is in the displayed unit: 30
// means 30 degrees if `factor` is 180/pi. Throws ParseError.
double typed_number(const std::string& text, const std::string& unit, double factor);

// The marker beside a row whose value differs from the file's.
void mark_changed();
// Shows a row. Returns true if the user changed the value; `value` is then the new one.
bool moved(Slider& slider, PanelState& state);
// Puts the effect of a parameter or initial value on the selected quantity below its slider (dependence.cpp).
void put_bar(const Session& session, Slider& slider);

}  // namespace achilles
