#include "session/history.hpp"

namespace achilles {

namespace {

template <class... Kinds>
bool is_one_of(const Command& command) {
    return (std::holds_alternative<Kinds>(command) || ...);
}

}  // namespace

bool is_change(const Command& command) {
    return is_one_of<command::Open, command::New, command::Text, command::Start, command::Set, command::Reset,
                     command::UseOption, command::Grid, command::PlotView, command::Zoom, command::Range, command::Fit,
                     command::AxisScale, command::ShowCurve>(command);
}

bool goes_on(const Command& last, const Command& next) {
    if (last.index() != next.index()) return false;
    if (const auto* set = std::get_if<command::Set>(&next)) return std::get<command::Set>(last).name == set->name;
    if (const auto* zoom = std::get_if<command::Zoom>(&next)) return std::get<command::Zoom>(last).plot == zoom->plot;
    if (const auto* use = std::get_if<command::UseOption>(&next))  // a slider
        return std::get<command::UseOption>(last).name == use->name && std::holds_alternative<double>(use->values[0]);
    return is_one_of<command::Start>(next);
}

}  // namespace achilles
