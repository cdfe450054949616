// A sweep as a line of text: what a person types, and what is wrong with it.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "expression/nearest.hpp"
#include "expression/parse.hpp"
#include "expression/read_number.hpp"
#include "study/flags.hpp"
#include "study/sweep.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first));
}

InputError refusal(std::string_view flag, std::string_view text, const std::string& why, const std::string& hint = {}) {
    return {fmt::format("{} {}", flag, shown(text)), {}, why, hint};
}

double number(std::string_view flag, std::string_view whole, std::string_view text, std::string_view unit = {}) {
    try {
        return read_number(text, unit).value;
    } catch (const ParseError& error) {
        throw refusal(flag, whole, error.what());
    }
}

// From `least` to most_points.
std::uint64_t whole_number(std::string_view flag, std::string_view whole, std::string_view text, double least) {
    const double value = number(flag, whole, text);
    if (!(value >= least) || value != std::floor(value))
        throw refusal(
            flag, whole,
            fmt::format("the number of values is a whole number from {} on, and '{}' is none", least, trimmed(text)),
            least > 1.0 ? "one value is --set" : "");
    if (value > static_cast<double>(most_points))
        throw refusal(flag, whole, fmt::format("a sweep has at most {} points", most_points));
    return static_cast<std::uint64_t>(value);
}

constexpr const char* how_to_vary =
    "write --over NAME=LOW:HIGH:COUNT, as in --over e=0:0.95:200, or e=log:1e-3:0.9:100";

std::vector<std::string_view> parts_of(std::string_view text) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t colon = text.find(':');
        parts.push_back(text.substr(0, colon));
        if (colon == text.npos) return parts;
        text.remove_prefix(colon + 1);
    }
}

void check_name(const SweepAxis& axis, std::string_view text, const SystemDescription& description) {
    Run run = default_run(description);
    if (find_value(description, run, axis.name) != nullptr) return;
    const std::vector<const Option*> options = options_of_axis(axis.name);
    if (options.empty()) {
        std::vector<std::string> others;
        for (const Option& option : all_options())
            if (const std::string name(option.flag.substr(2)); !options_of_axis(name).empty()) others.push_back(name);
        const std::string meant = did_you_mean(axis.name, others);
        throw refusal("--over", text,
                      meant.empty() ? why_not_settable(description, axis.name)
                                    : fmt::format("there is no '{}'{}", shown(axis.name), meant));
    }
    for (const double end : {axis.low, axis.high})
        if (!allows(*options.front(), end))
            throw refusal("--over", text, fmt::format("{} must be positive, and {} is not", axis.name, end));
}

SweepAxis read_axis(std::string_view text, const SystemDescription& description) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos) throw refusal("--over", text, "there are no values", how_to_vary);
    SweepAxis axis;
    axis.name = trimmed(text.substr(0, equals));
    std::vector<std::string_view> parts = parts_of(text.substr(equals + 1));
    axis.logarithmic = trimmed(parts.front()) == "log";
    if (axis.logarithmic) parts.erase(parts.begin());
    if (parts.size() < 2 || parts.size() > 3)
        throw refusal("--over", text, "it has two limits and a number of values", how_to_vary);
    const std::string unit = unit_of(description, axis.name);
    axis.low = number("--over", text, parts[0], unit);
    axis.high = number("--over", text, parts[1], unit);
    check_name(axis, text, description);
    if (axis.low == axis.high)
        throw refusal("--over", text, fmt::format("both limits are {}: nothing varies", axis.low),
                      "one value is --set");
    if (!std::isfinite(axis.high - axis.low)) throw refusal("--over", text, "the limits are too far apart");
    if (axis.logarithmic && !(axis.low > 0.0 && axis.high > 0.0))
        throw refusal("--over", text, "the limits of a logarithmic axis are positive");
    if (parts.size() == 3) axis.count = whole_number("--over", text, parts[2], 2.0);
    return axis;
}

