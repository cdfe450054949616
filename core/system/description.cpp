#include "system/description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "number/angle.hpp"
#include "number/float_environment.hpp"
#include "system/input_error.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

}  // namespace

SystemDescription::SystemDescription() = default;
SystemDescription::SystemDescription(const SystemDescription&) = default;
SystemDescription::SystemDescription(SystemDescription&&) noexcept = default;
SystemDescription& SystemDescription::operator=(const SystemDescription&) = default;
SystemDescription& SystemDescription::operator=(SystemDescription&&) noexcept = default;
SystemDescription::~SystemDescription() = default;

InputError SystemDescription::error(Location at, const std::string& message, const std::string& hint) const {
    return {file, at, message, hint, line_of(source_text, at.line)};
}

bool SystemDescription::has_friction() const {
    return !frictions.empty() || std::any_of(constraints.begin(), constraints.end(),
                                             [](const ConstraintDescription& c) { return c.has_friction(); });
}

Run default_run(const SystemDescription& description) {
    Run run;
    run.options = description.options;
    for (const ParameterDescription& parameter : description.parameters) run.parameters.push_back(parameter.value);
    const auto n = static_cast<Eigen::Index>(description.coordinates.size());
    run.q.resize(n);
    run.v.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        run.q[i] = description.coordinates[static_cast<std::size_t>(i)].start;
        run.v[i] = description.coordinates[static_cast<std::size_t>(i)].rate;
    }
    return run;
}

std::vector<std::string> settable_names(const SystemDescription& description) {
    std::vector<std::string> names;
    for (const CoordinateDescription& c : description.coordinates) names.insert(names.end(), {c.name, c.name + "'"});
    for (const ParameterDescription& p : description.parameters) names.push_back(p.name);
    return names;
}

double* find_value(const SystemDescription& description, Run& run, std::string_view name) {
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        if (description.parameters[i].name == name) return &run.parameters[i];
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const std::string& coordinate = description.coordinates[i].name;
        if (name == coordinate) return &run.q[static_cast<Eigen::Index>(i)];
        if (name == coordinate + "'") return &run.v[static_cast<Eigen::Index>(i)];
    }
    return nullptr;
}

std::string why_not_settable(const SystemDescription& description, std::string_view name) {
    for (const DerivedDescription& derived : description.derived)
        if (derived.name == name)
            return fmt::format("'{}' is a derived parameter, {}: set the parameters in this expression", name,
                               shown(derived.definition.text));
    for (const Option& option : all_options())
        if (name == option.key || name == option.command)
            return fmt::format("'{}' is an option of the run, {} on the command line", name, option.flag);
    const std::vector<std::string> settable = settable_names(description);
    std::string hint = did_you_mean(name, settable);
    constexpr std::size_t few = 10;
    if (hint.empty() && settable.size() <= few) hint = fmt::format("; these may be set: {}", fmt::join(settable, ", "));
    if (has_word("e restitution eps epsilon cor", name) && !description.constraints.empty()) {
        const std::string& e = description.constraints.front().restitution.text;
        if (std::find(settable.begin(), settable.end(), e) != settable.end())
            hint = fmt::format("; did you mean '{}'?", e);
        else if (!has_names(e))
            hint += "; to vary the restitution, add a parameter e to the file and write restitution = \"e\"";
    }
    return fmt::format("'{}' is not a parameter, coordinate or rate of this system{}", shown(name), hint);
}

std::string rate_unit(const std::string& unit) { return unit.empty() ? unit : unit + "/s"; }

std::string unit_of(const SystemDescription& description, std::string_view name) {
    for (const ParameterDescription& p : description.parameters)
        if (p.name == name) return p.unit;
    for (const DerivedDescription& derived : description.derived)
        if (derived.name == name) return derived.unit;
    for (const CoordinateDescription& c : description.coordinates) {
        if (name == c.name) return c.unit;
        if (name == c.name + "'") return rate_unit(c.unit);
    }
    return {};
}

namespace {

// "8.2 rad". An angle with many decimals in radians, such as 400 deg or 3*pi, is in degrees.
std::string with_unit(double value, const std::string& unit) {
    constexpr double few_decimals = 1e4;
    if (!is_of_angles(unit) || std::round(value * few_decimals) == value * few_decimals)
        return fmt::format("{}{}{}", value, unit.empty() ? "" : " ", unit);
    return fmt::format("{:.6g} deg{}", degrees(value), unit.substr(3));
}

}  // namespace

