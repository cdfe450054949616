// Guards: jumps of the state, and contacts that count only sometimes (theory-modes.md 1, 2); the ends of latches by an
// expression (latch.cpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulate/execution.hpp"

namespace achilles {

namespace {

int sign_of(const Interval& x) { return certainly_positive(x) ? 1 : certainly_negative(x) ? -1 : 0; }

// The sign of a value over the rounding box of a state; 0 where it may be 0 within rounding, also where the value falls
// on 0 exactly.
int sign_beyond_rounding(const Interval& value, double more = 0.0) {
    constexpr double few = 4.0;
    if (!value.is_defined() || std::abs(mid(value)) <= few * rad(value) + more) return 0;
    return mid(value) > 0.0 ? 1 : -1;
}

}  // namespace

std::string ExecutionAutomaton::text_of_guard(std::size_t watched) const {
    const WatchedGuard& guard = model_->watched_guards()[watched];
    const SystemDescription& system = model_->description();
    return guard.is_latch ? fmt::format("the latch of '{}'", system.constraints[guard.number].name)
                          : fmt::format("the jump '{}'", system.jumps[guard.number].name);
}

ContactSet ExecutionAutomaton::all_watched_guards() const {
    ContactSet all;
    for (std::size_t k = 0; k < model_->watched_guards().size(); ++k) all = all.with(k);
    return all;
}

int ExecutionAutomaton::sign_of_guard(std::size_t guard) {
    const FloatEnvironmentGuard ground;
    if (!guards_) guards_ = model_->evaluator<Interval>(model_->guards(), run_.parameters);
    set_rounding_box(*guards_, next_.state);
    guards_->run();
    return sign_beyond_rounding(guards_->output(guard));
}

// Whether a closed gap is a contact, from the state before its impact. Ends the run, undecided, where `when` is 0.
bool ExecutionAutomaton::does_count(std::size_t contact) {
    if (!model_->is_conditional(contact)) return true;
    const int sign = sign_of_guard(model_->guard_of_contact(contact));
    if (sign == 0)
        stop(Outcome::Kind::undecided,
             fmt::format("'when' of {} is zero to within rounding as its gap closes: cannot decide whether it is a "
                         "contact, at {}",
                         name_of(contact), where(next_.state)));
    return sign > 0;
}

// ---- watched guards ----

// Starts the watched guards at the state: whether each is above or below zero. A zero that the state
// has jumped to is a known root; one that a smooth motion has reached is still an event.
void ExecutionAutomaton::start_guards() {
    const std::size_t count = model_->watched_guards().size();
    if (count == 0) return;
    if (record_.impacts() != impacts_before_) known_zeros_ = all_watched_guards();
    impacts_before_ = record_.impacts();
    ModeKinematics& motion = surfaces_->motion(next_.mode);
    const auto values = motion.enclosed(next_.state);
    const std::size_t first = motion.first_guard();
    next_.starts.resize(first + count);
    for (std::size_t k = 0; k < count; ++k) {
        EventStart& start = next_.starts[first + k] = {};
        const auto& [value, rate] = values[first + k];
        const bool is_located = located_zeros_.contains(k);
        int sign = is_located ? 0 : sign_beyond_rounding(value, resolution(rate) + rounding_of_guard(k));
        if (sign == 0 && !is_located && !known_zeros_.contains(k)) {
            start.is_below = below_.contains(k);
            continue;
        }
        if (sign == 0) sign = sign_after_zero(k, rate, start);
        if (outcome_) return;
        below_ = sign < 0 ? below_.with(k) : below_.without(k);
        start.is_below = sign < 0;
    }
    known_zeros_ = located_zeros_ = {};
}

// The effect on a watched guard of roundings of the state at the largest values that it has had.
double ExecutionAutomaton::rounding_of_guard(std::size_t watched) {
    constexpr double few = 4.0;
    if (!guard_slopes_) guard_slopes_ = model_->evaluator(model_->guard_slopes(), run_.parameters);
    set_state(*guard_slopes_, next_.state);
    guard_slopes_->run();
    const auto n = static_cast<std::size_t>(model_->dof());
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        sum += std::abs(guard_slopes_->output(watched * 2 * n + i)) * scale_.q[k] +
               std::abs(guard_slopes_->output((watched * 2 + 1) * n + i)) * scale_.v[k];
    }
    return few * 0x1p-53 * sum;
}

// Below this size a gap counts as zero at the start and after a jump. Where a jump has moved the coordinates, roundings
// of those before it count, too.
double ExecutionAutomaton::closed_within(ContactKinematics& surface, const Contact& contact) const {
    constexpr double few = 4.0;
    return few * (surface.gap_error(next_.state) + (has_moved_ ? rounding_so_far(contact) : 0.0));
}

