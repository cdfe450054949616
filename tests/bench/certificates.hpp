// Measures the cost of a run's certificates by repeating every request of the run.
#pragma once

#include <memory>
#include <vector>

#include "certify/truncation.hpp"
#include "simulate/impact.hpp"
#include "simulate/simulate.hpp"

namespace achilles::bench {

// Every collision at which a run requested a certificate: all its impacts. The last before a Zeno point is the cut.
inline std::vector<Collision> collisions(const Trajectory& trajectory) {
    ContactKinematics surface(*trajectory.model, trajectory.run);
    std::vector<Collision> result;
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::impact) continue;
        const State before{event.q, event.v_before, event.t};
        const Contact contact = surface.at(before);
        const auto kind = trajectory.run.options.truncation.reinitialization;
        result.push_back({before, -contact.hdot, reinitialize(contact, before.v, Reinitialization::kinetic),
                          reinitialize(contact, before.v, kind)});
    }
    return result;
}

// Requests certificates as a run does.
inline void ask(TruncationConditions& conditions, const std::vector<Collision>& collisions) {
    for (const Collision& collision : collisions)
        if (!conditions.fails_at_point(collision)) conditions.certify(collision);
}

// Repeats the requests of the run, with newly built conditions. The data are in the cache, so the time is at most that
// of the certificates inside the run.
inline void ask_again(const Model& model, const Run& run, const std::vector<Collision>& asked) {
    ask(*truncation_conditions(model, run), asked);
}

}  // namespace achilles::bench
