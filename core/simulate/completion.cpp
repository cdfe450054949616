// The events of an execution: impact, completion at a Zeno point, release.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/degenerate_gap.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

}  // namespace

// ---- impact ----

void ExecutionAutomaton::land(std::size_t which, const Contact& contact) {
    which_ = which;
    if (!(contact.hdot < 0.0)) {
        stop(Outcome::Kind::undecided, "an impact whose speed is zero to within rounding at " + where(next_.state));
        return;
    }
    if (has_guards() && !does_count(which)) return outcome_ ? void() : pass_alone(which, contact.hdot);
    if (record_.impacts() >= run_.options.max_impacts) {
        const bool elastic = restitution(which) >= 1.0;
        stop(Outcome::Kind::too_many_impacts,
             fmt::format(
                 "{} impacts by t = {:.9g}, and the truncation conditions were never met{}", record_.impacts(),
                 next_.state.t,
                 elastic ? ": with restitution 1 the bouncing does not converge" : "; try a larger --max-impacts"));
        return;
    }
    if (surfaces_->has_friction()) return collide_with_friction(ContactSet::of(which));
    if ((model_->has_jumps() && may_jump(ContactSet::of(which), falling_jumps())) ||
        !unlatched_by(ContactSet::of(which)).empty()) {
        const auto together = surfaces_->count() > 1 ? landing_with(which, contact) : ContactSet::of(which);
        if (together) collide(*together);
        return;
    }
    if (surfaces_->count() > 1) {
        const bool at_rounding = is_at_rounding(which, -contact.hdot);
        if (complete_collapse(which, contact, at_rounding)) return;
        if (at_rounding) {
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

// An impact of one contact that leaves all held contacts held.
void ExecutionAutomaton::land_alone(const Contact& contact) {
    const double e = restitution(which_);
    find_conditions(ContactState::held);
    // For most impacts this check is enough. Flights near rounding level need the full treatment below, because the
    // bouncing must end there.
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
    } else if (auto certificate = may_cut(which_) && could_truncate(collision)
                                      ? timed([&] { return conditions_->certify(collision, proof_scope_); })
                                      : std::nullopt) {
        complete(contact, collision, std::move(*certificate));
    } else if (too_short_to_resolve(collision, e)) {
        if (!may_cut(which_))
            return stop(Outcome::Kind::undecided,
                        fmt::format("the flights became shorter than double precision resolves, and bouncing of a "
                                    "contact that stands in held(NAME) is cut under the sharp conditions only, at {}",
                                    where(next_.state)));
        if (auto proved = timed([&] { return conditions_->prove_any(collision); })) {
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

// Sets conditions_ to those of the contact in the current mode, if they exist. With friction, the contact slides or
// sticks at its impacts.
void ExecutionAutomaton::find_conditions(ContactState state) {
    conditions_ = nullptr;
    const ContactSet unpressed = always_unpressed(next_.mode);
    for (const ContactConditions& known : all_conditions_)
        if (known.contact == which_ && known.mode == next_.mode && known.state == state && known.unpressed == unpressed)
            conditions_ = known.conditions.get();
}

// Creates the truncation conditions at first use. The fast check itself is not timed: it takes less time than reading
// the clock.
bool ExecutionAutomaton::could_truncate(const Collision& collision, ContactState state) {
    if (conditions_ == nullptr) {
        const ContactSet unpressed = always_unpressed(next_.mode);
        const Interval& e = surfaces_->restitution(which_).enclosure;
        all_conditions_.push_back(
            {which_, next_.mode, unpressed, state, timed([&] {
                 return truncation_conditions(*model_, run_, e, {which_, next_.mode, state}, unpressed);
             })});
        conditions_ = all_conditions_.back().conditions.get();
    }
    conditions_->set_states(next_.inactive, next_.latched);
    return !conditions_->fails_at_point(collision);
}

// Applies Newton's impact law and starts the next flight.
void ExecutionAutomaton::bounce(const Contact& contact, double e) {
    const Vector v_after = impact(contact, next_.state.v, e);
    record_.impact(next_.state, v_after, -contact.hdot, exchange_of(contact, e), ContactSet::of(which_));
    const double hdot = newton::rate_after(e, contact.hdot);
    next_.starts[which_] = {{0.0, hdot, 0.0, 0.0, state_error()}, 1};
    const Vector v_before = next_.state.v;
    next_.state.v = v_after;
    change_rates(v_before, ContactSet::of(which_));
    begin_stretch(next_.mode, run_.options.end_time);
    if (run_.options.method == Method::taylor) return;  // a series determines its own step length
    const double hddot = kinematics().normal_acceleration(next_.state);
    next_.first_step = hddot < 0.0 ? 1.05 * 2.0 * hdot / -hddot : 0.0;  // a little beyond the predicted impact
}

// Fast sufficient check: the last flight was so long and so high that too_short_to_resolve() is false.
bool ExecutionAutomaton::is_well_resolved(double speed) const {
    const double q = next_.state.q.cwiseAbs().maxCoeff();
    return last_step_ > 1e-6 * (1.0 + next_.state.t) && last_step_ * speed > 1e-8 * (1.0 + q);
}

// theory.md 6.3: the next flight, to leading order, is lower than four roundings of h or shorter than four of t. The
// first check uses the last flight; with a very small e it may accept one flight that is too short, and the next impact
// then ends here.
bool ExecutionAutomaton::too_short_to_resolve(const Collision& collision, double e) {
    if (is_well_resolved(collision.speed)) return false;
    const double u = newton::rate_after(e, -collision.speed);
    const double a = -kinematics().normal_acceleration(collision.with(collision.tangential));
    if (!(a > 0.0)) return false;
    return u * u / (2.0 * a) < 4.0 * kinematics().gap_error(collision.before) ||
           2.0 * u / a < 4.0 * ulp(collision.before.t);
}

// Plastic impact, e = 0: the motion continues on the contact surface with velocity s. If hddot < 0, or if the contact
// stays closed without a force, no bounce follows and no impact sequence is truncated.
void ExecutionAutomaton::capture(const Contact& contact, const Collision& before) {
    Collision collision = before;
    collision.restart = collision.tangential;
    Interval hddot = kinematics().hddot(collision.with(collision.restart));
    if (surfaces_->needs_no_force(which_, next_.mode, collision.with(collision.restart), scale_)) {
        hddot = Interval(0.0);
        next_.unpressed = next_.unpressed.with(which_);
    }
    const bool latches = model_->equations().latches[which_].has_value();  // then its force may pull
    if (next_.unpressed.contains(which_) || certainly_negative(hddot) || latches) {
        Certificate certificate;
        certificate.certified = true;
        certificate.conditions = run_.options.truncation.conditions;
        certificate.reinitialization = Reinitialization::kinetic;
        certificate.zeno_low = certificate.zeno_high = certificate.zeno_time = next_.state.t;
        certificate.shadowing_position = certificate.shadowing_velocity = certificate.uniform_position = 0.0;
        certificate.a_min = -hddot.hi();
        certificate.a_max = -hddot.lo();
        certificate.tightest_bound = "restitution 0: no impact sequence is truncated";
        if (!latches) certificate.assumptions = {{"normal acceleration", hddot.hi(), 0.0}};
        complete(contact, collision, std::move(certificate));
    } else if (certainly_positive(hddot)) {
        bounce(contact, 0.0);
        next_.starts[which_] = {{0.0, 0.0}, 2};
    } else {
        collide(ContactSet::of(which_));  // the rate of hddot decides
    }
}

// ---- completion ----

// Truncation at this collision, the last simulated impact: the constrained motion replaces the bouncing after it. The
// phase changes at the estimated Zeno time.
void ExecutionAutomaton::complete(const Contact& contact, const Collision& collision, Certificate certificate) {
    // A plastic impact leads to s. No impact leads to the v* of Def. 7, so the loss follows from the energies.
    Exchange plastic = exchange_of(contact, 0.0);
    if (collision.restart != collision.tangential)
        plastic = record_.exchange_of_jump(next_.state, collision.with(collision.restart), plastic.work);
    record_.impact(next_.state, impact(contact, next_.state.v, restitution(which_)), collision.speed, plastic,
                   ContactSet::of(which_));
    continue_to_zeno_point(collision, ContactState::held, std::move(certificate));
}

// The motion in contact from the restart of this collision, until the estimated Zeno time.
void ExecutionAutomaton::continue_to_zeno_point(const Collision& collision, ContactState state, Certificate certificate,
                                                int sticks_from) {
    next_.state = collision.with(collision.restart);
    const Mode held = next_.mode.with(which_, state);
    // Until the Zeno point the contact is open for the forces.
    const bool waits = certificate.zeno_time > next_.state.t;
    const Mode mode =
        held.with_silent(waits ? ContactSet::of(which_).within(model_->equations().in_forces) : ContactSet());
    if (collision.position.size() > 0) {
        next_.state.q = collision.position;
        for (std::size_t i = 0; i < surfaces_->count(); ++i) {
            const Contact contact = surfaces_->of(i).at(next_.state);
            next_.starts[i] = {{contact.h, contact.hdot}, 0};
        }
    } else {
        change_rates(collision.before.v, ContactSet::of(which_));
    }
    for (const std::size_t i : mode.held()) next_.starts[i] = {};
    next_.unpressed = unpressed_of(next_.unpressed, mode);
    cut_error_ += std::max(certificate.shadowing_position.value_or(0.0), certificate.shadowing_velocity.value_or(0.0));
    Event& event = completion_.emplace();
    event.kind = Event::Kind::zeno;
    event.t = certificate.zeno_time;
    event.truncation = Event::TruncationRecord{collision.before.t, collision.before.q, collision.before.v,
                                               collision.restart, collision.speed};
    event.certificate = std::move(certificate);
    event.sticks_from = sticks_from;
    event.contacts = ContactSet::of(which_);
    event.mode = held;
    begin_stretch(mode, std::min(event.t, run_.options.end_time));
    next_.keeps_stick = event.certificate->tail == Certificate::Tail::stick_then_slip;
}

// Records the Zeno event and continues in the constrained phase.
void ExecutionAutomaton::pass_zeno_point() {
    Event event = std::move(*completion_);
    completion_.reset();
    next_.state.t = event.t;
    if (event.is_collapse()) return pass_collapse(std::move(event));
    ContactSet gone;
    if (next_.keeps_stick || !next_.mode.silent().empty()) {
        gone = decide_at_zeno_point();
        if (outcome_) return;
        event.mode = gone.empty() ? next_.resting() : event.mode;
    }
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    // After a plastic impact the state is still the one that it has made, so a guard that is zero has no event.
    if (event.truncation && event.truncation->t == event.t) known_zeros_ = all_watched_guards();
    record_.event(std::move(event));
    if (!gone.empty()) return leave(gone);
    enter_phase();
    begin_stretch(next_.mode, run_.options.end_time);
}

// Decides the mode at a Zeno point where sticking ends, or where forces begin to see the contact. Returns the other
// contacts that then leave at once.
ContactSet ExecutionAutomaton::decide_at_zeno_point() {
    const Mode before = next_.mode.with_silent({});
    const ContactSet closed = before.held().with(next_.touching);
    acting_ = before.held().within(model_->equations().in_forces);
    if (surfaces_->has_friction()) {
        if (!decide_with_friction(closed, before)) return {};
    } else {
        decide(closed);
    }
    const ContactSet gone = before.held().without(next_.resting().held());
    if (!outcome_ && surfaces_->has_friction()) start_released(gone);
    return gone;
}

// Starts a new phase after a change of the mode.
void ExecutionAutomaton::enter_phase() {
    record_.close(next_.state.t);
    record_.open(next_.resting(), next_.held(), next_.state.t);
    last_sliding_impact_ = 0;
}

// Starts a new phase if the mode has changed; otherwise only the load-bearing contacts may have.
void ExecutionAutomaton::enter_or_stay() {
    if (next_.resting() != record_.mode()) return enter_phase();
    record_.continue_phase(next_.held());
}

// ---- release ----

// Called if lambda = 0. It is a release if h''' > 0 is proved; otherwise contact and flight cannot be distinguished.
void ExecutionAutomaton::release(std::size_t which) {
    which_ = which;
    if (completing())
        return stop(Outcome::Kind::undecided,
                    "the contact force vanishes before the Zeno time at " + where(next_.state));
    if (surfaces_->has_friction()) return release_with_friction(which);
    const Mode mode = next_.mode;
    const ContactSet vanishing = surfaces_->count() > 1 ? vanishing_with(which) : ContactSet::of(which);
    const bool leaves =
        certainly_positive(surfaces_->of(which, model_->unconstrained(mode, which)).normal(next_.state).jerk);
    if (surfaces_->count() > 1 &&
        (!leaves || vanishing.count() > 1 || !next_.touching.with(next_.unpressed).empty() || not_unique_)) {
        const ContactSet resting = next_.resting().held();
        decide(mode.held().with(next_.touching), vanishing);
        if (outcome_) return;
        const ContactSet gone = resting.without(next_.resting().held());
        return gone.empty() ? continue_phase() : leave(gone);
    }
    if (!leaves) {
        const std::string hint = product_hint(*model_, which);
        return stop(Outcome::Kind::undecided,
                    fmt::format("the contact force touches zero and h''' > 0 is not proved at {}{}{}",
                                where(next_.state), hint.empty() ? "" : "; ", hint));
    }
    next_.mode = mode.without(which);
    next_.starts[which] = {{0.0, 0.0}, 3};
    start_released(ContactSet::of(which));
    if (!outcome_) leave(ContactSet::of(which));
}

// Records the release of these contacts.
void ExecutionAutomaton::leave(ContactSet contacts, bool ends_latch) {
    Event event;
    event.kind = Event::Kind::release;
    event.contacts = contacts;
    event.mode = next_.resting();
    event.ends_latch = ends_latch;
    if (not_unique_) {
        auto joint = std::make_shared<MultiContactInfo>();
        joint->is_nonunique = true;
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
