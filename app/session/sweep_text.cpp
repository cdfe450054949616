#include "session/sweep_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expression/parse.hpp"
#include "figure/sweep_figure.hpp"
#include "output/contacts.hpp"
#include "output/event_descriptions.hpp"
#include "session/number_text.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

std::optional<double> present_value(const Session& session, const SweepAxis& axis) {
    if (const auto value = session.value(axis.name)) return value;
    const std::vector<const Option*> options = options_of_axis(axis.name);
    if (options.empty()) return std::nullopt;
    const OptionValue value = options.front()->get(session.run().options);
    if (const double* const number = std::get_if<double>(&value)) return *number;
    if (const int* const count = std::get_if<int>(&value)) return static_cast<double>(*count);
    return std::nullopt;
}

void go_to_point(const SweepData& data, const std::vector<double>& values, Commands& commands) {
    command::SetStart start;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SweepAxis& axis = data.sweep.axes[i];
        const double value = std::clamp(values[i], std::min(axis.low, axis.high), std::max(axis.low, axis.high));
        const std::vector<const Option*> options = options_of_axis(axis.name);
        if (options.empty()) {
            start.values.emplace_back(axis.name, value);
            continue;
        }
        Options changed = data.sweep.base.options;
        for (const Option* option : options) option->set(changed, value);
        commands.emplace_back(command::SetOption(*options.front(), changed));
    }
    if (!start.values.empty()) commands.emplace_back(std::move(start));
}

std::string events_at(const Session& session, const Run& run) {
    constexpr int most_impacts = 2000, most_steps = 20000, max_listed = 6;
    Run shorter = run;
    shorter.options.max_impacts = std::min(shorter.options.max_impacts, most_impacts);
    shorter.options.max_steps = std::min(shorter.options.max_steps, most_steps);
    std::vector<std::string> listed;
    int impacts = 0;
    const auto tell_impacts = [&](const char* before) {
        if (impacts > 0) listed.push_back((impacts == 1 ? "an impact" : fmt::format("{} impacts", impacts)) + before);
        impacts = 0;
    };
    try {
        const Trajectory trajectory = simulate(session.model(), shorter);
        for (const Event& event : trajectory.events) {
            if (event.is_impact()) {
                ++impacts;
                continue;
            }
            tell_impacts(event.truncation && !is_plastic_landing(event) ? " before the cut" : "");
            listed.push_back(fmt::format("{} at {} s", names_of(event).name, number(event.t, "{:.5g}")));
        }
        tell_impacts("");
        if (trajectory.outcome.kind != Outcome::Kind::end_time) listed.emplace_back("\u2026");
    } catch (const InputError& problem) {
        return problem.message;
    }
    if (listed.empty()) return "no event";
    std::string text;
    // Two per line: if ImGui wrapped the line, it could break within a number.
    for (std::size_t i = 0; i < listed.size() && i < max_listed; ++i)
        text += (i == 0 ? "" : i % 2 == 0 ? ",\n" : ", ") + listed[i];
    return listed.size() > max_listed ? text + ", \u2026" : text;
}

std::optional<std::size_t> sweep_row_at(const SweepData& data, const std::vector<double>& values) {
    std::uint64_t point = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SweepAxis& axis = data.sweep.axes[i];
        double share = (values[i] - axis.low) / (axis.high - axis.low);
        if (axis.logarithmic) share = std::log(values[i] / axis.low) / std::log(axis.high / axis.low);
        if (!(share >= -0.01 && share <= 1.01)) return std::nullopt;
        const double last = static_cast<double>(axis.count - 1);
        point = point * axis.count + static_cast<std::uint64_t>(std::clamp(std::round(share * last), 0.0, last));
    }
    const auto& points = data.rows.points;
    const auto found = std::lower_bound(points.begin(), points.end(), point);
    if (found == points.end() || *found != point) return std::nullopt;
    return static_cast<std::size_t>(found - points.begin());
}

std::string sweep_quantity_text(double value, const ShownUnit& unit) {
    return number_with_unit(number(unit.factor * value), unit.text);
}

std::string sweep_row_text(const SweepData& data, std::size_t row) {
    std::size_t number_place = 0;
    std::string text;
    for (const RunMeasures::Column& column : data.columns) {
        std::string value;
        if (column.kind == RunMeasures::Column::Kind::number) {
            const double x = data.number(row, number_place++);
            value = std::isfinite(x) ? sweep_quantity_text(x, shown_unit(column.unit)) : "no value";
        } else if (column.kind == RunMeasures::Column::Kind::outcome) {
            value = data.rows.ends[row].text();
        } else if (column.kind == RunMeasures::Column::Kind::modes) {
            value = modes_text(data.sliding, data.rows.modes[row]);
        } else {
            for (std::size_t i = 0; i < data.contacts.size(); ++i)
                if (data.rows.held[row].contains(i)) value += (value.empty() ? "" : ", ") + data.contacts[i];
            if (value.empty()) value = "nothing";
        }
        text += (text.empty() ? "" : "\n") + column.name + " = " + value;
    }
    return text;
}

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
