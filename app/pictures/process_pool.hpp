// Long work: shared by several processes, and how far it has come.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace achilles {

// ImGui has one context at a time in a process, so pictures are drawn in as many.

struct CrewOutcome {
    std::size_t done = 0;  // tasks
    int signal = 0;        // that ended one of the processes; 0: none
};

// Does the tasks 0 to count - 1 in `jobs` processes, each the next that nobody has. `begin` is called once in each and
// returns what does a task there; `done` is called here with the number of tasks done so far. Where a task throws, no
// other is begun, and the first one's exception is thrown here, as an InputError, or as NotEnoughMemory. Where a process is killed the others
// go on: its task is missing. Call it before any context of OpenGL is made, or threads are.
CrewOutcome share_work(std::size_t count, int jobs, const std::function<std::function<void(std::size_t task)>()>& begin,
                       const std::function<void(std::size_t done)>& done);

// How far a long work has come, for a person at a terminal.

// "[#####.....]  50%  60/120 frames  11.3/s  0:05 left"; without times before the first is done.
std::string progress_line(std::size_t done, std::size_t count, double seconds, const std::string& things);

// A line on standard error that is written over and over, and taken away at the end. Where that is no terminal a line after half
// a minute, a minute, two, and so on; or with `lines` a line each time for a program that reads them.
class Progress {
 public:
    Progress(std::size_t count, std::string things, bool lines = false);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void show(std::size_t done);
    // Takes the line away, before something else is told.
    void end();

 private:
    std::size_t count_;
    std::string things_;
    bool on_terminal_, lines_;
    double next_line_ = 30.0;  // s; where neither of these
    std::chrono::steady_clock::time_point begin_;
};

}  // namespace achilles
