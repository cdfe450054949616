// The bars of contacts below the plots over time.
#include <algorithm>
#include <limits>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"

namespace achilles {

namespace {

// All contacts, then all joints with friction.
std::vector<std::size_t> bar_places(const Model& model) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < model.contacts(); ++i) places.push_back(i);
    for (std::size_t k = 0; k < model.description().frictions.size(); ++k) places.push_back(joint_number(k));
    return places;
}

}  // namespace

std::vector<TimeBar> contact_bars(const Trajectory& trajectory, double end, const Axis& time, const Theme& theme) {
    constexpr double parts = 4000.0;  // distinguishable positions on an axis
    const double near = (time.high - time.low) / parts;
    const Model& model = *trajectory.model;
    const Color impact = phase_color(theme, PhaseLook::flight);
    std::vector<TimeBar> bars;
    for (const std::size_t place : bar_places(model)) {
        const ContactSet own = ContactSet::of(place);
        TimeBar& bar = bars.emplace_back();
        bar.label = typeset_name(contact_names(model, own).front());
        std::vector<TimeBar::TimeMark>& marks = bar.marks;
        const auto is_seen = [&](double low, double high) {
            return high >= time.low && low <= time.high && low <= end;
        };
        for (const Phase& phase : trajectory.phases) {
            if (!phase.mode.is_held(place) || !is_seen(phase.start, phase.end)) continue;
            const double until = std::min(phase.end, end);
            const Color color = phase_color(theme, look_of(model, own, phase.mode));
            if (!marks.empty() && phase.start - marks.back().high < near && marks.back().color == color)
                marks.back().high = until;
            else if (until > phase.start)
                marks.push_back({phase.start, until, color});
        }
        double last = -std::numeric_limits<double>::infinity();
        for (const Event& event : trajectory.events) {
            if (!event.is_impact() || !event.contacts.contains(place) || !is_seen(event.t, event.t) ||
                event.t - last < near)
                continue;
            marks.push_back({event.t, event.t, impact});
            last = event.t;
        }
    }
    return bars;
}

}  // namespace achilles
