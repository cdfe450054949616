// The table of the event list.
#pragma once

#include <imgui.h>

#include <cstddef>
#include <string>
#include <vector>

#include "panels/panels.hpp"
#include "session/event_rows.hpp"

namespace achilles {

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

// The table of the event list, open while this exists: a marker, a number, the time, and a sentence; then the energy
// loss, the held contacts if there are several contacts, and as many coordinates and rates as the sentence leaves room
// for. A right click on a title hides columns. Beside a card (not `is_alone`) it ends with the sentence.
class EventTable {
 public:
    EventTable(const Session& session, const ImVec2& size, bool is_alone);
    ~EventTable();
    EventTable(const EventTable&) = delete;
    EventTable& operator=(const EventTable&) = delete;

    bool is_open() const { return is_open_; }  // false: nothing of it is seen, and it can have no rows
    // The menu that a right click on a title opens.
    void choose_columns(PanelState& state) const;
    // Begins a row; true if it is clicked.
    bool row(bool is_marked) const;
    Point sign() const;  // the middle of the first column
    void number(std::size_t number) const;
    void time(const std::string& digits, const Color& color) const;
    void words(const std::string& text, const Color& color) const;
    // The numbers at the right. For consecutive impacts `event` is null, and only their energy loss is written.
    void values(const Event* event, double lost, const Color& color) const;

 private:
    enum Column { sign_column, number_column, time_column, words_column, first_value };
    void title(int column, const std::string& text) const;
    // Right-aligned; with `decimals` their points are aligned.
    void put(int column, const std::string& text, const Color& color, int decimals = 0) const;
    bool is_held(std::size_t i) const { return is_of_several_ && i == 1; }
    static int column_of(std::size_t i) { return first_value + static_cast<int>(i); }
    const StateColumn& state_of(std::size_t i) const { return states_[i - (is_of_several_ ? 2 : 1)]; }

    const Session& session_;
    std::vector<StateColumn> states_;
    bool is_of_several_;
    std::size_t values_ = 0;  // columns after the sentence
    bool is_open_ = false;
};

}  // namespace achilles
