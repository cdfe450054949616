#include "simulate/execution.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

std::string where(double t, const State& state) {
    std::string text = fmt::format("t = {:.9g}, q = (", t);
    for (Eigen::Index i = 0; i < state.q.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", state.q[i]);
    text += "), v = (";
    for (Eigen::Index i = 0; i < state.v.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", state.v[i]);
    return text + ")";
}

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

}  // namespace

Execution::Execution(std::shared_ptr<const Model> model, const Run& run, Watch* watch)
    : model_(std::move(model)),
      run_(run),
      watch_(watch),
      flow_(*model_, run_),
      surface_(*model_, run_),
      record_(model_, run_),
      restitution_(model_->evaluator(model_->restitution(), run_.parameters).output(0)),
      state_{run.q, run.v} {}

// ---- the start ----

void Execution::begin() {
    const Contact contact = contact_ = surface_.at(state_);
    takeoff_ = {{contact.h, contact.hdot}, 0};
    if (contact.h <= 4.0 * surface_.gap_error(state_)) {  // |h| and |hdot| within rounding count as zero
        takeoff_ = {{0.0, contact.hdot}, 1};
        const double error = 4.0 * surface_.hdot_error(state_);
        at_impact_ = contact.hdot < -error;
        if (std::abs(contact.hdot) <= error) start_in_contact(surface_.normal(state_));
    }
    record_.open(constrained_ ? Phase::Kind::constrained : Phase::Kind::hybrid, t_);
}

// h = 0 and hdot = 0: the sign of hddot decides, and where it is zero the sign of h'''.
void Execution::start_in_contact(const Surface::Normal& normal) {
    state_.v = reinitialize(surface_.at(state_), state_.v, Reinitialization::kinetic);
    if (certainly_positive(normal.hddot)) {
        takeoff_ = {{0.0, 0.0}, 2};
    } else if (certainly_negative(normal.hddot) || certainly_negative(normal.jerk)) {
        constrained_ = true;
    } else if (certainly_positive(normal.jerk)) {
        takeoff_ = {{0.0, 0.0}, 3};
    } else {
        stop(Outcome::Kind::undecided,
             "the contact force and its rate are zero to within rounding: contact or release cannot be decided at " +
                 where(t_, state_));
    }
}

// ---- flight ----

void Execution::fly_to_impact() {
    if (!at_impact_) {
        flow_.fly(t_, state_, takeoff_.gap, first_step_);
        record_.stretch(state_);
        while (!outcome_ && !find_impact()) {
        }
    }
    at_impact_ = false;
    if (!outcome_) land();
}

// The gap along the last step, as a polynomial in theta. It is the integrated increment; evaluating h(q) instead would
// leave a root uncertain by err(h)/w, which is longer than the last flights. Where h(q) at the step's end is known
// better (the difference is above its rounding), the polynomial is made to end there.
Polynomial Execution::gap_along() {
    Polynomial h = flow_.watched();
    const int known = takeoff_.multiplicity;
    for (int j = 0; j < known; ++j) h.c[static_cast<std::size_t>(j)] = 0.0;  // known roots stay roots
    if (flow_.is_expansion()) return h;
    const Contact contact = surface_.at(flow_.end());
    const double value = contact.h - h(1.0), slope = contact.hdot * flow_.duration() - h.slope(1.0);
    if (!surface_.within_gap_error(value, 4.0, contact, flow_.end())) {
        // theta^m (value - b + b theta), with this value and slope at 1, and nothing below theta^m
        const int m = std::max(2, known);
        const double b = slope - m * value;
        h.c[static_cast<std::size_t>(m)] += value - b;
        h.c[static_cast<std::size_t>(m + 1)] += b;
    }
    return h;
}

// One step. True if the flight is over, by an impact or an outcome.
bool Execution::find_impact() {
    if (!advance(run_.options.end_time - flow_.end_time())) return true;
    Polynomial h = gap_along();
    Descent descent = first_descent(h, takeoff_.multiplicity, flow_.remainder());
    if (takeoff_.inside && descent.kind == Descent::Kind::none) descent.kind = Descent::Kind::undecided;
    if (descent.kind == Descent::Kind::undecided) return leave_undecided(descent.theta);
    if (descent.kind == Descent::Kind::root) {
        if (descent.theta == 0.0) return true;  // it came down within the remainder of the last step
        if (locate_impact(descent.theta)) return true;
        h = gap_along();  // no impact after all, or the step became shorter
    }
    Gap gap{h(1.0), h.slope(1.0) / flow_.duration()};
    const Contact contact = surface_.at(flow_.end());
    if (!surface_.within_gap_error(contact.h - gap.h, 4.0, contact, flow_.end())) gap = {contact.h, contact.hdot};
    flow_.move_gap(gap);
    takeoff_ = {gap, 0, descent.kind == Descent::Kind::open};
    take(contact);
    return false;
}

// Whether the gap closes cannot be told from here on: the run ends there. Always true.
bool Execution::leave_undecided(double theta) {
    if (theta > 0.0 && flow_.retake(theta * flow_.duration()) == Obstacle::none) take(surface_.at(flow_.end()));
    stop(Outcome::Kind::undecided,
         fmt::format("the gap comes closer to zero than the integration knows it (to {:.1g}): an impact or none cannot "
                     "be told just after {}",
                     flow_.remainder(), where(t_, state_)));
    return true;
}

// Integrates to the root and corrects it by Newton's method until the rest is a Taylor step. False if there is no
// impact in the step after all (it was the dense output that dipped).
bool Execution::locate_impact(double theta) {
    double duration = theta * flow_.duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto obstacle = flow_.retake(duration); obstacle != Obstacle::none) {
            leave(obstacle);
            return true;
        }
        if (flow_.is_expansion()) break;
        const bool shortened = flow_.duration() < duration * (1.0 - 1e-12);
        const Polynomial h = gap_along();
        const double hdot = h.slope(1.0) / flow_.duration();
        if (shortened || !(hdot < 0.0)) return false;
        const double correction = -h(1.0) / hdot;
        if (std::abs(correction) < 1e-7 && std::abs(correction) < 1e-3 * duration) {
            flow_.shift_end(correction);
            break;
        }
        duration = std::max(duration + correction, 0.5 * duration);
    }
    const auto landed = surface_.project(flow_.end(), true);
    if (!landed) {
        stop(Outcome::Kind::left_the_domain,
             "dh = 0 where contact happens: the normal is not defined at " + where(flow_.end_time(), flow_.end()));
        return true;
    }
    flow_.move_end(landed->state);
    take(landed->contact);
    return true;
}

