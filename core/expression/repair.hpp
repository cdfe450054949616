// What was probably meant by an expression in the notation of another language: LaTeX, Python, Matlab, Modelica, paper.
#pragma once

#include <string>
#include <string_view>

#include "expression/parse.hpp"

namespace achilles {

// The text in the language of system files: 0.5*x^2 for 0.5x², sin(x)^2 for sin²x, x' for \dot{x}, xdot or der(x), x^2 for
// pow(x, 2), y - sin(x) for y >= sin(x). Names are those of the scope. What is not recognized stays as it is, so the
// result need not be an expression: parse() suggests it where it is one.
std::string repaired(std::string_view text, const Scope& scope);

}  // namespace achilles
