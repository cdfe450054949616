#include "enclose/prover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

Interval both(const Interval& a, const Interval& b) {
    const double lo = std::max(a.lo(), b.lo()), hi = std::min(a.hi(), b.hi());
    return lo <= hi ? Interval(lo, hi) : a;
}

}  // namespace

Prover::Prover(const Model& model, const Claim& claim, const Coordinates& coordinates, const Intervals& start,
               ProofWatch* watch, const Ground&)
    : claim_(claim),
      z_(coordinates),
      watch_(watch),
      flight_(model, coordinates, {}),
      contact_motion_(model, coordinates, ContactSet::of(0)),
      maps_(make_maps(model, coordinates)),
      completion_(model, coordinates),
      set_(start, coordinates.varied.size()),
      proved_until_(claim.run.options.start_time) {
    for (const double time : claim.times) asked_.push_back({time, {}, false});
    asked_.push_back({claim.run.options.end_time, {}, false});
}

Enclosure Prover::run() {
    try {
        begin();
        while (!is_over()) {
            if (watch_ != nullptr && watch_->stop.stop_requested()) {
                result_.outcome = {Enclosure::Outcome::Kind::cancelled, "stopped before its end"};
                break;
            }
            move();
        }
        if (is_over()) result_.outcome = {Enclosure::Outcome::Kind::end_time, "proved to the end time"};
    } catch (const Undecided& doubt) {
        result_.outcome = {Enclosure::Outcome::Kind::undecided, doubt.reason};
    }
    const bool whole = result_.outcome.kind == Enclosure::Outcome::Kind::end_time;
    result_.proved_until = whole ? claim_.run.options.end_time : proved_until_;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
        if (!asked_[i].is_known) continue;
        if (i + 1 < asked_.size())
            result_.samples.push_back(*asked_[i].state);
        else if (whole)
            result_.end = *asked_[i].state;
    }
    return std::move(result_);
}

double Prover::now() const { return set_.hull(Coordinates::t()).lo(); }

Intervals Prover::part(const Intervals& box, std::size_t first) const {
    const auto begin = box.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(z_.dof)};
}

double Prover::largest_radius() const {
    double result = 0.0;
    for (std::size_t i = 0; i < 2 * z_.dof; ++i) result = std::max(result, rad(set_.hull(z_.q(i))));
    return result;
}

// ---- times that are asked for

bool Prover::is_over() const {
    return std::all_of(asked_.begin(), asked_.end(), [](const Asked& asked) { return asked.is_known; });
}

// A little beyond the end for every member.
double Prover::longest() const {
    const double left = claim_.run.options.end_time - std::max(now(), proved_until_);
    return 1.001 * left + 0x1p-40 * std::abs(claim_.run.options.end_time);
}

// The state at times that members reach after elapsed times in [0, elapsed] of a step: of every member at once, where all
// reach it before any has come to the step's end; else a part of a hull.
void Prover::cover(const Step& step, const Interval& elapsed) {
    const Interval now = set_.hull(Coordinates::t());
    for (Asked& asked : asked_) {
        if (asked.is_known) continue;
        const Interval tau = Interval(asked.time) - now;
        if (!(tau.hi() >= 0.0) || !(tau.lo() <= elapsed.hi())) continue;
        if (tau.lo() >= 0.0 && tau.hi() < elapsed.lo() && !asked.state) {
            Doubleton there = set_;
            Interval when = tau;
            cross(there, step, Section::of_time(z_, asked.time), when);
            const Intervals box = there.hull();
            asked.state = EnclosedState{asked.time, positions(box), velocities(box)};
            asked.is_known = true;
            proved_until_ = std::max(proved_until_, asked.time);
            continue;
        }
        const Interval part(std::max(0.0, tau.lo()), std::min(tau.hi(), elapsed.hi()));
        const Intervals box = step.box_over(set_, part);
        cover(Interval(asked.time), positions(box), velocities(box));
    }
}

// The members that reach a time that is asked for in `times` are in this box then.
void Prover::cover(const Interval& times, const Intervals& q, const Intervals& v) {
    for (Asked& asked : asked_) {
        if (asked.is_known || !times.contains(asked.time)) continue;
        if (!asked.state) {
            asked.state = EnclosedState{asked.time, q, v};
            continue;
        }
        for (std::size_t i = 0; i < z_.dof; ++i) {
            asked.state->q[i] = hull(asked.state->q[i], q[i]);
            asked.state->v[i] = hull(asked.state->v[i], v[i]);
        }
    }
}

// A hull is complete once every member has passed its time.
void Prover::settle() {
    proved_until_ = std::max(proved_until_, now());
    if (watch_ != nullptr) watch_->time.store(proved_until_, std::memory_order_relaxed);
    for (Asked& asked : asked_)
        if (!asked.is_known && asked.state && proved_until_ > asked.time) asked.is_known = true;
}

// ---- motion

