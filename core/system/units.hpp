// Units of expressions, derived from the units of coordinates and parameters in a system file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "system/description.hpp"

namespace achilles {

// The unit of an expression in t, coordinates, rates, parameters, gap, gap', gap'', lambda and energy, in the notation
// of system files: "m", "rad/s", "kg*m/s", "N" for a force and "J" for an energy, "N*m" for a contact force whose gap
// is an angle. Numbers and function values agree with any unit. An angle times a length is a length. Returns "" if the
// expression has no unit, or if the terms of a sum disagree. Also returns "" if a unit in it is not a product of kg, m,
// s and rad (N, J, W, Hz and Pa are known).
std::string unit_of_expression(const SystemDescription& description, std::string_view expression);

// The unit of a quotient: "s/m" for s over m. If `below` is empty, it is `above`. Returns "" if `above` or the quotient
// is unknown.
std::string unit_of_quotient(std::string_view above, std::string_view below);

// A number with a unit: "9.81 m/s²" is {"9.81", "m/s^2"}. nullopt for any other text, and for angles in degrees, which
// read_number() accepts.
struct ValueWithUnit {
    std::string number, unit;
};
std::optional<ValueWithUnit> measured(std::string_view text);

// Advice for a number with a unit: `right`, the number alone, if the typed unit is that of the quantity, `unit`.
// Otherwise the number must be converted first: 200 g is not 200 kg.
std::string without_unit(const ValueWithUnit& typed, std::string_view name, std::string_view unit,
                         const std::string& right);

}  // namespace achilles
