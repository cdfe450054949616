// Integrates one smooth segment, free or in contact, with dense output, by either stepper.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/polynomial.hpp"
#include "run/trajectory.hpp"
#include "simulate/domain_monitor.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

class Flow {
 public:
    Flow(const Model& model, const Run& run, ContactCache& surfaces);

    // Starts a segment at this state in this mode. In free flight the first step is at most `first_step` (s); 0 leaves
    // it to the stepper. `gaps` has one entry for each contact; of a held contact, only state_error is used.
    void start(Mode mode, const State& state, std::span<const Gap> gaps, double first_step);
    // Makes one accepted step, at most to the time `until`, which is met exactly. If a function leaves its domain or
    // reaches an edge (model/domain_boundaries.hpp) inside the step, the step is shortened. If it becomes too short,
    // that is the failure.
    StepFailure step(double until);
    // Repeats the last step with this shorter duration, so that its end is as accurate as that of a normal step.
    StepFailure redo_step(double duration);
    // The end of the last step, for projection onto a contact surface; the next step starts there.
    State& edit_end();
    // Sets an open contact's gap at the end of the last step, from which the next one starts.
    void move_gap(std::size_t contact, const Gap& gap);
    // Moves the end of the last step along the motion by dt (s), so short that a second-order Taylor step is exact
    // within rounding.
    void shift_end(double dt);

    // The last step: [begin_time, begin_time + duration], its end, and q, v as polynomials in theta.
    double begin_time() const { return t_; }
    double duration() const { return span_; }
    double end_time() const { return end_; }
    const State& end() const {
        if (fetched_) return to_;
        to_ = stepper_->current_state();
        to_.t = end_;
        fetched_ = true;
        return to_;
    }
    // The event function of a contact along the last step: h if it is open, hddot of the mode without it if it is held
    // (Stepper).
    void event_function(std::size_t contact, Polynomial& p) const { stepper_->event_function(contact, p); }
    bool stays_negative(std::size_t contact) const { return stepper_->stays_negative(contact); }
    bool stays_positive(std::size_t contact) const { return stepper_->stays_positive(contact); }
    bool is_expansion() const { return stepper_->is_expansion(); }
    double remainder(std::size_t contact, const Polynomial& p) const { return stepper_->remainder(contact, p); }
    void add_error(std::size_t contact, const Polynomial& p, Gap& end) const { stepper_->add_error(contact, p, end); }
    // The work and heat of the last step if the stepper knows them (Stepper).
    std::optional<EnergyFlow> energy_flow() const { return stepper_->energy_flow(); }
    // The last step as dense output; coefficients are appended. Its ends are exactly those of the step.
    DenseSegment piece(std::vector<double>& coefficients) const;

    long evaluations() const { return stepper_->evaluations(); }

 private:
    double least() const;

    std::unique_ptr<Stepper> stepper_;
    std::unique_ptr<DomainMonitor> edges_;  // null if the system has no edges
    bool is_examined_ = false;              // edges_ has the polynomials of the last step
    const Model* model_;
    std::span<const double> parameters_;
    Model::MotionEvaluators motions_;          // by mode, created at first use
    double t_ = 0.0, span_ = 0.0, end_ = 0.0;  // end_ = t_ + span_, rounded
    double first_ = 0.0;                       // bound on the next step; 0: none
    mutable State to_;                         // the end of the last step
    std::vector<Gap> gaps_;                    // at to_
    Mode mode_;
    mutable bool fetched_ = true;  // to_ is up to date
    bool moved_ = false;           // the end was changed, so the stepper must be reinitialized
};

// ---- the work along a run: E(t) - E(0) = work - loss - heat (theory-gaps.md 1, theory-friction.md 5) ----

// Integrates the power along steps: v'Q + dV/dt - lambda dh/dt of held contacts; and the heat of friction.
class WorkIntegrator {
 public:
    WorkIntegrator(const Model& model, const Run& run);

    // Whether there is any work or heat. False if there is no friction, all forces have a potential, and neither it nor
    // the gaps depend on time.
    bool any() const { return any_; }
    // The work and heat from the start of a step to the time `to` (s) in it, in units of energy. Without friction they
    // are accurate to rounding, with friction as accurate as the motion.
    EnergyFlow along(const DenseSegment& piece, std::span<const double> coefficients, double to);

 private:
    struct Power {
        Evaluator<double> value;
        SeriesEvaluator<double> series;
    };
    Power* power_in(Mode mode);
    // The integral of the series of the power along the polynomials of the step. nullopt if its last terms are not
    // small: a power that depends on time may vary much faster than the motion. Gauss quadrature then evaluates it.
    std::optional<EnergyFlow> by_series(SeriesEvaluator<double>& power, const DenseSegment& piece,
                                        std::span<const double> coefficients, double to) const;

    bool any_;
    Eigen::Index dof_;
    double accurate_;  // largest part of the sum of a series that its last terms may have
    const Model* model_;
    std::vector<double> parameters_;
    std::map<Mode, std::optional<Power>> powers_;  // by mode, created at first use; nullopt if it is always 0
};

}  // namespace achilles
