// The steps of a motion on the surface: where the contact force vanishes.
#include <algorithm>
#include <cmath>

#include "simulate/event_stepper.hpp"

namespace achilles {

// What the flow's last step came to.
StepResult::End EventStepper::find_release() {
    const bool asked_before = request_->start.asked_again;
    Descent descent = flow_->stays_negative(contact) ? Descent{} : force_descent();
    if (descent.kind == Descent::Kind::rose && end_step_at(descent.theta)) descent = force_descent();
    bool asked_again = false;
    switch (descent.kind) {
        case Descent::Kind::none:
            break;
        case Descent::Kind::root:
            if (descent.theta == 0.0) return End::force_vanishes;
            if (const auto end = locate_release(descent.theta)) return *end;
            break;  // the step became shorter
        case Descent::Kind::rose:
            if (!knows_its_start() || asked_before) return doubt_force(0.0);
            break;
        case Descent::Kind::open:
            // As in flight: a dip that holds the end of a step lies inside the next one.
            asked_again = !asked_before && end_step_at(descent.theta);
            if (!asked_again && !(knows_its_start() && is_last())) return doubt_force(descent.theta);
            break;
        case Descent::Kind::undecided:
            return doubt_force(descent.theta);
    }
    result_.start = {{}, 0, asked_again};
    return end_on_surface() ? End::no_event : End::off_surface;
}

// Ends the flow's last step moved onto the surface. False if it cannot be.
bool EventStepper::end_on_surface() {
    const auto projected = kinematics_->project(flow_->edit_end(), false);
    end_step(projected ? projected->h : kinematics_->at(flow_->end()).h);
    return projected.has_value();
}

// Whether the force vanishes cannot be told from theta on: the step ends there.
StepResult::End EventStepper::doubt_force(double theta) {
    if (end_step_at(theta) && !end_on_surface()) return End::off_surface;
    return End::doubt;
}

// Where the contact force vanishes along the last step: -hddot = W lambda. At theta = 0 if it did before, to within
// rounding.
Descent EventStepper::force_descent() {
    const int multiplicity = request_->start.multiplicity;
    Polynomial force = flow_->event_function(contact);
    for (int i = 0; i <= force.degree; ++i) force.c[static_cast<std::size_t>(i)] *= -1.0;
    if (!flow_->is_expansion()) {
        State end = flow_->end();
        kinematics_->project(end, false);
        force.c[2] += -kinematics_->normal_acceleration(end) - force(1.0);
    }
    if (multiplicity > 0) {
        force.c[0] = 0.0;
    } else if (!(force.c[0] > 0.0)) {
        return {Descent::Kind::root, 0.0};
    }
    return first_descent(force, multiplicity, flow_->remainder(contact, force));
}

// The same as locate_impact, for hddot = 0 along the constrained motion.
std::optional<StepResult::End> EventStepper::locate_release(double theta) {
    double duration = theta * flow_->duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto failure = flow_->redo_step(duration); failure != StepFailure::none) return fail(failure);
        const auto projected = kinematics_->project(flow_->edit_end(), false);
        if (!projected || flow_->duration() < duration * (1.0 - 1e-12)) return std::nullopt;
        const State& end = flow_->end();
        const double correction = -kinematics_->normal_acceleration(end) / kinematics_->jerk(end);
        const bool close = std::abs(correction) < 1e-7;
        if (close) {
            flow_->shift_end(correction);
            kinematics_->project(flow_->edit_end(), false);
            break;
        }
        if (!std::isfinite(correction)) break;  // a touch: the release decides
        duration = std::max(duration + correction, 0.5 * duration);
    }
    end_step(kinematics_->at(flow_->end()).h);
    return End::force_vanishes;
}

}  // namespace achilles
