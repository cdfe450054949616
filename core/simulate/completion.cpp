// What an execution does at its events: impact, completion of a bouncing, Zeno point, release.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/flat.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

}  // namespace

// ---- impact ----

void Execution::land(std::size_t which, const Contact& contact) {
    which_ = which;
    if (!(contact.hdot < 0.0)) {
        stop(Outcome::Kind::undecided, "an impact whose speed is zero to within rounding at " + where(next_.state));
        return;
    }
    if (record_.impacts() >= run_.options.max_impacts) {
        const bool elastic = restitution(which) >= 1.0;
        stop(Outcome::Kind::too_many_impacts,
             fmt::format(
                 "{} impacts by t = {:.9g}, and the truncation conditions were never met{}", record_.impacts(),
                 next_.state.t,
                 elastic ? ": with restitution 1 the bouncing does not converge" : "; try a larger --max-impacts"));
        return;
    }
    if (surfaces_->count() > 1) {
        // Contacts that strike in turn may leave no time between them, however high each would bounce alone.
        constexpr double resolved = 16.0;
        if (record_.impacts() > 1 &&
            (last_step_ < resolved * ulp(next_.state.t) || moves_within_rounding(which, -contact.hdot))) {
            const Vector v_after = impact(contact, next_.state.v, restitution(which));
            if (!complete_pair(ContactSet::of(which), v_after, true)) end_chatter(ContactSet::of(which));
            return;
        }
        const auto together = landing_with(which, contact);
        if (!together) return;
        const ContactSet landing = *together;
        if (landing.count() > 1 || !next_.touching.empty() || !stays_held(which, contact)) return collide(landing);
    }
    land_alone(contact);
}

// On an open place; what is held stays held.
void Execution::land_alone(const Contact& contact) {
    const double e = restitution(which_);
    conditions_ = nullptr;
    const ContactSet unpressed = always_unpressed(next_.mode);
    for (const OfContact& known : all_conditions_)
        if (known.contact == which_ && known.mode == next_.mode && known.unpressed == unpressed)
            conditions_ = known.conditions.get();
    // Most impacts need no more than this look. Not where flights are near rounding: there the bouncing must end.
    if (e > 0.0 && conditions_ != nullptr && conditions_->fails_by_speed(-contact.hdot) &&
        is_well_resolved(-contact.hdot))
        return bounce(contact, e);
    const Vector tangential = reinitialize(contact, next_.state.v, Reinitialization::kinetic);
    const Reinitialization kind = run_.options.truncation.reinitialization;
    const bool kinetic = kind == Reinitialization::kinetic;
    Collision collision{next_.state, -contact.hdot, tangential,
                        kinetic ? tangential : reinitialize(contact, next_.state.v, kind)};
    if (e == 0.0) {
        capture(contact, collision);
    } else if (auto certificate =
                   could_truncate(collision) ? prove(&TruncationConditions::certify, collision) : std::nullopt) {
        complete(contact, collision, std::move(*certificate));
    } else if (too_short_to_resolve(collision, e)) {
        if (auto proved = prove(&TruncationConditions::prove_any, collision)) {
            complete(contact, collision, std::move(*proved));
        } else if (surfaces_->count() > 1) {
            if (!complete_pair(ContactSet::of(which_), impact(contact, next_.state.v, e), true))
                end_chatter(ContactSet::of(which_));
        } else {
            stop(Outcome::Kind::undecided,
                 "the flights became shorter than double precision resolves, and no truncation is certified, at " +
                     where(next_.state));
        }
    } else if (surfaces_->count() == 1 ||
               !complete_pair(ContactSet::of(which_), impact(contact, next_.state.v, e), false)) {
        bounce(contact, e);
    }
}

// The truncation conditions stand ready from the first question on. The guess takes less time than the clock.
bool Execution::could_truncate(const Collision& collision) {
    if (conditions_ == nullptr) {
        const ContactSet unpressed = always_unpressed(next_.mode);
        const Interval& e = surfaces_->restitution(which_).enclosure;
        all_conditions_.push_back({which_, next_.mode, unpressed, timed([&] {
                                       return truncation_conditions(*model_, run_, e, which_, next_.mode, unpressed);
                                   })});
        conditions_ = all_conditions_.back().conditions.get();
    }
    return !conditions_->fails_at_point(collision);
}

