#include "enclose/initial_uncertainty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "expression/parse.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// The interval of a claim for a name of the run.
Interval& place_of(EnclosureProblem& claim, const SystemDescription& description, const std::string& name) {
    Run marked = claim.run;
    for (auto* values : {&marked.q, &marked.v}) values->setZero();
    for (double& value : marked.parameters) value = 0.0;
    *find_value(description, marked, name) = 1.0;
    for (std::size_t i = 0; i < claim.q.size(); ++i) {
        if (marked.q[static_cast<Eigen::Index>(i)] != 0.0) return claim.q[i];
        if (marked.v[static_cast<Eigen::Index>(i)] != 0.0) return claim.v[i];
    }
    std::size_t at = 0;
    while (marked.parameters[at] == 0.0) ++at;
    return claim.parameters[at];
}

}  // namespace

namespace {

// Converts other notations of an interval to LOW..HIGH: 0.4:0.6, [0.4, 0.6], 0.5±0.1, 0.5+-0.1, 0.4...0.6; "" if it is
// not an interval.
std::string other_interval(std::string text) {
    std::erase(text, ' ');
    const auto between = [&](std::string_view sign) -> std::optional<std::pair<std::string, std::string>> {
        const std::size_t at = text.find(sign);
        if (at == text.npos || at == 0 || at + sign.size() >= text.size()) return std::nullopt;
        return std::pair{text.substr(0, at), text.substr(at + sign.size())};
    };
    for (const char* sign : {"\u00b1", "+-", "+/-"})
        if (const auto parts = between(sign)) {
            try {
                const double middle = read_number(parts->first).value, half = read_number(parts->second).value;
                return fmt::format("{:.12g}..{:.12g}", middle - half, middle + half);
            } catch (const ParseError&) {
                return "";
            }
        }
    const bool is_list = text.starts_with("[") && text.ends_with("]");  // otherwise a comma is a decimal comma
    if (is_list) text = text.substr(1, text.size() - 2);
    for (const char* sign : {"...", ":", ",", "\u2026"})
        if (const auto parts = between(sign);
            parts && (is_list || *sign != ',') && parts->second.find_first_of(":,") == std::string::npos)
            return parts->first + ".." + parts->second;
    return "";
}

}  // namespace

std::optional<InitialUncertainty::VariableRange> parse_interval(const std::string& setting,
                                                                const SystemDescription& description) {
    if (const std::size_t at = setting.find('='); at != setting.npos)
        if (const std::string right = other_interval(setting.substr(at + 1)); !right.empty())
            throw InputError("--set " + shown(setting), {}, "an interval is written LOW..HIGH",
                             fmt::format("write --set {}={}", setting.substr(0, at), right));
    const std::size_t dots = setting.find(".."), equals = setting.find('=');
    if (dots == setting.npos || equals == setting.npos || dots < equals) return std::nullopt;
    InitialUncertainty::VariableRange side{setting.substr(0, equals)};
    side.name.erase(std::remove(side.name.begin(), side.name.end(), ' '), side.name.end());
    const std::array ends{setting.substr(0, dots), setting.substr(0, equals + 1) + setting.substr(dots + 2)};
    const std::array values{&side.low, &side.high};
    if (dots == equals + 1 || dots + 2 == setting.size())
        throw InputError("--set " + shown(setting), {}, "an end of the interval is missing",
                         fmt::format("write --set {}=LOW..HIGH", side.name));
    for (std::size_t i = 0; i < 2; ++i) {
        Run run = default_run(description);
        assign(run, description, ends[i]);
        *values[i] = *find_value(description, run, side.name);
    }
    if (!(side.low <= side.high))
        throw InputError("--set " + shown(setting), {}, "LOW is above HIGH",
                         fmt::format("write --set {}={}..{}", side.name, side.high, side.low));
    return side;
}

std::string to_text(const InitialUncertainty::VariableRange& side) {
    return fmt::format("{}={}..{}", side.name, side.low, side.high);
}

std::string describe(const InitialUncertainty& spread) {
    std::string text;
    if (spread.width > 0.0) text = fmt::format("start \u00b1 {}", spread.width);
    for (const InitialUncertainty::VariableRange& side : spread.sides)
        text += fmt::format("{}{} in [{}, {}]", text.empty() ? "" : ", ", side.name, side.low, side.high);
    return text;
}

EnclosureProblem problem_of(const SystemDescription& description, const Run& run, const InitialUncertainty& spread) {
    EnclosureProblem claim = problem_from_decimals(run);
    for (const InitialUncertainty::VariableRange& side : spread.sides)
        place_of(claim, description, side.name) = hull(interval_of_decimal(side.low), interval_of_decimal(side.high));
    inflate(claim, spread.width);
    return claim;
}

}  // namespace achilles
