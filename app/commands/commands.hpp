// The commands of the program, one function each: it adds its subcommand to the command line; when that was chosen, the
// callback does the work and leaves the exit status (INTERFACE section 2).
#pragma once

namespace CLI {
class App;
}

namespace achilles {

// Exit statuses.
constexpr int reached_end = 0, bad_input = 2, stopped_early = 3;

void add_explore(CLI::App& program, int& status);
void add_simulate(CLI::App& program, int& status);
void add_paper(CLI::App& program, int& status);
void add_screenshot(CLI::App& program, int& status);
void add_list(CLI::App& program, int& status);

}  // namespace achilles
