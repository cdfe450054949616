// The cards of events in words, and the forces of the contacts that are held now.
#pragma once

#include <optional>
#include <string>

#include "figure/label.hpp"
#include "session/session.hpp"
#include "simulate/explain.hpp"

namespace achilles {

// "Impact of wall, event 7"; without the name if there is only one contact.
std::string event_title(const char* kind, const Session& session, const Event& event, std::size_t index);
// "t = 1.25 s", with the digits that are known.
std::string event_time_text(const Session& session, std::size_t event);
// Why the impact sequence is cut at this impact, or is not. `attempt`: the certificate that was tried; null: none.
std::string why_not_cut(const ImpactReason& reason, const Certificate* attempt, bool several, bool all_at_once,
                        const ShownUnit& acceleration);
// What is held before an impact of a system with several contacts, and what the impact opens.
std::string what_is_held(const Session& session, const Event& event, const ImpactReason& reason);

// ---- forces of contacts, and of joints with friction ----

// The friction force of a contact or joint in a mode, and its largest value: mu lambda, or the level. Static while it
// sticks.
struct FrictionShare {
    double force = 0.0, limit = 0.0;
};
FrictionShare friction_share(const Trajectory& run, std::size_t which, Mode mode, const State& state);

// A line for each force, such as "normal force of floor: 9.81 N"; empty in flight. `only`: of this contact or joint.
std::string contact_forces_text(const Session& session, const std::optional<std::size_t>& only = {});

}  // namespace achilles
