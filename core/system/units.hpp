// The unit of whatever a system file lets one write, from the units that it gives its coordinates and parameters.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "system/description.hpp"

namespace achilles {

// The unit of an expression of t, coordinates, rates, parameters, gap, gap', gap'', lambda and energy, as a file would
// write it: "m", "rad/s", "kg*m/s", "N" for a force and "J" for an energy, "N*m" for a contact force whose gap is an
// angle. "" where it has none, where a quantity in it has a unit that is not made of kg, m, s and rad (N, J, W, Hz and
// Pa are known), and where the terms of a sum do not agree; a plain number, or a function's value, agrees with any.
// An angle times a length is a length.
std::string unit_of_expression(const SystemDescription& description, std::string_view expression);

// The unit of a quotient: "s/m" of s over m; that above where nothing is said of what is below, and "" where the one above, or
// their quotient, is not known.
std::string unit_of_quotient(std::string_view above, std::string_view below);

// A number with a unit behind it, as people write what was measured: "9.81 m/s²" is {"9.81", "m/s^2"}. Nothing where a text is
// something else. Angles in degrees are no such thing: where they may stand read_number() takes them.
struct Measured {
    std::string number, unit;
};
std::optional<Measured> measured(std::string_view text);

// What to write in place of a number with a unit: `right`, the number alone, where `unit`, that of the quantity, is the typed
// one. Else the number must be converted first: 200 g is not 200 kg.
std::string without_unit(const Measured& typed, std::string_view name, std::string_view unit, const std::string& right);

}  // namespace achilles