// Asks for a proof, after could_truncate().
std::optional<Certificate> Execution::prove(
    std::optional<Certificate> (TruncationConditions::*question)(const Collision&), const Collision& collision) {
    return timed([&] { return ((*conditions_).*question)(collision); });
}

// Newton's law, and the flight it starts.
void Execution::bounce(const Contact& contact, double e) {
    const Vector v_after = impact(contact, next_.state.v, e);
    record_.impact(next_.state, v_after, -contact.hdot, exchange_of(contact, e), ContactSet::of(which_));
    const double hdot = newton::rate_after(e, contact.hdot);
    next_.starts[which_] = {{0.0, hdot, 0.0, 0.0, state_error()}, 1};
    const Vector v_before = next_.state.v;
    next_.state.v = v_after;
    change_rates(v_before, ContactSet::of(which_));
    begin_stretch(next_.mode, run_.options.end_time);
    if (run_.options.method == Method::taylor) return;  // a series tells its length itself
    const double hddot = kinematics().normal_acceleration(next_.state);
    next_.first_step = hddot < 0.0 ? 1.05 * 2.0 * hdot / -hddot : 0.0;  // a little past the predicted landing
}

// Cheap and sufficient: the last step was so long, and what it fell so much, that too_short_to_resolve() need not look.
bool Execution::is_well_resolved(double speed) const {
    const double q = next_.state.q.cwiseAbs().maxCoeff();
    return last_step_ > 1e-6 * (1.0 + next_.state.t) && last_step_ * speed > 1e-8 * (1.0 + q);
}

// theory.md 6.3: the next flight, to leading order, is lower than four roundings of h or shorter than four of t. The first
// line looks at the last step alone: with a very small e it may let one such flight through, which then ends here.
bool Execution::too_short_to_resolve(const Collision& collision, double e) {
    if (is_well_resolved(collision.speed)) return false;
    const double u = newton::rate_after(e, -collision.speed);
    const double a = -kinematics().normal_acceleration(collision.with(collision.tangential));
    if (!(a > 0.0)) return false;
    return u * u / (2.0 * a) < 4.0 * kinematics().gap_error(collision.before) ||
           2.0 * u / a < 4.0 * ulp(collision.before.t);
}

// e = 0: the impact itself ends on the surface, at s. No bounce follows where hddot < 0, or where the contact stays closed
// without a force, and nothing is cut short.
void Execution::capture(const Contact& contact, const Collision& before) {
    Collision collision = before;
    collision.restart = collision.tangential;
    Interval hddot = kinematics().normal(collision.with(collision.restart)).hddot;
    if (surfaces_->needs_no_force(which_, next_.mode, collision.with(collision.restart), scale_)) {
        hddot = Interval(0.0);
        next_.unpressed = next_.unpressed.with(which_);
    }
    if (next_.unpressed.contains(which_) || certainly_negative(hddot)) {
        Certificate certificate;
        certificate.certified = true;
        certificate.conditions = run_.options.truncation.conditions;
        certificate.reinitialization = Reinitialization::kinetic;
        certificate.zeno_low = certificate.zeno_high = certificate.zeno_time = next_.state.t;
        certificate.shadowing_position = certificate.shadowing_velocity = certificate.uniform_position = 0.0;
        certificate.a_min = -hddot.hi();
        certificate.a_max = -hddot.lo();
        certificate.decisive = "restitution 0: no impact sequence is truncated";
        certificate.assumptions = {{"normal acceleration", hddot.hi(), 0.0}};
        complete(contact, collision, std::move(certificate));
    } else if (certainly_positive(hddot)) {
        bounce(contact, 0.0);
        next_.starts[which_] = {{0.0, 0.0}, 2};
    } else {
        collide(ContactSet::of(which_));  // the rate of hddot decides
    }
}

// ---- completion ----

