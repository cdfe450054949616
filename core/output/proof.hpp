// A whole run as a theorem, written: for programs, and for a person.
#pragma once

#include <string>
#include <string_view>

#include "enclose/enclosure.hpp"

namespace achilles {

std::string_view to_text(Enclosure::Outcome::Kind kind);
// Every interval is [lo, hi], both in the shortest form that reads back the same double; no wall clock.
std::string to_json(const Model& model, const Claim& claim, const Enclosure& proof);
// Numbers with how far the truth is from them at most, rounded up.
std::string proof_text(const Model& model, const Claim& claim, const Enclosure& proof);

}  // namespace achilles