std::vector<std::string> outside_ranges(const SystemDescription& description, const Run& run) {
    std::vector<std::string> messages;
    const auto look = [&](const std::string& name, double value, const std::array<double, 2>& range, bool is_written) {
        if (!is_written || (value >= range[0] && value <= range[1])) return;
        const std::string unit = unit_of(description, name), shown_value = with_unit(value, unit);
        const bool is_shown_in_degrees = shown_value.find(" deg") != shown_value.npos;
        const bool seems_degrees = is_of_angles(unit) && !is_shown_in_degrees && std::abs(value) > 6.5;
        const double factor = is_shown_in_degrees ? degrees(1.0) : 1.0;
        messages.push_back(fmt::format(
            "{} = {} is outside its range, {:.6g} to {:.6g}{}", name, shown_value, factor * range[0], factor * range[1],
            seems_degrees ? fmt::format(": for an angle in degrees write {} deg{}", value, unit.substr(3)) : ""));
    };
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const CoordinateDescription& c = description.coordinates[i];
        look(c.name, run.q[static_cast<Eigen::Index>(i)], c.range, c.has_range);
        look(c.name + "'", run.v[static_cast<Eigen::Index>(i)], c.rate_range, c.has_rate_range);
    }
    for (std::size_t i = 0; i < description.parameters.size(); ++i) {
        const ParameterDescription& p = description.parameters[i];
        look(p.name, run.parameters[i], p.range, p.has_range);
    }
    return messages;
}

std::vector<std::string> unseen_lines(const SystemDescription& description) {
    constexpr double least = 0.25;  // pixels: about a tenth of the usual width
    std::vector<std::string> messages;
    for (const DrawingDescription& drawing : description.drawings) {
        double width = 0.0;
        try {
            width = read_number(drawing.width.text).value;
        } catch (const ParseError&) {  // no width given, or one that depends on parameters
            continue;
        }
        if (width > 0.0 && width < least)
            messages.push_back(
                fmt::format("line {}: a width of {} is too small to see: widths are in pixels, not in the units of the "
                            "points (default 2)",
                            drawing.width.at.line, width));
    }
    return messages;
}

namespace {

// Rejects several values in one argument: "e=0.3,g=9.81", a range, an interval.
template <class Refuse>
void refuse_several(const std::string& name, const std::string& written, const Refuse& refuse) {
    if (const std::size_t equals = written.find('='); equals != written.npos && equals > 0) {
        const std::size_t end = std::min(written.find_first_of(",; "), equals);
        std::size_t next = written.find_first_not_of(",; ", end);
        if (end < equals && next < equals)
            throw refuse("each value needs its own --set",
                         fmt::format("write --set {}={} --set {}", name, written.substr(0, end), written.substr(next)));
    }
    const bool is_interval = written.find("..") != written.npos;
    const std::size_t colon = written.find(':');
    if (is_interval || colon != written.npos || trimmed(written).starts_with("["))
        throw refuse(fmt::format("{} takes one number", name),
                     fmt::format("achilles prove takes an interval, --set {0}=LOW..HIGH; achilles sweep takes a range, "
                                 "--over {0}=LOW:HIGH:COUNT",
                                 name));
    if (written.ends_with('%'))
        throw refuse(fmt::format("{} takes a number", name),
                     fmt::format("write --set {}={}/100", name, written.substr(0, written.size() - 1)));
}

}  // namespace

void assign(Run& run, const SystemDescription& description, std::string_view name_value) {
    const auto refuse = [&](const std::string& why, const std::string& hint = {}) {
        return InputError("--set " + shown(name_value), {}, why, hint);
    };
    const std::size_t equals = name_value.find('=');
    const std::size_t colon = name_value.find(':');
    if (equals == name_value.npos && colon != name_value.npos)
        throw refuse("an equals sign is missing",
                     fmt::format("write --set {}={}", name_value.substr(0, colon), name_value.substr(colon + 1)));
    if (equals == name_value.npos)
        throw refuse("a value is missing", "write --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5");
    const std::string name(trimmed(name_value.substr(0, equals))), written(name_value.substr(equals + 1));
    double* const place = find_value(description, run, name);
    if (place == nullptr) {
        const std::size_t open = name.find('(');
        if (open != name.npos && name.ends_with("(0)") && find_value(description, run, name.substr(0, open)) != nullptr)
            throw refuse("the name alone sets the start",
                         fmt::format("write --set {}={}", name.substr(0, open), written));
        throw refuse(why_not_settable(description, name));
    }
    refuse_several(name, written, refuse);
    std::optional<double> value;
    try {
        value = read_number(written, unit_of(description, name)).value;
    } catch (const ParseError& error) {
        const auto apart = measured(written);
        if (!apart) throw refuse(error.what(), error.hint);
        throw refuse(
            "a value must be a number without a unit",
            without_unit(*apart, name, unit_of(description, name), fmt::format("--set {}={}", name, apart->number)));
    }
    const bool is_parameter = std::any_of(description.parameters.begin(), description.parameters.end(),
                                          [&](const ParameterDescription& p) { return p.name == name; });
    if (is_parameter && is_subnormal(*value)) throw refuse(subnormal_parameter(name, *value), subnormal_hint);
    *place = *value;
}

