// How far a long work has come, for a person at a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace achilles {

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
