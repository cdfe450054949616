#include "enclose/prover.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace achilles {

Prover::Prover(const Model& model, const EnclosureProblem& claim, const Coordinates& coordinates,
               const Intervals& start, ProofMonitor* watch, const FloatEnvironmentGuard&)
    : model_(&model),
      claim_(claim),
      z_(coordinates),
      watch_(watch),
      set_(start, coordinates.varied.size()),
      openings_(coordinates.contacts),
      bounces_(coordinates.contacts),
      proved_until_(claim.run.options.start_time) {
    for (std::size_t i = 0; i < z_.contacts; ++i) restitutions_.push_back(restitution_over(model, claim, i));
    for (const double time : claim.times) sample_requests_.push_back({time, {}, false});
    sample_requests_.push_back({claim.run.options.end_time, {}, false});
}

Enclosure Prover::run() {
    try {
        begin();
        while (!is_over()) {
            if (watch_ != nullptr && watch_->stop.stop_requested()) {
                result_.outcome = {Enclosure::ProofOutcome::Kind::cancelled, "stopped before its end"};
                break;
            }
            move();
        }
        if (is_over()) result_.outcome = {Enclosure::ProofOutcome::Kind::end_time, "proved to the end time"};
    } catch (const ProofStopped& doubt) {
        result_.outcome = {Enclosure::ProofOutcome::Kind::undecided, doubt.reason};
    }
    const bool whole = result_.outcome.kind == Enclosure::ProofOutcome::Kind::end_time;
    result_.proved_until = whole ? claim_.run.options.end_time : proved_until_;
    for (std::size_t i = 0; i < sample_requests_.size(); ++i) {
        if (!sample_requests_[i].is_known) continue;
        if (i + 1 < sample_requests_.size())
            result_.samples.push_back(*sample_requests_[i].state);
        else if (whole)
            result_.end = *sample_requests_[i].state;
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

// ---- requested times ----

bool Prover::is_over() const {
    return std::all_of(sample_requests_.begin(), sample_requests_.end(),
                       [](const SampleRequest& request) { return request.is_known; });
}

// The remaining time (s), a little beyond the end for every member.
double Prover::longest() const {
    const double left = claim_.run.options.end_time - std::max(now(), proved_until_);
    return 1.001 * left + 0x1p-40 * std::abs(claim_.run.options.end_time);
}

// Covers the requested times that members reach within elapsed times [0, elapsed] of a step. If all members reach the
// time before any reaches the end of the step, the set is mapped to that time. Otherwise the hull there is extended.
void Prover::cover(const EnclosureStep& step, const Interval& elapsed) {
    const Interval now = set_.hull(Coordinates::t());
    for (SampleRequest& request : sample_requests_) {
        if (request.is_known) continue;
        const Interval tau = Interval(request.time) - now;
        if (!(tau.hi() >= 0.0) || !(tau.lo() <= elapsed.hi())) continue;
        if (tau.lo() >= 0.0 && tau.hi() < elapsed.lo() && !request.state) {
            Doubleton there = set_;
            Interval when = tau;
            cross(there, step, CrossingSurface::of_time(z_, request.time), when);
            const Intervals box = there.hull();
            request.state = EnclosedState{request.time, positions(box), velocities(box)};
            request.is_known = true;
            proved_until_ = std::max(proved_until_, request.time);
            continue;
        }
        const Interval part(std::max(0.0, tau.lo()), std::min(tau.hi(), elapsed.hi()));
        const Intervals box = step.box_over(set_, part);
        cover(Interval(request.time), positions(box), velocities(box));
    }
}

// Extends the hulls of the requested times in `times` by a box that contains the members at those times.
void Prover::cover(const Interval& times, const Intervals& q, const Intervals& v) {
    for (SampleRequest& request : sample_requests_) {
        if (request.is_known || !times.contains(request.time)) continue;
        if (!request.state) {
            request.state = EnclosedState{request.time, q, v};
            continue;
        }
        for (std::size_t i = 0; i < z_.dof; ++i) {
            request.state->q[i] = hull(request.state->q[i], q[i]);
            request.state->v[i] = hull(request.state->v[i], v[i]);
        }
    }
}

// Updates proved_until_. A hull is complete once every member has passed its time.
void Prover::settle() {
    proved_until_ = std::max(proved_until_, now());
    if (watch_ != nullptr) watch_->time.store(proved_until_, std::memory_order_relaxed);
    for (SampleRequest& request : sample_requests_)
        if (!request.is_known && request.state && proved_until_ > request.time) request.is_known = true;
}

// ---- motion ----

void Prover::count_step() {
    if (++result_.statistics.steps > claim_.run.options.max_steps)
        throw ProofStopped{fmt::format("more than {} steps", claim_.run.options.max_steps)};
}

EnclosureStepper& Prover::motion() {
    auto& known = motions_[mode_];
    if (!known) known = std::make_unique<EnclosureStepper>(*model_, z_, mode_);
    return *known;
}

EventMaps& Prover::maps(std::size_t contact) {
    const Mode others = mode_.without(contact);
    auto& known = maps_[{others, contact}];
    if (!known) known = make_maps(*model_, z_, contact, others);
    return *known;
}

Completion& Prover::completion(std::size_t contact) {
    auto& known = completions_[{unpressed_, {mode_, contact}}];
    if (!known) known = std::make_unique<Completion>(*model_, z_, contact, mode_, unpressed_);
    return *known;
}

void Prover::enter(Mode mode) {
    mode_ = mode;
    const ContactSet before = unpressed_;
    unpressed_ = {};
    for (const std::size_t i : before)
        if (mode_.is_held(i) && model_->stays_closed_without_force(i, mode_.without(i)))
            unpressed_ = unpressed_.with(i);
    motion().forget();
}

// The remaining time; after impacts, a little more than the next flight.
double Prover::longest_step() {
    double most = longest();
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        if (mode_.is_held(i) || openings_[i].known != KnownRoot::landed) continue;
        const double a = -mid(maps(i).normal(set_.hull()).hddot), u = set_.hull(z_.u(i)).hi();
        if (a > 0.0) most = std::min(most, 1.5 * 2.0 * u / a);
    }
    return most;
}

namespace {

const char* doubt_of(Transition transition) {
    switch (transition) {
        case Transition::impact:
            return "cannot decide whether an impact occurs: the gap is not bounded away from zero over the set";
        case Transition::release:
            return "cannot decide whether a contact is released: the contact force is not bounded away from zero over "
                   "the set";
    }
    return "";
}

}  // namespace

// The event of this step that precedes all others in every member, if there is one.
Prover::NextEvent Prover::next_in(const EnclosureStep& step) const {
    std::vector<FirstRoot> roots;
    NextEvent next{{}, {}, step.length(), {}};
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        const FirstRoot& root = roots.emplace_back(unpressed_.contains(i) ? FirstRoot{FirstRoot::Kind::none, {}}
                                                                          : first_root(step.watched(i), step.length()));
        if (root.kind == FirstRoot::Kind::none) continue;
        next.clear = std::min(next.clear, root.at.lo());
        const bool is_first = !next.contact || root.at.hi() < next.elapsed.hi();
        if (root.kind == FirstRoot::Kind::one && is_first) {
            next.contact = i;
            next.elapsed = root.at;
        }
        if (root.kind == FirstRoot::Kind::undecided) next.doubt = doubt_of(law_of(mode_.state(i)).transition);
    }
    for (std::size_t i = 0; i < z_.contacts && next.contact; ++i) {
        if (i == *next.contact || roots[i].kind == FirstRoot::Kind::none || roots[i].at.lo() > next.elapsed.hi())
            continue;
        if (next.doubt.empty()) next.doubt = "cannot decide the order of the events of two contacts over the set";
        next.contact.reset();
    }
    return next;
}

