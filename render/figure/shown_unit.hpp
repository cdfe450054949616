// Units as they are shown: angles in degrees, and whatever they are divided by.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "system/units.hpp"

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

// Of what a slider sets: of a start as above, of a parameter an angle alone; a drive's frequency is known in rad/s.
inline ShownUnit shown_unit_of_setting(const std::string& unit, bool is_start) {
    return is_start || unit == "rad" ? shown_unit(unit) : ShownUnit{typeset_unit(unit)};
}
inline ShownUnit shown_unit_of_setting(const SystemDescription& description, std::string_view name) {
    const bool is_start = std::none_of(description.parameters.begin(), description.parameters.end(),
                                       [&](const ParameterDescription& p) { return p.name == name; });
    return shown_unit_of_setting(std::string(unit_of(description, name)), is_start);
}

}  // namespace achilles
