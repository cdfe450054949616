// The rows of the event list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include "output/contacts.hpp"
#include "session/session.hpp"

namespace achilles {

// The events at which the set of held contacts changes. A run may have 100,000 impacts, too many to examine in each
// frame; these events are found at the starts and ends of phases.

// Indices of Zeno points and releases, in order; with_openings: also of impacts that open a contact.
inline std::vector<std::size_t> turns(const Trajectory& trajectory, bool with_openings = false) {
    std::vector<std::size_t> result;
    const auto& events = trajectory.events;
    for (const Phase& phase : trajectory.phases) {
        auto event = std::lower_bound(events.begin(), events.end(), phase.start,
                                      [](const Event& e, double t) { return e.t < t; });
        for (; event != events.end() && event->t == phase.start; ++event) {
            const auto index = static_cast<std::size_t>(event - events.begin());
            const bool turns_here = with_openings ? event->changes_held() : !event->is_impact();
            if (turns_here && (result.empty() || result.back() < index)) result.push_back(index);
        }
    }
    return result;
}

// Rows of the event list.

// The rows: one per event, but consecutive impacts are folded into one row until it is unfolded, and so are sequences
// in which contacts repeatedly come to rest and are opened. A run may have 100,000 impacts, so rows are computed on
// demand.
class EventRows {
 public:
    struct EventRow {
        std::size_t event;      // index of the event, or of the first folded impact
        std::size_t count = 0;  // number of folded impacts; 0: the row is a single event
        bool is_open = false;   // the folded impacts follow, one per row
    };
    // `shows_impacts`: nothing is folded. `unfolded`: the first events of the rows that were unfolded.
    EventRows(const Session& session, bool shows_impacts, const std::set<std::size_t>& unfolded) {
        const Trajectory& trajectory = session.trajectory();
        const std::vector<std::size_t> all_turns = turns(trajectory, true);
        folds_ = !shows_impacts && !all_turns.empty();  // a run with only impacts is not folded
        std::size_t next = 0;
        const std::vector<ChatterPhases> chatters = chatters_of(trajectory);
        auto chatter = chatters.begin();
        for (const std::size_t turn : all_turns) {
            if (folds_ && chatter != chatters.end() && turn >= chatter->first_event) {
                add_impacts(session, unfolded, next, chatter->first_event - next);
                add_impacts(session, unfolded, chatter->first_event, chatter->last_event - chatter->first_event);
                next = chatter++->last_event;
            }
            if (turn < next) continue;
            add_impacts(session, unfolded, next, turn - next);
            add({turn, 1, false, false, 0});
            next = turn + 1;
        }
        add_impacts(session, unfolded, next, trajectory.events.size() - next);
    }
    std::size_t size() const { return count_; }
    EventRow at(std::size_t index) const {
        const auto after = std::upper_bound(parts_.begin(), parts_.end(), index,
                                            [](std::size_t i, const ListPart& part) { return i < part.row; });
        const ListPart& part = *std::prev(after);
        const std::size_t within = index - part.row;
        if (part.is_folded && within == 0) return {part.first, part.count, part.is_open};
        return {part.first + within - (part.is_folded ? 1 : 0)};
    }
    // The row of this event, or the row into which it is folded.
    std::size_t row_of(std::size_t event) const {
        const auto after = std::upper_bound(parts_.begin(), parts_.end(), event,
                                            [](std::size_t e, const ListPart& part) { return e < part.first; });
        if (after == parts_.begin()) return 0;
        const ListPart& part = *std::prev(after);
        if (part.is_folded && !part.is_open) return part.row;
        return part.row + (part.is_folded ? 1 : 0) + event - part.first;
    }

 private:
    struct ListPart {
        std::size_t first, count;
        bool is_folded, is_open;
        std::size_t row;
    };
    void add(ListPart part) {
        part.row = count_;
        count_ += (part.is_folded ? 1 : 0) + (part.is_folded && !part.is_open ? 0 : part.count);
        parts_.push_back(part);
    }
    void add_impacts(const Session& session, const std::set<std::size_t>& unfolded, std::size_t first,
                     std::size_t count) {
        if (count == 0) return;
        const auto chosen = static_cast<std::size_t>(std::max(session.selected() - 1, 0));
        const bool has_chosen = session.selected() > 0 && chosen >= first && chosen < first + count;
        add({first, count, count > 1 && folds_, has_chosen || unfolded.contains(first), 0});
    }

    std::vector<ListPart> parts_;
    std::size_t count_ = 0;
    bool folds_ = true;
};

}  // namespace achilles
