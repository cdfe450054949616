// Resource limits for journals and pictures from untrusted sources. Limits on memory, steps and points give the same
// result on every machine. The time limit covers everything else and ends the program without writing a picture.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "run/options.hpp"

namespace achilles {

struct SweepSpec;
struct Trajectory;

// The limits of one session. They apply only after limit(): commands typed by the user are not limited.
class Budget {
 public:
    // Maximum number of points, and of rows, of one sweep.
    static constexpr std::uint64_t max_points = std::uint64_t{1} << 22;
    // Maximum total of all runs. Each run counts as the fraction it uses of the steps or memory allowed for one run.
    static constexpr double max_full_runs = 4.0;

    // `how_to_allow`: what the error message tells the user to type. `allowed`: upper limits of memory and max_steps of
    // a run.
    explicit Budget(std::string how_to_allow, const Options& allowed = {})
        : how_to_allow_(std::move(how_to_allow)), allowed_(allowed) {}
    const std::string& how_to_allow() const { return how_to_allow_; }

    void limit() { is_limited_ = true; }
    // Lifts the limits and resets the total.
    void lift();
    bool is_limited() const { return is_limited_; }
    // Raises the limits of memory and max_steps to the options that the user typed.
    void allow(const Options& typed);

    // Throw Forbidden if a run may use more memory or steps than the limits, or if a sweep has too many points.
    void check(const Options& options) const;
    void check(const SweepSpec& sweep) const;
    void check_rows(std::uint64_t rows) const;  // rows of the sections of a sweep
    // Adds a run to the total. Throws PermissionDenied if the total exceeds max_full_runs.
    void charge(const Trajectory& run);

 private:
    std::string how_to_allow_;
    bool is_limited_ = false;
    Options allowed_;
    double full_runs_ = 0.0;
};

// Ends the process with a message and the exit status of bad input after the given time. For programs without a window:
// they write their output last, so nothing has been written by then.
class TimeLimit {
 public:
    static constexpr unsigned usual_seconds = 600;
    TimeLimit() = default;
    ~TimeLimit() { disarm(); }
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;

    // Starts the timer, unless it is running. There is one timer per process.
    void arm(const std::string& how_to_allow, unsigned seconds = usual_seconds);
    void disarm();

 private:
    bool is_armed_ = false;
};

}  // namespace achilles
