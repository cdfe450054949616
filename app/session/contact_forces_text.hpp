// The forces of the contacts that are held now, and of the joints with friction, in words.
#pragma once

#include <optional>
#include <string>

#include "run/trajectory.hpp"

namespace achilles {

class Session;

// The friction force of a contact or joint in a mode, and its largest value: mu lambda, or the level. Static while it
// sticks.
struct FrictionShare {
    double force = 0.0, limit = 0.0;
};
FrictionShare friction_share(const Trajectory& run, std::size_t which, Mode mode, const State& state);

// A line for each force, such as "normal force of floor: 9.81 N"; empty in flight. `only`: of this contact or joint.
std::string contact_forces_text(const Session& session, const std::optional<std::size_t>& only = {});

}  // namespace achilles
