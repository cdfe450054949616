// What the command line changes in a run: the top of "command line over file over default".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/trajectory.hpp"
#include "system/description.hpp"

namespace achilles {

// Every option that was given; the others keep what the file or the default says.
struct OptionOverrides {
    std::optional<double> end_time, tolerance;
    std::optional<Method> method;
    std::optional<int> max_impacts;
    std::optional<Conditions> conditions;
    std::optional<Reinitialization> reinitialization;
    std::optional<double> eps;  // all three; --eps-q and its kin go over it
    std::optional<double> eps_q, eps_v, eps_t;
};

// Puts them over the options of a file. Throws InputError (without a location) for a value out of range.
void apply(const OptionOverrides& overrides, Options& options);

// The run of a system that a command line asks for: the file's own, with --set and the options over it. Throws
// InputError.
Run asked_run(const SystemDescription& description, const std::vector<std::string>& settings,
              const OptionOverrides& overrides);

// Tells on standard error what a person should know of the options of a run: core's warnings().
void warn(const Options& options);

}  // namespace achilles
