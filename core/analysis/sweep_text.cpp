// The text form of a sweep: parsing, error messages, and printing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "analysis/sweep.hpp"
#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr std::string_view unquoted_characters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%^";

// Quotes a text if necessary. Expressions contain no double quotes and nothing that a shell interprets inside them.
std::string quoted(const std::string& text) {
    const bool is_bare = !text.empty() && text.find_first_not_of(unquoted_characters) == text.npos;
    return is_bare ? text : "\"" + text + "\"";
}

std::vector<std::string> words_of(std::string_view text, const std::string& whose) {
    std::vector<std::string> words;
    bool inside = false, open = false;
    for (const char c : text) {
        if (c == '"') {
            open = !open;
            if (!inside) words.emplace_back();
            inside = true;
        } else if (c == ' ' && !open) {
            inside = false;
        } else {
            if (!inside) words.emplace_back();
            inside = true;
            words.back() += c;
        }
    }
    if (open) throw InputError(whose, {}, "a quote is never closed");
    return words;
}

}  // namespace

std::vector<Flag> read_flags(std::string_view text, const std::string& whose) {
    const std::vector<std::string> words = words_of(text, whose);
    std::vector<Flag> flags;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        if (i + 1 == words.size()) throw InputError(shown(words[i]), {}, "a value is missing");
        flags.push_back({words[i], words[i + 1]});
    }
    return flags;
}

std::string to_text(const std::vector<Flag>& flags) {
    std::string text;
    for (const Flag& flag : flags) text += (text.empty() ? "" : " ") + flag.name + " " + quoted(flag.value);
    return text;
}

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

// Parses a whole number from `least` to max_sweep_points.
std::uint64_t whole_number(std::string_view flag, std::string_view whole, std::string_view text, double least) {
    const double value = number(flag, whole, text);
    if (!(value >= least) || value != std::floor(value))
        throw refusal(
            flag, whole,
            fmt::format("the number of values must be a whole number of at least {}, not {}", least, trimmed(text)),
            least > 1.0 ? "for one value use --set" : "");
    if (value > static_cast<double>(max_sweep_points))
        throw refusal(flag, whole, fmt::format("a sweep has at most {} points", max_sweep_points));
    return static_cast<std::uint64_t>(value);
}

constexpr const char* how_to_vary =
    "write --over NAME=LOW:HIGH:COUNT, as in --over e=0:0.95:200, or e=log:1e-3:0.9:100";

// Converts other notations, 0..0.9:10, 0,0.9,10, [0,0.9,10] and linspace(0,0.9,10), to "0:0.9:10"; "" if the text is
// none of these.
std::string with_colons(std::string text) {
    std::erase(text, ' ');
    for (const char* call : {"np.linspace(", "linspace(", "["})
        if (text.starts_with(call)) text = text.substr(std::string_view(call).size());
    while (text.ends_with(')') || text.ends_with(']')) text.pop_back();
    if (text.starts_with("lin:")) return text.substr(4);
    bool changed = false;
    for (const char* sign : {"...", "..", ","})
        for (std::size_t at = text.find(sign); at != text.npos; at = text.find(sign), changed = true)
            text.replace(at, std::string_view(sign).size(), ":");
    const auto colons = std::count(text.begin(), text.end(), ':');
    if (!changed || text.starts_with(':') || text.ends_with(':')) return "";
    return colons == 1 ? text + ":COUNT" : colons == 2 ? text : "";
}

// Converts LOW:STEP:HIGH (Matlab) to LOW:HIGH:COUNT; "" if the numbers do not fit.
std::string from_steps(double low, double step, double high) {
    const double steps = (high - low) / step, count = std::round(steps) + 1.0;
    if (!(count >= 2.0 && count <= 1e6) || std::abs(steps - std::round(steps)) > 1e-6) return "";
    return fmt::format("{}:{}:{}", low, high, count);
}

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
        if (!is_valid_value(*options.front(), end))
            throw refusal("--over", text, fmt::format("{} must be positive, but {} is not", axis.name, end));
}