// The sign of a watched guard just after its known zero, of order 1 or 2.
int ExecutionAutomaton::sign_after_zero(std::size_t watched, Interval rate, EventStart& start) {
    start.multiplicity = 1;
    if (const int sign = sign_beyond_rounding(rate); sign != 0) return sign;
    start.multiplicity = 2;
    const FloatEnvironmentGuard ground;
    auto known = guard_curvatures_.find(next_.mode);
    if (known == guard_curvatures_.end())
        known =
            guard_curvatures_
                .emplace(next_.mode, model_->evaluator<Interval>(model_->guard_curvatures(next_.mode), run_.parameters))
                .first;
    set_rounding_box(known->second, next_.state);
    known->second.run();
    if (const int sign = sign_beyond_rounding(known->second.output(watched)); sign != 0) return sign;
    if (is_at_rest(next_.mode)) return 1;  // it stays 0
    stop(Outcome::Kind::undecided,
         fmt::format("the function of {} and its first two rates are zero to within rounding: cannot decide its sign, "
                     "at {}",
                     text_of_guard(watched), where(next_.state)));
    return 0;
}

// How much a function may change within the resolution of time.
double ExecutionAutomaton::resolution(const Interval& rate) const {
    constexpr double few = 16.0;
    return few * 0x1p-52 * std::abs(next_.state.t) * mag(rate);
}

// Those of these watched guards that pass through zero at the present state, within rounding, with rates of this sign.
ContactSet ExecutionAutomaton::passing(ContactSet guards, int sign) {
    ContactSet found;
    if (guards.empty()) return found;
    ModeKinematics& motion = surfaces_->motion(next_.mode);
    const auto values = motion.enclosed(next_.state);
    for (const std::size_t k : guards.without(known_zeros_)) {
        const auto& [value, rate] = values[motion.first_guard() + k];
        if (sign_beyond_rounding(value, resolution(rate) + rounding_of_guard(k)) == 0 && sign_of(rate) == sign)
            found = found.with(k);
    }
    return found;
}

// The watched jumps whose functions fall through zero at the present state.
ContactSet ExecutionAutomaton::falling_jumps() {
    ContactSet jumps;
    for (const std::size_t k : all_watched_guards().without(below_))
        if (!model_->watched_guards()[k].is_latch) jumps = jumps.with(k);
    return passing(jumps, -1);
}

// The contacts whose latch ends at the present state by an expression that rises.
ContactSet ExecutionAutomaton::ending_latches() {
    ContactSet latches, contacts;
    for (const std::size_t k : below_)
        if (model_->watched_guards()[k].is_latch) latches = latches.with(k);
    for (const std::size_t k : passing(latches, 1)) contacts = contacts.with(model_->watched_guards()[k].number);
    return contacts.within(next_.latched);
}

// Whether jumps follow impacts of these contacts, or these watched jumps fall, whatever their `when`.
bool ExecutionAutomaton::may_jump(ContactSet landing, ContactSet falling) const {
    const std::vector<JumpLaw>& laws = model_->equations().jumps;
    return !falling.empty() || std::any_of(laws.begin(), laws.end(), [&](const JumpLaw& law) {
        return law.contact && landing.contains(*law.contact);
    });
}

// The jumps that happen at this instant, decided by the state before its impacts and jumps. Ends the run, undecided,
// where `when` of one of them is 0.
ExecutionAutomaton::Jumps ExecutionAutomaton::jumps_after(ContactSet landing, ContactSet falling) {
    Jumps jumps;
    std::size_t watched = 0;
    for (std::size_t i = 0; i < model_->equations().jumps.size(); ++i) {
        const JumpLaw& law = model_->equations().jumps[i];
        const bool is_due = law.contact ? landing.contains(*law.contact) : falling.contains(watched);
        if (!law.contact) ++watched;
        if (!is_due) continue;
        const int sign = law.when ? sign_of_guard(model_->guard_of_jump(i)) : 1;
        if (sign > 0) jumps.push_back(i);
        if (sign != 0) continue;
        stop(Outcome::Kind::undecided,
             fmt::format("'when' of the jump '{}' is zero to within rounding: cannot decide whether it happens, at {}",
                         model_->description().jumps[i].name, where(next_.state)));
        return {};
    }
    return jumps;
}

