// A Taylor series of the motion, of high order, as a stepper: the step ends where the series stops being exact.
#pragma once

#include "series/series.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

// With q_{k+1} = v_k/(k+1) and v_{k+1} = f_k/(k+1), order k of the program gives order k + 1 of the motion. The gap (in
// flight) and hddot (in contact) are outputs of the same program, so their series come with it.
//
// Order and step: term k of the motion in units of the tolerance is m_k t^k. A step of order p ends where its last
// terms reach 1. How far the next event can be is often known from the first terms (a flight ends about where its
// parabola does); then the order is the first one whose terms are that small there, and a short flight costs a few
// orders. Else it is the order at which the cost of a step over its length is least.
class Taylor : public Stepper {
 public:
    Taylor(const Model& model, const Run& run);

    void initialize(ContactSet held, const State& state, const Gap& gap) override;
    StepFailure do_step(double longest, double first, double least) override;
    StepFailure redo_step(double duration, double least) override;
    double current_time() const override { return span_; }
    const State& current_state() override;
    Polynomial event_function() const override;
    std::uint32_t coefficients(std::vector<double>& coefficients) const override;
    bool stays_negative() const override;
    double remainder(const Polynomial& p) const override;
    void add_error(const Polynomial& p, Gap& end) const override;
    bool is_expansion() const override { return true; }
    long evaluations() const override { return evaluations_; }

 private:
    double* row(int k) { return rows_.data() + static_cast<std::size_t>(k) * width_; }
    const double* row(int k) const { return rows_.data() + static_cast<std::size_t>(k) * width_; }
    StepFailure expand(double longest);
    void extend_flight(SeriesMotion& motion, double longest);
    StepFailure extend(SeriesEvaluator& series, double longest);
    bool three_before_vanish() const;
    double parabola_root(double longest) const;
    struct Magnitude {
        double m;
        std::size_t component;  // that it is of
    };
    double size(const double* c) const;
    Magnitude magnitude(const double* c) const;
    StepFailure leave_out_infinite();
    double natural_step();
    double far_term(int k, std::size_t component, double t) const;
    void evaluate_far(double duration);
    double within_numbers(double step);
    void evaluate(double duration);
    double drifting() const;
    double earlier_error() const;
    double own_remainder(double size, double last_terms) const;

    std::size_t dof_, width_;  // width: q, v, what is watched
    double tolerance_;
    SeriesEvaluator flight_, contact_;
    int flight_order_, contact_order_;
    ContactSet held_;
    Gap gap_;
    State to_;
    bool evaluated_ = true;      // to_ is the step's end, not its start
    std::vector<double> rows_;   // coefficients, order by order: q, v, watched
    std::vector<double> units_;  // 1/(tolerance of each component)
    int order_ = 0;              // of the last expansion
    double target_ = 0.0;        // the longest step that it is needed for, as far as is known
    double power_ = 0.0;         // target^order
    bool reached_ = false;       // the last two terms are small there
    double span_ = 0.0;
    long evaluations_ = 0;
};

}  // namespace achilles
