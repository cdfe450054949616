#include "run/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <type_traits>
#include <utility>

namespace achilles {

namespace {

// The words of an enumeration, in the order of its enumerators.
template <class Choice>
constexpr std::array<std::string_view, 2> words_of{};
template <>
constexpr std::array<std::string_view, 2> words_of<Method>{"dopri5", "taylor"};
template <>
constexpr std::array<std::string_view, 2> words_of<Conditions>{"paper", "sharp"};
template <>
constexpr std::array<std::string_view, 2> words_of<Reinitialization>{"euclidean", "kinetic"};
template <>
constexpr std::array<std::string_view, 2> words_of<Simultaneous>{"moreau", "stop"};
template <>
constexpr std::array<std::string_view, 2> words_of<EnergyGain>{"cap", "stop"};

template <class Choice>
std::string_view word_of(Choice choice) {
    return words_of<Choice>[static_cast<std::size_t>(choice)];
}

template <class Choice>
std::optional<Choice> choice_from(std::string_view text) {
    const auto& words = words_of<Choice>;
    const auto found = std::find(words.begin(), words.end(), text);
    return found == words.end() ? std::nullopt : std::optional(static_cast<Choice>(found - words.begin()));
}

}  // namespace

std::string_view to_text(Method method) { return word_of(method); }
std::string_view to_text(Conditions conditions) { return word_of(conditions); }
std::string_view to_text(Reinitialization kind) { return word_of(kind); }
std::string_view to_text(Simultaneous kind) { return word_of(kind); }
std::string_view to_text(EnergyGain kind) { return word_of(kind); }
std::optional<Method> method_from(std::string_view text) { return choice_from<Method>(text); }
std::optional<Conditions> conditions_from(std::string_view text) { return choice_from<Conditions>(text); }
std::optional<Reinitialization> reinitialization_from(std::string_view text) {
    return choice_from<Reinitialization>(text);
}

std::string to_text(const OptionValue& value) {
    return std::visit([](const auto& x) { return fmt::format("{}", x); }, value);
}

namespace {

// The member at the end of a chain of member pointers.
template <auto first, auto... rest, class Owner>
auto& member(Owner& owner) {
    if constexpr (sizeof...(rest) == 0)
        return owner.*first;
    else
        return member<rest...>(owner.*first);
}

// Completes a row with what follows from the member: getter, setter and words.
template <auto... path>
constexpr Option at(Option entry) {
    using Value = std::remove_cvref_t<decltype(member<path...>(std::declval<Options&>()))>;
    entry.get = [](const Options& options) -> OptionValue {
        if constexpr (std::is_enum_v<Value>)
            return word_of(member<path...>(options));
        else
            return member<path...>(options);
    };
    entry.set = [](Options& options, const OptionValue& value) {
        if constexpr (std::is_enum_v<Value>)
            member<path...>(options) = choice_from<Value>(std::get<std::string_view>(value)).value();
        else
            member<path...>(options) = std::get<Value>(value);
    };
    if constexpr (std::is_enum_v<Value>) entry.words = words_of<Value>;
    return entry;
}

constexpr auto cut = &Options::truncation;
constexpr std::string_view usage_of_eps = "write: eps 1e-6, or: eps POSITION VELOCITY TIME";
constexpr std::string_view wrong_eps = "eps must be positive and finite, not {}";

constexpr std::array rows{
    at<&Options::start_time>({.key = "start_time",
                              .table = "run",
                              .flag = "--start-time",
                              .command = "start-time",
                              .usage = "write: start-time NUMBER",
                              .error_text = "the start time must be finite, not {}",
                              .unit = "s",
                              .help = "start time of the run",
                              .summary_text = "start time {}",
                              .omit_if_default = true,
                              .any_sign = true}),
    at<&Options::end_time>({.key = "end_time",
                            .table = "run",
                            .flag = "--end",
                            .command = "end",
                            .usage = "write: end NUMBER",
                            .error_text = "the end time must be finite, not {}",
                            .unit = "s",
                            .help = "end time of the run",
                            .summary_text = "end time {}",
                            .any_sign = true}),
    at<&Options::tolerance>({.key = "tolerance",
                             .table = "run",
                             .flag = "--tolerance",
                             .command = "tolerance",
                             .usage = "write: tolerance NUMBER",
                             .error_text = "the tolerance must be positive and finite, not {}",
                             .help = "local error per step, absolute and relative",
                             .summary_text = "tolerance {}",
                             .is_tolerance = true}),
    at<&Options::method>({.key = "method",
                          .table = "run",
                          .flag = "--method",
                          .command = "method",
                          .usage = "write: method taylor, or: method dopri5",
                          .error_text = "unknown method '{}'",
                          .help = "integration method",
                          .summary_text = "method {}"}),
    at<&Options::max_impacts>({.key = "max_impacts",
                               .table = "run",
                               .flag = "--max-impacts",
                               .command = "max-impacts",
                               .usage = "write: max-impacts NUMBER",
                               .error_text = "at least one impact must be allowed",
                               .help = "maximum number of impacts in the run",
                               .summary_text = "at most {} impacts"}),
    at<&Options::max_steps>({.key = "max_steps",
                             .table = "run",
                             .flag = "--max-steps",
                             .command = "max-steps",
                             .usage = "write: max-steps NUMBER",
                             .error_text = "at least one step must be allowed",
                             .help = "maximum number of integration steps in the run",
                             .summary_text = "at most {} steps",
                             .omit_if_default = true}),
    at<&Options::memory>({.key = "memory",
                          .table = "run",
                          .flag = "--memory",
                          .command = "memory",
                          .usage = "write: memory BYTES",
                          .error_text = "the memory must be positive and finite, not {}",
                          .unit = "bytes",
                          .help = "maximum memory for the stored run",
                          .summary_text = "at most {} bytes",
                          .omit_if_default = true}),
    at<&Options::simultaneous>({.key = "simultaneous",
                                .table = "run",
                                .flag = "--simultaneous",
                                .command = "simultaneous",
                                .usage = "write: simultaneous moreau, or: simultaneous stop",
                                .error_text = "unknown value '{}' for simultaneous: use moreau or stop",
                                .help = "how simultaneous impacts with an order-dependent outcome are resolved",
                                .summary_text = "simultaneous impacts: {}",
                                .omit_if_default = true}),
    at<&Options::energy_gain>({.key = "energy_gain",
                               .table = "run",
                               .flag = "--energy-gain",
                               .command = "energy-gain",
                               .usage = "write: energy-gain cap, or: energy-gain stop",
                               .error_text = "unknown value '{}' for energy-gain: use cap or stop",
                               .help = "with friction: what happens at an impact that would gain energy",
                               .summary_text = "energy gain at impacts: {}",
                               .omit_if_default = true,
                               .is_of_friction = true}),
    at<&Options::max_events>({.key = "max_events",
                              .table = "run",
                              .flag = "--max-events",
                              .command = "max-events",
                              .usage = "write: max-events NUMBER",
                              .error_text = "at least one event must be allowed",
                              .help = "with friction: maximum number of sticks, slips and reversals in the run",
                              .summary_text = "at most {} sticks, slips and reversals",
                              .omit_if_default = true,
                              .is_of_friction = true}),
    at<cut, &Truncation::eps_q>({.key = "eps_q",
                                 .table = "truncation",
                                 .flag = "--eps-q",
                                 .command = "eps",
                                 .usage = usage_of_eps,
                                 .error_text = wrong_eps,
                                 .help = "maximum position error between the cut and the Zeno time, Euclidean norm",
                                 .summary_text = "eps_q {}",
                                 .is_tolerance = true}),
    at<cut, &Truncation::eps_v>({.key = "eps_v",
                                 .table = "truncation",
                                 .flag = "--eps-v",
                                 .command = "eps",
                                 .usage = usage_of_eps,
                                 .error_text = wrong_eps,
                                 .help = "maximum velocity error at the Zeno time, Euclidean norm",
                                 .summary_text = "eps_v {}",
                                 .is_tolerance = true}),
    at<cut, &Truncation::eps_t>({.key = "eps_t",
                                 .table = "truncation",
                                 .flag = "--eps-t",
                                 .command = "eps",
                                 .usage = usage_of_eps,
                                 .error_text = wrong_eps,
                                 .unit = "s",
                                 .help = "maximum half-width of the interval that contains the Zeno time",
                                 .summary_text = "eps_t {}",
                                 .is_tolerance = true}),
    at<cut, &Truncation::conditions>({.key = "conditions",
                                      .table = "truncation",
                                      .flag = "--conditions",
                                      .command = "conditions",
                                      .usage = "write: conditions paper, or: conditions sharp",
                                      .error_text = "unknown conditions '{}'",
                                      .help = "criterion for truncating the impact sequence: paper (Def. 7) or sharp",
                                      .summary_text = "{} conditions"}),
    at<cut, &Truncation::reinitialization>({.key = "reinitialization",
                                            .table = "truncation",
                                            .flag = "--reinitialization",
                                            .command = "reinitialization",
                                            .usage = "write: reinitialization kinetic, or: reinitialization euclidean",
                                            .error_text = "unknown reinitialization '{}'",
                                            .help = "velocity at the start of contact",
                                            .summary_text = "{} reinitialization"}),
};

}  // namespace

std::span<const Option> all_options() { return rows; }

const Option& option(std::string_view key) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Option& o) { return o.key == key; });
    assert(found != rows.end());
    return *found;
}

