// What the command line changes in a run: the top of "command line over file over default".
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "enclose/spread.hpp"
#include "system/description.hpp"

namespace achilles {

class Model;

// The options that were given, by flag; the others keep what the file or the default says. `--eps` gives the three of
// the explorer's command `eps`, and --eps-q and its kin go over it.
struct OptionOverrides {
    std::map<std::string, OptionValue, std::less<>> by_flag;

    // What was given for an option: the flag, and its value; null if nothing was.
    const std::pair<const std::string, OptionValue>* given(const Option& option) const;
};
// The flag that gives all options of one command of the explorer. Most stand alone: it is theirs.
std::string common_flag(const Option& option);

// A number as read_number() takes it, all of it; CLI11 would take more (hexadecimal, "nan"). Throws InputError.
double number_from(const std::string& option, std::string_view text, std::string_view unit = {});

// The value of an option as typed: one of its words, a whole number, or a number. Throws InputError about the flag.
OptionValue value_from(const Option& option, const std::string& flag, const std::string& text);

// Puts them over the options of a file. Throws InputError (without a location) for a value out of range.
void apply(const OptionOverrides& overrides, Options& options);

// What a command line says of the work of one run: memory and max_steps; the defaults where it says nothing.
Options work_options(const OptionOverrides& overrides);

// The run of a system that a command line asks for: the file's own, with --set and the options over it. Throws
// InputError.
Run asked_run(const SystemDescription& description, const std::vector<std::string>& settings,
              const OptionOverrides& overrides);

// What a command line gives one value: the names of --set, and the flags of options.
std::vector<std::string> fixed_names(const std::vector<std::string>& settings, const OptionOverrides& overrides);

// The intervals among settings, which may be NAME=LOW..HIGH; `points` becomes the settings with the middle of each. Throws
// InputError.
Spread take_spread(const std::vector<std::string>& settings, double width, const SystemDescription& description,
                   std::vector<std::string>& points);

// Model::check(). What a --set makes impossible is told with that setting in place of the file's line. Throws InputErrors.
void check_asked(const Model& model, const Run& run, const std::vector<std::string>& settings);

// Tells on standard error what a person should know of a run: core's warnings(), outside_ranges() and
// unseen_lines().
void warn(const SystemDescription& description, const Run& run);

}  // namespace achilles
