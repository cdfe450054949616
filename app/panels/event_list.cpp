#include "panels/event_list.hpp"

#include <algorithm>
#include <cmath>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"

namespace achilles {

std::vector<StateColumn> state_columns(const Session& session) {
    std::vector<StateColumn> columns;
    const auto& coordinates = session.description().coordinates;
    for (const bool is_rate : {false, true})
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            const bool is_angle = coordinates[i].unit == "rad";
            std::string unit = is_angle ? "\u00b0" : typeset_unit(coordinates[i].unit);
            if (is_rate && !unit.empty()) unit += "/s";
            const std::string name = coordinates[i].name + (is_rate ? "'" : "");
            columns.push_back({name, with_unit(typeset_name(name), unit), static_cast<Eigen::Index>(i), is_rate,
                               is_angle ? degrees(1.0) : 1.0});
        }
    return columns;
}

void number_cell(ImVec2 at, float x, const std::string& text, const Color& color) {
    const float room = units(state_width - 8.0F), width = std::min(label_width(text, ImGui::GetFontSize()), room);
    cell({std::floor(at.x + units(x) - width), at.y}, text, width + 0.5F, color);
}

EventColumns::EventColumns(const Session& session, float width, bool is_alone)
    : states_(state_columns(session)), width_(width), is_of_several_(session.model()->contacts() > 1) {
    const float room = width - units(words_at + words_width);
    const auto fitting = static_cast<std::size_t>(std::max(0.0F, room / units(state_width)));
    shown_ = is_alone ? std::min(fitting, 1 + (is_of_several_ ? 1 : 0) + states_.size()) : 0;
}

float EventColumns::words() const {
    return width_ - units(words_at + 8.0F) - units(state_width) * static_cast<float>(shown_);
}

void EventColumns::put_words(ImVec2 at, const std::string& text, const Color& color) const {
    cell({std::floor(at.x + units(words_at)), at.y}, text, words(), color);
}

void EventColumns::put(ImVec2 at, std::size_t i, const std::string& text, const Color& color) const {
    const float end = width_ - units(8.0F) - units(state_width) * static_cast<float>(shown_ - 1 - i);
    number_cell(at, end / units(1.0F), text, color);
}

void EventColumns::titles(const Session& session, ImVec2 at) const {
    const std::string unit = typeset_unit(session.sentences().energy_unit());
    for (std::size_t i = 0; i < shown_; ++i)
        put(at, i, i == 0 ? with_unit("energy lost", unit) : is_held(i) ? "held" : state(i).title, faint_color());
}

void EventColumns::row(const Session& session, const Event* event, double lost, ImVec2 at, const Color& color) const {
    // Below so much a loss is rounding.
    const double size = 10.0 * std::max(std::abs(session.trajectory().loss), session.sentences().energy_scale());
    const double shown_loss = without_noise(lost, size);
    const Precision& precision = session.precision();
    if (shown_ > 0 && shown_loss != 0.0)
        put(at, 0,
            number(shown_loss, event == nullptr ? 0.0 : precision.of_energy(sample_at(session.trajectory(), *event)),
                   4),
            color);
    if (event == nullptr) return;
    const State errors = precision.of_state(event->t);
    for (std::size_t i = 1; i < shown_; ++i)
        put(at, i,
            is_held(i) ? joined_names(*session.model(), event->mode.held())
                       : number_of_size(state(i).of(*event), state(i).size(session.scale()), 5, state(i).error(errors)),
            color);
}

}  // namespace achilles
