#include "figure/contact_bars.hpp"

#include <algorithm>
#include <limits>

#include "figure/label.hpp"
#include "model/model.hpp"

namespace achilles {

std::vector<TimeBar> contact_bars(const Trajectory& trajectory, double end, const Axis& time, const Theme& theme) {
    constexpr double parts = 4000.0;  // of an axis that can be told apart
    const double near = (time.high - time.low) / parts;
    const Color held = phase_color(theme, Phase::Kind::constrained), impact = phase_color(theme, Phase::Kind::hybrid);
    const auto& constraints = trajectory.model->description().constraints;
    std::vector<TimeBar> bars(constraints.size());
    for (std::size_t contact = 0; contact < bars.size(); ++contact) {
        bars[contact].label = typeset_name(constraints[contact].name);
        std::vector<TimeBar::Mark>& marks = bars[contact].marks;
        const auto is_seen = [&](double low, double high) {
            return high >= time.low && low <= time.high && low <= end;
        };
        for (const Phase& phase : trajectory.phases) {
            if (!phase.held.contains(contact) || !is_seen(phase.start, phase.end)) continue;
            const double until = std::min(phase.end, end);
            if (!marks.empty() && phase.start - marks.back().high < near)
                marks.back().high = until;
            else if (until > phase.start)
                marks.push_back({phase.start, until, held});
        }
        double last = -std::numeric_limits<double>::infinity();
        for (const Event& event : trajectory.events) {
            if (event.kind != Event::Kind::impact || !event.contacts.contains(contact) || !is_seen(event.t, event.t) ||
                event.t - last < near)
                continue;
            marks.push_back({event.t, event.t, impact});
            last = event.t;
        }
    }
    return bars;
}

}  // namespace achilles
