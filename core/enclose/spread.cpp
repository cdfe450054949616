#include "enclose/spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "system/input_error.hpp"

namespace achilles {

namespace {

// Where a claim keeps the interval of a name that a run has a value of.
Interval& place_of(Claim& claim, const SystemDescription& description, const std::string& name) {
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

std::optional<Spread::Side> read_side(const std::string& setting, const SystemDescription& description) {
    const std::size_t dots = setting.find(".."), equals = setting.find('=');
    if (dots == setting.npos || equals == setting.npos || dots < equals) return std::nullopt;
    Spread::Side side{setting.substr(0, equals)};
    side.name.erase(std::remove(side.name.begin(), side.name.end(), ' '), side.name.end());
    const std::array ends{setting.substr(0, dots), setting.substr(0, equals + 1) + setting.substr(dots + 2)};
    const std::array values{&side.low, &side.high};
    for (std::size_t i = 0; i < 2; ++i) {
        Run run = default_run(description);
        assign(run, description, ends[i]);
        *values[i] = *find_value(description, run, side.name);
    }
    if (!(side.low <= side.high))
        throw InputError("--set " + shown(setting), {}, "the interval ends before it begins",
                         fmt::format("write --set {}={}..{}", side.name, side.high, side.low));
    return side;
}

std::string to_text(const Spread::Side& side) { return fmt::format("{}={}..{}", side.name, side.low, side.high); }

std::string told(const Spread& spread) {
    std::string text;
    if (spread.width > 0.0) text = fmt::format("start \u00b1 {}", spread.width);
    for (const Spread::Side& side : spread.sides)
        text += fmt::format("{}{} in [{}, {}]", text.empty() ? "" : ", ", side.name, side.low, side.high);
    return text;
}

Claim claim_of(const SystemDescription& description, const Run& run, const Spread& spread) {
    Claim claim = claim_as_written(run);
    for (const Spread::Side& side : spread.sides)
        place_of(claim, description, side.name) = hull(as_written(side.low), as_written(side.high));
    widen(claim, spread.width);
    return claim;
}

}  // namespace achilles
