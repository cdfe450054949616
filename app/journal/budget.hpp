// What journals and pictures of unknown origin may cost. Memory, steps and points decide alike on every machine; the time
// limit is for what these do not see, and ends the program without a picture.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "run/options.hpp"

namespace achilles {

struct Sweep;
struct Trajectory;

// The limits of one session. Until limit() is called nothing is refused: what a person types has no limits.
class Budget {
 public:
    // Points, and rows, of one sweep.
    static constexpr std::uint64_t max_points = std::uint64_t{1} << 22;
    // All runs together: each counts as the share that it takes of the steps, or the memory, of one.
    static constexpr double max_full_runs = 4.0;

    // `how_to_allow`: what a refusal says to type. `allowed`: memory and max_steps of a run, at most.
    explicit Budget(std::string how_to_allow, const Options& allowed = {})
        : how_to_allow_(std::move(how_to_allow)), allowed_(allowed) {}
    const std::string& how_to_allow() const { return how_to_allow_; }

    void limit() { is_limited_ = true; }
    // Lifts the limits, and forgets the runs.
    void lift();
    bool is_limited() const { return is_limited_; }
    // Raises the limits of memory and max_steps to those of options that a person typed.
    void allow(const Options& typed);

    // Throw Forbidden where a run may keep more memory or take more steps than the limits, or a sweep has too many points.
    void check(const Options& options) const;
    void check(const Sweep& sweep) const;
    void check_rows(std::uint64_t rows) const;  // of the sections of a sweep
    // Counts a run. Throws Forbidden where all of them together are too many.
    void charge(const Trajectory& run);

 private:
    std::string how_to_allow_;
    bool is_limited_ = false;
    Options allowed_;
    double full_runs_ = 0.0;
};

// Ends the process, with a message and the exit status of bad input, when it is armed for so long. For programs without a
// window: nothing has been written by then.
class TimeLimit {
 public:
    static constexpr unsigned usual_seconds = 600;
    TimeLimit() = default;
    ~TimeLimit() { disarm(); }
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;

    // Begins, unless it is armed already. There is one timer in a process.
    void arm(const std::string& how_to_allow, unsigned seconds = usual_seconds);
    void disarm();

 private:
    bool is_armed_ = false;
};

}  // namespace achilles
