// A number as a person gives it, in a file, on the command line, in a journal or typed into a field: a constant
// expression, 0.3, pi/6, 1/3, 30 deg. All of them are read here.
#pragma once

#include <string_view>

#include "expression/parse.hpp"

namespace achilles {

struct GivenNumber {
    double value = 0.0;     // finite
    bool has_unit = false;  // it says that it is in degrees or radians: 30 deg, 30°, 0.5 rad
    bool has_pi = false;
};

// Lets deg, ° and rad follow a value in an expression whose unit is rad or rad/s, and where it is rad/s deg/s, °/s and rad/s.
void allow_units(Scope& scope, std::string_view unit, Graph& graph);
// Whether a text is an expression in names that stand for something else than a number, as "m*L^2/12".
bool has_names(std::string_view text);

// Reads the whole text. deg, ° (both pi/180) and rad (1) may follow a value where `unit`, that of the quantity, is rad; the same
// and deg/s, °/s and rad/s where it is rad/s.
// Throws ParseError, whose message begins with the text: "'0,4' is not a finite number: ...".
GivenNumber read_number(std::string_view text, std::string_view unit = {});

}  // namespace achilles
