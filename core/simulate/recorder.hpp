// Writes a trajectory while it happens: pieces, phases, events, statistics.
#pragma once

#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "simulate/flow.hpp"
#include "simulate/impact.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

class Recorder {
 public:
    Recorder(std::shared_ptr<const Model> model, const Run& run, Keep keep);

    // For another run of the same parameters.
    void restart(std::shared_ptr<const Model> model, const Run& run);

    // What was recorded so far, and back to it. No event may lie between.
    struct Mark {
        std::size_t pieces, coefficients;
        Statistics statistics;
        double scale, largest_change, work;
        bool any_gap;
    };
    Mark mark() const {
        return {trajectory_.pieces.size(),
                trajectory_.coefficients.size(),
                trajectory_.statistics,
                scale_,
                largest_change_,
                trajectory_.work,
                any_gap_};
    }
    void go_back(const Mark& mark);

    // A phase begins. Where not all that is held carries, its forces are not unique.
    void open(Mode mode, ContactSet carriers, double t);
    // The phase goes on with other carriers.
    void carry_on(ContactSet carriers);
    void close(double t);
    Phase::Kind phase() const { return trajectory_.phases.back().kind; }
    Mode mode() const { return trajectory_.phases.back().mode; }

    // A smooth stretch begins: the energy at its start is what later ends of steps are compared with.
    void stretch(const State& state);
    // The flow's last step, as it stands, in the mode of the phase; `gap` is h at its end.
    void step(const Flow& flow, double gap, Mode mode);
    // Steps of which the end alone is kept.
    void steps(long count, double least_gap);
    // An impact at this state before it, and what it does to the energy.
    void impact(const State& before, const Vector& v_after, double speed, const Exchange& exchange, ContactSet contacts,
                std::shared_ptr<const Joint> joint = nullptr);
    // What the last impact has opened, and the mode after it.
    void after_impact(ContactSet opened, Mode mode);
    // The same of a jump to a velocity that no impact leads to: what is lost follows from the energies.
    Exchange exchange_of_jump(const State& before, const State& after, double work);
    // Any other event.
    void event(Event event);
    long impacts() const { return trajectory_.statistics.impacts; }
    long steps() const { return trajectory_.statistics.steps; }
    // Of all that is kept.
    double bytes() const;

    // Ends the run. The recorder is empty afterwards.
    Trajectory finish(const State& state, Outcome outcome, long evaluations);

 private:
    Keep keep_;
    Trajectory trajectory_;
    EnergyTerms<Evaluator<double>> energy_;
    Work work_;
    double reference_ = 0.0;       // energy less work at the start of the stretch
    double scale_ = 0.0;           // the largest |T| + |V| of the stretch so far
    double largest_ = 0.0;         // the same of the run
    double largest_change_ = 0.0;  // of the energy less the work, in the stretches of a run with work
    bool any_gap_ = false;
};

}  // namespace achilles
