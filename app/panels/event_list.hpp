// The columns of the event list.
#pragma once

#include <imgui.h>

#include <cstddef>
#include <string>
#include <vector>

#include "panels/panels.hpp"
#include "session/event_rows.hpp"

namespace achilles {

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
