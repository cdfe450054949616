// Random systems of a ball, or a ball and a mass beside it, among floors, walls and discs, and what scaling their gaps changes.
#pragma once

#include <cstdint>
#include <string>

#include "system/description.hpp"

namespace achilles::test {

// Wavy or flat floors, some of them shaken; walls, some of which move; discs; damping or none; restitutions of which a half are 0.
SystemDescription random_system(std::uint64_t seed);

// Runs a system as it is, and with all its gaps multiplied by a number. What of the courses differs: how they ended, an event, or
// its time by more than rounding makes of it along the way; "" where nothing does, "undecided" where the system as it is ends so.
std::string difference_by_scaling(const SystemDescription& system, double factor);

}  // namespace achilles::test
