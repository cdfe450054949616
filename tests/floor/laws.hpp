// Laws that every execution of every system obeys. A law takes a trajectory and returns its violations, one sentence
// each. There must be none for a result of simulate(), and some for a falsified trajectory (lies_test.cpp).
#pragma once

#include <string>
#include <vector>

#include "run/trajectory.hpp"

namespace achilles::test {

using Violations = std::vector<std::string>;

// E - work + loss + heat is constant over the whole run. In an impact with impulses p the loss is sum p (1 - e) |hdot|/2,
// and moving constraints do the work -sum p dh/dt.
Violations energy(const Trajectory& trajectory);
// Every gap is >= -1e-12 max(1, |q|) at all times.
Violations gap(const Trajectory& trajectory);
// Phases are contiguous, and each ends where the set of held contacts changes. With one contact the order is that of
// Def. 5: hybrid, Zeno point, constrained, release, hybrid, ... Impacts obey Moreau's law, with one contact Newton's.
// At Zeno points h = hdot = 0, forces are positive, and the values lie inside the bounds of the certificate.
Violations phases(const Trajectory& trajectory);
// The force of every held contact is positive inside constrained phases. At a release it is 0 and h''' > 0.
Violations contact_force(const Trajectory& trajectory);
// With friction: what sticks has the slip 0 and its friction force inside its cone; what slides has the sign of its
// mode; heat never falls but at impacts whose friction does work. Without friction there is nothing to violate.
Violations friction(const Trajectory& trajectory);
// contact_force() for systems with friction, where forces depend on the mode.
Violations rough_contact_force(const Trajectory& trajectory);

}  // namespace achilles::test