// Updates the bounds on the open gaps after a step without an event of theirs.
void Prover::pass(const EnclosureStep& step, const Interval& elapsed) {
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        if (mode_.is_held(i)) continue;
        const Interval factor = integer_power(elapsed, static_cast<int>(openings_[i].known));
        openings_[i] = {KnownRoot::none, value_over(step.watched(i), elapsed) * factor};
    }
}

// The surface where the watched function of a contact vanishes.
CrossingSurface Prover::section_of(std::size_t contact, WatchedFunction watched) {
    switch (watched) {
        case WatchedFunction::gap:
            break;
        case WatchedFunction::normal_force:
            return {[this, contact](const Intervals& box) { return maps(contact).normal(box).hddot; },
                    [this, contact](const Intervals& box) { return maps(contact).normal(box).slope; },
                    {},
                    true};
    }
    return CrossingSurface::of_gap(z_, contact);
}

void Prover::handle_event(Transition transition, std::size_t contact, const Interval& time) {
    switch (transition) {
        case Transition::impact:
            return land(contact, time);
        case Transition::release:
            return release(contact, time);
    }
}

void Prover::move() {
    const EnclosureStep step = motion().make(set_, longest_step(), openings_);
    count_step();
    const NextEvent next = next_in(step);
    if (next.contact) {
        const std::size_t contact = *next.contact;
        Doubleton there = set_;
        Interval elapsed = next.elapsed;
        const ContactLaw& law = law_of(mode_.state(contact));
        cross(there, step, section_of(contact, law.watched), elapsed);
        cover(step, elapsed);
        if (is_over()) return;
        pass(step, elapsed);
        set_ = there;
        settle();
        doubts_ = 0;
        last_ = contact;
        motion().forget();
        handle_event(law.transition, contact, set_.hull(Coordinates::t()));
        settle();
        return;
    }
    double length = step.length();
    if (!next.doubt.empty()) {
        length = 0.9 * next.clear;
        if (!(length > 0.0) || ++doubts_ > 12) throw ProofStopped{next.doubt};
    } else {
        doubts_ = 0;
    }
    cover(step, Interval(length));
    if (is_over()) return;
    pass(step, Interval(length));
    step.advance(set_, length);
    retract(mode_);
    if (mode_.is_free() && z_.contacts > 0) project(last_);
    settle();
}

