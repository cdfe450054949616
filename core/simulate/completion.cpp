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
    flow_.stay(t_, state_);
    const bool vanished = stay(contact_until());
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
    flow_.stay(t_, state_);
    record_.stretch(state_);
    if (stay(run_.options.end_time)) release();
}

// Moves on the surface until a time (false) or until the contact force vanishes (true).
bool Execution::stay(double until) {
    while (!outcome_ && until - t_ > 1e-15 * std::abs(t_))
        if (stay_step(until)) return true;
    if (!outcome_ && until >= run_.options.end_time) stop(Outcome::Kind::end_time, "reached the end time");
    return false;
}

// One step of it. True if the contact force vanishes where it ends.
bool Execution::stay_step(double until) {
    if (!advance(until - t_)) return false;
    const auto projected = surface_.project(flow_.moved_end(), false);
    if (!projected) {
        leave_contact(flow_.end_time(), flow_.end());
        return false;
    }
    const auto descent = flow_.stays_negative() ? Descent{} : force_descent();
    if (descent.kind == Descent::Kind::root && descent.theta == 0.0) return true;
    if (descent.kind == Descent::Kind::undecided) {
        stop(Outcome::Kind::undecided,
             "the contact force comes closer to zero than the integration knows it just after " +
                 where(flow_.begin_time() + descent.theta * flow_.duration(), state_));
        return false;
    }
    if (descent.kind == Descent::Kind::root) {
        if (locate_release(descent.theta)) return !outcome_;
        take(surface_.at(flow_.end()));  // the step became shorter
    } else {
        take(*projected);
    }
    return false;
}

// Where the contact force vanishes along the last step: -hddot = W lambda. At theta = 0 if it did before, to within
// rounding.
Descent Execution::force_descent() {
    Polynomial force = flow_.watched();
    for (int i = 0; i <= force.degree; ++i) force.c[static_cast<std::size_t>(i)] *= -1.0;
    if (!flow_.is_expansion()) force.c[2] += -surface_.normal_acceleration(flow_.end()) - force(1.0);
    if (!(force.c[0] > 0.0)) return {Descent::Kind::root, 0.0};
    return first_descent(force, 0, flow_.remainder(force));
}

// The same as locate_impact, for hddot = 0 along the constrained motion.
bool Execution::locate_release(double theta) {
    double duration = theta * flow_.duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto obstacle = flow_.retake(duration); obstacle != Obstacle::none) {
            leave(obstacle);
            return true;
        }
        const auto projected = surface_.project(flow_.moved_end(), false);
        if (!projected || flow_.duration() < duration * (1.0 - 1e-12)) return false;
        const State& end = flow_.end();
        const double correction = -surface_.normal_acceleration(end) / surface_.jerk(end);
        const bool close = std::abs(correction) < 1e-7;
        if (close) {
            flow_.shift_end(correction);
            surface_.project(flow_.moved_end(), false);
            break;
        }
        if (!std::isfinite(correction)) break;  // a touch: the release decides
        duration = std::max(duration + correction, 0.5 * duration);
    }
    take(surface_.at(flow_.end()));
    return true;
}

// lambda = 0. It is a release where h''' > 0 is proved; otherwise contact and flight cannot be told apart.
void Execution::release() {
    if (!certainly_positive(surface_.normal(state_).jerk)) {
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
    takeoff_ = {{0.0, 0.0}, 3};
    first_step_ = 0.0;
}

}  // namespace achilles