std::span<const Option> options_set_by(std::string_view command) {
    const auto is_of_it = [&](const Option& o) { return o.command == command; };
    const auto first = std::find_if(rows.begin(), rows.end(), is_of_it);
    return {first, std::find_if_not(first, rows.end(), is_of_it)};
}

std::vector<std::span<const Option>> options_by_command() {
    std::vector<std::span<const Option>> groups;
    for (auto rest = all_options(); !rest.empty(); rest = rest.subspan(groups.back().size()))
        groups.push_back(options_set_by(rest.front().command));
    return groups;
}

std::vector<std::span<const Option>> options_by_command(const Options& from, const Options& to) {
    auto groups = options_by_command();
    const auto of = [&](std::string_view key) {
        return std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group[0].key == key; });
    };
    if (to.start_time >= from.end_time) std::swap(*of("start_time"), *of("end_time"));
    return groups;
}

std::vector<const Option*> options_in_report_order(std::initializer_list<std::string_view> first) {
    std::vector<const Option*> ordered;
    for (const Option& o : rows) ordered.push_back(&o);
    const auto rank = [&](const Option* o) {
        const auto named = std::find(first.begin(), first.end(), o->key);
        const bool is_of_cut = o->table == "truncation";
        return (named - first.begin()) + (is_of_cut ? 1 : 0) + (is_of_cut && o->words.empty() ? 1 : 0);
    };
    std::stable_sort(ordered.begin(), ordered.end(),
                     [&](const Option* a, const Option* b) { return rank(a) < rank(b); });
    return ordered;
}