// Error message for an axis given as several words: "e 0 0.9 10" instead of e=0:0.9:10.
InputError apart(const std::vector<std::string>& words) {
    std::string values;
    for (std::size_t i = 1; i < words.size(); ++i) values += (i == 1 ? "" : ":") + words[i];
    return refusal("--over", fmt::format("{}", fmt::join(words, " ")), "an axis must be one word",
                   words.size() == 4 ? fmt::format("write --over {}={}", words[0], values) : how_to_vary);
}

SweepAxis read_axis(std::string_view text, const SystemDescription& description) {
    const std::size_t equals = text.find('='), first_colon = text.find(':');
    if (equals == text.npos && first_colon != text.npos)
        throw refusal("--over", text, "an equals sign is missing",
                      fmt::format("write --over {}={}", text.substr(0, first_colon), text.substr(first_colon + 1)));
    if (equals == text.npos) throw refusal("--over", text, "the values are missing", how_to_vary);
    SweepAxis axis;
    axis.name = trimmed(text.substr(0, equals));
    const std::string right = with_colons(std::string(text.substr(equals + 1)));
    std::vector<std::string_view> parts = parts_of(text.substr(equals + 1));
    const bool is_decimal = parts.size() > 2 && right.find("COUNT") == right.npos;  // a decimal comma, as in 0,1:1:3
    if (!right.empty() && !is_decimal)
        throw refusal("--over", text, "the limits and the number of values must be separated by colons",
                      fmt::format("write --over {}={}", axis.name, right));
    axis.logarithmic = trimmed(parts.front()) == "log";
    if (axis.logarithmic) parts.erase(parts.begin());
    if (parts.size() == 1 && !axis.logarithmic)
        throw refusal(
            "--over", text, "this is a single value",
            fmt::format("write --over {0}=LOW:HIGH:COUNT; for one value use --set {0}={1}", axis.name, parts[0]));
    if (parts.size() < 2 || parts.size() > 3)
        throw refusal("--over", text, "two limits and a number of values are expected", how_to_vary);
    const std::string unit = unit_of(description, axis.name);
    axis.low = number("--over", text, parts[0], unit);
    axis.high = number("--over", text, parts[1], unit);
    check_name(axis, text, description);
    const double count = parts.size() == 3 ? number("--over", text, parts[2]) : 0.0;
    const std::string ours = parts.size() == 3 ? from_steps(axis.low, axis.high, count) : "";
    if (!ours.empty() && !axis.logarithmic && (count < 2.0 || count != std::floor(count)) && axis.high < count)
        throw refusal("--over", text, "the order is LOW:HIGH:COUNT, not LOW:STEP:HIGH",
                      fmt::format("write --over {}={}", axis.name, ours));
    if (axis.low == axis.high)
        throw refusal("--over", text, fmt::format("both limits are {}: nothing varies", axis.low),
                      "for one value use --set");
    if (!std::isfinite(axis.high - axis.low)) throw refusal("--over", text, "the limits are too far apart");
    if (axis.logarithmic && !(axis.low > 0.0 && axis.high > 0.0))
        throw refusal("--over", text, "the limits of a logarithmic axis must be positive");
    if (parts.size() < 3) return axis;
    axis.count = whole_number("--over", text, parts[2], 2.0);
    return axis;
}

std::vector<SweepAxis> read_axes(const std::vector<std::string>& over, const SystemDescription& description) {
    std::vector<SweepAxis> axes;
    const auto has_no_values = [](const std::string& text) { return text.find_first_of("=:") == text.npos; };
    const auto bare = std::find_if(over.begin(), over.end(), has_no_values);
    if (const auto end = std::find_if_not(bare, over.end(), has_no_values); end - bare > 1) throw apart({bare, end});
    for (const std::string& text : over) {
        const SweepAxis axis = read_axis(text, description);
        for (const SweepAxis& other : axes)
            if (other.name == axis.name) throw refusal("--over", text, fmt::format("{} is already varied", axis.name));
        axes.push_back(axis);
    }
    return axes;
}

