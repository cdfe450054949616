// The columns of the list of events: a sign, a number, the time and a sentence, and behind it numbers below one another.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "panels/panels.hpp"

namespace achilles {

// Where they are, at scale 1, from the left edge of the list: signs and words begin there, numbers end there. The sentence has
// what the numbers behind it leave, and these stand back before it has less than a sentence needs.
constexpr float sign_at = 14.0F, number_at = 62.0F, time_at = 164.0F, words_at = 180.0F, words_width = 600.0F,
                state_width = 112.0F;

// A column of the state after an event: a coordinate or its rate.
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

// A number, or a word over numbers, that ends at x; a long word is cut.
void number_cell(ImVec2 at, float x, const std::string& text, const Color& color);

// The numbers at the right end of the list: the energy that is lost, where there are several contacts what is held, and as much
// of the state as has room. Beside a card the list has no numbers but the time.
class EventColumns {
 public:
    EventColumns(const Session& session, float width, bool is_alone);
    float words() const;  // how wide the words are, pixels
    void put_words(ImVec2 at, const std::string& text, const Color& color) const;
    void titles(const Session& session, ImVec2 at) const;
    // Of an event, or of impacts in a row what they have lost.
    void row(const Session& session, const Event* event, double lost, ImVec2 at, const Color& color) const;

 private:
    bool is_held(std::size_t i) const { return is_of_several_ && i == 1; }
    const StateColumn& state(std::size_t i) const { return states_[i - (is_of_several_ ? 2 : 1)]; }
    void put(ImVec2 at, std::size_t i, const std::string& text, const Color& color) const;

    std::vector<StateColumn> states_;
    float width_;
    bool is_of_several_;
    std::size_t shown_ = 0;
};

}  // namespace achilles
