// Work shared by several processes: ImGui has one context at a time in a process, so pictures are drawn in as many.
#pragma once

#include <cstddef>
#include <functional>

namespace achilles {

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

}  // namespace achilles
