// Units as they are shown: angles in degrees, and whatever they are divided by.
#pragma once

#include <string>

#include "figure/label.hpp"
#include "number/angle.hpp"

namespace achilles {

struct ShownUnit {
    std::string text;     // typeset
    double factor = 1.0;  // of a number in the file's unit
};

inline ShownUnit shown_unit(std::string unit) {
    const bool is_angle = unit == "rad" || unit.starts_with("rad/");
    if (is_angle) unit.replace(0, 3, "\u00B0");
    return {typeset_unit(unit), is_angle ? degrees(1.0) : 1.0};
}

}  // namespace achilles