// The zeros of these watched guards are found at the state, beside those found there before.
void ExecutionAutomaton::locate(ContactSet guards) {
    constexpr double few_ulps = 0x1p-46;
    const double t = next_.state.t;
    if (std::abs(t - located_at_) > few_ulps * std::abs(t)) located_here_ = {};
    located_at_ = t;
    located_here_ = located_zeros_ = located_here_.with(guards);
}

// A zero of a watched guard: a jump happens, a latch ends, or a sign changes. Other guards may pass through zero at the
// same instant.
void ExecutionAutomaton::accept_guard_event(std::size_t event) {
    const std::size_t watched = event - surfaces_->motion(next_.mode).first_guard();
    const WatchedGuard& guard = model_->watched_guards()[watched];
    const bool rises = below_.contains(watched);
    ContactSet falling = falling_jumps(), ending = ending_latches();
    const bool is_known = falling.contains(watched);
    if (!guard.is_latch && !rises) falling = falling.with(watched);
    if (guard.is_latch && rises) ending = ending.with(guard.number).within(next_.latched);
    const ContactSet passing_here = passing(below_, 1).with(passing(all_watched_guards().without(below_), -1));
    if (!falling.empty()) {
        if (completing())
            return stop(Outcome::Kind::undecided, fmt::format("{} happens before the Zeno time, at {}",
                                                              text_of_guard(watched), where(next_.state)));
        if (impacts_first(watched, is_known)) return;
        const Jumps jumps = jumps_after({}, falling);
        if (outcome_) return;
        unlatch(ending);
        if (!jumps.empty()) return jump(jumps, {});
    }
    locate(passing_here.with(falling).with(watched));
    ending.empty() ? go_on_in_mode() : end_latches(ending);
}

// Whether an impact happens at the instant of this jump: it comes first. `is_known`: the jump falls within rounding
// there, too. Also true if the run ends, undecided.
bool ExecutionAutomaton::impacts_first(std::size_t watched, bool is_known) {
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (next_.mode.is_held(i) || next_.touching.with(next_.inactive).contains(i)) continue;
        ContactKinematics& surface = surfaces_->of(i);
        const Contact contact = surface.at(next_.state);
        const double error = 4.0 * surface.gap_error(next_.state) + resolution(Interval(contact.hdot));
        if (contact.h > error || !(contact.hdot < -4.0 * surface.hdot_error(next_.state))) continue;
        if (is_known) {
            land(i, contact);
        } else {
            stop(Outcome::Kind::undecided,
                 fmt::format("cannot decide whether {} happens together with the impact of {}, at {}",
                             text_of_guard(watched), name_of(i), where(next_.state)));
        }
        return true;
    }
    return false;
}

// Begins a segment at the present state, in the present mode.
void ExecutionAutomaton::go_on_in_mode() {
    const double until = next_.until;
    const bool keeps_stick = next_.keeps_stick;
    for (const std::size_t i : next_.held()) next_.starts[i] = {};
    begin_stretch(next_.mode, until);
    next_.keeps_stick = keeps_stick;
}

// ---- the jump ----

void ExecutionAutomaton::jump_after_impact(const Jumps& jumps, ContactSet landing, ContactSet opened) {
    record_.after_impact(opened, next_.mode.without(opened));
    jump(jumps, landing);
}

// Sets the state by these jumps, in the order of the file, and decides the mode of every contact anew.
void ExecutionAutomaton::jump(const Jumps& jumps, ContactSet landing) {
    if (is_endless(jumps.size())) return;
    unlatch(ending_latches());
    const Vector q_before = next_.state.q;
    for (const std::size_t number : jumps)
        if (!apply_jump(number, landing)) return;
    note_scale();
    jumped_ = jumps.size();
    has_moved_ = next_.state.q != q_before;
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        ContactKinematics& surface = surfaces_->of(i);
        const Contact contact = surface.at(next_.state);
        if (model_->is_conditional(i) || contact.h >= -closed_within(surface, contact)) continue;
        record_.close(next_.state.t);
        record_.open({}, {}, next_.state.t);
        record_.after_jumps(jumps.size(), {});
        return stop(
            Outcome::Kind::left_the_domain,
            fmt::format("after the jump '{}' the gap of {} is negative: h = {:.9g}, at {}",
                        model_->description().jumps[jumps.back()].name, name_of(i), contact.h, where(next_.state)));
    }
    record_.close(next_.state.t);
    forget_held();
    decide_at_start();
}