std::vector<DrawingDescription> drawings_of(const SystemDescription& system) {
    std::vector<DrawingDescription> all = system.drawings;
    for (const ConstraintDescription& constraint : system.constraints)
        all.insert(all.end(), constraint.drawings.begin(), constraint.drawings.end());
    std::stable_sort(all.begin(), all.end(), [](const DrawingDescription& a, const DrawingDescription& b) {
        return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
    });
    return all;
}

std::vector<std::string> output_names(const SystemDescription& system, std::string_view quantity) {
    if (system.constraints.size() == 1) return {std::string(quantity)};
    const std::size_t primes = std::min(quantity.find('\''), quantity.size());
    std::vector<std::string> names;
    for (const ConstraintDescription& constraint : system.constraints)
        names.push_back(fmt::format("{}_{}{}", quantity.substr(0, primes), constraint.name, quantity.substr(primes)));
    return names;
}

bool SystemDescription::has_conditional_contacts() const {
    return std::any_of(constraints.begin(), constraints.end(),
                       [](const ConstraintDescription& c) { return !c.when.text.empty(); });
}

std::vector<SlidingPlace> sliding_places(const SystemDescription& system) {
    std::vector<SlidingPlace> places;
    const auto add = [&](const auto& table, const Text& level, const std::optional<Text>& static_level,
                         std::size_t number, bool never_slides) {
        places.push_back(
            {table.name, &table.slip, &level, static_level ? &*static_level : nullptr, number, never_slides});
    };
    for (std::size_t i = 0; i < system.constraints.size(); ++i) {
        const ConstraintDescription& c = system.constraints[i];
        if (c.has_friction()) add(c, c.friction, c.static_friction, i, c.never_slides);
    }
    for (std::size_t k = 0; k < system.frictions.size(); ++k) {
        const FrictionDescription& f = system.frictions[k];
        add(f, f.level, f.static_level, joint_number(k), false);
    }
    return places;
}

std::vector<std::string> sliding_names(const SystemDescription& system, std::string_view quantity) {
    const bool is_one = system.constraints.size() == 1 && system.frictions.empty();
    std::vector<std::string> names;
    for (const SlidingPlace& place : sliding_places(system))
        names.push_back(is_one ? std::string(quantity) : fmt::format("{}_{}", quantity, place.name));
    return names;
}

std::vector<Text> texts_of(const DrawingDescription& drawing) {
    using Shape = DrawingDescription::Shape;
    std::vector<Text> texts;
    for (const auto& point : drawing.points) texts.insert(texts.end(), point.begin(), point.end());
    if (is_round(drawing.shape)) texts.push_back(drawing.radius);
    texts.insert(texts.end(), drawing.sizes.begin(), drawing.sizes.end());
    if (drawing.shape == Shape::curve)
        texts.insert(texts.end(), drawing.over_limits.begin(), drawing.over_limits.end());
    if (!drawing.width.text.empty()) texts.push_back(drawing.width);
    return texts;
}

namespace {

double& value_of(const SystemDescription& description, Run& run, std::string_view name) {
    double* const place = find_value(description, run, name);
    if (place == nullptr) throw InputError({}, {}, why_not_settable(description, name));
    return *place;
}

}  // namespace

NamedRun::NamedRun(const SystemDescription& description)
    : Run(default_run(description)), description_(std::make_shared<const SystemDescription>(description)) {}

NamedRun& NamedRun::set(std::string_view name, double value) {
    value_of(*description_, *this, name) = value;
    return *this;
}

double NamedRun::get(std::string_view name) const {
    Run copy = *this;
    return value_of(*description_, copy, name);
}

}  // namespace achilles
