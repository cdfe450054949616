// The contacts that are held along a step: where the force of one vanishes.
#include <algorithm>
#include <cmath>

#include "simulate/event_stepper.hpp"

namespace achilles {

// Nothing where the force goes on along the step, as it then is.
std::optional<StepResult::End> EventStepper::meet_force(Descent descent) {
    const bool asked_before = start_of(contact_).asked_again;
    if (descent.kind == Descent::Kind::rose && end_step_at(descent.theta)) descent = force_descent();
    switch (descent.kind) {
        case Descent::Kind::none:
            break;
        case Descent::Kind::root:
            if (descent.theta == 0.0) return End::force_vanishes;
            return locate_release(descent.theta);  // nothing: the step has become shorter
        case Descent::Kind::rose:
            if (!knows_its_start() || asked_before) return doubt_force(0.0);
            break;
        case Descent::Kind::open:
            // As in flight: a dip that holds the end of a step lies inside the next one.
            if (!asked_before && end_step_at(descent.theta)) {
                asked_again_ = asked_again_.with(contact_);
            } else if (!(knows_its_start() && is_last())) {
                return doubt_force(descent.theta);
            }
            break;
        case Descent::Kind::undecided:
            return doubt_force(descent.theta);
    }
    return std::nullopt;
}

// Ends the flow's last step moved onto the surfaces of what is held. False if it cannot be.
bool EventStepper::end_on_surface() {
    const auto gap = surfaces_->project(flow_->edit_end(), held(), held());
    end_step(gap ? *gap : surfaces_->of(contact_).at(flow_->end()).h);
    return gap.has_value();
}

// Whether the force vanishes cannot be told from theta on: the step ends there.
StepResult::End EventStepper::doubt_force(double theta) {
    if (!end_step_at(theta)) return End::doubt;
    if (!end_on_surface()) return End::off_surface;
    const std::size_t contact = contact_;
    settle_gaps({}, result_.gap);
    contact_ = contact;
    return End::doubt;
}

// Where a contact force vanishes along the last step: -hddot = W lambda. At theta = 0 if it did before, to within
// rounding.
Descent EventStepper::force_descent() {
    if (flow_->stays_negative(contact_)) return {};
    const int multiplicity = start_of(contact_).multiplicity;
    Polynomial force;
    flow_->event_function(contact_, force);
    for (int i = 0; i <= force.degree; ++i) force.c[static_cast<std::size_t>(i)] *= -1.0;
    if (!flow_->is_expansion()) {
        State end = flow_->end();
        surfaces_->project(end, held(), held());
        force.c[2] += -surfaces_->of(contact_, request_->mode.without(contact_)).normal_acceleration(end) - force(1.0);
    }
    if (multiplicity > 0) {
        force.c[0] = 0.0;
    } else if (!(force.c[0] > 0.0)) {
        return {Descent::Kind::root, 0.0};
    }
    return first_descent(force, multiplicity, flow_->remainder(contact_, force));
}

// The same as locate_impact, for hddot = 0 along the constrained motion.
std::optional<StepResult::End> EventStepper::locate_release(double theta) {
    ContactKinematics& leaving = surfaces_->of(contact_, request_->mode.without(contact_));
    const double longest = flow_->duration();  // where the force only touches zero Newton's method would run away
    double duration = theta * longest;
    for (int round = 0; round < 8; ++round) {
        known_ = {};
        if (const auto failure = flow_->redo_step(duration); failure != StepFailure::none) return fail(failure);
        const bool projected = surfaces_->project(flow_->edit_end(), held(), held()).has_value();
        if (!projected || flow_->duration() < duration * (1.0 - 1e-12)) return std::nullopt;
        const State& end = flow_->end();
        const double correction = -leaving.normal_acceleration(end) / leaving.jerk(end);
        const bool close = std::abs(correction) < 1e-7;
        if (close) {
            known_ = {};
            flow_->shift_end(correction);
            surfaces_->project(flow_->edit_end(), held(), held());
            break;
        }
        if (!std::isfinite(correction)) break;  // a touch: the release decides
        duration = std::clamp(duration + correction, 0.5 * duration, longest);
    }
    const std::size_t contact = contact_;
    double least = surfaces_->of(contact).at(flow_->end()).h;
    settle_gaps({}, least);
    contact_ = contact;
    end_step(least);
    return End::force_vanishes;
}

}  // namespace achilles
