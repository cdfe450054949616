// Which lines the list of events has.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "output/contacts.hpp"
#include "panels/panels.hpp"
#include "panels/turns.hpp"

namespace achilles {

// The lines of the list: each event, but impacts one after the other as one line, until it is opened; so, too, where contacts
// come to rest and are opened again and again. A run may have a
// hundred thousand impacts: only what is seen is made.
class EventRows {
 public:
    struct Row {
        std::size_t event;      // the first, of impacts in one line
        std::size_t count = 0;  // of these impacts; 0: the line is an event
        bool is_open = false;   // they follow, line by line
    };
    EventRows(const Session& session, const PanelState& state) {
        const Trajectory& trajectory = session.trajectory();
        const std::vector<std::size_t> all_turns = turns(trajectory, true);
        folds_ = !state.show_impacts && !all_turns.empty();  // where there are only impacts each is seen
        std::size_t next = 0;
        const std::vector<Chatter> chatters = chatters_of(trajectory);
        auto chatter = chatters.begin();
        for (const std::size_t turn : all_turns) {
            if (folds_ && chatter != chatters.end() && turn >= chatter->first_event) {
                add_impacts(session, state, next, chatter->first_event - next);
                add_impacts(session, state, chatter->first_event, chatter->last_event - chatter->first_event);
                next = chatter++->last_event;
            }
            if (turn < next) continue;
            add_impacts(session, state, next, turn - next);
            add({turn, 1, false, false, 0});
            next = turn + 1;
        }
        add_impacts(session, state, next, trajectory.events.size() - next);
    }
    std::size_t size() const { return count_; }
    Row at(std::size_t index) const {
        const auto after = std::upper_bound(parts_.begin(), parts_.end(), index,
                                            [](std::size_t i, const Part& part) { return i < part.row; });
        const Part& part = *std::prev(after);
        const std::size_t within = index - part.row;
        if (part.is_folded && within == 0) return {part.first, part.count, part.is_open};
        return {part.first + within - (part.is_folded ? 1 : 0)};
    }
    // The line of this event, or that which it is folded into.
    std::size_t row_of(std::size_t event) const {
        const auto after = std::upper_bound(parts_.begin(), parts_.end(), event,
                                            [](std::size_t e, const Part& part) { return e < part.first; });
        if (after == parts_.begin()) return 0;
        const Part& part = *std::prev(after);
        if (part.is_folded && !part.is_open) return part.row;
        return part.row + (part.is_folded ? 1 : 0) + event - part.first;
    }

 private:
    struct Part {
        std::size_t first, count;
        bool is_folded, is_open;
        std::size_t row;
    };
    void add(Part part) {
        part.row = count_;
        count_ += (part.is_folded ? 1 : 0) + (part.is_folded && !part.is_open ? 0 : part.count);
        parts_.push_back(part);
    }
    void add_impacts(const Session& session, const PanelState& state, std::size_t first, std::size_t count) {
        if (count == 0) return;
        const auto chosen = static_cast<std::size_t>(std::max(session.selected() - 1, 0));
        const bool has_chosen = session.selected() > 0 && chosen >= first && chosen < first + count;
        add({first, count, count > 1 && folds_, has_chosen || state.unfolded.contains(first), 0});
    }

    std::vector<Part> parts_;
    std::size_t count_ = 0;
    bool folds_ = true;
};

}  // namespace achilles
