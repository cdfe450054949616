// The estimated error of every coordinate and rate along a run, and the run's horizon: from there on some error is too large for
// the run to be trusted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

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

}  // namespace achilles