std::optional<RandomPoints> read_random(const SweepOptions& typed, const std::vector<SweepAxis>& axes) {
    if (!typed.random) {
        if (typed.seed)
            throw refusal("--seed", *typed.seed,
                          "this has an effect only with --random N, which draws N points from the ranges of --over");
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (axes[i].count == 0)
                throw refusal("--over", typed.over[i], "the number of values is missing",
                              std::string(how_to_vary) + "; or draw points at random: --random N");
        return std::nullopt;
    }
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (axes[i].count != 0)
            throw refusal("--over", typed.over[i],
                          "--random gives the number of points, so the number of values is not allowed",
                          fmt::format("write --over {}={}:{}", axes[i].name, axes[i].low, axes[i].high));
    RandomPoints random;
    random.count = whole_number("--random", *typed.random, *typed.random, 1.0);
    if (typed.seed) {
        const std::string text = trimmed(*typed.seed);
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), random.seed);
        if (problem != std::errc() || end != text.data() + text.size())
            throw refusal("--seed", *typed.seed, "a whole number of at least 0 is expected");
    }
    return random;
}

// Splits at commas outside of parentheses; a comma between digits is a decimal comma.
std::vector<std::string> parts_between_commas(const std::string& text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto is_digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
        depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        if (text[i] == ',' && depth == 0 && !(i > 0 && is_digit(i - 1) && is_digit(i + 1)))
            parts.emplace_back();
        else
            parts.back() += text[i];
    }
    for (std::string& part : parts) part = trimmed(part);
    return parts;
}

// Replaces line breaks, because the print is a column heading.
std::string read_print(const std::string& text) {
    std::string print = trimmed(text);
    for (char& c : print)
        if (c == '\n' || c == '\t' || c == '\r') c = ' ';
    if (print.empty()) throw InputError("--print", {}, "an expression is missing");
    if (const std::vector<std::string> several = parts_between_commas(print); several.size() > 1) {
        std::string right = "write";
        for (const std::string& one : several)
            right += one.find(' ') == one.npos ? fmt::format(" --print {}", one) : fmt::format(" --print \"{}\"", one);
        throw refusal("--print", print, "each expression needs its own --print", right);
    }
    return print;
}

std::optional<Section> read_section(const SweepOptions& typed) {
    if (!typed.at) {
        if (typed.after) throw refusal("--after", *typed.after, "this needs --at");
        return std::nullopt;
    }
    Section section;
    const std::string at = trimmed(*typed.at);
    const auto names =
        std::find_if(event_names.begin(), event_names.end(), [&](const EventNames& one) { return one.word == at; });
    section.event = names != event_names.end() ? std::optional(names->kind) : std::nullopt;
    if (!section.event) section.expression = at;
    if (!at.empty() && !section.event && names_in(at).empty())
        throw refusal("--at", at, "a constant never crosses zero",
                      fmt::format("write --at \"t - {}\" for an instant, or impact, zeno, release", at));
    if (at.empty()) throw InputError("--at", {}, "impact, zeno, release or an expression is expected");
    if (!typed.after) return section;
    section.after = number("--after", *typed.after, *typed.after);
    return section;
}

// Refuses an axis whose name is also set to a single value.
void refuse_fixed(const SweepAxis& axis, const std::vector<std::string>& fixed) {
    for (const std::string& name : fixed) {
        const std::vector<const Option*> options = options_of_axis(axis.name);
        const bool is_option = std::any_of(options.begin(), options.end(), [&](const Option* option) {
            return option->flag == name || "--" + std::string(option->command) == name;
        });
        if (name != axis.name && !is_option) continue;
        const std::string given = is_option ? name : "--set " + name;
        throw refusal("--over", axis.name, fmt::format("it is both varied and fixed, by {}", given),
                      fmt::format("remove {} or --over {}", given, axis.name));
    }
}

