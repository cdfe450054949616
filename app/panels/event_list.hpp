// The event list: its rows and its columns.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "output/contacts.hpp"
#include "panels/panels.hpp"
#include "run/trajectory.hpp"

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
    EventRows(const Session& session, const PanelState& state) {
        const Trajectory& trajectory = session.trajectory();
        const std::vector<std::size_t> all_turns = turns(trajectory, true);
        folds_ = !state.show_impacts && !all_turns.empty();  // a run with only impacts is not folded
        std::size_t next = 0;
        const std::vector<ChatterPhases> chatters = chatters_of(trajectory);
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
    void add_impacts(const Session& session, const PanelState& state, std::size_t first, std::size_t count) {
        if (count == 0) return;
        const auto chosen = static_cast<std::size_t>(std::max(session.selected() - 1, 0));
        const bool has_chosen = session.selected() > 0 && chosen >= first && chosen < first + count;
        add({first, count, count > 1 && folds_, has_chosen || state.unfolded.contains(first), 0});
    }

    std::vector<ListPart> parts_;
    std::size_t count_ = 0;
    bool folds_ = true;
};

// Columns of the event list: a marker, a number, the time, a sentence, and right-aligned numbers.

// Positions at scale 1 from the left edge of the list. Markers and words are left-aligned, numbers right-aligned.
// Number columns are dropped before the sentence becomes too narrow.
constexpr float sign_at = 14.0F, number_at = 62.0F, time_at = 164.0F, words_at = 180.0F, words_width = 600.0F,
                state_width = 112.0F;

// A column of the state after an event: one coordinate or its rate.
struct StateColumn {
    std::string name, title;
    Eigen::Index coordinate = 0;
    bool is_rate = false;
    double factor = 1.0;
    double of(const Event& event) const { return (is_rate ? event.v_after : event.q)[coordinate] * factor; }
    double size(const State& scale) const { return (is_rate ? scale.v : scale.q)[coordinate] * factor; }
    double error(const State& errors) const { return (is_rate ? errors.v : errors.q)[coordinate] * factor; }
};

std::vector<StateColumn> state_columns(const Session& session);

// A number or a column title that ends at x; a long title is shortened.
void number_cell(ImVec2 at, float x, const std::string& text, const Color& color);
// The same with aligned decimal points, in a column of numbers with at most this many decimals.
void decimal_cell(ImVec2 at, float x, const std::string& text, int decimals, const Color& color);

// The columns at the right end of the list: the energy loss, the held contacts if there are several contacts, and as
// many coordinates and rates as fit. Beside a card the list has only the time column.
class EventColumns {
 public:
    EventColumns(const Session& session, float width, bool is_alone);
    float words() const;  // width of the sentence, pixels
    void put_words(ImVec2 at, const std::string& text, const Color& color) const;
    void titles(const Session& session, ImVec2 at) const;
    // Writes the numbers of an event. For consecutive impacts `event` is null, and only their energy loss is written.
    void row(const Session& session, const Event* event, double lost, ImVec2 at, const Color& color) const;

 private:
    bool is_held(std::size_t i) const { return is_of_several_ && i == 1; }
    const StateColumn& state(std::size_t i) const { return states_[i - (is_of_several_ ? 2 : 1)]; }
    static constexpr int loss_decimals = 4, state_decimals = 5;
    void put(ImVec2 at, std::size_t i, const std::string& text, const Color& color, int decimals = 0) const;

    std::vector<StateColumn> states_;
    float width_;
    bool is_of_several_;
    std::size_t shown_ = 0;
};

}  // namespace achilles
