// Parallel work in several processes, and a progress display.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace achilles {

// ImGui has one current context per process, so pictures are drawn in several processes.

struct CrewOutcome {
    std::size_t done = 0;  // finished tasks
    int signal = 0;        // signal that killed one of the processes; 0: none
};

// Runs the tasks 0 to count - 1 in `jobs` processes; each takes the next task not yet taken. `begin` is called once in
// each process and returns the function that does a task. `done` is called in the calling process with the number of
// finished tasks. If a task throws, no new task starts, and the exception is rethrown here as InputError or
// NotEnoughMemory. If a process is killed, the others continue without its task. Call this before creating threads or
// an OpenGL context.
CrewOutcome share_work(std::size_t count, int jobs, const std::function<std::function<void(std::size_t task)>()>& begin,
                       const std::function<void(std::size_t done)>& done);

// Progress display on a terminal.

// "[#####.....]  50%  60/120 frames  11.3/s  0:05 left"; without times until the first is done.
std::string progress_line(std::size_t done, std::size_t count, double seconds, const std::string& things);

// A line on standard error that is overwritten, and erased at the end. If standard error is not a terminal: one line
// after half a minute, a minute, two minutes, and so on. With `lines`: one line per update, for programs that parse
// them.
class Progress {
 public:
    Progress(std::size_t count, std::string things, bool lines = false);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void show(std::size_t done);
    // Erases the line before other output.
    void end();

 private:
    std::size_t count_;
    std::string things_;
    bool on_terminal_, lines_;
    double next_line_ = 30.0;  // s; used if neither is true
    std::chrono::steady_clock::time_point begin_;
};

}  // namespace achilles
