// What every execution of every system obeys. A law takes a trajectory and returns its violations, one sentence each:
// none for what simulate() makes, some for a trajectory that was falsified (lies_test.cpp).
#pragma once

#include <string>
#include <vector>

#include "run/trajectory.hpp"

namespace achilles::test {

using Violations = std::vector<std::string>;

// E - work + loss is constant over the whole run; an impact with impulses p loses sum p (1 - e) |hdot|/2, and in it
// moving surfaces do the work -sum p dh/dt.
Violations energy(const Trajectory& trajectory);
// Every gap >= -1e-12 max(1, |q|) everywhere.
Violations gap(const Trajectory& trajectory);
// Phases abut, and each ends where the set of held contacts changes (Def. 5, where there is one: hybrid, Zeno point,
// constrained, release, hybrid, ...); impacts are Moreau's, with one contact Newton's; Zeno points lie on h = hdot = 0
// where forces press, inside what their certificate says.
Violations phases(const Trajectory& trajectory);
// The force of every held contact presses inside constrained phases; a release is where it is 0 and h''' > 0.
Violations contact_force(const Trajectory& trajectory);

}  // namespace achilles::test
