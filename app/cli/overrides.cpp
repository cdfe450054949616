#include "cli/overrides.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace achilles {

namespace {

void put_positive(double& target, const std::optional<double>& value, const char* option) {
    if (!value) return;
    if (!(std::isfinite(*value) && *value > 0.0))
        throw InputError(option, {}, fmt::format("the value must be positive and finite, but it is {}", *value));
    target = *value;
}

}  // namespace

void apply(const OptionOverrides& overrides, Options& options) {
    Truncation& truncation = options.truncation;
    put_positive(options.end_time, overrides.end_time, "--end");
    put_positive(options.tolerance, overrides.tolerance, "--tolerance");
    if (overrides.method) options.method = *overrides.method;
    if (overrides.max_impacts) {
        if (*overrides.max_impacts < 1) throw InputError("--max-impacts", {}, "at least one impact must be allowed");
        options.max_impacts = *overrides.max_impacts;
    }
    if (overrides.conditions) truncation.conditions = *overrides.conditions;
    if (overrides.reinitialization) truncation.reinitialization = *overrides.reinitialization;
    for (double* eps : {&truncation.eps_q, &truncation.eps_v, &truncation.eps_t})
        put_positive(*eps, overrides.eps, "--eps");
    put_positive(truncation.eps_q, overrides.eps_q, "--eps-q");
    put_positive(truncation.eps_v, overrides.eps_v, "--eps-v");
    put_positive(truncation.eps_t, overrides.eps_t, "--eps-t");
}

Run asked_run(const SystemDescription& description, const std::vector<std::string>& settings,
              const OptionOverrides& overrides) {
    Run run = default_run(description);
    for (const std::string& setting : settings) assign(run, description, setting);
    apply(overrides, run.options);
    return run;
}

void warn(const Options& options) {
    for (const std::string& warning : warnings(options)) fmt::print(stderr, "achilles: warning: {}\n", warning);
}

}  // namespace achilles
