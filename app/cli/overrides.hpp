// Changes that the command line makes to a run: the command line overrides the file, which overrides the defaults.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "enclose/initial_uncertainty.hpp"
#include "system/description.hpp"

namespace achilles {

class Model;

// Options given on the command line, by flag. All others keep the value of the file or the default. `--eps` sets the
// three values of the explorer's command `eps`; --eps-q etc. override it.
struct OptionOverrides {
    std::map<std::string, OptionValue, std::less<>> by_flag;

    // The flag and value given for an option; null if none was given.
    const std::pair<const std::string, OptionValue>* find(const Option& option) const;
};
// The flag that sets all options of one explorer command. Most commands set a single option: then it is that option's
// flag.
std::string common_flag(const Option& option);

// Parses a complete number by read_number(). CLI11 would accept more (hexadecimal, "nan"). Throws InputError.
double number_from(const std::string& option, std::string_view text, std::string_view unit = {});

// Parses the value of an option: one of its words, an integer, or a number. Throws InputError about the flag.
OptionValue value_from(const Option& option, const std::string& flag, const std::string& text);

// Applies the overrides to the options of a file. Throws InputError (without a location) for a value out of range.
void apply(const OptionOverrides& overrides, Options& options);

// The options memory and max_steps from the command line, or their defaults.
Options work_options(const OptionOverrides& overrides);

// The run specified by a command line: the file's run with --set and options applied. Throws InputError.
Run requested_run(const SystemDescription& description, const std::vector<std::string>& settings,
                  const OptionOverrides& overrides);

// Names fixed by the command line: those of --set, and the flags of options.
std::vector<std::string> fixed_names(const std::vector<std::string>& settings, const OptionOverrides& overrides);

// Parses settings that may be intervals, NAME=LOW..HIGH. `points` receives the settings with the midpoint of each
// interval. Throws InputError.
InitialUncertainty parse_uncertainty(const std::vector<std::string>& settings, double width,
                                     const SystemDescription& description, std::vector<std::string>& points);

// Model::check(), but if a --set value causes the error, the message names that setting instead of a line of the file.
// Throws InputErrors.
void validate_overrides(const Model& model, const Run& run, const std::vector<std::string>& settings);

// Prints the warnings about a run to standard error: core's warnings(), outside_ranges() and unseen_lines().
void warn(const SystemDescription& description, const Run& run);

}  // namespace achilles
