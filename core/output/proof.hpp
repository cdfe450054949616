// A whole run as a theorem, written: for programs, and for a person.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles {

std::string_view to_text(Enclosure::Outcome::Kind kind);
// Every interval is [lo, hi], both in the shortest form that reads back the same double; no wall clock.
std::string to_json(const Model& model, const Claim& claim, const Enclosure& proof);
// No more than to_json() claims: hypotheses as a person wrote them, or rounded inward; conclusions rounded outward, as numbers
// with how far the truth is from them at most.
std::string proof_text(const Model& model, const Claim& claim, const Enclosure& proof);
// The default output: the time reached, a row per change of the contact state, the hypotheses. The same rounding.
std::string proof_answer(const Model& model, const Claim& claim, const Enclosure& proof);

// The time until which all is proved, s: the end time, or another one rounded down to so many digits.
std::string reach_text(const Enclosure& proof, int digits = 6);

// Of every event of a run the enclosed one that it is among: Zeno points and releases one after the other, impacts as they
// follow these. Null where the proof has none; a run may cut a bouncing earlier than a proof does.
std::vector<const EnclosedEvent*> enclosed_events(const Trajectory& run, const Enclosure& proof);

}  // namespace achilles
