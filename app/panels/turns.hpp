// The events of a run at which what is held changes. A run may have a hundred thousand impacts, and a frame has no time to
// look at each: phases begin and end where these events are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "run/trajectory.hpp"

namespace achilles {

// The indices of Zeno points and releases, in order; with openings, of impacts that open a contact, too.
inline std::vector<std::size_t> turns(const Trajectory& trajectory, bool with_openings = false) {
    std::vector<std::size_t> result;
    const auto& events = trajectory.events;
    for (const Phase& phase : trajectory.phases) {
        auto event = std::lower_bound(events.begin(), events.end(), phase.start,
                                      [](const Event& e, double t) { return e.t < t; });
        for (; event != events.end() && event->t == phase.start; ++event) {
            const auto index = static_cast<std::size_t>(event - events.begin());
            const bool turns_here = event->kind != Event::Kind::impact || (with_openings && !event->opened.empty());
            if (turns_here && (result.empty() || result.back() < index)) result.push_back(index);
        }
    }
    return result;
}

}  // namespace achilles