// The collision is the last impact that is drawn: the bouncing after it is replaced by the constrained motion. The
// phase changes at the best estimate of the Zeno time.
void Execution::complete(const Contact& contact, const Collision& collision, Certificate certificate) {
    // A plastic impact leads to s. Nothing does to the v* of Def. 7.
    Exchange plastic = exchange_of(contact, 0.0);
    if (collision.restart != collision.tangential)
        plastic = record_.exchange_of_jump(next_.state, collision.with(collision.restart), plastic.work);
    record_.impact(next_.state, impact(contact, next_.state.v, restitution(which_)), collision.speed, plastic,
                   ContactSet::of(which_));
    next_.state = collision.with(collision.restart);
    const Mode mode = next_.mode.with(which_, ContactState::held);
    for (const std::size_t i : mode.held()) next_.starts[i] = {};
    change_rates(collision.before.v, ContactSet::of(which_));
    next_.unpressed = unpressed_of(next_.unpressed, mode);
    cut_error_ += std::max(certificate.shadowing_position.value_or(0.0), certificate.shadowing_velocity.value_or(0.0));
    Event& event = completion_.emplace();
    event.kind = Event::Kind::zeno;
    event.t = certificate.zeno_time;
    event.truncation = Event::Truncation{collision.before.t, collision.before.q, collision.before.v, collision.restart,
                                         collision.speed};
    event.certificate = std::move(certificate);
    event.contacts = ContactSet::of(which_);
    event.mode = mode;
    begin_stretch(mode, std::min(event.t, run_.options.end_time));
}

// The motion in contact has come to the Zeno time.
void Execution::pass_zeno_point() {
    Event event = std::move(*completion_);
    completion_.reset();
    next_.state.t = event.t;
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    record_.event(std::move(event));
    enter_phase();
    begin_stretch(next_.mode, run_.options.end_time);
}

// What is held has changed.
void Execution::enter_phase() {
    record_.close(next_.state.t);
    record_.open(next_.resting(), next_.held(), next_.state.t);
}

// If it has. Else others of it may carry now.
void Execution::enter_or_stay() {
    if (next_.resting() != record_.mode()) return enter_phase();
    record_.carry_on(next_.held());
}

// ---- release ----

// lambda = 0. It is a release where h''' > 0 is proved; otherwise contact and flight cannot be told apart.
void Execution::release(std::size_t which) {
    which_ = which;
    if (completing())
        return stop(Outcome::Kind::undecided,
                    "the contact force vanishes before the Zeno time at " + where(next_.state));
    const Mode mode = next_.mode;
    const ContactSet vanishing = surfaces_->count() > 1 ? vanishing_with(which) : ContactSet::of(which);
    const bool leaves = certainly_positive(surfaces_->of(which, mode.without(which)).normal(next_.state).jerk);
    if (surfaces_->count() > 1 &&
        (!leaves || vanishing.count() > 1 || !next_.touching.with(next_.unpressed).empty() || not_unique_)) {
        const ContactSet resting = next_.resting().held();
        decide(mode.held().with(next_.touching), vanishing);
        if (outcome_) return;
        const ContactSet gone = resting.without(next_.resting().held());
        return gone.empty() ? carry_on() : leave(gone);
    }
    if (!leaves) {
        const std::string hint = product_hint(*model_, which);
        return stop(Outcome::Kind::undecided,
                    fmt::format("the contact force touches zero and h''' > 0 is not proved at {}{}{}",
                                where(next_.state), hint.empty() ? "" : "; ", hint));
    }
    next_.mode = mode.without(which);
    next_.starts[which] = {{0.0, 0.0}, 3};
    leave(ContactSet::of(which));
}

// These have been released.
void Execution::leave(ContactSet contacts) {
    Event event;
    event.kind = Event::Kind::release;
    event.contacts = contacts;
    event.mode = next_.resting();
    if (not_unique_) {
        auto joint = std::make_shared<Joint>();
        joint->not_unique = true;
        event.joint = std::move(joint);
    }
    event.t = next_.state.t;
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    record_.event(std::move(event));
    enter_phase();
    begin_stretch(next_.mode, run_.options.end_time);
}

}  // namespace achilles
