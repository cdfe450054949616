// High-order Taylor series of the motion as a stepper; a step ends where the series stops being accurate.
#pragma once

#include <map>
#include <vector>

#include "series/taylor_step.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

// TaylorStep makes the step and AdaptiveOrder chooses its order. This class adapts them to states, and handles steps so
// long that powers of their length overflow.
class TaylorStepper : public Stepper {
 public:
    TaylorStepper(const Model& model, const Run& run, ContactCache& surfaces);

    void initialize(Mode mode, const State& state, std::span<const Gap> gaps) override;
    StepFailure do_step(double time, double longest, double first, double least) override;
    StepFailure redo_step(double duration, double least) override;
    double current_time() const override { return span_; }
    const State& current_state() override;
    void event_function(std::size_t contact, Polynomial& p) const override;
    std::uint32_t coefficients(std::vector<double>& coefficients) const override;
    std::optional<TimeSeries> time_series() const override;
    bool stays_negative(std::size_t contact) const override;
    double remainder(std::size_t contact, const Polynomial& p) const override;
    void add_error(std::size_t contact, const Polynomial& p, Gap& end) const override;
    std::optional<EnergyFlow> energy_flow() const override;
    bool is_expansion() const override { return true; }
    long evaluations() const override { return evaluations_; }

 private:
    // The series of one mode and its order control.
    struct MotionExpansion {
        SeriesEvaluator<double> series;
        AdaptiveOrder order;
        std::span<const FrictionEvent> friction;  // the event functions after those of the contacts
        std::size_t guards = 0;                   // how many watched guards follow
        std::size_t powers = 0;                   // how many powers follow
        std::size_t further_events() const { return friction.size() + guards; }
    };
    StepFailure expand(double longest);
    double far_term(int k, std::size_t component, double t) const;
    void evaluate_far(double duration);
    double within_numbers(double step);
    void evaluate(double duration);

    std::size_t dof_;
    double tolerance_;
    const Model* model_;
    std::span<const double> parameters_;
    std::map<Mode, MotionExpansion> motions_;  // created at first use
    MotionExpansion* motion_ = nullptr;        // the entry of mode_
    Mode mode_;
    TaylorStep<double> step_;
    GapUnits gap_units_;
    State to_;
    bool evaluated_ = true;  // to_ is the end of the step, not its start
    double span_ = 0.0;
    long evaluations_ = 0;
};

}  // namespace achilles
