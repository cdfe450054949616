#include "simulate/execution.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "simulate/domain.hpp"

namespace achilles {

std::string where(double t, const State& state) {
    std::string text = fmt::format("t = {:.9g}, q = (", t);
    for (Eigen::Index i = 0; i < state.q.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", state.q[i]);
    text += "), v = (";
    for (Eigen::Index i = 0; i < state.v.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", state.v[i]);
    return text + ")";
}

namespace {

constexpr int most_stalled = 100;

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

}  // namespace

Execution::Execution(std::shared_ptr<const Model> model, const Run& run, Watch* watch, Keep keep)
    : model_(std::move(model)),
      watch_(watch),
      run_(run),
      state_{run.q, run.v},
      flow_(*model_, run_),
      record_(model_, run_, keep),
      kinematics_(*model_, run_),
      restitution_(model_->evaluator(model_->restitution(), run_.parameters).output(0)) {}

bool Execution::restart(const Run& run) {
    const Options &now = run_.options, &next = run.options;
    if (next.tolerance != now.tolerance || next.method != now.method || next.truncation != now.truncation ||
        run.parameters != run_.parameters)
        return false;
    run_ = run;
    if (conditions_) conditions_->forget();
    record_.restart(model_, run_);
    t_ = last_step_ = first_step_ = proving_ = cut_error_ = 0.0;
    stalled_ = 0;
    other_evaluations_ = -flow_.evaluations() - (exact_ ? exact_->evaluations() : 0);
    state_ = {run.q, run.v};
    contact_ = {};
    flight_start_ = {};
    constrained_start_ = {};
    doubt_.reset();
    constrained_ = at_impact_ = false;
    completion_.reset();
    outcome_.reset();
    return true;
}

// ---- the start ----

void Execution::begin() {
    const Contact contact = contact_ = kinematics_.at(state_);
    flight_start_ = {{contact.h, contact.hdot}, 0};
    if (contact.h <= 4.0 * kinematics_.gap_error(state_)) {  // |h| and |hdot| within rounding count as zero
        flight_start_ = {{0.0, contact.hdot}, 1};
        const double error = 4.0 * kinematics_.hdot_error(state_);
        at_impact_ = contact.hdot < -error;
        if (std::abs(contact.hdot) <= error) start_in_contact(kinematics_.normal(state_));
    }
    record_.open(constrained_ ? Phase::Kind::constrained : Phase::Kind::hybrid, t_);
}

// h = 0 and hdot = 0: the sign of hddot decides, and where it is zero the sign of h'''.
void Execution::start_in_contact(const ContactKinematics::Normal& normal) {
    state_.v = reinitialize(kinematics_.at(state_), state_.v, Reinitialization::kinetic);
    if (certainly_positive(normal.hddot)) {
        flight_start_ = {{0.0, 0.0}, 2};
    } else if (certainly_negative(normal.hddot) || certainly_negative(normal.jerk)) {
        constrained_ = true;
        if (!certainly_negative(normal.hddot)) constrained_start_.known = 1;
    } else if (certainly_positive(normal.jerk)) {
        flight_start_ = {{0.0, 0.0}, 3};
    } else {
        stop(Outcome::Kind::undecided,
             "the contact force and its rate are zero to within rounding: contact or release cannot be decided at " +
                 where(t_, state_));
    }
}

// ---- impact ----

void Execution::land() {
    const Contact& contact = contact_;
    if (!(contact.hdot < 0.0)) {
        stop(Outcome::Kind::undecided, "an impact whose speed is zero to within rounding at " + where(t_, state_));
        return;
    }
    if (record_.impacts() >= run_.options.max_impacts) {
        const bool elastic = restitution_ >= 1.0;
        stop(Outcome::Kind::too_many_impacts,
             fmt::format("{} impacts by t = {:.9g}, and the truncation conditions were never met{}", record_.impacts(),
                         t_, elastic ? ": with restitution 1 the bouncing does not converge" : ""));
        return;
    }
    // Most impacts need no more than this look. Not where flights are near rounding: there the bouncing must end.
    if (restitution_ > 0.0 && conditions_ && conditions_->fails_by_speed(-contact.hdot) &&
        is_well_resolved(-contact.hdot))
        return bounce(contact, restitution_);
    const Vector tangential = reinitialize(contact, state_.v, Reinitialization::kinetic);
    const Reinitialization kind = run_.options.truncation.reinitialization;
    const bool kinetic = kind == Reinitialization::kinetic;
    Collision collision{t_, state_, -contact.hdot, tangential,
                        kinetic ? tangential : reinitialize(contact, state_.v, kind)};
    if (restitution_ == 0.0) {
        capture(collision);
    } else if (auto certificate =
                   could_truncate(collision) ? prove(&TruncationConditions::certify, collision) : std::nullopt) {
        complete(collision, std::move(*certificate));
    } else if (too_short_to_resolve(collision, restitution_)) {
        if (auto proved = prove(&TruncationConditions::prove_any, collision)) {
            complete(collision, std::move(*proved));
        } else {
            stop(Outcome::Kind::undecided,
                 "flights became shorter than floating point resolves, and no truncation is certified at " +
                     where(t_, state_));
        }
    } else {
        bounce(contact, restitution_);
    }
}

// The truncation conditions stand ready from the first question on. The guess takes less time than the clock.
bool Execution::could_truncate(const Collision& collision) {
    if (!conditions_) conditions_ = timed([&] { return truncation_conditions(*model_, run_); });
    return !conditions_->fails_at_point(collision);
}

// Asks for a proof, after could_truncate().
std::optional<Certificate> Execution::prove(
    std::optional<Certificate> (TruncationConditions::*question)(const Collision&), const Collision& collision) {
    return timed([&] { return ((*conditions_).*question)(collision); });
}

// Newton's law, and the flight it starts.
void Execution::bounce(const Contact& contact, double e) {
    const Vector v_after = impact(contact, state_.v, e);
    record_.impact(t_, state_, v_after, -contact.hdot);
    state_.v = v_after;
    const double hdot = -e * contact.hdot;
    flight_start_ = {{0.0, hdot, 0.0, 0.0, state_error()}, 1};
    first_step_ = 0.0;
    if (flow().is_expansion()) return;
    const double hddot = kinematics_.normal_acceleration(state_);
    first_step_ = hddot < 0.0 ? 1.05 * 2.0 * hdot / -hddot : 0.0;  // a little past the predicted landing
}

// Far from what follows: the last step was neither short nor low.
bool Execution::is_well_resolved(double speed) const {
    const double q = state_.q.cwiseAbs().maxCoeff();
    return last_step_ > 1e-6 * (1.0 + t_) && last_step_ * speed > 1e-8 * (1.0 + q);
}

// theory.md 6.3: the next flight is lower than the rounding of h, or shorter than that of t.
bool Execution::too_short_to_resolve(const Collision& collision, double e) {
    if (is_well_resolved(collision.speed)) return false;
    const double u = e * collision.speed;
    const double a = -kinematics_.normal_acceleration({collision.before.q, collision.tangential});
    if (!(a > 0.0)) return false;
    return u * u / (2.0 * a) < 4.0 * kinematics_.gap_error(collision.before) || 2.0 * u / a < 4.0 * ulp(collision.t);
}

// e = 0: the impact itself ends on the surface, at s. No bounce follows where hddot < 0, and the completion is exact.
void Execution::capture(const Collision& before) {
    Collision collision = before;
    collision.restart = collision.tangential;
    const Interval hddot = kinematics_.normal({collision.before.q, collision.restart}).hddot;
    if (certainly_negative(hddot)) {
        Certificate certificate;
        certificate.certified = true;
        certificate.conditions = run_.options.truncation.conditions;
        certificate.reinitialization = Reinitialization::kinetic;
        certificate.zeno_low = certificate.zeno_high = certificate.zeno_time = t_;
        certificate.shadowing_position = certificate.shadowing_velocity = certificate.uniform_position = 0.0;
        certificate.a_min = -hddot.hi();
        certificate.a_max = -hddot.lo();
        certificate.decisive = "exact: restitution 0";
        certificate.assumptions = {{"normal acceleration", hddot.hi(), 0.0}};
        complete(collision, std::move(certificate));
    } else if (certainly_positive(hddot)) {
        bounce(contact_, 0.0);
        flight_start_ = {{0.0, 0.0}, 2};
    } else {
        stop(Outcome::Kind::undecided,
             "after a plastic impact hddot is zero to within rounding: contact or flight cannot be decided at " +
                 where(t_, state_));
    }
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

// One step of the flow, not past the time `until`. False if the run is over.
bool Execution::advance(double until) {
    if (is_cancelled()) return false;
    if (until - flow().end_time() <= 1e-15 * std::abs(flow().end_time())) {
        stop(Outcome::Kind::end_time, "reached the end time");
        return false;
    }
    if (record_.steps() >= run_.options.max_steps) {
        stop(Outcome::Kind::too_many_steps,
             fmt::format("{} steps by t = {:.9g}: the motion is too fast for this tolerance and end time",
                         record_.steps(), t_));
        return false;
    }
    // Steps of the resolution of time, one after the other, round back to the same state for ever.
    const auto failure = stalled_ > most_stalled ? StepFailure::step_too_small : flow().step(until);
    if (failure != StepFailure::none) stop_at(failure);
    return failure == StepFailure::none;
}

// Accepts the flow's last step; `contact` is that of its end.
void Execution::accept_step(const Contact& contact) {
    contact_ = contact;
    record_.step(flow(), contact.h);
    advance_clock(flow().duration(), flow().end_time());
    state_ = flow().end();
}

// Time goes on to t, by a last step of this duration.
void Execution::advance_clock(double duration, double t) {
    stalled_ = t - t_ > 0x1p-51 * std::abs(t_) ? 0 : stalled_ + 1;
    t_ = t;
    last_step_ = duration;
}

void Execution::stop_at(StepFailure failure) {
    const std::string place = where(t_, state_);
    if (failure == StepFailure::not_a_number)
        return stop(Outcome::Kind::not_a_number, "the motion runs away: no finite number follows " + place);
    const std::string edge = edge_of_domain(*model_, run_, t_, state_);
    if (!edge.empty()) return stop(Outcome::Kind::left_the_domain, fmt::format("{}, just after {}", edge, place));
    if (failure == StepFailure::left_the_domain)
        return stop(Outcome::Kind::left_the_domain,
                    "M is not positive definite, or a function undefined, just after " + place);
    stop(Outcome::Kind::step_too_small, "no step is small enough for the tolerance after " + place);
}

// A state that cannot be moved onto the surface.
void Execution::fail_projection(double t, const State& state) {
    stop(Outcome::Kind::left_the_domain,
         fmt::format("{}, at {}", edge_of_contact(*model_, run_, state), where(t, state)));
}

// ---- doubt ----

// What the flow integrates with: the run's tolerance, or the least that there is where a stretch is made again.
Flow& Execution::flow() { return exactly_ ? *exact_ : flow_; }

// As well as can be: all that led there was as exact.
bool Execution::knows_its_start() const { return run_.options.tolerance <= least_tolerance; }

// What the steps so far may have made the state wrong by, relative to its size: a tenth of the tolerance each, as
// measured; and what the cuts of bouncings have, as certified.
double Execution::state_error() const {
    return 0.1 * run_.options.tolerance * static_cast<double>(record_.steps()) + cut_error_;
}

Execution::Beginning Execution::beginning() const {
    return {state_,     flight_start_, constrained_start_, record_.mark(), t_,
            last_step_, first_step_,   state_error(),      stalled_};
}

void Execution::go_back(const Beginning& to) {
    state_ = to.state;
    flight_start_ = to.flight_start;
    constrained_start_ = to.constrained_start;
    record_.go_back(to.recorded);
    t_ = to.t;
    last_step_ = to.last_step;
    first_step_ = to.first_step;
    stalled_ = to.stalled;
}

// The stretch that was made since is in doubt: true if it may be made again, as exactly as double precision allows.
bool Execution::try_exactly(const Beginning& since) {
    if (exactly_ || knows_its_start() || !asks_again_) return false;
    if (!exact_) {
        Run run = run_;
        run.options.tolerance = least_tolerance;
        exact_ = std::make_unique<Flow>(*model_, run);
    }
    doubt_.reset();
    go_back(since);
    exactly_ = true;
    return true;
}

// The end of a stretch: what is in doubt still is the end of the run.
void Execution::settle() {
    exactly_ = false;
    if (doubt_) stop(Outcome::Kind::undecided, std::move(*doubt_));
}

void Execution::stop(Outcome::Kind kind, std::string message) { outcome_ = Outcome{kind, std::move(message)}; }

Trajectory Execution::finish() {
    const long evaluations = flow_.evaluations() + (exact_ ? exact_->evaluations() : 0) + other_evaluations_;
    Trajectory trajectory = record_.finish(t_, state_, std::move(*outcome_), evaluations);
    trajectory.statistics.certificate_seconds = proving_;
    return trajectory;
}

}  // namespace achilles
