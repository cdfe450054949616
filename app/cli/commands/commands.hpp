// The commands of the program, one function each: it adds its subcommand to the command line; when that was chosen, the
// callback does the work and leaves the exit status.
#pragma once

namespace CLI {
class App;
}

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

}  // namespace achilles
