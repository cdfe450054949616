// What `achilles check` says: a system and its derived equations, for a person, as text or as a LaTeX document.
#pragma once

#include <string>

#include "check/finite_differences.hpp"
#include "expression/notation.hpp"
#include "model/model.hpp"

namespace achilles {

class Simplified;

// Simplifies, compares with differences of L, and writes. `deriving` is what it took to derive the model, in seconds:
// the only thing that differs from run to run. The largest disagreement goes to `disagreement`.
std::string check_report(const Model& model, const Run& run, double deriving, Notation notation, double& disagreement);

}  // namespace achilles
