// Reference for simulate(): the completed execution in 34 digits, from a start in flight or in contact to an end time.
// It resolves impacts down to speeds far below double precision, Zeno points and releases.
#pragma once

#include <vector>

#include "certify/bouncing.hpp"

namespace achilles::test {

template <class Number>
struct TrueEventOf {
    Event::Kind kind = Event::Kind::impact;
    Number t;
    Number speed;           // impact: |hdot| before
    PointOf<Number> point;  // before the event
};
using TrueEvent = TrueEventOf<Real>;

template <class Number>
struct TrueExecutionOf {
    std::vector<TrueEventOf<Number>> events;  // in order of time
    PointOf<Number> end;
    Phase::Kind start_phase = Phase::Kind::hybrid, end_phase = Phase::Kind::hybrid;
};
using TrueExecution = TrueExecutionOf<Real>;

// A local minimum of the gap in free motion.
template <class Number>
struct DipOf {
    Number t, gap;
    Number curvature;  // hddot at the minimum
};
using Dip = DipOf<Real>;

Point point_of(const State& state);

// Computes reference executions. Throws std::runtime_error after `most_events` events, if the impacts do not converge.
template <class Number>
class TrueRunsOf {
 public:
    using Point = PointOf<Number>;
    using TrueExecution = TrueExecutionOf<Number>;
    using Dip = DipOf<Number>;

    // 0 <= e <= 1.
    TrueRunsOf(const Model& model, const Run& run, std::size_t most_events = 5000, double longest_step = 1e300)
        : TrueRunsOf(model, List<Number>(run.parameters.begin(), run.parameters.end()), most_events, longest_step) {}
    TrueRunsOf(const Model& model, const List<Number>& parameters, std::size_t most_events = 5000,
               double longest_step = 1e300);

    // Starts with h > 0. Follows impacts until their speed is below `cut` and hddot is constant for the remaining time.
    // The rest is a geometric series and the plastic restart, with an error of O(cut^3).
    TrueExecution run(const Point& start, double end_time, double cut = 1e-9);
    // Starts with h = hdot = 0; rounding errors of `start` in h and hdot are removed first. Contact is kept if the
    // contact force is positive, or is zero and increases.
    TrueExecution run_from_contact(const Point& start, double end_time, double cut = 1e-9);
    // The first local minimum of the gap in free motion from the start, if there is one within this time.
    std::optional<Dip> first_dip(const Point& start, double within);

 private:
    static constexpr double precision = 1e-26;  // error tolerance of a step
    TrueExecution run(double end_time, double cut);
    bool settles(const Point& slid, const Number& acceleration, const Number& rest);
    void fly();
    void stay();

    std::size_t dof_, most_events_;
    TrueMotionOf<Number> motion_;
    Number e_, end_time_;
    Number cut_;
    TrueExecution result_;
    FlightOf<Number> flight_;
    bool contact_ = false;
    double expected_ = 0.0;
};
using TrueRuns = TrueRunsOf<Real>;

}  // namespace achilles::test
