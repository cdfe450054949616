// How a proof begins: in flight, in contact, or taking off; and what no proof covers.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "enclose/prover.hpp"

namespace achilles {

// Every gap and its rate become coordinates.
void Prover::begin() {
    const Intervals start = set_.hull();
    measure_others({});
    std::optional<std::size_t> on_surface;
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        if (certainly_positive(openings_[i].gap)) continue;
        if (on_surface) throw Undecided{"the initial box may touch more than one contact surface"};
        on_surface = i;
    }
    if (on_surface) begin_on_surface(start, *on_surface);
}

void Prover::measure_others(ContactSet but) {
    for (std::size_t i = 0; i < z_.contacts; ++i) {
        if (but.contains(i)) continue;
        maps(i).measure_gap(set_);
        openings_[i] = {KnownRoot::none, set_.hull(z_.h(i))};
    }
}

// A start that is on the surface to within rounding: the theorem is about the members with h = 0, and those with hdot = 0
// where that is not told from 0. That there are such members is proved by a change of sign of h along n.
void Prover::begin_on_surface(const Intervals& start, std::size_t contact) {
    Maps& maps = this->maps(contact);
    const std::size_t h = z_.h(contact), u_place = z_.u(contact);
    const Maps::Surface surface = maps.surface(start);
    const Undecided doubt{
        "cannot decide between contact and flight at the start: the gap is not bounded away from zero over the set"};
    // What roundings of the coordinates make of the gap; g n = 1, so that a way along n is as long as the gap it makes.
    Intervals near = start;
    for (std::size_t i = 0; i < z_.dof; ++i) {
        const double ulps = 0x1p-48 * mag(near[z_.q(i)]);
        near[z_.q(i)] = Interval(mid(near[z_.q(i)])) + Interval(-ulps, ulps);
    }
    const double error = rad(maps.surface(near).h), off = mag(surface.h);
    const double reach = 4.0 * error + 0x1p-200;  // where all are 0 to the last bit, too
    if (!(off <= reach)) throw doubt;
    Intervals below = start, above = start;
    for (std::size_t i = 0; i < z_.dof; ++i) {
        const double n = mid(surface.n[i]);
        below[z_.q(i)] = Interval(mid(below[z_.q(i)])) - Interval(n) * Interval(reach);
        above[z_.q(i)] = Interval(mid(above[z_.q(i)])) + Interval(n) * Interval(reach);
    }
    if (!certainly_negative(maps.surface(below).h) || !certainly_positive(maps.surface(above).h)) throw doubt;
    // The members that are meant lie within reach of these.
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
        measure_others(ContactSet::of(contact));
        return;
    }
    double fast = 0.0;
    for (std::size_t i = 0; i < z_.dof; ++i) fast = std::max(fast, mag(box[z_.v(i)]));
    if (certainly_negative(u) || rad(u) > 0x1p-40 * std::max(fast, 1.0))
        throw Undecided{"at the start the gap is zero, and a contact closes or may close; start a little earlier"};
    for (std::size_t i = 0; i < z_.dof; ++i) box[z_.v(i)] += Interval(-1.0, 1.0) * Interval(mag(surface.n[i]) * mag(u));
    box[u_place] = Interval(0.0);
    set_ = Doubleton(box, z_.varied.size());
    maps.retract(set_);
    measure_others(ContactSet::of(contact));
    const Interval hddot = maps.normal(set_.hull()).hddot;
    if (!certainly_positive(hddot) && !certainly_negative(hddot) && model_->is_carried(contact, {}))
        unpressed_ = ContactSet::of(contact);
    if (certainly_negative(hddot) || unpressed_.contains(contact)) {
        enter(Mode::holding(ContactSet::of(contact)));
    } else if (certainly_positive(hddot)) {
        openings_[contact].known = KnownRoot::at_rest;
    } else {
        throw Undecided{
            "cannot decide between contact and flight at the start: the contact force is not bounded away from zero "
            "over the set"};
    }
}

namespace {

// An interval that rounding alone may have made is no coordinate: what depends on it is enclosed for all of it at once.
bool is_wide(const Interval& x) { return width(x) > 0x1p-47 * mag(x); }

InputError refusal(const Model& model, const std::string& why) {
    return {model.description().file, {}, "prove does not cover this system: " + why};
}

}  // namespace

Enclosure prove(const std::shared_ptr<const Model>& model, const Claim& claim, ProofWatch* watch) {
    const auto clock = std::chrono::steady_clock::now();
    const Ground ground;
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
    } catch (const Undecided& doubt) {
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