void Prover::count_step() {
    if (++result_.statistics.steps > claim_.run.options.max_steps)
        throw Undecided{fmt::format("more than {} steps", claim_.run.options.max_steps)};
}

void Prover::move() {
    Stepper& stepper = in_contact_ ? contact_motion_ : flight_;
    double most = longest();
    if (!in_contact_ && known_ == KnownRoot::landed) {
        const Maps::Normal normal = maps_->normal(set_.hull());
        const double a = -mid(normal.hddot), u = set_.hull(z_.u()).hi();
        if (a > 0.0) most = std::min(most, 1.5 * 2.0 * u / a);
    }
    const Step step = stepper.make(set_, most, known_, gap_);
    count_step();
    const FirstRoot root = first_root(step.watched(), step.length());
    if (root.kind == FirstRoot::Kind::one) {
        Doubleton there = set_;
        Interval elapsed = root.at;
        Section section = Section::of_gap(z_);
        if (in_contact_)
            section = {[this](const Intervals& box) { return maps_->normal(box).hddot; },
                       [this](const Intervals& box) { return maps_->normal(box).slope; },
                       {},
                       true};
        cross(there, step, section, elapsed);
        cover(step, elapsed);
        if (is_over()) return;
        set_ = there;
        settle();
        doubts_ = 0;
        stepper.forget();
        if (in_contact_)
            release(set_.hull(Coordinates::t()));
        else
            land(set_.hull(Coordinates::t()));
        settle();
        return;
    }
    double length = step.length();
    if (root.kind == FirstRoot::Kind::doubt) {
        length = 0.9 * root.at.lo();
        if (!(length > 0.0) || ++doubts_ > 12)
            throw Undecided{in_contact_
                                ? "release or none: the contact force cannot be told from zero for all of the set"
                                : "impact or none: the gap cannot be told from zero for all of the set"};
    } else {
        doubts_ = 0;
    }
    cover(step, Interval(length));
    if (is_over()) return;
    if (!in_contact_) {
        const Interval factor = integer_power(Interval(length), static_cast<int>(known_));
        gap_ = value_over(step.watched(), Interval(length)) * factor;
    }
    step.advance(set_, length);
    known_ = KnownRoot::none;
    if (in_contact_)
        maps_->retract(set_);
    else
        project();
    settle();
}

// ---- events

void Prover::note_event(Event::Kind kind, const Interval& t, const Intervals& v_before, const Intervals& v_after) {
    result_.events.push_back({kind, t, positions(set_.hull()), v_before, v_after, bounces_});
}

// All members are on the surface.
void Prover::land(const Interval& time) {
    const Interval u = set_.hull(z_.u());
    if (!certainly_negative(u)) throw Undecided{"graze: the impact speed cannot be told from zero for all of the set"};
    project();
    const Intervals v_before = velocities(set_.hull());
    const Interval e = maps_->restitution(set_.hull());
    if (e.lo() == 0.0 && e.hi() == 0.0) return capture(time, v_before);
    if (++result_.statistics.impacts > claim_.run.options.max_impacts)
        throw Undecided{fmt::format("more than {} impacts", claim_.run.options.max_impacts)};
    ++bounces_;
    const double radius = largest_radius();
    Doubleton before = set_;
    maps_->impact(set_);
    set_.set(z_.h(), 0.0);
    note_event(Event::Kind::impact, time, v_before, velocities(set_.hull()));
    Doubleton after = set_;
    set_ = before;
    if (complete(time, e, radius)) return;
    set_ = after;
    const double rise = set_.hull(z_.u()).hi(), a = mag(maps_->normal(set_.hull()).hddot);
    if (2.0 * rise < 0x1p-50 * mag(time) * a)
        throw Undecided{"the flights are below the resolution of time, and no completion is proved"};
    known_ = KnownRoot::landed;
    flight_.forget();
}

// What the set has gained where no member is goes, unless the map's own bending costs more: it is of second order, but a wide
// set pays it at once, and what goes would have grown later only.
void Prover::project() {
    const auto size = [&](const Doubleton& set) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 2 * z_.dof; ++i) sum += rad(set.hull(z_.q(i)));
        return sum;
    };
    Doubleton projected = set_;
    maps_->project(projected);
    constexpr double hardly = 1.001;
    if (size(projected) <= hardly * size(set_)) set_ = projected;
}

// A landing with e = 0 of every member.
void Prover::capture(const Interval& time, const Intervals& v_before) {
    maps_->take_rate_out(set_);
    set_.set(z_.h(), 0.0);
    set_.set(z_.u(), 0.0);
    maps_->retract(set_);
    const Interval hddot = maps_->normal(set_.hull()).hddot;
    if (certainly_negative(hddot)) {
        in_contact_ = true;
        contact_motion_.forget();
        note_event(Event::Kind::zeno, time, v_before, velocities(set_.hull()));
        return;
    }
    if (!certainly_positive(hddot))
        throw Undecided{"contact or flight: the contact force cannot be told from zero for all of the set"};
    ++result_.statistics.impacts;
    note_event(Event::Kind::impact, time, v_before, velocities(set_.hull()));
    known_ = KnownRoot::at_rest;
    flight_.forget();
}