// ---- impact ----

void Execution::land() {
    const Contact& contact = contact_;
    if (!(contact.hdot < 0.0)) {
        stop(Outcome::Kind::undecided, "an impact whose speed is zero to within rounding at " + where(t_, state_));
        return;
    }
    Collision collision{t_, state_, -contact.hdot, reinitialize(contact, state_.v, Reinitialization::kinetic),
                        reinitialize(contact, state_.v, run_.options.truncation.reinitialization)};
    if (restitution_ == 0.0) {
        capture(collision);
    } else if (auto certificate = prove(&TruncationConditions::hold, collision)) {
        complete(collision, *certificate);
    } else if (too_short_to_resolve(collision, restitution_)) {
        if (auto widest = prove(&TruncationConditions::widest, collision)) {
            complete(collision, *widest);
        } else {
            stop(Outcome::Kind::undecided,
                 "flights became shorter than floating point resolves, and no truncation is certified at " +
                     where(t_, state_));
        }
    } else {
        bounce(contact, restitution_);
    }
}

// Asks the truncation conditions, which stand ready from the first question on.
std::optional<Certificate> Execution::prove(
    std::optional<Certificate> (TruncationConditions::*question)(const Collision&), const Collision& collision) {
    const auto clock = std::chrono::steady_clock::now();
    if (!conditions_) conditions_ = truncation_conditions(*model_, run_);
    auto certificate = ((*conditions_).*question)(collision);
    proving_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return certificate;
}

