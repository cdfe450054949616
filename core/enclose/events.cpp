// Events of all members: impact, truncation of a bouncing, and release (theory-enclosure.md 5 to 7, 10).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "enclose/prover.hpp"

namespace achilles {

namespace {

Interval both(const Interval& a, const Interval& b) {
    const double lo = std::max(a.lo(), b.lo()), hi = std::min(a.hi(), b.hi());
    return lo <= hi ? Interval(lo, hi) : a;
}

}  // namespace

void Prover::note_event(Event::Kind kind, std::size_t contact, const Interval& t, const Intervals& v_before,
                        const Intervals& v_after) {
    const Intervals q = positions(set_.hull());
    const int impacts = bounces_[contact];
    result_.events.push_back({{kind}, contact, mode_, {}, t, q, v_before, v_after, impacts, impacts});
}

void Prover::retract(Mode onto) {
    const Mode before = std::exchange(mode_, onto);
    for (const std::size_t i : onto.held()) maps(i).retract(set_);
    mode_ = before;
}

// The held contacts that an impact opens in every member. Moreau's law has a unique solution, which is proved to be
// this one (theory-gaps.md 2.1): transmitted impulses press the contacts that stay. check_opened() checks afterwards
// that the others leave.
ContactSet Prover::opened_by(std::size_t contact) {
    ContactSet opened;
    const Mode before = mode_;
    for (int round = 0; round < 2 && !mode_.is_free(); ++round) {
        Doubleton tangential = set_;
        maps(contact).take_rate_out(tangential);
        ContactSet pulled;
        for (const auto& [other, passed] : completion(contact).passed_on(tangential)) {
            if (certainly_negative(passed))
                pulled = pulled.with(other);
            else if (!(passed.lo() >= 0.0))
                throw ProofStopped{"cannot decide whether an impact opens a held contact"};
        }
        if (pulled.empty()) break;
        if (round > 0) throw ProofStopped{"cannot decide which held contacts an impact opens"};
        opened = pulled;
        mode_ = mode_.without(opened);
    }
    mode_ = before;
    return opened;
}

// Checks that the last recorded event opened these contacts.
void Prover::check_opened(ContactSet opened) {
    result_.events.back().opened = opened;
    for (std::size_t i = 0; i < z_.contacts; ++i)
        if (opened.contains(i) && !certainly_positive(set_.hull(z_.u(i))))
            throw ProofStopped{"cannot decide whether an impact opens a held contact"};
}

// Impact of all members, which must be on the surface.
void Prover::land(std::size_t contact, const Interval& time) {
    const std::size_t h = z_.h(contact), u = z_.u(contact);
    if (!certainly_negative(set_.hull(u)))
        throw ProofStopped{"graze: the impact speed is not bounded away from zero over the set"};
    project(contact);
    const Intervals v_before = velocities(set_.hull());
    const Interval& e = restitutions_[contact];
    const ContactSet opened = opened_by(contact);
    if (!opened.empty()) {
        enter(mode_.without(opened));
        for (std::size_t i = 0; i < z_.contacts; ++i)
            if (opened.contains(i)) openings_[i].known = KnownRoot::landed;
    }
    if (e.lo() == 0.0 && e.hi() == 0.0) return capture(contact, time, v_before, opened);
    if (++result_.statistics.impacts > claim_.run.options.max_impacts)
        throw ProofStopped{fmt::format("more than {} impacts", claim_.run.options.max_impacts)};
    ++bounces_[contact];
    const double radius = largest_radius();
    Doubleton before = set_;
    maps(contact).impact(set_);
    set_.set(h, 0.0);
    note_event(Event::Kind::impact, contact, time, v_before, velocities(set_.hull()));
    check_opened(opened);
    Doubleton after = set_;
    set_ = before;
    if (complete(contact, time, e, radius)) return;
    set_ = after;
    const double rise = set_.hull(u).hi(), a = mag(maps(contact).normal(set_.hull()).hddot);
    if (2.0 * rise < 0x1p-50 * mag(time) * a)
        throw ProofStopped{"the flights are shorter than the resolution of time, and no completion is proved"};
    openings_[contact].known = KnownRoot::landed;
    motion().forget();
}

// Removes the part of the set where no member is, unless the curvature of the map widens the set more. That effect is
// of second order, but acts at once on a wide set, whereas the removed part would only have grown later.
void Prover::project(std::size_t contact) {
    const auto size = [&](const Doubleton& set) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 2 * z_.dof; ++i) sum += rad(set.hull(z_.q(i)));
        return sum;
    };
    Doubleton projected = set_;
    maps(contact).project(projected);
    constexpr double hardly = 1.001;
    if (size(projected) <= hardly * size(set_)) set_ = projected;
}

