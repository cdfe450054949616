// A journal replayed at a person's pace: every `wait` takes its time, and what plays goes on meanwhile.
#pragma once

#include <deque>
#include <vector>

#include "session/command.hpp"

namespace achilles {

class Tour {
 public:
    Tour() = default;
    explicit Tour(const std::vector<Command>& journal) : left_(journal.begin(), journal.end()) {}

    bool runs() const { return !left_.empty(); }
    // What is due when so many seconds have passed: commands, and of a wait what has passed of it, so that the waits
    // add up to those of the journal and the end is that of a replay at once.
    std::vector<Command> advance(double seconds);
    // The rest of the present wait at once.
    std::vector<Command> next();
    void stop() { left_.clear(); }
    // Another journal, in place of a command that names it, or of the tour that runs.
    void begin(const std::vector<Command>& journal) { left_.insert(left_.begin(), journal.begin(), journal.end()); }

 private:
    std::deque<Command> left_;
};

}  // namespace achilles