// ---- start: in free flight, in contact, or leaving the surface; and systems that are not covered ----

// Adds every gap and its rate as coordinates.
void Prover::begin() {
    const Intervals start = set_.hull();
    measure_other_gaps({});
    std::optional<std::size_t> on_surface;
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        if (certainly_positive(openings_[i].gap)) continue;
        if (on_surface) throw ProofStopped{"the initial box may touch more than one contact surface"};
        on_surface = i;
    }
    if (on_surface) begin_on_surface(start, *on_surface);
}

void Prover::measure_other_gaps(ContactSet but) {
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        if (but.contains(i)) continue;
        maps(i).measure_gap(set_);
        openings_[i] = {KnownRoot::none, set_.hull(z_.h(i))};
    }
}

// A start on the contact surface within rounding: the theorem holds for the members with h = 0 and, if hdot is 0 within
// rounding, hdot = 0. A sign change of h along n proves that such members exist.
void Prover::begin_on_surface(const Intervals& start, std::size_t contact) {
    EventMaps& maps = this->maps(contact);
    const std::size_t h = z_.h(contact), u_place = z_.u(contact);
    const EventMaps::GapValues surface = maps.surface(start);
    const ProofStopped doubt{
        "cannot decide between contact and flight at the start: the gap is not bounded away from zero over the set"};
    // The effect of rounding of the coordinates on the gap. Because g n = 1, a displacement along n changes the gap by
    // its own length.
    Intervals near = start;
    for (std::size_t i = 0; i < z_.dof; ++i) {
        const double ulps = 0x1p-48 * mag(near[z_.q(i)]);
        near[z_.q(i)] = Interval(mid(near[z_.q(i)])) + Interval(-ulps, ulps);
    }
    const double error = rad(maps.surface(near).h), off = mag(surface.h);
    const double reach = 4.0 * error + 0x1p-200;  // also if all are exactly 0
    if (!(off <= reach)) throw doubt;
    Intervals below = start, above = start;
    for (std::size_t i = 0; i < z_.dof; ++i) {
        const double n = mid(surface.n[i]);
        below[z_.q(i)] = Interval(mid(below[z_.q(i)])) - Interval(n) * Interval(reach);
        above[z_.q(i)] = Interval(mid(above[z_.q(i)])) + Interval(n) * Interval(reach);
    }
    if (!certainly_negative(maps.surface(below).h) || !certainly_positive(maps.surface(above).h)) throw doubt;
    // The members with h = 0 lie within this distance.
    Intervals box = start;
    for (std::size_t i = 0; i < z_.dof; ++i) box[z_.q(i)] += Interval(-1.0, 1.0) * Interval(mag(surface.n[i]) * reach);
    box[h] = Interval(0.0);
    const Interval u = maps.surface(box).hdot;
    if (certainly_positive(u)) {
        box[u_place] = u;
        set_ = Doubleton(box, z_.varied.size());
        maps.measure_gap(set_);
        set_.set(h, 0.0);
        openings_[contact].known = KnownRoot::landed;
        measure_other_gaps(ContactSet::of(contact));
        return;
    }
    double fast = 0.0;
    for (std::size_t i = 0; i < z_.dof; ++i) fast = std::max(fast, mag(box[z_.v(i)]));
    if (certainly_negative(u) || rad(u) > 0x1p-40 * std::max(fast, 1.0))
        throw ProofStopped{"at the start the gap is zero, and a contact closes or may close; start a little earlier"};
    for (std::size_t i = 0; i < z_.dof; ++i) box[z_.v(i)] += Interval(-1.0, 1.0) * Interval(mag(surface.n[i]) * mag(u));
    box[u_place] = Interval(0.0);
    set_ = Doubleton(box, z_.varied.size());
    maps.retract(set_);
    measure_other_gaps(ContactSet::of(contact));
    const Interval hddot = maps.normal(set_.hull()).hddot;
    if (!certainly_positive(hddot) && !certainly_negative(hddot) && model_->stays_closed_without_force(contact, {}))
        unpressed_ = ContactSet::of(contact);
    if (certainly_negative(hddot) || unpressed_.contains(contact)) {
        enter(Mode::holding(ContactSet::of(contact)));
    } else if (certainly_positive(hddot)) {
        openings_[contact].known = KnownRoot::at_rest;
    } else {
        throw ProofStopped{
            "cannot decide between contact and flight at the start: the contact force is not bounded away from zero "
            "over the set"};
    }
}

