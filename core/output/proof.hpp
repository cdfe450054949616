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
// Numbers with how far the truth is from them at most, rounded up.
std::string proof_text(const Model& model, const Claim& claim, const Enclosure& proof);

// "2.7251421727(13)": the last digits of the number may be off by so many of them, and both ends are inside.
std::string short_text(const Interval& x);

// Of every event of a run the enclosed one that it is among: Zeno points and releases one after the other, impacts as they
// follow these. Null where the proof has none; a run may cut a bouncing earlier than a proof does.
std::vector<const EnclosedEvent*> enclosed_events(const Trajectory& run, const Enclosure& proof);

}  // namespace achilles