std::vector<SweepAxis> read_axes(const std::vector<std::string>& over, const SystemDescription& description) {
    std::vector<SweepAxis> axes;
    for (const std::string& text : over) {
        const SweepAxis axis = read_axis(text, description);
        for (const SweepAxis& other : axes)
            if (other.name == axis.name) throw refusal("--over", text, fmt::format("{} is varied already", axis.name));
        axes.push_back(axis);
    }
    return axes;
}

std::optional<RandomPoints> read_random(const AskedSweep& asked, const std::vector<SweepAxis>& axes) {
    if (!asked.random) {
        if (asked.seed) throw refusal("--seed", *asked.seed, "this needs --random N");
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (axes[i].count == 0)
                throw refusal("--over", asked.over[i], "a number of values is missing",
                              std::string(how_to_vary) + "; or draw points at random: --random N");
        return std::nullopt;
    }
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (axes[i].count != 0)
            throw refusal("--over", asked.over[i], "it has a number of values, and --random says how many points",
                          fmt::format("write --over {}={}:{}", axes[i].name, axes[i].low, axes[i].high));
    RandomPoints random;
    random.count = whole_number("--random", *asked.random, *asked.random, 1.0);
    if (asked.seed) {
        const std::string text = trimmed(*asked.seed);
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), random.seed);
        if (problem != std::errc() || end != text.data() + text.size())
            throw refusal("--seed", *asked.seed, "a whole number from 0 on is expected");
    }
    return random;
}

// In one line: a heading of a table has no other.
std::string read_print(const std::string& text) {
    std::string print = trimmed(text);
    for (char& c : print)
        if (c == '\n' || c == '\t' || c == '\r') c = ' ';
    if (print.empty()) throw InputError("--print", {}, "an expression is missing");
    return print;
}

std::optional<Section> read_section(const AskedSweep& asked) {
    if (!asked.at) {
        if (asked.after) throw refusal("--after", *asked.after, "this needs --at");
        return std::nullopt;
    }
    Section section;
    const std::string at = trimmed(*asked.at);
    section.kind = at == "impact"    ? Section::Kind::impact
                   : at == "zeno"    ? Section::Kind::zeno
                   : at == "release" ? Section::Kind::release
                                     : Section::Kind::zero;
    if (section.kind == Section::Kind::zero) section.expression = at;
    if (at.empty()) throw InputError("--at", {}, "it is impact, zeno, release or an expression");
    if (!asked.after) return section;
    section.after = number("--after", *asked.after, *asked.after);
    return section;
}

}  // namespace

Sweep make_sweep(const AskedSweep& asked, const Run& base, const SystemDescription& description) {
    Sweep sweep;
    sweep.base = base;
    sweep.axes = read_axes(asked.over, description);
    // Of a section one run may be enough.
    if (sweep.axes.empty() && (!asked.at || asked.random))
        throw InputError("--over", {}, "nothing is varied", how_to_vary);
    sweep.random = read_random(asked, sweep.axes);
    double points = 1.0;
    for (const SweepAxis& axis : sweep.axes) points *= sweep.random ? 1.0 : static_cast<double>(axis.count);
    if (points > static_cast<double>(most_points))
        throw InputError("--over", {},
                         fmt::format("these are {:.3g} points, and a sweep has at most {}", points, most_points));
    for (const std::string& text : asked.prints) {
        const std::string print = read_print(text);
        if (std::find(sweep.prints.begin(), sweep.prints.end(), print) != sweep.prints.end())
            throw refusal("--print", print, "it is printed already");
        sweep.prints.push_back(print);
    }
    if (sweep.prints.empty())
        throw InputError("--print", {}, "nothing is asked of the runs",
                         "write --print WHAT, as in --print \"zeno_time(2)\" or --print outcome");
    sweep.at = read_section(asked);
    return sweep;
}

// ---- one line ----