bool is_left_out(const Option& option, const Options& options) {
    return option.is_of_friction && option.get(options) == option.get({});
}

bool is_valid_value(const Option& option, const OptionValue& value) {
    if (const auto* number = std::get_if<double>(&value))
        return std::isfinite(*number) && (option.any_sign || *number > 0.0);
    if (const auto* whole = std::get_if<int>(&value)) return *whole >= 1;
    const auto& words = option.words;
    return std::find(words.begin(), words.end(), std::get<std::string_view>(value)) != words.end();
}

std::string summary_text(const Option& option, const Options& options, std::string_view number) {
    const OptionValue value = option.get(options);
    const auto* x = std::get_if<double>(&value);
    return fmt::format(fmt::runtime(option.summary_text), x ? fmt::format(fmt::runtime(number), *x) : to_text(value));
}

std::vector<std::string> warnings(const Options& options) {
    std::vector<std::string> messages;
    for (const Option& o : all_options())
        if (o.is_tolerance && std::get<double>(o.get(options)) < min_tolerance)
            messages.push_back(fmt::format("{} = {} is below what double precision supports; using {}", o.key,
                                           to_text(o.get(options)), min_tolerance));
    return messages;
}

void clamp_tolerances(Options& options) {
    for (const Option& o : all_options())
        if (o.is_tolerance) o.set(options, std::max(std::get<double>(o.get(options)), min_tolerance));
}

std::optional<std::string> end_time_error(const Options& options) {
    if (!(options.end_time <= options.start_time)) return std::nullopt;
    return fmt::format("the end time {} is not after the start time {}", options.end_time, options.start_time);
}

std::vector<std::string> validation_errors(const Options& options) {
    std::vector<std::string> messages;
    for (const Option& o : all_options()) {
        if (!o.words.empty()) continue;  // Options cannot hold an invalid word
        const OptionValue value = o.get(options);
        if (is_valid_value(o, value)) continue;
        messages.push_back(std::holds_alternative<double>(value)
                               ? fmt::format("{} must be a {} number, but it is {}", o.key,
                                             o.any_sign ? "finite" : "positive", to_text(value))
                               : fmt::format("{} must be at least 1", o.key));
    }
    if (const auto fault = end_time_error(options)) messages.push_back(*fault);
    return messages;
}

}  // namespace achilles
