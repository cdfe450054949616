#include "cli/overrides.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace achilles {

std::string common_flag(const Option& option) { return "--" + std::string(option.command); }

const std::pair<const std::string, OptionValue>* OptionOverrides::given(const Option& option) const {
    auto found = by_flag.find(option.flag);
    if (found == by_flag.end()) found = by_flag.find(common_flag(option));
    return found == by_flag.end() ? nullptr : &*found;
}

void apply(const OptionOverrides& overrides, Options& options) {
    const auto check = [](const Option& option, const auto& flag, const OptionValue& value) {
        if (allows(option, value)) return;
        if (std::holds_alternative<double>(value))
            throw InputError(flag, {},
                             fmt::format("the value must be positive and finite, but it is {}", to_text(value)));
        throw InputError(flag, {}, std::string(option.wrong));
    };
    for (const Option& option : all_options()) {
        if (const auto all = overrides.by_flag.find(common_flag(option)); all != overrides.by_flag.end())
            check(option, all->first, all->second);
        if (const auto* given = overrides.given(option)) {
            check(option, given->first, given->second);
            option.set(options, given->second);
        }
    }
}

Run asked_run(const SystemDescription& description, const std::vector<std::string>& settings,
              const OptionOverrides& overrides) {
    Run run = default_run(description);
    for (const std::string& setting : settings) assign(run, description, setting);
    apply(overrides, run.options);
    return run;
}

void warn(const SystemDescription& description, const Run& run) {
    for (const auto& told : {warnings(run.options), outside_ranges(description, run)})
        for (const std::string& warning : told) fmt::print(stderr, "achilles: warning: {}\n", warning);
}

}  // namespace achilles