// Newton's law, and the flight it starts.
void Execution::bounce(const Contact& contact, double e) {
    if (record_.impacts() >= run_.options.max_impacts) {
        const bool elastic = e >= 1.0;
        stop(Outcome::Kind::too_many_impacts,
             fmt::format("{} impacts by t = {:.9g}, and the truncation conditions were never met{}", record_.impacts(),
                         t_, elastic ? ": with restitution 1 the bouncing does not converge" : ""));
        return;
    }
    Event event;
    event.kind = Event::Kind::impact;
    event.t = t_;
    event.q = state_.q;
    event.v_before = state_.v;
    event.v_after = impact(contact, state_.v, e);
    event.impact_speed = -contact.hdot;
    state_.v = event.v_after;
    record_.event(std::move(event));
    const double hdot = -e * contact.hdot;
    takeoff_ = {{0.0, hdot}, 1};
    first_step_ = 0.0;
    if (flow_.is_expansion()) return;
    const double hddot = surface_.normal_acceleration(state_);
    first_step_ = hddot < 0.0 ? 1.05 * 2.0 * hdot / -hddot : 0.0;  // a little past the predicted landing
}

// THEORY section 6: the next flight is lower than the rounding of h, or shorter than that of t.
bool Execution::too_short_to_resolve(const Collision& collision, double e) {
    // Far from it where the last step was neither short nor low.
    const double last = flow_.duration(), q = collision.before.q.cwiseAbs().maxCoeff();
    if (last > 1e-6 * (1.0 + collision.t) && last * collision.speed > 1e-8 * (1.0 + q)) return false;
    const double u = e * collision.speed;
    const double a = -surface_.normal_acceleration({collision.before.q, collision.tangential});
    if (!(a > 0.0)) return false;
    return u * u / (2.0 * a) < 4.0 * surface_.gap_error(collision.before) || 2.0 * u / a < 4.0 * ulp(collision.t);
}

// e = 0: the impact itself ends on the surface, at s. No bounce follows where hddot < 0, and the completion is exact.
void Execution::capture(const Collision& before) {
    Collision collision = before;
    collision.restart = collision.tangential;
    const Interval hddot = surface_.normal({collision.before.q, collision.restart}).hddot;
    if (certainly_negative(hddot)) {
        Certificate certificate;
        certificate.certified = true;
        certificate.conditions = run_.options.truncation.conditions;
        certificate.reinitialization = Reinitialization::kinetic;
        certificate.zeno_low = certificate.zeno_high = t_;
        certificate.shadowing_position = certificate.shadowing_velocity = 0.0;
        certificate.a_min = -hddot.hi();
        certificate.a_max = -hddot.lo();
        certificate.decisive = "exact: restitution 0";
        certificate.inequalities = {{"normal acceleration", hddot.hi(), 0.0}};
        complete(collision, certificate);
    } else if (certainly_positive(hddot)) {
        bounce(contact_, 0.0);
        takeoff_ = {{0.0, 0.0}, 2};
    } else {
        stop(Outcome::Kind::undecided,
             "after a plastic impact hddot is zero to within rounding: contact or flight cannot be decided at " +
                 where(t_, state_));
    }
}

// ---- completion ----

// The bouncing is replaced by the constrained motion from the collision on; the phase changes at the best estimate of
// the Zeno time, the middle of its interval.
void Execution::complete(const Collision& collision, Certificate certificate) {
    const double zeno_time = 0.5 * (certificate.zeno_low + certificate.zeno_high);
    state_ = {collision.before.q, collision.restart};
    record_.stretch(state_);
    flow_.stay(t_, state_);
    if (stay(std::min(zeno_time, run_.options.end_time))) {
        stop(Outcome::Kind::undecided, "the contact force vanishes before the Zeno time at " + where(t_, state_));
        return;
    }
    if (outcome_ || zeno_time > run_.options.end_time) return;
    Event event;
    event.kind = Event::Kind::zeno;
    event.t = t_ = zeno_time;
    event.q = state_.q;
    event.v_before = event.v_after = state_.v;
    event.truncation =
        Event::Truncation{collision.t, collision.before.q, collision.before.v, collision.restart, collision.speed};
    event.certificate = std::move(certificate);
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
    while (!outcome_ && until - t_ > 1e-15 * std::abs(t_)) {
        if (!advance(until - t_)) return false;
        const auto projected = surface_.project(flow_.end(), false);
        if (!projected) {
            stop(Outcome::Kind::left_the_domain,
                 "the motion cannot be kept on the surface at " + where(flow_.end_time(), flow_.end()));
            return false;
        }
        flow_.move_end(projected->state);
        Polynomial force = flow_.watched();
        for (double& c : force.c) c = -c;  // -hddot = W lambda
        if (!flow_.is_expansion()) force.c[2] += -surface_.normal_acceleration(projected->state) - force(1.0);
        if (!(force.c[0] > 0.0)) return true;  // it vanished at the step's start, to within rounding
        const Descent descent = first_descent(force, 0, flow_.remainder());
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
            take(projected->contact);
        }
    }
    if (!outcome_ && until >= run_.options.end_time) stop(Outcome::Kind::end_time, "reached the end time");
    return false;
}

