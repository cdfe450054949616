// The forces of the contacts that are held now, in words.
#pragma once

#include <string>

namespace achilles {

class Session;

// A line for each force, such as "force of floor: 9.81 N"; empty in flight.
std::string contact_forces_text(const Session& session);

}  // namespace achilles
