#include "session/sweep_choices.hpp"

#include <fmt/format.h>

#include "expression/parse.hpp"
#include "session/session.hpp"

namespace achilles {

std::vector<std::string> offered_prints(const SystemDescription& description, const SweepSpec& sweep) {
    const bool is_section = sweep.at.has_value(), has_friction = !sliding_places(description).empty();
    std::vector<std::string> prints;
    if (!is_section) prints = {"zeno_time(1)", "zeno_time(2)", "zeno_points", "impacts", "releases", "least_gap"};
    for (const CoordinateDescription& coordinate : description.coordinates) {
        prints.push_back(coordinate.name);
        prints.push_back(coordinate.name + "'");
    }
    prints.emplace_back("energy");
    if (has_friction) prints.insert(prints.end(), {"heat", "modes"});
    if (has_friction && !is_section)
        prints.insert(prints.end(), {"stick_time(1)", "slip_time(1)", "sticks", "slips", "reversals"});
    if (!is_section) prints.insert(prints.end(), {"held", "outcome"});
    Run run = default_run(description);
    const bool has_slope = !sweep.axes.empty() && find_value(description, run, sweep.axes.front().name) != nullptr &&
                           (!is_section || sweep.at->event);
    if (has_slope) prints.push_back(fmt::format("d({}, {})", prints.front(), sweep.axes.front().name));
    return prints;
}

command::ShowSweep showing(const SweepSpec& sweep, const SystemDescription& description) {
    SweepSpec bare = sweep;
    bare.base = default_run(description);
    return {to_text(bare, description)};
}

std::optional<SweepAxis> axis_for(const Session& session, const std::string& name) {
    const SystemDescription& description = session.description();
    constexpr std::uint64_t finest_points = 512;
    const auto over = [&](const std::array<double, 2>& range) {
        return SweepAxis{name, range[0], range[1], finest_points, false};
    };
    for (const ParameterDescription& parameter : description.parameters)
        if (parameter.name == name) return over(parameter.range);
    for (const CoordinateDescription& coordinate : description.coordinates) {
        if (coordinate.name == name) return over(coordinate.range);
        if (coordinate.name + "'" == name) return over(coordinate.rate_range);
    }
    const Options& options = session.run().options;
    if (name == "end") return over({options.start_time, options.end_time});
    return std::nullopt;
}

}  // namespace achilles
