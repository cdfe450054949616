// Why no motion follows a state: what stops being defined just ahead of it.
#pragma once

#include <string>

#include "model/model.hpp"

namespace achilles {

// The first part of the system that cannot be shown to be defined along the straight line that the state moves on, for
// the shortest of a few times up to 1e-9 max(1e-3, |t|): a function outside its domain, a division by zero (both named
// as they stand in T, V, h or the equations of motion), a function at an edge where it is not smooth (sqrt(x^2) where
// x = 0), or a mass matrix that is not positive definite. Interval evaluation over the box of that line: a pole between
// two floating-point numbers is not missed. A sentence without a full stop; empty if there is none.
std::string edge_of_domain(const Model& model, const Run& run, const State& state);

// The same at the state itself, to within rounding, for a contact. Empty where it is dh that vanishes.
std::string edge_of_contact(const Model& model, const Run& run, const State& state);

}  // namespace achilles
