#include "cli/commands/common.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "expression/nearest.hpp"

namespace achilles {

namespace {

template <class Number>
std::optional<Number> parse(std::string_view text) {
    Number value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

int integer_from(const std::string& option, std::string_view text) {
    const auto value = parse<int>(text);
    if (!value) throw InputError(fmt::format("{} {}", option, text), {}, "this is not a whole number");
    return *value;
}

void add_number(CLI::App& command, const std::string& option, std::optional<double>& target, const std::string& about) {
    command
        .add_option_function<std::string>(
            option, [&target, option](const std::string& text) { target = number_from(option, text); }, about)
        ->type_name("X");
}

// One of two words.
template <class Value>
void add_choice(CLI::App& command, const std::string& option, std::optional<Value>& target,
                std::optional<Value> (*from)(std::string_view), const std::vector<std::string>& choices,
                const std::string& about) {
    const auto take = [&target, option, from, choices](const std::string& text) {
        target = from(text);
        if (!target)
            throw InputError(fmt::format("{} {}", option, text), {},
                             fmt::format("there is no '{}' to choose{}", text, did_you_mean(text, choices)),
                             fmt::format("the choice is {} or {}", choices[0], choices[1]));
    };
    command.add_option_function<std::string>(option, take, about)->type_name(choices[0] + "|" + choices[1]);
}

}  // namespace

double number_from(const std::string& option, std::string_view text) {
    const auto value = parse<double>(text);
    if (!value || !std::isfinite(*value))
        throw InputError(fmt::format("{} {}", option, text), {}, "this is not a finite number");
    return *value;
}

void add_system_argument(CLI::App& command, std::string& system) {
    command.add_option("SYSTEM", system, "a path to a .toml file, or a name from 'achilles list'")
        ->required()
        ->type_name("");
}

void add_format_option(CLI::App& command, std::string& format, const std::string& about) {
    command.add_option("--format", format, about)->type_name("png|svg")->check(CLI::IsMember({"png", "svg"}));
}

void add_view_option(CLI::App& command, std::vector<std::string>& views, const std::string& about) {
    command.add_option("--view", views, about)
        ->type_name("NAME")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<ViewDescription> views_of(const SystemDescription& description, const std::vector<std::string>& names) {
    std::vector<ViewDescription> views;
    if (names.empty()) {
        views = description.views;
        std::stable_partition(views.begin(), views.end(),
                              [](const ViewDescription& view) { return view.x.text == "t"; });
        return views;
    }
    std::vector<std::string> known;
    for (const ViewDescription& view : description.views) known.push_back(view.name);
    for (const std::string& name : names) {
        const auto at = std::find(known.begin(), known.end(), name);
        if (at == known.end()) {
            std::string all;
            for (const std::string& view : known) all += (all.empty() ? "" : ", ") + view;
            throw InputError("--view " + name, {},
                             fmt::format("this system has no view '{}'{}", name, did_you_mean(name, known)),
                             "its views are: " + all);
        }
        views.push_back(description.views[static_cast<std::size_t>(at - known.begin())]);
    }
    return views;
}

void add_run_options(CLI::App& command, std::vector<std::string>& settings, OptionOverrides& overrides) {
    command.add_option("--set", settings, "a parameter, a coordinate x=0.3 or a rate x'=1.5; may be given again")
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add_number(command, "--end", overrides.end_time, "end time, s");
    add_number(command, "--tolerance", overrides.tolerance, "local error per step, absolute and relative");
    add_choice<Method>(command, "--method", overrides.method, method_from, {"dopri5", "taylor"}, "of the integration");
    command
        .add_option_function<std::string>(
            "--max-impacts",
            [&overrides](const std::string& text) { overrides.max_impacts = integer_from("--max-impacts", text); },
            "after so many the run stops")
        ->type_name("N");
    add_choice<Conditions>(command, "--conditions", overrides.conditions, conditions_from, {"paper", "sharp"},
                           "when infinitely many impacts may be cut short");
    add_choice<Reinitialization>(command, "--reinitialization", overrides.reinitialization, reinitialization_from,
                                 {"euclidean", "kinetic"}, "the velocity that contact starts with");
    add_number(command, "--eps", overrides.eps, "the error the cut may cost: position, velocity and time");
    add_number(command, "--eps-q", overrides.eps_q, "position");
    add_number(command, "--eps-v", overrides.eps_v, "velocity");
    add_number(command, "--eps-t", overrides.eps_t, "time, s");
}

void add_step_option(CLI::App& command, std::vector<std::string>& steps) {
    command.add_option("--do", steps, "a command as in a journal, --do \"seek 3.2\"; may be given again")
        ->type_name("COMMAND")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_scale_option(CLI::App& command, double& scale, const std::string& about) {
    const auto take_scale = [&scale](const std::string& text) {
        scale = number_from("--scale", text);
        if (!(scale >= 0.25 && scale <= 8.0))
            throw InputError("--scale " + text, {}, "the scale must lie in [0.25, 8]");
    };
    command.add_option_function<std::string>("--scale", take_scale, about)->type_name("S");
}

void add_size_options(CLI::App& command, int& width, int& height, double& scale, const std::string& about) {
    const auto take_size = [&width, &height](const std::string& text) {
        const std::size_t x = text.find('x');
        const auto w = parse<int>(std::string_view(text).substr(0, x));
        const auto h = x == std::string::npos ? std::nullopt : parse<int>(std::string_view(text).substr(x + 1));
        if (!w || !h || *w < 64 || *h < 64 || *w > 16384 || *h > 16384)
            throw InputError("--size " + text, {}, "this is no size in pixels",
                             "write WIDTHxHEIGHT, as in --size 1600x1000; each from 64 to 16384");
        width = *w;
        height = *h;
    };
    const std::string size = fmt::format("pixels (default {}x{})", width, height);
    command.add_option_function<std::string>("--size", take_size, about.empty() ? size : about)->type_name("WxH");
    if (about.empty())
        add_scale_option(command, scale);
    else
        add_scale_option(command, scale, about);
}

}  // namespace achilles
