// One step of a smooth motion after the other, with dense output: what an integrator must offer to the flow.
//
// The calls bear the names that Boost.Odeint gives to those of a dense-output stepper. Time runs from 0 in every step,
// so that the shortest flight late in a run has all its digits; what depends on the time is told when a step begins. Besides (q, v), every step carries the event function of
// each contact: the gap where it is open, hddot of the free motion where it is held.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/polynomial.hpp"
#include "run/mode.hpp"
#include "run/trajectory.hpp"
#include "series/gap.hpp"

namespace achilles {

// Why a step could not be made.
enum class StepFailure { none, left_the_domain, not_a_number, step_too_small };

class Stepper {
 public:
    virtual ~Stepper() = default;

    // Stands at a state, ready to step on from there in this mode. One gap for each contact; of a held
    // one's only the state_error counts.
    virtual void initialize(Mode mode, const State& state, std::span<const Gap> gaps) = 0;
    // One accepted step from where the stepper stands, at this time, not longer than `longest`; `first` > 0 is a step that
    // is known to be sensible after an impact. `least` is the shortest that time can resolve.
    virtual StepFailure do_step(double time, double longest, double first, double least) = 0;
    // The last step again, from the same state, with this duration.
    virtual StepFailure redo_step(double duration, double least) = 0;

    // The last step: [0, current_time], and what is reached there (its t has no meaning).
    virtual double current_time() const = 0;
    virtual const State& current_state() = 0;

    // Along the last step, polynomials in theta = t/current_time: a contact's event function, and (q, v) as blocks of
    // ascending powers, appended to `coefficients`; their degree is returned.
    virtual void event_function(std::size_t contact, Polynomial& p) const = 0;
    virtual std::uint32_t coefficients(std::vector<double>& coefficients) const = 0;
    // Whether it is known to stay below zero along the last step, by more than its remainder. False says nothing.
    virtual bool stays_negative(std::size_t) const { return false; }
    // Bound, as good as the method knows one, on how far it is from the motion that starts at the same state.
    virtual double remainder(std::size_t contact, const Polynomial& event_function) const = 0;
    // Adds to a contact's gap at the end of the last step what later steps must take it to be wrong by.
    virtual void add_error(std::size_t contact, const Polynomial& event_function, Gap& end) const = 0;
    // True if a step is an expansion about its start: any part of it is as good as the whole, event functions are those
    // of the state's own values, and no first guess is needed. False if it is integrated to its end: an event function
    // then drifts from its value at (q, v) within the tolerance, and between the ends it is interpolated.
    virtual bool is_expansion() const = 0;

    virtual long evaluations() const = 0;
};

std::unique_ptr<Stepper> make_dopri5(const Model& model, const Run& run);
std::unique_ptr<Stepper> make_taylor(const Model& model, const Run& run);

}  // namespace achilles
