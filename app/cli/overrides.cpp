#include "cli/overrides.hpp"
#include "model/read_system.hpp"

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

SystemDescription adjusted(SystemDescription description, const std::vector<std::string>& settings,
                           const OptionOverrides& overrides) {
    for (const std::string& setting : settings) assign(description, setting);
    apply(overrides, description.options);
    return description;
}

SystemDescription open_system(const std::filesystem::path& file, const std::vector<std::string>& settings,
                              const OptionOverrides& overrides) {
    return adjusted(read_system(file), settings, overrides);
}

void warn(const Options& options) {
    for (const std::string& warning : warnings(options)) fmt::print(stderr, "achilles: warning: {}\n", warning);
}

Run run_of_text(const SystemDescription& description) {
    const SystemDescription text = parse_system(description.source_text, description.file);
    Run run;
    run.options = text.options;
    const auto n = static_cast<Eigen::Index>(text.coordinates.size());
    run.q.resize(n);
    run.v.resize(n);
    for (const ParameterDescription& parameter : text.parameters) run.parameters.push_back(parameter.value);
    for (Eigen::Index i = 0; i < n; ++i) {
        run.q[i] = text.coordinates[static_cast<std::size_t>(i)].start;
        run.v[i] = text.coordinates[static_cast<std::size_t>(i)].rate;
    }
    return run;
}

}  // namespace achilles
