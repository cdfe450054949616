// Estimates the error of a run to first order: the omitted terms of steps, the errors of roots and of truncations,
// carried through the rest of the run (theory-enclosure.md 9). This is not a proof.
//
//     const ErrorEstimate e = estimate_error(trajectory);
//     e.end->norm       approximate norm of true minus computed end state;  e.end->reach: hardly ever exceeded
//     e.events[j]       s, error of the time of event j
//     e.trusted_until   s: from this time on some error exceeds a thousandth of its coordinate's range
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

// The estimated error of every coordinate and rate along a run, and the horizon of the run, the time from which on some
// error is too large.
class ErrorCourse {
 public:
    // An error is acceptable up to this share of the range so far, the largest minus the smallest value; the range
    // counts as `min_range` or more.
    static constexpr double largest_share = 1e-3, min_range = 1e-9;

    // Estimated sizes at a fixed time, combining the error and the standard deviation of rounding. Infinite: unknown.
    struct Entry {
        double t = 0.0;  // s
        Vector q, v;
    };

    // Starts at the beginning of the run, where the error is 0.
    void begin(const Run& run);
    // Adds the end of a step, or an event with the sizes after it, in order of time.
    void add(const Trajectory& trajectory, const DenseSegment& step, const State& sizes);
    void add(const Event& event, const State& sizes);

    // The time (s) of the first step end or event where some size exceeds its share of the range; nullopt if there is
    // none.
    std::optional<double> horizon() const { return horizon_; }
    // The coordinate whose error exceeds its share at the horizon, and whether it is its rate.
    Eigen::Index coordinate() const { return coordinate_; }
    bool is_rate() const { return is_rate_; }
    // The larger of the neighboring sizes at time t (s). After the horizon, the largest so far, because the error does
    // not recover. nullopt if there is no estimate.
    std::optional<State> at(double t) const;
    // The largest minus the smallest value over the run.
    State range() const { return {high_.q - low_.q, high_.v - low_.v}; }
    const std::vector<Entry>& entries() const { return entries_; }

 private:
    void take(const Vector& q, const Vector& v);
    void add(double t, const State& sizes);

    std::vector<Entry> entries_;  // step ends and events, in order of time
    State low_, high_;            // smallest and largest values so far
    std::optional<double> horizon_;
    Eigen::Index coordinate_ = 0;
    bool is_rate_ = false;
};

struct ErrorEstimate {
    struct FinalError {
        Vector q, v;         // true minus computed, at the end time
        double norm = 0.0;   // Euclidean norm of both
        double sigma = 0.0;  // standard deviation of the effect of rounding
        double reach() const { return 1.5 * norm + 3.0 * sigma; }
        double size() const;  // of both; the value that is reported
    };
    std::optional<FinalError> end;
    // Errors of the times of events (s), including rounding, for the first events of the trajectory as far as they can
    // be estimated.
    std::vector<double> events;
    // Errors of all coordinates and rates along the run, as far as they can be estimated.
    ErrorCourse course;
    // The horizon (s): the first step end or event where the error of some coordinate or rate exceeds its share of the
    // range so far (ErrorCourse). It is the end of the run if that never happens; nullopt only if there is no estimate.
    std::optional<double> trusted_until;
    // The reason why there is no estimate at the end; else empty.
    std::string no_estimate_reason;
};

// Estimates the errors of a run that was recorded in full. There is no estimate if steps are not made by Taylor's
// method, truncations were restarted by the Euclidean projection, or there are more than max_estimated_steps steps.
// The estimate ends where the run has no derivative. There is none for an end between a truncation and its Zeno point,
// or after a stop request.
//
// An estimate takes up to eight times as long as the run (bench_estimate). Call it on demand, once the runs are
// finished. The limit is a number of steps, not of seconds, so that a run either always has an estimate or never.
ErrorEstimate estimate_error(const Trajectory& trajectory, const std::stop_token& stop = {});
inline constexpr std::size_t max_estimated_steps = 100'000;

// The horizon of a run if it is before the end (s); else nullopt.
std::optional<double> horizon_before_end(const Trajectory& trajectory, const ErrorEstimate& estimate);

}  // namespace achilles
