// The meaning of an event, by which it is found again in another run of the system: "the second Zeno point", "the third
// impact after the first release".
#pragma once

#include <cstddef>
#include <optional>

#include "run/trajectory.hpp"

namespace achilles {

struct EventMeaning {
    Event::Kind kind = Event::Kind::impact;
    ContactSet contacts;
    std::size_t turns = 0;    // for an impact: number of other events before it
    std::size_t ordinal = 0;  // among the events of this kind and these contacts (impacts: since the last other event)
};

EventMeaning meaning_of(const Trajectory& run, std::size_t event);
// The index of the event with this meaning; empty if the run has none.
std::optional<std::size_t> find_event(const Trajectory& run, const EventMeaning& meaning);

}  // namespace achilles
