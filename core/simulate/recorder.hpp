// Records the trajectory during a run: dense output, phases, events, statistics.
#pragma once

#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "simulate/flow.hpp"
#include "simulate/impact.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

class Recorder {
 public:
    Recorder(std::shared_ptr<const Model> model, const Run& run, Recording keep);

    // Starts over, for another run with the same parameters.
    void restart(std::shared_ptr<const Model> model, const Run& run);

    // The position in the record; go_back() returns to it. No event may lie between.
    struct Checkpoint {
        std::size_t pieces, coefficients;
        Statistics statistics;
        double scale, largest_change, work, heat;
        bool any_gap;
    };
    Checkpoint mark() const {
        return {trajectory_.pieces.size(), trajectory_.coefficients.size(),
                trajectory_.statistics,    scale_,
                largest_change_,           trajectory_.work,
                trajectory_.heat,          any_gap_};
    }
    // Discards everything recorded since the checkpoint.
    void go_back(const Checkpoint& mark);

    // Begins a phase. If not all held contacts are load-bearing, its forces are not unique.
    void open(Mode mode, ContactSet load_bearing, double t);
    // Continues the phase with other load-bearing contacts.
    void continue_phase(ContactSet load_bearing);
    void close(double t);
    Phase::Kind phase() const { return trajectory_.phases.back().kind; }
    Mode mode() const { return trajectory_.phases.back().mode; }

    // Begins a segment. Its initial energy is the reference for the energy drift at later step ends.
    void stretch(const State& state);
    // Records the last step, in the mode of the phase; `gap` is the smallest h at its end.
    void step(const Flow& flow, double gap, Mode mode);
    // Counts steps of which only the end is known.
    void steps(long count, double least_gap);
    // Records an impact: the state before it, and its work and loss.
    void impact(const State& before, const Vector& v_after, double speed, const Exchange& exchange, ContactSet contacts,
                std::shared_ptr<const MultiContactInfo> joint = nullptr);
    // Adds the impulses of friction to the last impact.
    void friction_at_impact(std::shared_ptr<const Event::FrictionImpulses> friction);
    // Adds to the last impact the contacts that it opened and the mode after it.
    void after_impact(ContactSet opened, Mode mode);
    // Work and loss of a jump that is not an impact: the loss follows from the energies before and after.
    Exchange exchange_of_jump(const State& before, const State& after, double work);
    // Adds the work and loss of such a jump.
    void add(const Exchange& exchange);
    // Records a jump of the state, with its loss.
    void jump(Event&& event, const Exchange& exchange);
    // Sets the mode after the last jumps, once it is decided.
    void after_jumps(std::size_t count, Mode mode);
    // Records any other event.
    void event(Event&& event);
    // The contacts that do not count, from here on.
    void set_inactive(ContactSet inactive) { inactive_ = inactive; }
    // The contacts that a latch holds, from here on.
    void set_latched(ContactSet latched) { latched_ = latched; }
    // Ends the start of the run: its inactive and latched contacts are those of now.
    void end_start() {
        trajectory_.start_inactive = inactive_;
        trajectory_.start_latched = latched_;
    }
    long impacts() const { return trajectory_.statistics.impacts; }
    int impacts_of_phase() const { return trajectory_.phases.back().impacts; }
    bool knows_energies() const { return keep_ == Recording::full; }
    long steps() const { return trajectory_.statistics.steps; }
    bool has_no_step() const { return steps() == 0; }
    // Memory of everything recorded, bytes.
    double bytes() const;

    // Ends the run. The recorder is empty afterwards.
    Trajectory finish(const State& state, Outcome outcome, long evaluations);

 private:
    Recording keep_;
    Trajectory trajectory_;
    EnergyTerms<Evaluator<double>> energy_;
    WorkIntegrator work_;
    double reference_ = 0.0;       // energy minus work at the start of the segment
    double scale_ = 0.0;           // largest |T| + |V| in the segment so far
    double largest_ = 0.0;         // the same over the whole run
    double largest_change_ = 0.0;  // of energy minus work in any segment, for runs with work
    bool any_gap_ = false;
    ContactSet inactive_, latched_;
};

}  // namespace achilles
