// What was probably meant by an expression in the notation of another language: LaTeX, Python, Matlab, Modelica, paper.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "expression/parse.hpp"

namespace achilles {

// The text in the language of system files: 0.5*x^2 for 0.5x², sin(x)^2 for sin²x, x' for \dot{x}, xdot or der(x), x^2 for
// pow(x, 2), y - sin(x) for y >= sin(x). Names are those of the scope. What is not recognized stays as it is, so the
// result need not be an expression: parse() suggests it where it is one.
std::string repaired(std::string_view text, const Scope& scope);

// What people write who know other languages, and what stands for it here. Endings of messages; "" where there is nothing to say.
struct Habit {
    std::string_view written, instead;  // what people write, and a sentence
    std::string_view right = {};        // what stands for it, where one sign does
};
// The sign at the start of the rest of a text, where it has no meaning here; null where it has one.
const Habit* sign_at(std::string_view rest);
// Of a sign that has no meaning here, at the start of the rest of a text: "; write '*' for a product" of a dot.
std::string instead_of_sign(std::string_view rest);
// Of a name that has none: "; the gap is called gap" of h, where that is known.
std::string instead_of_name(std::string_view name, const std::function<bool(std::string_view)>& is_known);
// Of a function that has corners or jumps: "sqrt(x^2 + w^2) is nearly |x|, with a small w" of abs. A sentence of its own.
std::string_view instead_of_corner(std::string_view name);

}  // namespace achilles
