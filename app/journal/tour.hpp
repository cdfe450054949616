// A journal replayed at a person's pace: every `wait` takes its time, and what plays goes on meanwhile.
#pragma once

#include <cstddef>
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
    // Of the sentences that it says: the how manieth is said, and how many there are, as far as is known.
    std::size_t said() const;
    std::size_t sentences() const;
    // Back to the sentence before: what leads there from the beginning, at once; what follows is due again. Commands that
    // write files, or replay journals whose commands have been done, are not among them. Nothing where there is none before.
    std::vector<Command> back();
    void stop() { left_.clear(), done_.clear(); }
    // Another journal, in place of a command that names it, or of the tour that runs.
    void begin(const std::vector<Command>& journal);

 private:
    void keep(const Command& command);

    std::deque<Command> left_;
    std::vector<Command> done_;  // a wait as one, however many pieces it passed in
};

}  // namespace achilles