// Sets the state by one jump and records it. False if the run ends.
bool ExecutionAutomaton::apply_jump(std::size_t number, ContactSet landing) {
    const State before = next_.state;
    auto map = model_->evaluator(model_->jump_map(number), run_.parameters);
    set_state(map, before);
    map.run();
    const auto n = before.q.size();
    for (Eigen::Index i = 0; i < n; ++i) {
        next_.state.q[i] = map.output(static_cast<std::size_t>(i));
        next_.state.v[i] = map.output(static_cast<std::size_t>(n + i));
    }
    if (!next_.state.q.allFinite() || !next_.state.v.allFinite()) {
        next_.state = before;
        stop(Outcome::Kind::left_the_domain, fmt::format("the jump '{}' has no finite value, at {}",
                                                         model_->description().jumps[number].name, where(before)));
        return false;
    }
    Event event;
    event.kind = Event::Kind::jump;
    const auto& contact = model_->equations().jumps[number].contact;
    if (contact && landing.contains(*contact)) event.contacts = ContactSet::of(*contact);
    event.t = before.t;
    event.q = next_.state.q;
    event.v_before = before.v;
    event.v_after = next_.state.v;
    event.jump = std::make_shared<const Event::JumpRecord>(Event::JumpRecord{number, before.q});
    record_.jump(std::move(event), record_.exchange_of_jump(before, next_.state, 0.0));
    return true;
}

// Ends the run where jumps follow one another without end.
bool ExecutionAutomaton::is_endless(std::size_t jumps) {
    constexpr int most_at_once = 100;
    const auto count = static_cast<int>(jumps);
    const double t = next_.state.t;
    jumps_at_once_ = jumps_ > 0 && t - last_jump_ <= 0x1p-50 * std::abs(t) ? jumps_at_once_ + count : count;
    last_jump_ = t;
    jumps_ += count;
    if (jumps_at_once_ > most_at_once)
        stop(Outcome::Kind::too_many_events,
             fmt::format("{} jumps follow one another without time between them: they do not end, at {}",
                         jumps_at_once_, where(next_.state)));
    else if (jumps_ > run_.options.max_events)
        stop(Outcome::Kind::too_many_events,
             fmt::format("{} jumps by t = {:.9g}; try a larger --max-events", run_.options.max_events, t));
    return outcome_.has_value();
}

// ---- contacts that count only sometimes ----

// A gap closes that is no contact.
void ExecutionAutomaton::pass(std::size_t contact, double hdot) {
    set_inactive(next_.inactive.with(contact));
    next_.starts[contact] = {{0.0, hdot}, 1};
    Event event;
    event.kind = Event::Kind::pass;
    event.contacts = ContactSet::of(contact);
    event.mode = next_.resting();
    event.t = next_.state.t;
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    record_.event(std::move(event));
}

void ExecutionAutomaton::pass_alone(std::size_t contact, double hdot) {
    pass(contact, hdot);
    go_on_in_mode();
}

// The gap of an inactive contact has risen to zero.
void ExecutionAutomaton::count_again(std::size_t contact) {
    set_inactive(next_.inactive.without(contact));
    next_.starts[contact] = {{0.0, surfaces_->of(contact).at(next_.state).hdot}, 1};
    go_on_in_mode();
}

// A contact whose gap is zero and rises counts again at once, as after an impact that turns it around.
void ExecutionAutomaton::update_inactive() {
    for (const std::size_t i : next_.inactive) {
        ContactKinematics& surface = surfaces_->of(i);
        const Contact contact = surface.at(next_.state);
        if (std::abs(contact.h) > 4.0 * surface.gap_error(next_.state)) continue;
        if (!(contact.hdot > 4.0 * surface.hdot_error(next_.state))) continue;
        set_inactive(next_.inactive.without(i));
        next_.starts[i] = {{0.0, contact.hdot}, 1};
    }
}

// Contacts at rest on their surface that do not count: whether their gap rises or falls from here.
void ExecutionAutomaton::decide_uncounted(ContactSet contacts) {
    for (const std::size_t i : contacts) {
        const auto [hddot, jerk] = surfaces_->of(i, next_.mode).normal(next_.state);
        const int by_acceleration = sign_of(hddot), sign = by_acceleration != 0 ? by_acceleration : sign_of(jerk);
        next_.starts[i] = {{0.0, 0.0}, by_acceleration != 0 ? 2 : 3};
        if (sign > 0) set_inactive(next_.inactive.without(i));
        if (sign == 0 && !is_at_rest(next_.mode))
            return stop(
                Outcome::Kind::undecided,
                fmt::format("{} rests on its surface and does not count, and its acceleration and jerk are zero "
                            "to within rounding: cannot decide whether its gap rises, at {}",
                            name_of(i), where(next_.state)));
    }
}

}  // namespace achilles