// The same as locate_impact, for hddot = 0 along the constrained motion.
bool Execution::locate_release(double theta) {
    double duration = theta * flow_.duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto obstacle = flow_.retake(duration); obstacle != Obstacle::none) {
            leave(obstacle);
            return true;
        }
        const auto projected = surface_.project(flow_.end(), false);
        if (!projected || flow_.duration() < duration * (1.0 - 1e-12)) {
            if (projected) flow_.move_end(projected->state);
            return false;
        }
        const State& end = projected->state;
        flow_.move_end(end);
        const double correction = -surface_.normal_acceleration(end) / surface_.jerk(end);
        const bool close = std::abs(correction) < 1e-7;
        if (close) {
            flow_.shift_end(correction);
            if (const auto again = surface_.project(flow_.end(), false)) flow_.move_end(again->state);
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

// ---- steps and ends ----

// Tells the watch how far the run is, and asks whether it shall go on. Once a step: every impact and every release lies
// between two.
bool Execution::is_cancelled() {
    if (watch_ == nullptr) return false;
    watch_->time.store(t_, std::memory_order_relaxed);
    watch_->impacts.store(record_.impacts(), std::memory_order_relaxed);
    if (!watch_->stop.stop_requested()) return false;
    stop(Outcome::Kind::cancelled, fmt::format("cancelled at t = {:.9g}", t_));
    return true;
}

// One step of the flow, not longer than `longest`. False if the run is over.
bool Execution::advance(double longest) {
    if (is_cancelled()) return false;
    if (longest <= 1e-15 * std::abs(flow_.end_time())) {
        stop(Outcome::Kind::end_time, "reached the end time");
        return false;
    }
    if (record_.steps() >= run_.options.max_steps) {
        stop(Outcome::Kind::too_many_steps,
             fmt::format("{} steps by t = {:.9g}: the motion is too fast for this tolerance and end time",
                         record_.steps(), t_));
        return false;
    }
    const auto obstacle = flow_.step(longest);
    if (obstacle != Obstacle::none) leave(obstacle);
    return obstacle == Obstacle::none;
}

// Accepts the flow's last step; `contact` is that of its end.
void Execution::take(const Contact& contact) {
    contact_ = contact;
    record_.step(flow_, contact.h);
    t_ = flow_.end_time();
    state_ = flow_.end();
}

void Execution::leave(Obstacle obstacle) {
    const std::string place = where(t_, state_);
    switch (obstacle) {
        case Obstacle::left_the_domain:
            return stop(
                Outcome::Kind::left_the_domain,
                "the motion leaves the domain (M not positive definite, or a function undefined) just after " + place);
        case Obstacle::not_a_number:
            return stop(Outcome::Kind::not_a_number, "the motion runs away: no finite number follows " + place);
        default:
            return stop(Outcome::Kind::step_too_small, "no step is small enough for the tolerance after " + place);
    }
}

void Execution::stop(Outcome::Kind kind, std::string message) { outcome_ = Outcome{kind, std::move(message)}; }

Trajectory Execution::finish() {
    Trajectory trajectory = record_.finish(t_, state_, std::move(*outcome_), flow_.evaluations());
    trajectory.statistics.certificate_seconds = proving_;
    return trajectory;
}

}  // namespace achilles
