// Output of a proof of a whole run, as JSON and as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles {

std::string_view to_text(Enclosure::ProofOutcome::Kind kind);
// Every interval is [lo, hi], both in the shortest form that is read back as the same double. No wall-clock times.
std::string to_json(const Model& model, const EnclosureProblem& claim, const Enclosure& proof);
// The same claims as text: hypotheses as typed or rounded inward, conclusions as numbers with error bounds, rounded
// outward.
std::string proof_text(const Model& model, const EnclosureProblem& claim, const Enclosure& proof);
// The default output: the time reached, a row per change of the contact state, the hypotheses. The same rounding
// applies.
std::string proof_answer(const Model& model, const EnclosureProblem& claim, const Enclosure& proof);

// The time (s) until which everything is proved: the end time, or another time rounded down to this number of digits.
std::string reach_text(const Enclosure& proof, int digits = 6);

// For each event of a run, the enclosed event that contains it. Zeno points and releases are matched in order, impacts
// between them. Null if the proof has no such event: a run may truncate an impact sequence earlier than a proof.
std::vector<const EnclosedEvent*> enclosed_events(const Trajectory& run, const Enclosure& proof);

}  // namespace achilles