namespace {

OptionValue option_value(const Option& option, const std::string& text) {
    if (std::holds_alternative<std::string_view>(option.get({}))) {
        const auto found = std::find(option.words.begin(), option.words.end(), text);
        if (found != option.words.end()) return *found;
        const std::vector<std::string> choices(option.words.begin(), option.words.end());
        throw refusal(option.flag, text, fmt::format("there is no '{}'{}", shown(text), did_you_mean(text, choices)));
    }
    const double value = number(option.flag, text, text);
    const OptionValue result = std::holds_alternative<int>(option.get({}))
                                   ? OptionValue(static_cast<int>(std::clamp(value, -1.0, 2e9)))
                                   : value;
    if (!allows(option, result)) throw refusal(option.flag, text, "this is not allowed");
    return result;
}

bool set_option(Run& base, const std::string& flag, const std::string& value) {
    for (const Option& option : all_options())
        if (option.flag == flag) {
            option.set(base.options, option_value(option, value));
            return true;
        }
    return false;
}

}  // namespace

std::string to_text(const Sweep& sweep, const SystemDescription& description) {
    std::vector<Flag> flags;
    const auto add = [&](std::string_view flag, const std::string& value) {
        flags.push_back({std::string(flag), value});
    };
    for (const SweepAxis& axis : sweep.axes)
        add("--over", fmt::format("{}={}{}:{}{}", axis.name, axis.logarithmic ? "log:" : "", axis.low, axis.high,
                                  axis.count == 0 ? "" : fmt::format(":{}", axis.count)));
    if (sweep.random) {
        add("--random", fmt::format("{}", sweep.random->count));
        add("--seed", fmt::format("{}", sweep.random->seed));
    }
    for (const std::string& print : sweep.prints) add("--print", print);
    if (sweep.at) {
        constexpr std::array<const char*, 3> kinds{"impact", "zeno", "release"};
        const bool is_zero = sweep.at->kind == Section::Kind::zero;
        add("--at", is_zero ? sweep.at->expression : kinds[static_cast<std::size_t>(sweep.at->kind)]);
        if (sweep.at->after) add("--after", fmt::format("{}", *sweep.at->after));
    }
    Run base = sweep.base, file = default_run(description);
    for (const std::string& name : settable_names(description)) {
        const double value = *find_value(description, base, name);
        if (value != *find_value(description, file, name)) add("--set", fmt::format("{}={}", name, value));
    }
    for (const Option& option : all_options())
        if (option.get(base.options) != option.get(file.options)) add(option.flag, to_text(option.get(base.options)));
    return to_text(flags);
}

Sweep read_sweep(std::string_view text, const SystemDescription& description) {
    AskedSweep asked;
    Run base = default_run(description);
    const std::vector<std::string> known{"--over", "--print", "--at", "--after", "--random", "--seed", "--set"};
    for (const Flag& one : read_flags(text, "sweep")) {
        const std::string &flag = one.name, &value = one.value;
        const auto only = [&](std::optional<std::string>& place) {
            if (place) throw InputError(shown(flag), {}, "it is given twice");
            place = value;
        };
        if (flag == "--over") {
            asked.over.push_back(value);
        } else if (flag == "--print") {
            asked.prints.push_back(value);
        } else if (flag == "--at") {
            only(asked.at);
        } else if (flag == "--after") {
            only(asked.after);
        } else if (flag == "--random") {
            only(asked.random);
        } else if (flag == "--seed") {
            only(asked.seed);
        } else if (flag == "--set") {
            assign(base, description, value);
        } else if (!set_option(base, flag, value)) {
            throw InputError("sweep", {},
                             fmt::format("'{}' is not expected here{}", shown(flag), did_you_mean(flag, known)));
        }
    }
    if (const auto fault = fault_of_times(base.options)) throw InputError("sweep", {}, *fault);
    return make_sweep(asked, base, description);
}

}  // namespace achilles