namespace {

// An interval no wider than rounding does not become a coordinate; terms that depend on it are enclosed over the whole
// interval.
bool is_wide(const Interval& x) { return width(x) > 0x1p-47 * mag(x); }

InputError refusal(const Model& model, const std::string& why) {
    return {model.description().file, {}, "prove does not cover this system: " + why};
}

}  // namespace

Enclosure prove(const std::shared_ptr<const Model>& model, const EnclosureProblem& claim, ProofMonitor* watch) {
    const auto clock = std::chrono::steady_clock::now();
    const FloatEnvironmentGuard ground;
    Coordinates z;
    z.dof = static_cast<std::size_t>(model->dof());
    z.autonomous = model->equations().autonomous;
    z.parameters = claim.parameters;
    z.contacts = model->contacts();
    Intervals start{Interval(claim.run.options.start_time)};
    start.insert(start.end(), claim.q.begin(), claim.q.end());
    start.insert(start.end(), claim.v.begin(), claim.v.end());
    start.resize(z.parameter(0));
    for (std::size_t i = 0; i < z.parameters.size(); ++i)
        if (is_wide(z.parameters[i])) {
            z.varied.push_back(i);
            start.push_back(z.parameters[i]);
        }
    Enclosure result;
    try {
        result = Prover(*model, claim, z, start, watch, ground).run();
    } catch (const ProofStopped& doubt) {
        throw refusal(*model, doubt.reason);
    }
    result.assumptions = fmt::format(
        "IEEE double arithmetic, rounded to nearest, with denormal numbers (set on this thread); errors of {} of at "
        "most "
        "2 ulp, 4 for hyperbolic functions; the derivation and compilation of the equations",
        mathematical_library());
    result.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return result;
}

}  // namespace achilles
