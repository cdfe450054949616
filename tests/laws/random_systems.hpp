// Random systems of a ball, or a ball and a second mass, with floors, walls and discs; the effect of scaling their
// gaps.
#pragma once

#include <cstdint>
#include <string>

#include "system/description.hpp"

namespace achilles::test {

// A random system: flat or wavy floor, possibly shaken; wall, possibly moving; disc; damping or none. Half of the
// restitutions are 0.
SystemDescription random_system(std::uint64_t seed);

// Runs a system unchanged and with all gaps multiplied by `factor`, the slips of contacts by sign*factor and those of
// joints by `sign`, which is 1 or -1 (theory-friction.md 1). Returns the first difference of the two runs: the outcome,
// an event, its mode, or its time by more than 1e-7 s. "" if there is none; "undecided" if the unchanged run ends so.
std::string difference_by_scaling(const SystemDescription& system, double factor, int sign = 1);

}  // namespace achilles::test