// Refuses to print a varied parameter, which already has a column. A varied initial coordinate may be printed, because
// its value at the end is another quantity.
void refuse_axis(const std::string& print, const SweepSpec& sweep, const SystemDescription& description) {
    for (const SweepAxis& axis : sweep.axes)
        if (axis.name == print && std::none_of(description.coordinates.begin(), description.coordinates.end(),
                                               [&](const auto& c) { return print == c.name || print == c.name + "'"; }))
            throw refusal("--print", print, fmt::format("{} is varied: it is already a column", print), "remove it");
}

}  // namespace

SweepSpec make_sweep(const SweepOptions& typed, const Run& base, const SystemDescription& description) {
    SweepSpec sweep;
    sweep.axes = read_axes(typed.over, description);
    for (const SweepAxis& axis : sweep.axes) refuse_fixed(axis, typed.fixed);
    sweep.base = without_axes(base, sweep.axes, default_run(description), description);
    // With a section, a single run may be enough.
    if (sweep.axes.empty() && (!typed.at || typed.random))
        throw InputError("--over", {}, "nothing is varied", how_to_vary);
    sweep.random = read_random(typed, sweep.axes);
    double points = 1.0;
    for (const SweepAxis& axis : sweep.axes) points *= sweep.random ? 1.0 : static_cast<double>(axis.count);
    if (points > static_cast<double>(max_sweep_points))
        throw InputError("--over", {}, fmt::format("too many points: {:.3g} (maximum {})", points, max_sweep_points));
    for (const std::string& text : typed.prints) {
        const std::string print = read_print(text);
        if (std::find(sweep.prints.begin(), sweep.prints.end(), print) != sweep.prints.end())
            throw refusal("--print", print, "it is already printed");
        refuse_axis(print, sweep, description);
        sweep.prints.push_back(print);
    }
    if (sweep.prints.empty())
        throw InputError("--print", {}, "name at least one quantity to print",
                         "write --print WHAT, as in --print \"zeno_time(2)\" or --print outcome");
    sweep.at = read_section(typed);
    return sweep;
}

// ---- one-line text ----

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
    if (!is_valid_value(option, result)) throw refusal(option.flag, text, "this value is not allowed");
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

std::string to_text(const SweepSpec& sweep, const SystemDescription& description) {
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
        const auto& [event, expression, after] = *sweep.at;
        add("--at", event ? std::string(names_of(*event).word) : expression);
        if (after) add("--after", fmt::format("{}", *after));
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

SweepSpec read_sweep(std::string_view text, const SystemDescription& description) {
    SweepOptions typed;
    Run base = default_run(description);
    const std::vector<std::string> known{"--over", "--print", "--at", "--after", "--random", "--seed", "--set"};
    for (const Flag& one : read_flags(text, "sweep")) {
        const std::string &flag = one.name, &value = one.value;
        const auto only = [&](std::optional<std::string>& place) {
            if (place) throw InputError(shown(flag), {}, "it is given twice");
            place = value;
        };
        if (flag == "--over") {
            typed.over.push_back(value);
        } else if (flag == "--print") {
            typed.prints.push_back(value);
        } else if (flag == "--at") {
            only(typed.at);
        } else if (flag == "--after") {
            only(typed.after);
        } else if (flag == "--random") {
            only(typed.random);
        } else if (flag == "--seed") {
            only(typed.seed);
        } else if (flag == "--set") {
            assign(base, description, value);
            typed.fixed.push_back(trimmed(value.substr(0, value.find('='))));
        } else if (set_option(base, flag, value)) {
            typed.fixed.push_back(flag);
        } else {
            throw InputError("sweep", {},
                             fmt::format("'{}' is not expected here{}", shown(flag), did_you_mean(flag, known)));
        }
    }
    if (const auto fault = end_time_error(base.options)) throw InputError("sweep", {}, *fault);
    return make_sweep(typed, base, description);
}

}  // namespace achilles
