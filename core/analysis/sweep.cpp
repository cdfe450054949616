#include "analysis/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/measures.hpp"

namespace achilles {

double SweepAxis::value(std::uint64_t i) const {
    if (i == 0) return low;
    if (i + 1 == count) return high;
    const auto part = static_cast<double>(i), parts = static_cast<double>(count - 1);
    if (logarithmic)
        return std::clamp(std::exp(std::log(low) + (std::log(high) - std::log(low)) * part / parts),
                          std::min(low, high), std::max(low, high));
    return low + (high - low) * part / parts;
}

double SweepAxis::between(double share) const {
    const double value =
        logarithmic ? std::exp(std::log(low) + (std::log(high) - std::log(low)) * share) : low + (high - low) * share;
    return std::clamp(value, std::min(low, high), std::max(low, high));
}

namespace {

// A pseudorandom number for each point and axis, from a counter-based hash.
double share_of(std::uint64_t seed, std::size_t axis, std::uint64_t i) {
    return static_cast<double>(mixed(mixed(mixed(seed) + axis) + i) >> 11) * 0x1p-53;
}

}  // namespace

std::uint64_t SweepSpec::count() const {
    if (random) return random->count;
    std::uint64_t points = 1;
    for (const SweepAxis& axis : axes) points *= axis.count;
    return points;
}

double SweepSpec::value(std::size_t axis, std::uint64_t i) const {
    if (random) return axes[axis].between(share_of(random->seed, axis, i));
    for (std::size_t faster = axes.size(); faster-- > axis + 1;) i /= axes[faster].count;
    return axes[axis].value(i % axes[axis].count);
}

std::vector<const Option*> options_of_axis(std::string_view name) {
    std::vector<const Option*> found;
    for (const Option& option : all_options()) {
        if (!std::holds_alternative<double>(option.get({}))) continue;
        if (option.flag.substr(2) == name) return {&option};
        if (option.command == name) found.push_back(&option);
    }
    return found;
}

Run without_axes(Run run, const std::vector<SweepAxis>& axes, const Run& file, const SystemDescription& description) {
    Run from = file;
    for (const SweepAxis& axis : axes) {
        if (double* const place = find_value(description, run, axis.name))
            *place = *find_value(description, from, axis.name);
        else
            for (const Option* option : options_of_axis(axis.name)) option->set(run.options, option->get(file.options));
    }
    return run;
}

std::string unit_of_axis(const SystemDescription& description, std::string_view name) {
    const std::string unit = unit_of(description, name);
    const std::vector<const Option*> options = options_of_axis(name);
    return unit.empty() && !options.empty() ? std::string(options.front()->unit) : unit;
}

SweepPoints::SweepPoints(const SweepSpec& sweep, const SystemDescription& description) : sweep_(&sweep) {
    for (const SweepAxis& axis : sweep.axes) {
        AxisTarget place{AxisTarget::Kind::option, 0, {}};
        const auto& parameters = description.parameters;
        const auto& coordinates = description.coordinates;
        const auto parameter = std::find_if(parameters.begin(), parameters.end(),
                                            [&](const ParameterDescription& p) { return p.name == axis.name; });
        const auto coordinate = std::find_if(coordinates.begin(), coordinates.end(), [&](const auto& c) {
            return c.name == axis.name || c.name + "'" == axis.name;
        });
        if (parameter != parameters.end()) {
            place.kind = AxisTarget::Kind::parameter;
            place.index = static_cast<std::size_t>(parameter - parameters.begin());
        } else if (coordinate != coordinates.end()) {
            place.kind = coordinate->name == axis.name ? AxisTarget::Kind::coordinate : AxisTarget::Kind::rate;
            place.index = static_cast<std::size_t>(coordinate - coordinates.begin());
        } else {
            place.options = options_of_axis(axis.name);
        }
        places_.push_back(std::move(place));
    }
}

Run SweepPoints::run(std::uint64_t i) const {
    Run run = sweep_->base;
    for (std::size_t axis = 0; axis < places_.size(); ++axis) {
        const AxisTarget& place = places_[axis];
        const double value = sweep_->value(axis, i);
        switch (place.kind) {
            case AxisTarget::Kind::parameter:
                run.parameters[place.index] = value;
                break;
            case AxisTarget::Kind::coordinate:
                run.q[static_cast<Eigen::Index>(place.index)] = value;
                break;
            case AxisTarget::Kind::rate:
                run.v[static_cast<Eigen::Index>(place.index)] = value;
                break;
            case AxisTarget::Kind::option:
                for (const Option* option : place.options) option->set(run.options, value);
        }
    }
    return run;
}

}  // namespace achilles
