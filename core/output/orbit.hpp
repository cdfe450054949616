// A periodic run and its branch, written: for programs, and for a person.
#pragma once

#include <string>

#include "study/orbit_question.hpp"

namespace achilles {

// Numbers in the shortest form that reads back the same double; no wall clock. Without a branch its member is null.
std::string to_json(const Orbit& orbit, const Branch* branch = nullptr);
std::string orbit_text(const Orbit& orbit, const Branch* branch = nullptr);
// The default output: period and stability first, then multipliers, one period, the start, and what the branch meets.
std::string orbit_answer(const Orbit& orbit, const Branch* branch = nullptr);
// Parts of it: "1 (along the motion), -0.7, 0, 0 (the last 2 exactly)", with so many digits; how stable it is, in a sentence; its
// margins.
std::string multipliers_text(const OrbitPoint& point, int digits);
std::string stability_text(const OrbitPoint& point);
std::string margins_text(const OrbitPoint& point);
// What a run may begin from, in what to_json() wrote of an orbit, or of a trajectory: there its end. Throws InputError.
OrbitGuess orbit_guess(const std::string& json, const std::string& file, std::size_t dof);

}  // namespace achilles
