// The whole completed execution in 34 digits, from a start in the air or in contact to an end time: every impact down
// to speeds far below what double precision resolves, Zeno points, releases. What simulate() computes is judged by it.
#pragma once

#include <vector>

#include "certify/bouncing.hpp"

namespace achilles::test {

template <class Number>
struct TrueEventOf {
    Event::Kind kind = Event::Kind::impact;
    Number t;
    Number speed;           // impact: |hdot| before
    PointOf<Number> point;  // before it
};
using TrueEvent = TrueEventOf<Real>;

template <class Number>
struct TrueExecutionOf {
    std::vector<TrueEventOf<Number>> events;  // in time
    PointOf<Number> end;
    Phase::Kind start_phase = Phase::Kind::hybrid, end_phase = Phase::Kind::hybrid;
};
using TrueExecution = TrueExecutionOf<Real>;

// A dip of the gap in free motion.
template <class Number>
struct DipOf {
    Number t, gap;
    Number curvature;  // hddot there
};
using Dip = DipOf<Real>;

Point point_of(const State& state);

// Throws std::runtime_error where there are more events than that: bouncing that does not settle.
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

    // Starts with h > 0. Bouncing is followed until its speed has fallen below `cut` and hddot no longer changes in
    // what is left, which is a geometric series and the plastic restart and errs by O(cut^3).
    TrueExecution run(const Point& start, double end_time, double cut = 1e-9);
    // Starts on the surface, at rest along its normal: the point is moved there from what rounding made of it. It stays
    // if the contact force is positive, or is zero and grows.
    TrueExecution run_from_contact(const Point& start, double end_time, double cut = 1e-9);
    // Where the gap first stops falling and rises again, if free motion from the start does that within the time.
    std::optional<Dip> first_dip(const Point& start, double within);

 private:
    static constexpr double precision = 1e-26;  // of a step
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