// Plastic impact (e = 0) of every member.
void Prover::capture(std::size_t contact, const Interval& time, const Intervals& v_before, ContactSet opened) {
    maps(contact).take_rate_out(set_);
    set_.set(z_.h(contact), 0.0);
    set_.set(z_.u(contact), 0.0);
    retract(mode_.with(contact, ContactState::held));
    const Interval hddot = maps(contact).normal(set_.hull()).hddot;
    const bool may_vanish = !certainly_negative(hddot) && !certainly_positive(hddot);
    if (may_vanish && model_->stays_closed_without_force(contact, mode_)) unpressed_ = unpressed_.with(contact);
    if (certainly_negative(hddot) || unpressed_.contains(contact)) {
        enter(mode_.with(contact, ContactState::held));
        note_event(Event::Kind::zeno, contact, time, v_before, velocities(set_.hull()));
        return check_opened(opened);
    }
    if (!certainly_positive(hddot))
        throw ProofStopped{
            "cannot decide between contact and flight: the contact force is not bounded away from zero over the set"};
    ++result_.statistics.impacts;
    note_event(Event::Kind::impact, contact, time, v_before, velocities(set_.hull()));
    check_opened(opened);
    openings_[contact].known = KnownRoot::at_rest;
    motion().forget();
}

// The states at the Zeno points if all members reach them in this step, each after its own accumulation time. The error
// of the comparison motion is not included.
Intervals Prover::zeno_box(std::size_t contact, const EnclosureStep& step, const Interval& tau,
                           const Completion::CompletionProof& proof) const {
    const double middle = std::clamp(mid(proof.at_center), 0.0, step.length());
    Intervals box = step.box_over(set_, tau);
    const Intervals point = step.center_at(Interval(middle)), rho = step.remainder_at(tau),
                    F = step.rate_at(hull(tau, Interval(middle)));
    IntervalMatrix S = step.slope_at(tau);
    for (std::size_t i = 0; i < z_.size(); ++i) {
        S(i, z_.u(contact)) += F[i] * proof.by_u;
        box[i] = both(box[i], point[i] + rho[i] + F[i] * (proof.at_center - Interval(middle)) + set_.along(S.row(i)));
    }
    return box;
}

// Completes the motion of all members if this is proved accurately enough. The set then consists of the members in
// contact, at a time after their collisions when all have reached their Zeno points.
bool Prover::complete(std::size_t contact, const Interval& time, const Interval& e, double radius) {
    const std::size_t u = z_.u(contact);
    maps(contact).take_rate_out(set_);
    set_.set(z_.h(contact), 0.0);
    const auto proof = completion(contact).prove(set_, e);
    if (!proof) return false;
    const double end = claim_.run.options.end_time;
    const double resolution = 0x1p-52 * std::max(mag(time), 0x1p-30), w = mag(set_.hull(u));
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
    enter(mode_.with(contact, ContactState::held));
    retract(mode_);  // u is kept, because the accumulation time depends on it
    Interval passed(0.0);
    std::optional<Intervals> zeno;
    for (double left = proof->window; left > 0x1p-43 * proof->window;) {
        const EnclosureStep step = motion().make(set_, left, openings_);
        count_step();
        const Interval accumulation_time = proof->accumulation_time - passed;
        const Interval tau(std::max(0.0, accumulation_time.lo()), std::min(step.length(), accumulation_time.hi()));
        if (tau.is_defined()) {
            const bool is_all = passed.hi() == 0.0 && accumulation_time.hi() <= step.length();
            const Intervals box = is_all ? zeno_box(contact, step, tau, *proof) : step.box_over(set_, tau);
            if (!zeno) zeno = box;
            for (std::size_t i = 0; i < box.size(); ++i) (*zeno)[i] = hull((*zeno)[i], box[i]);
        }
        step.advance(set_, step.length());
        passed += Interval(step.length());
        left = step.length() < left ? proof->window - mid(passed) : 0.0;
        if (left > 0x1p-43 * proof->window) retract(mode_);
    }
    if (!zeno) throw ProofStopped{"no enclosure of the Zeno point was found"};
    Intervals center = set_.center();
    for (std::size_t i = 0; i < 2 * z_.dof; ++i) {
        (*zeno)[z_.q(i)] += proof->error[i];
        center[z_.q(i)] += proof->error[i];
    }
    set_.map(center, IntervalMatrix::identity(z_.size()));
    set_.set(u, 0.0);
    retract(mode_);
    measure_other_gaps(mode_.held());
    const Intervals v = velocities(*zeno);
    const int impacts = bounces_[contact];
    result_.events.push_back(
        {{Event::Kind::zeno}, contact, mode_, {}, proof->time, positions(*zeno), v, v, impacts, impacts});
    bounces_[contact] = 0;
    motion().forget();
    return true;
}

void Prover::release(std::size_t contact, const Interval& time) {
    retract(mode_);
    if (!certainly_positive(maps(contact).normal(set_.hull()).jerk))
        throw ProofStopped{
            "degenerate release: the rate of the contact force is not bounded away from zero over the set"};
    const Intervals v = velocities(set_.hull());
    enter(mode_.without(contact));
    note_event(Event::Kind::release, contact, time, v, v);
    openings_[contact].known = KnownRoot::released;
    bounces_[contact] = 0;
}

}  // namespace achilles
