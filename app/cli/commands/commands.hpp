// The commands of the program, one function each: it adds its subcommand to the command line; when that was chosen, the
// callback does the work and leaves the exit status.
#pragma once

#include <string>
#include <vector>

#include "system/description.hpp"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace achilles {

class Messages;
class PictureJob;

// Exit statuses. made_differently: `reproduce` could, but the bytes are not the same.
constexpr int reached_end = 0, made_differently = 1, bad_input = 2, stopped_early = 3;

void add_explore(CLI::App& program, int& status);
void add_simulate(CLI::App& program, int& status);
// Those that make pictures.
void add_figure(CLI::App& program, int& status, PictureJob& job);
void add_frames(CLI::App& program, int& status, PictureJob& job);
void add_orbit(CLI::App& program, int& status, PictureJob& job);
void add_paper(CLI::App& program, int& status, PictureJob& job);
void add_screenshot(CLI::App& program, int& status, PictureJob& job);
// `ranks`: the processes that share the runs (study/ranks.hpp); null where this one is alone.
void add_sweep(CLI::App& program, int& status, PictureJob& job, Messages* ranks);
// All of them.
void add_pictures(CLI::App& program, int& status, PictureJob& job, Messages* ranks = nullptr);
void add_prove(CLI::App& program, int& status);
void add_reproduce(CLI::App& program, int& status);
void add_list(CLI::App& program, int& status);
void add_manual(CLI::App& program, int& status);  // help and new
void add_check(CLI::App& program, int& status);

// The program as a function.

// Runs one command line, without the program's name. Returns the exit status. What is wrong with the command
// line or with a file is one message on standard error, and status 2.
int run_program(const std::vector<std::string>& words);

// What to type in place of a command line that cannot be read: the words of other programs, misspellings, and values that
// stand in the wrong place.

// In the order in which --help lists them.
std::vector<std::string> command_names(const CLI::App& program);

// The first word is neither a command nor a system: "there is no command or system 'plot'; write achilles figure ...".
InputError unknown_command(const CLI::App& program, const std::vector<std::string>& words);

// What CLI11 could not read of the words of a command line: what is wrong, and what to type.
InputError unreadable_command_line(const CLI::ParseError& error, const CLI::App& program,
                                   const std::vector<std::string>& words);

}  // namespace achilles
