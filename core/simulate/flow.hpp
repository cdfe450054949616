// One smooth stretch of motion, free or in contact, advanced by an adaptive stepper with dense output, whichever it is.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/polynomial.hpp"
#include "run/trajectory.hpp"
#include "simulate/edge_watch.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

class Flow {
 public:
    Flow(const Model& model, const Run& run);

    // Starts a stretch at this state in this mode. In flight the first step is at most `first_step` (s); 0
    // leaves it to the stepper. One gap for each contact; of a held one's only the state_error counts.
    void start(Mode mode, const State& state, std::span<const Gap> gaps, double first_step);
    // Advances by one accepted step, not past the time `until`, which is met exactly. Where a function leaves its
    // domain inside a step the step is shortened, until it is too short to be a step: that is the failure. So it is
    // where one comes to an edge inside (model/edges.hpp).
    StepFailure step(double until);
    // Makes the last step again with this shorter duration, so that its end is as good as that of a step.
    StepFailure redo_step(double duration);
    // The end of the last step, to be moved (onto the surface, say); the next step starts from there.
    State& edit_end();
    // An open contact's gap at the end of the last step, where the next one starts.
    void move_gap(std::size_t contact, const Gap& gap);
    // Moves the end of the last step along the motion by a time so short that a second-order Taylor step is exact.
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
    // Of a contact along the last step: h where it is open, hddot of the free motion where it is held (Stepper).
    void event_function(std::size_t contact, Polynomial& p) const { stepper_->event_function(contact, p); }
    bool stays_negative(std::size_t contact) const { return stepper_->stays_negative(contact); }
    bool is_expansion() const { return stepper_->is_expansion(); }
    double remainder(std::size_t contact, const Polynomial& p) const { return stepper_->remainder(contact, p); }
    void add_error(std::size_t contact, const Polynomial& p, Gap& end) const { stepper_->add_error(contact, p, end); }
    // The last step as a piece of dense output; coefficients are appended. Its ends are those of the step exactly.
    Piece piece(std::vector<double>& coefficients) const;

    long evaluations() const { return stepper_->evaluations(); }

 private:
    double least() const;

    std::unique_ptr<Stepper> stepper_;
    std::unique_ptr<EdgeWatch> edges_;  // null where the system has none
    const Model* model_;
    std::vector<double> parameters_;
    Model::MotionEvaluators motions_;          // of those met so far
    double t_ = 0.0, span_ = 0.0, end_ = 0.0;  // end: t + span, as it is rounded
    double first_ = 0.0;                       // bound on the next step; 0: none
    mutable State to_;                         // the end of the last step,
    std::vector<Gap> gaps_;                    // at `to`
    Mode mode_;
    mutable bool fetched_ = true;  // the end has been asked for
    bool moved_ = false;           // it is not where the stepper left it
};

// What is done on a system along its run: E(t) - E(0) = work - loss (theory-gaps.md 1).

// Integrates the power along pieces: v'Q + dV/dt, in contact less lambda dh/dt.
class Work {
 public:
    Work(const Model& model, const Run& run);

    // Whether there is any: not where all forces have a potential that, as the gap, does not depend on the time.
    bool any() const { return any_; }
    // Over [from, to] inside a piece, in units of the energy: by Gauss's rule with as many points as the piece has powers, so that
    // a product of two such polynomials is met exactly.
    double along(const Piece& piece, std::span<const double> coefficients, double from, double to);

 private:
    bool any_;
    Eigen::Index dof_;
    const Model* model_;
    std::vector<double> parameters_;
    std::map<Mode, Evaluator<double>> powers_;  // of the motions met so far
};

}  // namespace achilles
