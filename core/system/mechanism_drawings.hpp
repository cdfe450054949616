// The drawings of a mechanism's bodies, springs, grounds and contacts, as [[drawing]] tables of the file.
#pragma once

#include <vector>

#include "system/contact_geometry.hpp"
#include "system/mechanism.hpp"

namespace achilles {

// Tables that the reader makes, with the location of their origin.
TomlValue made_string(std::string text, const Location& at);
TomlValue made_number(double number, const Location& at);
TomlValue made_boolean(bool boolean, const Location& at);
TomlValue made_list(const Location& at);  // empty
TomlValue made_point(const std::array<std::string, 2>& point, const Location& at);
TomlValue made_table(const Location& at);
TomlValue& set_entry(TomlValue& table, const std::string& key, TomlValue value);  // adds or replaces
TomlValue* find_entry(TomlValue& table, std::string_view key);

struct MechanismDrawings {
    std::vector<TomlValue> free;                      // [[drawing]]
    std::vector<std::vector<TomlValue>> of_contacts;  // [[constraint.drawing]], by contact
};

// `contacts` has an empty entry for a constraint with a typed gap.
MechanismDrawings draw_mechanism(const PlacedMechanism& mechanism,
                                 const std::vector<std::optional<ShapeContact>>& contacts);

// The coordinates in the world of a point of a frame, as text.
std::array<std::string, 2> world_point(const MechanismSymbols& symbols, const MovingPoint& point);

}  // namespace achilles
