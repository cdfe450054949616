#include "depend/error_course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

// What is no number is not known.
Vector known_or_infinite(Vector sizes) {
    for (double& x : sizes)
        if (!std::isfinite(x)) x = std::numeric_limits<double>::infinity();
    return sizes;
}

// The first size that is more than its share; -1: none.
Eigen::Index first_excess(const Vector& sizes, const Vector& range) {
    for (Eigen::Index i = 0; i < sizes.size(); ++i)
        if (sizes[i] > ErrorCourse::largest_share * std::max(range[i], ErrorCourse::least_range)) return i;
    return -1;
}

}  // namespace

void ErrorCourse::take(const Vector& q, const Vector& v) {
    low_ = {low_.q.cwiseMin(q), low_.v.cwiseMin(v)};
    high_ = {high_.q.cwiseMax(q), high_.v.cwiseMax(v)};
}

void ErrorCourse::begin(const Run& run) {
    low_ = high_ = {run.q, run.v};
    const Vector none = Vector::Zero(run.q.size());
    entries_ = {{run.options.start_time, none, none}};
    horizon_.reset();
}

// Inside a step a coordinate may come to its highest.
void ErrorCourse::add(const Trajectory& trajectory, const Piece& step, const State& sizes) {
    constexpr int parts = 8;
    for (int k = 1; k <= parts; ++k) {
        const double t = step.start + (step.end - step.start) * k / parts;
        const State state = state_in(step, trajectory.coefficients, trajectory.run.q.size(), t);
        take(state.q, state.v);
    }
    add(step.end, sizes);
}

void ErrorCourse::add(const Event& event, const State& sizes) {
    take(event.q, event.v_before);
    take(event.q, event.v_after);
    add(event.t, sizes);
}

void ErrorCourse::add(double t, const State& sizes) {
    Entry entry{t, known_or_infinite(sizes.q), known_or_infinite(sizes.v)};
    if (!horizon_) {
        const State range = this->range();
        const Eigen::Index q = first_excess(entry.q, range.q), v = first_excess(entry.v, range.v);
        if (q >= 0 || v >= 0) {
            horizon_ = t;
            is_rate_ = q < 0;
            coordinate_ = is_rate_ ? v : q;
        }
    } else {
        entry.q = entry.q.cwiseMax(entries_.back().q);
        entry.v = entry.v.cwiseMax(entries_.back().v);
    }
    entries_.push_back(std::move(entry));
}

std::optional<State> ErrorCourse::at(double t) const {
    if (entries_.empty()) return std::nullopt;
    auto after = std::lower_bound(entries_.begin(), entries_.end(), t,
                                  [](const Entry& entry, double time) { return entry.t < time; });
    if (after == entries_.end()) {
        if (!horizon_) return std::nullopt;
        return State{entries_.back().q, entries_.back().v, t};
    }
    State sizes{after->q, after->v, t};
    const auto include = [&](const Entry& entry) {
        sizes.q = sizes.q.cwiseMax(entry.q);
        sizes.v = sizes.v.cwiseMax(entry.v);
    };
    if (after->t > t && after != entries_.begin()) include(*std::prev(after));
    for (; after != entries_.end() && after->t == t; ++after) include(*after);
    return sizes;
}

}  // namespace achilles
