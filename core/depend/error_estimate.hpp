// How wrong a run has become, estimated: what its steps leave out, what its roots miss and what its cuts leave open, carried
// through all that follows (theory-enclosure.md 9). An estimate to first order, and not a proof.
//
//     const ErrorEstimate e = estimate_error(trajectory);
//     e.end->norm       of the true end less the computed one, roughly;  e.end->reach: hardly ever exceeded
//     e.events[j]       s, of the time of event j
//     e.trusted_until   s: from there on some error is more than a thousandth of its coordinate's range
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

// The estimated error of every coordinate and rate along a run, and the run's horizon: from there on some error is too large for
// the run to be trusted.
class ErrorCourse {
 public:
    // An error is trusted up to this share of the range so far: of the largest value less the smallest, at least `least_range`.
    static constexpr double largest_share = 1e-3, least_range = 1e-9;

    // Estimated sizes at a fixed time, of the error and of rounding's standard deviation together. Infinite: nothing is known.
    struct Entry {
        double t = 0.0;  // s
        Vector q, v;
    };

    // Begins at the start of the run, where there is no error.
    void begin(const Run& run);
    // Adds the end of a step, and an event with the sizes after it, both in time.
    void add(const Trajectory& trajectory, const Piece& step, const State& sizes);
    void add(const Event& event, const State& sizes);

    // The first step end or event where some size exceeds its share of the range (s). Nothing where that does not happen.
    std::optional<double> horizon() const { return horizon_; }
    // Which one does there: its coordinate, and whether it is the rate.
    Eigen::Index coordinate() const { return coordinate_; }
    bool is_rate() const { return is_rate_; }
    // The larger sizes of those beside a time (s); after the horizon the largest so far, for it does not recover. Nothing where
    // there is no estimate.
    std::optional<State> at(double t) const;
    // The largest value less the smallest over the run.
    State range() const { return {high_.q - low_.q, high_.v - low_.v}; }
    const std::vector<Entry>& entries() const { return entries_; }

 private:
    void take(const Vector& q, const Vector& v);
    void add(double t, const State& sizes);

    std::vector<Entry> entries_;  // step ends and events, in time
    State low_, high_;            // of the values so far
    std::optional<double> horizon_;
    Eigen::Index coordinate_ = 0;
    bool is_rate_ = false;
};

struct ErrorEstimate {
    struct AtEnd {
        Vector q, v;         // true less computed, at the end time
        double norm = 0.0;   // Euclidean, of both together
        double sigma = 0.0;  // what rounding makes of it, as a standard deviation
        double reach() const { return 1.5 * norm + 3.0 * sigma; }
        double size() const;  // of both: what is told a person
    };
    std::optional<AtEnd> end;
    // Of the times of events, s, rounding included: of the trajectory's, as many of the first as can be estimated.
    std::vector<double> events;
    // Of every coordinate and rate along the run, as far as it can be estimated.
    ErrorCourse course;
    // The horizon (s): the first step end or event where the error of some coordinate or rate exceeds its share of the range so
    // far (ErrorCourse), the end of the run where that never happens. Nothing only where there is no estimate.
    std::optional<double> trusted_until;
    // Why there is none at the end, else empty.
    std::string none_since;
};

// Of a run of which everything was kept. Nothing where steps are not made by Taylor's method, cuts were restarted by the
// Euclidean projection, or there are more steps than most_estimated_steps; nothing from where the run has no derivative; nothing
// of the end where it lies between a cut and its Zeno point, or where another thread asks to stop.
//
// It takes up to eight times as long as the run (bench_estimate). So who makes many runs, or waits for one, asks for it when the
// runs are there, if at all; and of a run of so many steps it is left out, which is counted in steps and not in seconds so that
// the same run always has it or never.
ErrorEstimate estimate_error(const Trajectory& trajectory, const std::stop_token& stop = {});
inline constexpr std::size_t most_estimated_steps = 100'000;

// The horizon of a run where it comes before the end (s); else nothing.
std::optional<double> horizon_before_end(const Trajectory& trajectory, const ErrorEstimate& estimate);

}  // namespace achilles
