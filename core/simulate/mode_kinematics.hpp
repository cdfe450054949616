// The event functions of a mode at one state, and their rates along the motion (ModeDynamics).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "number/interval.hpp"
#include "run/state.hpp"

namespace achilles {

class ModeKinematics {
 public:
    ModeKinematics(const Model& model, std::span<const double> parameters, Mode mode);

    // The number of event functions: one for each contact, then those of friction and the watched guards.
    std::size_t events() const { return contacts_ + dynamics_->further_events(); }
    // The number of the event function of the first watched guard.
    std::size_t first_guard() const { return contacts_ + dynamics_->friction.size(); }
    std::span<const FrictionEvent> friction() const { return dynamics_->friction; }

    // Value and rate of an event function; for an open contact the value is hddot, and there is no rate.
    template <class Number>
    struct EventValue {
        Number value, rate;
    };
    EventValue<double> at(const State& state, std::size_t event);
    // All of them over the rounding box of a state.
    std::vector<EventValue<Interval>> enclosed(const State& state);
    Vector acceleration(const State& state);

 private:
    template <class Evaluator>
    auto value_of(const Evaluator& terms, std::size_t event) const;
    void run(const State& state);

    const Model* model_;
    std::vector<double> parameters_;
    Mode mode_;
    const ModeDynamics* dynamics_;
    std::size_t contacts_, dof_;
    std::optional<MotionTerms<Evaluator<double>>> terms_;
    std::optional<MotionTerms<Evaluator<Interval>>> enclosure_;
};

}  // namespace achilles
