// The part of an execution on the surface: completion of a bouncing, contact, release.
#include <algorithm>
#include <cmath>

#include "simulate/execution.hpp"

namespace achilles {

// ---- completion ----

// The collision is the last impact that is drawn: the bouncing after it is replaced by the constrained motion. The
// phase changes at the best estimate of the Zeno time.
void Execution::complete(const Collision& collision, Certificate certificate) {
    record_.impact(t_, state_, impact(contact_, state_.v, restitution_), collision.speed);
    state_ = {collision.before.q, collision.restart};
    record_.stretch(state_);
    constrained_start_ = {};
    cut_error_ += std::max(certificate.shadowing_position.value_or(0.0), certificate.shadowing_velocity.value_or(0.0));
    Event& event = completion_.emplace();
    event.kind = Event::Kind::zeno;
    event.t = certificate.zeno_time;
    event.truncation =
        Event::Truncation{collision.t, collision.before.q, collision.before.v, collision.restart, collision.speed};
    event.certificate = std::move(certificate);
}

double Execution::contact_until() const {
    return completion_ ? std::min(completion_->t, run_.options.end_time) : run_.options.end_time;
}

void Execution::wait_for_zeno_point() {
    const Beginning start = beginning();
    bool vanished = false;
    do {
        flow().stay(t_, state_, start.state_error);
        vanished = advance_constrained(contact_until());
    } while (doubt_ && try_exactly(start));
    settle();
    Event event = std::move(*completion_);
    completion_.reset();
    if (vanished)
        stop(Outcome::Kind::undecided, "the contact force vanishes before the Zeno time at " + where(t_, state_));
    if (outcome_ || event.t > run_.options.end_time) return;
    t_ = event.t;
    event.q = state_.q;
    event.v_before = event.v_after = state_.v;
    record_.event(std::move(event));
    record_.close(t_);
    record_.open(Phase::Kind::constrained, t_);
    constrained_ = true;
}

// ---- contact ----

void Execution::stay_until_release() {
    const Beginning start = beginning();
    bool vanished = false;
    do {
        flow().stay(t_, state_, start.state_error);
        record_.stretch(state_);
        vanished = advance_constrained(run_.options.end_time);
    } while (doubt_ && try_exactly(start));
    settle();
    if (vanished) release();
}

// Moves on the surface until a time (false) or until the contact force vanishes (true).
bool Execution::advance_constrained(double until) {
    while (!outcome_ && !doubt_ && until - t_ > 1e-15 * std::abs(t_))
        if (constrained_step(until)) return true;
    if (!outcome_ && !doubt_ && until >= run_.options.end_time) stop(Outcome::Kind::end_time, "reached the end time");
    return false;
}

// One step of it. True if the contact force vanishes where it ends.
bool Execution::constrained_step(double until) {
    if (!advance(until)) return false;
    Descent descent = flow().stays_negative() ? Descent{} : force_descent();
    if (descent.kind == Descent::Kind::rose && end_step_at(descent.theta)) descent = force_descent();
    bool asked_again = false;
    switch (descent.kind) {
        case Descent::Kind::none:
            break;
        case Descent::Kind::root:
            if (descent.theta == 0.0) return true;
            if (locate_release(descent.theta)) return !outcome_;
            break;  // the step became shorter
        case Descent::Kind::rose:
            if (!knows_its_start() || constrained_start_.asked_again) return doubt_force(0.0);
            break;
        case Descent::Kind::open:
            // As in flight: a dip that holds the end of a step lies inside the next one.
            asked_again = !constrained_start_.asked_again && end_step_at(descent.theta);
            if (!asked_again && !(knows_its_start() && flow().end_time() >= until)) return doubt_force(descent.theta);
            break;
        case Descent::Kind::undecided:
            return doubt_force(descent.theta);
    }
    constrained_start_ = {0, asked_again};
    accept_constrained_step();
    return false;
}

// Accepts the flow's last step, moved onto the surface. False, and the run is over, if it cannot be.
bool Execution::accept_constrained_step() {
    const auto projected = kinematics_.project(flow().edit_end(), false);
    accept_step(projected ? *projected : kinematics_.at(flow().end()));
    if (!projected) fail_projection(t_, state_);
    return projected.has_value();
}

// Whether the force vanishes cannot be told from theta on: the motion goes there, and ends in doubt. Always false.
bool Execution::doubt_force(double theta) {
    if (end_step_at(theta) && !accept_constrained_step()) return false;
    doubt_ = "the contact force comes closer to zero than the integration knows it just after " + where(t_, state_);
    return false;
}

// Where the contact force vanishes along the last step: -hddot = W lambda. At theta = 0 if it did before, to within
// rounding.
Descent Execution::force_descent() {
    Polynomial force = flow().event_function();
    for (int i = 0; i <= force.degree; ++i) force.c[static_cast<std::size_t>(i)] *= -1.0;
    if (!flow().is_expansion()) {
        State end = flow().end();
        kinematics_.project(end, false);
        force.c[2] += -kinematics_.normal_acceleration(end) - force(1.0);
    }
    if (constrained_start_.known > 0) {
        force.c[0] = 0.0;
    } else if (!(force.c[0] > 0.0)) {
        return {Descent::Kind::root, 0.0};
    }
    return first_descent(force, constrained_start_.known, flow().remainder(force));
}

// The same as locate_impact, for hddot = 0 along the constrained motion.
bool Execution::locate_release(double theta) {
    double duration = theta * flow().duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto failure = flow().redo_step(duration); failure != StepFailure::none) {
            stop_at(failure);
            return true;
        }
        const auto projected = kinematics_.project(flow().edit_end(), false);
        if (!projected || flow().duration() < duration * (1.0 - 1e-12)) return false;
        const State& end = flow().end();
        const double correction = -kinematics_.normal_acceleration(end) / kinematics_.jerk(end);
        const bool close = std::abs(correction) < 1e-7;
        if (close) {
            flow().shift_end(correction);
            kinematics_.project(flow().edit_end(), false);
            break;
        }
        if (!std::isfinite(correction)) break;  // a touch: the release decides
        duration = std::max(duration + correction, 0.5 * duration);
    }
    accept_step(kinematics_.at(flow().end()));
    return true;
}

// lambda = 0. It is a release where h''' > 0 is proved; otherwise contact and flight cannot be told apart.
void Execution::release() {
    if (!certainly_positive(kinematics_.normal(state_).jerk)) {
        stop(Outcome::Kind::undecided,
             "the contact force touches zero and h''' > 0 is not proved at " + where(t_, state_));
        return;
    }
    Event event;
    event.kind = Event::Kind::release;
    event.t = t_;
    event.q = state_.q;
    event.v_before = event.v_after = state_.v;
    record_.event(std::move(event));
    record_.close(t_);
    record_.open(Phase::Kind::hybrid, t_);
    constrained_ = false;
    constrained_start_ = {};
    flight_start_ = {{0.0, 0.0}, 3};
    first_step_ = 0.0;
}

}  // namespace achilles
