// The states of a trajectory between its step ends.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "../run/trajectory.hpp"

namespace achilles {

// One instant of a trajectory. j counts the events so far (hybrid time): two samples of the same t differ in j.
struct Sample {
    double t = 0.0;
    int j = 0;
    Phase::Kind phase = Phase::Kind::hybrid;
    bool contact = false;  // h = 0 is kept here (a constrained phase, or the restarted motion just before one)
    Mode mode;
    State state;
    double work = 0.0, loss = 0.0;  // of the run until then
    ContactSet carriers{};          // of what is held, whose motion it is (Phase)
};

// The mode just before an event: that which the last one left, or the start.
Mode mode_before(const Trajectory& trajectory, std::size_t event);
// Of what a mode holds at a time, the carriers (Phase).
ContactSet carriers_of(const Trajectory& trajectory, Mode mode, double t);

// The state at time t (clamped to the run), from dense output; at an event the state after it. One per thread. Throws
// InputError where t is no number.
class Sampler {
 public:
    explicit Sampler(const Trajectory& trajectory);
    explicit Sampler(const Trajectory&&) = delete;  // it would be gone at once
    ~Sampler();
    Sample at(double t);
    // The state inside one of its pieces, which j does not tell of, without the work where that is not wanted.
    Sample in(const Piece& piece, double t, bool with_work = true) const;
    // Every step end and every event (an impact as two samples, before and after), and `between` instants inside each
    // step.
    std::vector<Sample> all(int between = 0);
    // The same of at most so many steps, spread over the run, and of the events that border on them; where events are few as
    // many steps again around them.
    std::vector<Sample> some(std::size_t most_steps, int between);
    // The step ends and events of [from, to] one by one, in time, and the states at both ends. `piece` is the step that leads
    // to a sample from the one before it; null where no step does: at the start, and before and after an event.
    using Visitor = std::function<void(const Sample& sample, const Piece* piece)>;
    void walk(double from, double to, bool with_work, const Visitor& take) const;

 private:
    // Which steps are visited.
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
    State state(const Piece& piece, double t) const;
    double work(const Piece& piece, double t) const;
    std::vector<bool> blocks_with_events(std::size_t stride) const;
    const Trajectory& trajectory_;
    std::unique_ptr<Projection> projection_;
};

// How near the run came to the surfaces, at any time. Computed from the run when asked, not kept in it.

// The least gap of all contacts over the run: at its start, where steps end, and at the minima inside steps, of contacts
// that the step does not hold. In the gap's unit. A trajectory of which the end alone was kept has no steps to look into.
double least_gap(const Trajectory& trajectory);

}  // namespace achilles
