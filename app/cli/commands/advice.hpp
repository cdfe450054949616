// What to type in place of a command line that cannot be read: the words of other programs, misspellings, and values that
// stand in the wrong place.
#pragma once

#include <string>
#include <vector>

#include "system/description.hpp"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace achilles {

// In the order in which --help lists them.
std::vector<std::string> command_names(const CLI::App& program);

// The first word is neither a command nor a system: "there is no command or system 'plot'; write achilles figure ...".
InputError unknown_command(const CLI::App& program, const std::vector<std::string>& words);

// What CLI11 could not read of the words of a command line: what is wrong, and what to type.
InputError unreadable_command_line(const CLI::ParseError& error, const CLI::App& program,
                                   const std::vector<std::string>& words);

}  // namespace achilles
