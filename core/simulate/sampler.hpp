// The states of a trajectory at any time, from its dense output.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

// A sample of a trajectory. j counts the events so far (hybrid time): two samples with the same t differ in j.
struct Sample {
    double t = 0.0;
    int j = 0;
    Phase::Kind phase = Phase::Kind::hybrid;
    bool contact = false;  // h = 0 is kept here (a constrained phase, or after a truncation just before one)
    Mode mode;
    State state;
    double work = 0.0, loss = 0.0;  // of the run up to t
    ContactSet load_bearing{};      // held contacts whose constraints define the motion (Phase)
    double heat = 0.0;
    ContactSet inactive{};  // contacts that do not count
    ContactSet latched{};   // contacts that a latch holds
};

// The mode just before an event: the mode after the event before, or at the start.
Mode mode_before(const Trajectory& trajectory, std::size_t event);
// The load-bearing contacts (Phase) in this mode at time t (s).
ContactSet load_bearing_contacts(const Trajectory& trajectory, Mode mode, double t);

// Evaluates dense output. Use one object per thread.
class Sampler {
 public:
    explicit Sampler(const Trajectory& trajectory);
    explicit Sampler(const Trajectory&&) = delete;  // the trajectory would be a temporary
    ~Sampler();
    Sample at(double t);
    // The state in one step of the trajectory at time t (s). j is not set; work is 0 unless with_work.
    Sample in(const DenseSegment& piece, double t, bool with_work = true) const;
    // All step ends and events (an impact as two samples, before and after), and `between` instants inside each step.
    std::vector<Sample> all(int between = 0);
    // The same for at most `most_steps` steps spread over the run, with the events next to them. If events are few, up
    // to as many steps again around them.
    std::vector<Sample> some(std::size_t most_steps, int between);
    // Calls `take` for each step end and event of [from, to] in order of time, and for the states at both ends. `piece`
    // is the step from the sample before to this one; null if no step leads to it: at the start, and before and after
    // an event.
    using Visitor = std::function<void(const Sample& sample, const DenseSegment* piece)>;
    void walk(double from, double to, bool with_work, const Visitor& take) const;

 private:
    // Which steps visit() visits.
    struct Selection {
        double from = 0.0, to = 0.0;
        bool with_work = true;
        std::size_t stride = 1;
        std::vector<bool> whole{};
    };
    Selection whole_run() const;
    void visit(const Selection& selection, const Visitor& visitor) const;
    std::vector<Sample> listed(const Selection& selection, int between) const;
    struct Projection;
    State state(const DenseSegment& piece, double t) const;
    // Sets the work and the heat at the sample's time.
    void set_work(Sample& sample, const DenseSegment& piece) const;
    std::vector<bool> blocks_with_events(std::size_t stride) const;
    const Trajectory& trajectory_;
    std::unique_ptr<Projection> projection_;
};

// ---- closest approach ----

// The smallest gap of all contacts over the run, in the unit of the gap. It is searched at the start, at step ends, and
// at minima inside steps of contacts that the step does not hold. A trajectory recorded with Recording::final_state has
// no steps to examine.
double least_gap(const Trajectory& trajectory);

}  // namespace achilles
