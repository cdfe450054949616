// Suggestions for expressions in another notation: LaTeX, Python, Matlab, Modelica, handwriting.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "expression/parse.hpp"

namespace achilles {

// Translates the text to the language of system files: 0.5*x^2 for 0.5x², sin(x)^2 for sin²x, x' for \dot{x}, xdot or
// der(x), x^2 for pow(x, 2), y - sin(x) for y >= sin(x). Names are those of the scope. Unrecognized parts are left
// unchanged, so the result may not be an expression; parse() suggests it only if it is one.
std::string repaired(std::string_view text, const Scope& scope);

// Hints for syntax borrowed from other languages. The functions below return a message suffix, or "" if they have no
// hint.
struct Habit {
    std::string_view written, instead;  // the foreign syntax, and a sentence of advice
    std::string_view right = {};        // its replacement, if there is a direct one
};
// The entry for a foreign sign at the start of `rest`; null if the table has none.
const Habit* sign_at(std::string_view rest);
// The hint for a foreign sign at the start of `rest`, such as "; write '*' for a product" for a dot.
std::string instead_of_sign(std::string_view rest);
// The hint for an unknown name, such as "; the gap is called gap" for h, if the name it refers to is known.
std::string instead_of_name(std::string_view name, const std::function<bool(std::string_view)>& is_known);
// For a function with corners or jumps, a sentence with a smooth approximation: "sqrt(x^2 + w^2) is nearly |x|, with a
// small w" for abs.
std::string_view instead_of_corner(std::string_view name);

}  // namespace achilles