// The states at the Zeno points of members that all reach them in this step, each after its own wait, without the error of the
// comparison.
Intervals Prover::zeno_box(const Step& step, const Interval& tau, const Completion::Proof& proof) const {
    const double middle = std::clamp(mid(proof.at_centre), 0.0, step.length());
    Intervals box = step.box_over(set_, tau);
    const Intervals point = step.centre_at(Interval(middle)), rho = step.remainder_at(tau),
                    F = step.rate_at(hull(tau, Interval(middle)));
    IntervalMatrix S = step.slope_at(tau);
    for (std::size_t i = 0; i < z_.size(); ++i) {
        S(i, z_.u()) += F[i] * proof.by_u;
        box[i] = both(box[i], point[i] + rho[i] + F[i] * (proof.at_centre - Interval(middle)) + set_.along(S.row(i)));
    }
    return box;
}

// All members bounce to their Zeno points, if that is proved well enough. Then the set is that of the members in contact, so
// much later than their collisions that all have reached them.
bool Prover::complete(const Interval& time, const Interval& e, double radius) {
    maps_->take_rate_out(set_);
    set_.set(z_.h(), 0.0);
    const auto proof = completion_.prove(set_, e);
    if (!proof) return false;
    const double end = claim_.run.options.end_time;
    const double resolution = 0x1p-52 * std::max(mag(time), 0x1p-30), w = mag(set_.hull(z_.u()));
    double error = 0.0, fast = 0.0, size = 0.0;
    for (const Interval& entry : proof->error) error = std::max(error, rad(entry));
    for (std::size_t i = 0; i < z_.dof; ++i) {
        fast = std::max(fast, mag(set_.hull(z_.v(i))));
        size = std::max({size, fast, mag(set_.hull(z_.q(i)))});
    }
    const bool last = w < 1e-9 * fast || proof->window < 1000.0 * resolution;
    const bool sharp = claim_.cut_early || error <= std::max(2e-16 * size, 0.05 * radius);
    const bool timely = proof->half <= std::max(claim_.eps_t, 0.1 * proof->own);
    if (!last && !(sharp && timely && proof->time.hi() < end)) return false;

    cover(Interval(time.lo(), (Interval(time.hi()) + Interval(proof->window)).hi()), proof->position, proof->velocity);
    maps_->retract(set_);  // u is kept beside: the wait depends on it
    Interval passed(0.0);
    std::optional<Intervals> zeno;
    contact_motion_.forget();
    for (double left = proof->window; left > 0x1p-43 * proof->window;) {
        const Step step = contact_motion_.make(set_, left, KnownRoot::none);
        count_step();
        const Interval wait = proof->wait - passed;
        const Interval tau(std::max(0.0, wait.lo()), std::min(step.length(), wait.hi()));
        if (tau.is_defined()) {
            const bool is_all = passed.hi() == 0.0 && wait.hi() <= step.length();
            const Intervals box = is_all ? zeno_box(step, tau, *proof) : step.box_over(set_, tau);
            if (!zeno) zeno = box;
            for (std::size_t i = 0; i < box.size(); ++i) (*zeno)[i] = hull((*zeno)[i], box[i]);
        }
        step.advance(set_, step.length());
        passed += Interval(step.length());
        left = step.length() < left ? proof->window - mid(passed) : 0.0;
        if (left > 0x1p-43 * proof->window) maps_->retract(set_);
    }
    if (!zeno) throw Undecided{"the Zeno point has no enclosure"};
    Intervals centre = set_.centre();
    for (std::size_t i = 0; i < 2 * z_.dof; ++i) {
        (*zeno)[z_.q(i)] += proof->error[i];
        centre[z_.q(i)] += proof->error[i];
    }
    set_.map(centre, IntervalMatrix::identity(z_.size()));
    set_.set(z_.u(), 0.0);
    maps_->retract(set_);
    const Intervals v = velocities(*zeno);
    result_.events.push_back({Event::Kind::zeno, proof->time, positions(*zeno), v, v, bounces_});
    bounces_ = 0;
    in_contact_ = true;
    known_ = KnownRoot::none;
    contact_motion_.forget();
    return true;
}

void Prover::release(const Interval& time) {
    maps_->retract(set_);
    if (!certainly_positive(maps_->normal(set_.hull()).jerk))
        throw Undecided{
            "degenerate release: the rate of the contact force cannot be told from zero for all of the set"};
    const Intervals v = velocities(set_.hull());
    note_event(Event::Kind::release, time, v, v);
    in_contact_ = false;
    known_ = KnownRoot::released;
    bounces_ = 0;
    flight_.forget();
}

}  // namespace achilles
