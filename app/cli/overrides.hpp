// What the command line changes in a system: the top of "command line over file over default".
#pragma once

#include <filesystem>
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

// Puts them over the options of a system just read. Throws InputError (without a location) for a value out of range.
void apply(const OptionOverrides& overrides, Options& options);

// A system with --set and the options over it, ready for Model; from its description, or its file.
SystemDescription adjusted(SystemDescription description, const std::vector<std::string>& settings,
                           const OptionOverrides& overrides);
SystemDescription open_system(const std::filesystem::path& file, const std::vector<std::string>& settings,
                              const OptionOverrides& overrides);

// Tells on standard error what a person should know of the options of a run: core's warnings().
void warn(const Options& options);

// What the text of a system says, whatever the command line put over it: where "reset" leads.
Run run_of_text(const SystemDescription& description);

}  // namespace achilles
