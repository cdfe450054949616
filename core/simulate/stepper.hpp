// Interface of the integrators: steps of a smooth motion with dense output.
//
// The functions are named as in a dense-output stepper of Boost.Odeint. Time runs from 0 in every step, so that a short
// flight late in a run keeps all its digits; the start time is passed when a step begins. Each step carries (q, v) and
// the event functions of its mode: of each contact, the gap if it is open, hddot of the mode without it if it is held;
// then those of friction (ModeDynamics). Below, `contact` is the number of an event function.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/polynomial.hpp"
#include "run/mode.hpp"
#include "run/trajectory.hpp"
#include "series/gap.hpp"

namespace achilles {

class ContactCache;

// The energy that a motion takes up from forces and moving surfaces, and what friction turns into heat.
struct EnergyFlow {
    double work = 0.0, heat = 0.0;
};

// Why a step could not be made.
enum class StepFailure { none, left_the_domain, not_a_number, step_too_small };

class Stepper {
 public:
    virtual ~Stepper() = default;

    // Sets the state and the mode for the next step. `gaps` has one entry for each contact; of a held contact, only
    // state_error is used.
    virtual void initialize(Mode mode, const State& state, std::span<const Gap> gaps) = 0;
    // Makes one accepted step from the current state, at this time, not longer than `longest` (s). `first` > 0 is a
    // reasonable length for a step after an impact. `least` is the shortest step that time can resolve.
    virtual StepFailure do_step(double time, double longest, double first, double least) = 0;
    // Repeats the last step from the same state with this duration (s).
    virtual StepFailure redo_step(double duration, double least) = 0;

    // The last step, [0, current_time], and the state at its end (whose t is not set).
    virtual double current_time() const = 0;
    virtual const State& current_state() = 0;

    // Along the last step, as polynomials in theta = t/current_time: the event function of a contact; and (q, v) as
    // blocks of ascending powers, appended to `coefficients`. The latter returns their degree.
    virtual void event_function(std::size_t contact, Polynomial& p) const = 0;
    virtual std::uint32_t coefficients(std::vector<double>& coefficients) const = 0;
    // The same in time: order k of (q, v) begins at first + k width, 0 <= k <= degree. nullopt if the stepper does not
    // expand the motion, or if powers of the step's length may overflow.
    struct TimeSeries {
        const double* first;
        std::size_t width;
        int degree;
    };
    virtual std::optional<TimeSeries> time_series() const { return std::nullopt; }
    // Whether the event function is known to stay below zero along the last step by more than its remainder. False
    // means unknown.
    virtual bool stays_negative(std::size_t) const { return false; }
    // The same above zero, of a gap.
    virtual bool stays_positive(std::size_t) const { return false; }
    // Estimated bound on the difference from the exact solution that starts at the same state.
    virtual double remainder(std::size_t contact, const Polynomial& event_function) const = 0;
    // Adds the errors of this step to the error bounds of a contact's gap at its end.
    virtual void add_error(std::size_t contact, const Polynomial& event_function, Gap& end) const = 0;
    // The integrals of the mode's powers (ModeDynamics) along the last step, in units of energy. nullopt if the stepper
    // does not expand them, or if the last terms are not small: a power may vary much faster than the motion.
    virtual std::optional<EnergyFlow> energy_flow() const { return std::nullopt; }
    // True if a step is a series expansion about its start. Any part of it is then as accurate as the whole, event
    // functions start at the values of the state itself, and no first step is guessed. False if a step is integrated to
    // its end. An event function may then differ from its value at (q, v) within the tolerance, and is interpolated
    // between the ends.
    virtual bool is_expansion() const = 0;

    virtual long evaluations() const = 0;
};

// `surfaces` of this run; it must outlive the stepper.
std::unique_ptr<Stepper> make_dopri5(const Model& model, const Run& run, ContactCache& surfaces);
std::unique_ptr<Stepper> make_taylor(const Model& model, const Run& run, ContactCache& surfaces);

}  // namespace achilles
