// The commands of the program, one function each. It adds its subcommand to the command line. The callback of the
// subcommand does the work and sets the exit status.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "system/description.hpp"

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace achilles {

class Messages;
class PictureJob;

// Exit statuses. made_differently: `reproduce` or `compare` succeeded, but the pictures differ.
constexpr int reached_end = 0, made_differently = 1, bad_input = 2, stopped_early = 3;

void add_explore(CLI::App& program, int& status);
void add_simulate(CLI::App& program, int& status);
// Commands that make pictures.
void add_figure(CLI::App& program, int& status, PictureJob& job);
void add_frames(CLI::App& program, int& status, PictureJob& job);
void add_orbit(CLI::App& program, int& status, PictureJob& job);
void add_paper(CLI::App& program, int& status, PictureJob& job);
void add_screenshot(CLI::App& program, int& status, PictureJob& job);
// `ranks`: the processes that share the runs (analysis/distributed_chunks.hpp); null if there is only this process.
void add_sweep(CLI::App& program, int& status, PictureJob& job, Messages* ranks);
// Adds all commands that make pictures.
void add_pictures(CLI::App& program, int& status, PictureJob& job, Messages* ranks = nullptr);
void add_html(CLI::App& program, int& status);
void add_prove(CLI::App& program, int& status);
void add_reproduce(CLI::App& program, int& status);
void add_list(CLI::App& program, int& status);
void add_manual(CLI::App& program, int& status);  // help and new
void add_completion(CLI::App& program, int& status);
void add_icon(CLI::App& program, int& status);
void add_check(CLI::App& program, int& status);
void add_compare(CLI::App& program, int& status);

// The man pages: achilles.1 and achilles-COMMAND.1, made from the tables of --help.
struct ManPage {
    std::string file, text;
};
std::vector<ManPage> man_pages(const CLI::App& program);

// The program as a function.

// Runs a command line, given without the program's name. Returns the exit status. Errors in the command line or in a
// file give one message on standard error and status 2. `commit`: of the source, for --version.
int run_program(const std::vector<std::string>& words, const std::string& commit = "commit unknown");

// Reading the tables of the program and what was typed.

// The command if the first word is a system, or missing.
inline constexpr const char* default_command = "explore";

// In the order of --help.
std::vector<std::string> command_names(const CLI::App& program);

// The option of a command with this name, without dashes; null if there is none.
const CLI::Option* option_of(const CLI::App& command, std::string_view name);

// The system that the first word with the name of a readable system names.
std::optional<SystemDescription> named_system(const std::vector<std::string>& words);

// Suggestions for command lines that cannot be parsed: terms of other programs, misspellings, misplaced values.

// Error if the first word is neither a command nor a system: "there is no command or system 'plot'; write achilles
// figure ...".
InputError unknown_command(const CLI::App& program, const std::vector<std::string>& words);

// Turns a CLI11 error into a message with a suggestion.
InputError unreadable_command_line(const CLI::ParseError& error, const CLI::App& program,
                                   const std::vector<std::string>& words);

}  // namespace achilles
