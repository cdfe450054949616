// A periodic run and its branch, written: for programs, and for a person.
#pragma once

#include <string>

#include "study/branch.hpp"

namespace achilles {

// Numbers in the shortest form that reads back the same double; no wall clock. Without a branch its member is null.
std::string to_json(const Orbit& orbit, const Branch* branch = nullptr);
std::string orbit_text(const Orbit& orbit, const Branch* branch = nullptr);
// What a run may begin from, in what to_json() wrote of an orbit, or of a trajectory: there its end. Throws InputError.
struct OrbitGuess {
    State state;
    std::optional<double> period;
};
OrbitGuess orbit_guess(const std::string& json, const std::string& file, std::size_t dof);

}  // namespace achilles
