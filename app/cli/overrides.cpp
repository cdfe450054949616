#include "cli/overrides.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "cli/terminal.hpp"
#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "model/model.hpp"
#include "system/input_error.hpp"
#include "system/units.hpp"

namespace achilles {

std::string common_flag(const Option& option) { return "--" + std::string(option.command); }

double number_from(const std::string& option, std::string_view text, std::string_view unit) {
    try {
        return read_number(text).value;
    } catch (const ParseError& error) {
        const auto apart = measured(text);
        throw apart
            ? InputError(fmt::format("{} {}", option, shown(text)), {}, "this value must be a number without a unit",
                         without_unit(*apart, option, unit, fmt::format("{} {}", option, apart->number)))
            : InputError(fmt::format("{} {}", option, shown(text)), {}, error.what(), error.hint);
    }
}

namespace {

int integer_from(const std::string& option, std::string_view text) {
    const double value = number_from(option, text);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max())
        throw InputError(fmt::format("{} {}", option, shown(text)), {},
                         fmt::format("a whole number is expected, at most {}", std::numeric_limits<int>::max()));
    return static_cast<int>(value);
}

}  // namespace

OptionValue value_from(const Option& option, const std::string& flag, const std::string& text) {
    if (std::holds_alternative<int>(option.get({}))) return integer_from(flag, text);
    if (option.words.empty()) return number_from(flag, text, option.unit);
    const auto found = std::find(option.words.begin(), option.words.end(), text);
    if (found != option.words.end()) return *found;
    const std::vector<std::string> choices(option.words.begin(), option.words.end());
    throw InputError(fmt::format("{} {}", flag, shown(text)), {},
                     "there is no such choice" + did_you_mean(text, choices),
                     fmt::format("write {} {}", flag, fmt::join(choices, fmt::format(" or {} ", flag))));
}

const std::pair<const std::string, OptionValue>* OptionOverrides::find(const Option& option) const {
    auto found = by_flag.find(option.flag);
    if (found == by_flag.end()) found = by_flag.find(common_flag(option));
    return found == by_flag.end() ? nullptr : &*found;
}

void apply(const OptionOverrides& overrides, Options& options) {
    const auto check = [](const Option& option, const auto& flag, const OptionValue& value) {
        if (is_valid_value(option, value)) return;
        if (std::holds_alternative<double>(value))
            throw InputError(flag, {},
                             fmt::format("the value must be positive and finite, but it is {}", to_text(value)));
        throw InputError(flag, {}, std::string(option.error_text));
    };
    for (const Option& option : all_options()) {
        if (const auto all = overrides.by_flag.find(common_flag(option)); all != overrides.by_flag.end())
            check(option, all->first, all->second);
        if (const auto* given = overrides.find(option)) {
            check(option, given->first, given->second);
            option.set(options, given->second);
        }
    }
    for (const char* key : {"end_time", "start_time"})
        if (const auto* given = overrides.find(option(key)))
            if (const auto fault = end_time_error(options)) throw InputError(given->first, {}, *fault);
}

Options work_options(const OptionOverrides& overrides) {
    Options options;
    for (const char* key : {"memory", "max_steps"})
        if (const auto* given = overrides.find(option(key));
            given != nullptr && is_valid_value(option(key), given->second))
            option(key).set(options, given->second);
    return options;
}

Run requested_run(const SystemDescription& description, const std::vector<std::string>& settings,
                  const OptionOverrides& overrides) {
    Run run = default_run(description);
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const auto has_value = [&](std::size_t k) { return settings[k].find('=') != std::string::npos; };
        if (i + 1 < settings.size() && !has_value(i) && !has_value(i + 1))
            throw InputError(fmt::format("--set {} {}", shown(settings[i]), shown(settings[i + 1])), {},
                             "a name and its value must be one word",
                             fmt::format("write --set {}={}", settings[i], settings[i + 1]));
        assign(run, description, settings[i]);
    }
    apply(overrides, run.options);
    return run;
}

std::vector<std::string> fixed_names(const std::vector<std::string>& settings, const OptionOverrides& overrides) {
    std::vector<std::string> names;
    for (const std::string& setting : settings) {
        std::string name = setting.substr(0, setting.find('='));
        std::erase(name, ' ');
        names.push_back(std::move(name));
    }
    for (const auto& [flag, value] : overrides.by_flag) names.push_back(flag);
    return names;
}

namespace {

bool can_start(const Model& model, const Run& run) {
    try {
        model.check(run);
    } catch (const InputError&) {
        return false;
    }
    return true;
}

// The run with the file's value for this setting.
Run without(const Model& model, const std::string& setting, Run run) {
    std::string name = setting.substr(0, setting.find('='));
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    Run file = model.default_run();
    double* const place = find_value(model.description(), run, name);
    if (place != nullptr) *place = *find_value(model.description(), file, name);
    return run;
}

}  // namespace

InitialUncertainty parse_uncertainty(const std::vector<std::string>& settings, double width,
                                     const SystemDescription& description, std::vector<std::string>& points) {
    InitialUncertainty spread;
    spread.width = width;
    for (const std::string& setting : settings) {
        const auto side = parse_interval(setting, description);
        points.push_back(side ? fmt::format("{}={}", side->name, 0.5 * side->low + 0.5 * side->high) : setting);
        if (side) spread.sides.push_back(*side);
    }
    return spread;
}

void validate_overrides(const Model& model, const Run& run, const std::vector<std::string>& settings) {
    try {
        model.check(run);
    } catch (const InputError& problem) {
        Run file = run;
        std::string all, alone;
        for (const std::string& setting : settings) {
            all += fmt::format("{}--set {}", all.empty() ? "" : " ", setting);
            if (can_start(model, without(model, setting, run))) alone = "--set " + setting;
            file = without(model, setting, file);
        }
        if (!can_start(model, file)) throw;  // the settings are not the cause
        std::vector<InputError> errors;
        for (const InputError& each : each_of(problem))
            errors.emplace_back(shown(alone.empty() ? all : alone), Location{}, each.message, each.hint);
        throw InputErrors(errors);
    }
}

void warn(const SystemDescription& description, const Run& run) {
    std::vector<std::string> all = warnings(run.options);
    for (const std::string& outside : outside_ranges(description, run)) all.push_back(outside);
    for (const std::string& unseen : unseen_lines(description)) all.push_back(unseen);
    for (const std::string& warning : all) print_clean(stderr, "achilles: warning: {}\n", warning);
}

}  // namespace achilles
