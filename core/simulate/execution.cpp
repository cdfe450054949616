#include "simulate/execution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/degenerate_gap.hpp"
#include "simulate/domain_monitor.hpp"

namespace achilles {

std::string where(const State& state) {
    std::string text = fmt::format("t = {:.9g}, q = (", state.t);
    for (Eigen::Index i = 0; i < state.q.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", state.q[i]);
    text += "), v = (";
    for (Eigen::Index i = 0; i < state.v.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", state.v[i]);
    return text + ")";
}

namespace {

constexpr int max_stalled = 100;

}  // namespace

ExecutionAutomaton::ExecutionAutomaton(std::shared_ptr<const Model> model, const Run& run, ContactCache& surfaces,
                                       RunMonitor* watch, Recording keep, AmbiguityPolicy ambiguity_policy)
    : ambiguity_policy_(ambiguity_policy),
      proof_scope_(keep == Recording::full ? CertificateScope::full : CertificateScope::decision),
      watch_(watch),
      run_(run),
      model_(std::move(model)),
      record_(model_, run_, keep),
      surfaces_(&surfaces) {
    begin();
}

bool ExecutionAutomaton::restart(const Run& run) {
    const Options &now = run_.options, &next = run.options;
    if (next.tolerance != now.tolerance || next.method != now.method || next.truncation != now.truncation) return false;
    if (run.parameters != run_.parameters) {
        if (surfaces_->count() > 1) return false;  // pair conditions depend on restitutions
        surfaces_->bounce_as(run);
    }
    run_ = run;
    for (ContactConditions& known : all_conditions_)
        known.conditions->restart(surfaces_->restitution(known.contact).enclosure);
    record_.restart(model_, run_);
    last_sliding_impact_ = 0;
    last_step_ = proving_ = cut_error_ = 0.0;
    stalled_ = load_sharing_changes_ = friction_events_ = jumps_ = jumps_at_once_ = 0;
    impacts_before_ = 0;
    next_.latched = spent_ = acting_ = located_here_ = {};
    evaluations_ = 0;
    completion_.reset();
    outcome_.reset();
    begin();
    return true;
}

// ---- start ----

// Starts in free flight, in contact, or with an impact, which takes precedence.
void ExecutionAutomaton::begin() {
    forget_held();
    next_.state = run_.start();
    scale_ = {Vector::Zero(model_->dof()), Vector::Zero(model_->dof()), 0.0};
    note_scale();
    next_.starts.assign(surfaces_->count(), {});
    has_moved_ = false;
    decide_at_start();
    if (record_.has_no_step()) record_.end_start();
}

// Decides the mode of every contact from the state alone: at the start of the run, and after a jump.
void ExecutionAutomaton::decide_at_start() {
    set_inactive({});
    const ContactSet latched = std::exchange(next_.latched, {});
    known_zeros_ = all_watched_guards();
    prepare_stretch({}, run_.options.end_time);
    ContactSet landing, resting;
    UncountedContacts uncounted;
    Contact last;
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        ContactKinematics& surface = surfaces_->of(i);
        const Contact contact = surface.at(next_.state);
        next_.starts[i] = {{contact.h, contact.hdot}, 0};
        const double gap_error = closed_within(surface, contact);
        if (contact.h > gap_error) continue;
        if (contact.h < -gap_error && has_guards()) {
            set_inactive(next_.inactive.with(i));  // a negative gap of another contact is excluded before
            continue;
        }
        next_.starts[i] = {{0.0, contact.hdot}, 1};  // |h| and |hdot| within rounding count as zero
        const double error = 4.0 * surface.hdot_error(next_.state);
        if (contact.hdot > error) continue;
        const bool counts = does_count(i), closes = contact.hdot < -error;
        if (outcome_) break;
        if (closes && counts) {
            landing = landing.with(i);
            last = contact;
        } else if (closes) {
            uncounted.closing.emplace_back(i, contact.hdot);
        } else if (latched.contains(i)) {
            next_.latched = next_.latched.with(i);  // it stays so through a jump that keeps it closed
        } else {
            ContactSet& set = counts ? resting : uncounted.resting;
            set = set.with(i);
        }
    }
    set_inactive(next_.inactive.with(uncounted.resting));
    if (outcome_) return open_first_phase({});
    if (surfaces_->has_friction()) return begin_with_friction(landing, resting, uncounted);
    if (landing.empty())
        start_at_rest(resting);
    else
        next_.mode = latched_mode();
    open_first_phase(uncounted);
    if (outcome_) return;
    if (landing.empty()) return has_guards() ? begin_stretch(next_.mode, run_.options.end_time) : void();
    if (surfaces_->count() == 1) return land(0, last);
    next_.touching = resting;
    collide(landing);
}

// Opens the phase that begins with the decided mode, at the start or after a jump.
void ExecutionAutomaton::open_first_phase(const UncountedContacts& uncounted) {
    record_.open(next_.resting(), next_.held(), next_.state.t);
    if (!has_guards()) return;
    if (!outcome_) decide_uncounted(uncounted.resting);
    record_.after_jumps(std::exchange(jumped_, 0), next_.resting());
    for (const auto& [contact, hdot] : uncounted.closing) pass(contact, hdot);
}

// Contacts that start with h = 0 and hdot = 0.
void ExecutionAutomaton::start_at_rest(ContactSet resting) {
    next_.mode = latched_mode();
    if (resting.empty()) return;
    const ContactSet closed = resting.with(next_.latched);
    if (closed.count() > 1) {
        if (!surfaces_->project(next_.state, closed, closed)) return fail_projection();
    } else {
        for (std::size_t i = 0; i < surfaces_->count(); ++i)
            if (resting.contains(i))
                next_.state.v =
                    reinitialize(surfaces_->of(i).at(next_.state), next_.state.v, Reinitialization::kinetic);
    }
    decide(resting);
}

// ---- next step ----

const StepRequest* ExecutionAutomaton::next() {
    if (outcome_ || (watch_ != nullptr && is_cancelled())) return nullptr;
    if (!is_time_left() && completing() && completion_->t < run_.options.end_time) pass_zeno_point();
    if (!completing() && !next_.unwatched.empty() && !is_time_left() && next_.until < run_.options.end_time)
        end_sharing();
    if (outcome_) return nullptr;
    if (!is_time_left()) {
        stop(Outcome::Kind::end_time, "reached the end time");
    } else if (record_.steps() >= run_.options.max_steps) {
        stop(Outcome::Kind::too_many_steps, fmt::format("{} steps by t = {:.9g}: the motion is too fast for this "
                                                        "tolerance and end time; try a larger --max-steps",
                                                        record_.steps(), next_.state.t));
    } else if (record_.bytes() >= run_.options.memory) {
        stop(Outcome::Kind::out_of_memory,
             fmt::format("{} steps and {} impacts by t = {:.9g} use all of the {:.4g} MB allowed; increase the memory "
                         "limit or choose an earlier end time",
                         record_.steps(), record_.impacts(), next_.state.t, run_.options.memory / 1e6));
    } else if (stalled_ > max_stalled) {
        // Consecutive steps at the resolution of time would return to the same state forever.
        stop_at(StepFailure::step_too_small);
    }
    if (outcome_) return nullptr;
    const bool in_contact = !next_.mode.is_free();
    for (const std::size_t i : next_.held()) next_.starts[i].gap.state_error = state_error();
    for (std::size_t i = surfaces_->count(); i < next_.starts.size(); ++i)
        next_.starts[i].gap.state_error = state_error();
    next_.most = run_.options.max_steps - record_.steps();
    if (!surfaces_->has_friction() && !next_.starts.empty()) {
        const EventStart& start = next_.starts.front();  // of the only contact; used only if there is one
        next_.plain =
            stalled_ == 0 && !start.is_shortened && next_.unpressed.empty() && (in_contact || start.multiplicity <= 1);
    }
    if (!completing() && next_.begins && !next_.unwatched.empty())
        next_.until = std::min(next_.until, end_of_sharing());
    if (next_.begins) note_beginning();
    return &next_;
}

// Saves the start of the segment.
void ExecutionAutomaton::note_beginning() {
    record_.stretch(next_.state);
    if (!can_retry_tight()) return;
    beginning_.next = next_;
    beginning_.recorded = record_.mark();
    beginning_.last_step = last_step_;
    beginning_.stalled = stalled_;
}

bool ExecutionAutomaton::is_time_left() const { return next_.until - next_.state.t > 1e-15 * std::abs(next_.state.t); }

// Reports progress, and checks for cancellation. Called once per step; every impact and every release lies between two
// steps.
bool ExecutionAutomaton::is_cancelled() {
    watch_->time.store(next_.state.t, std::memory_order_relaxed);
    watch_->impacts.store(record_.impacts(), std::memory_order_relaxed);
    if (!watch_->stop.stop_requested()) return false;
    stop(Outcome::Kind::cancelled, fmt::format("cancelled at t = {:.9g}", next_.state.t));
    return true;
}

// Estimated error of the state relative to its size: a tenth of the tolerance for each step so far, as measured, and
// the certified errors of the truncations.
double ExecutionAutomaton::state_error() const {
    return integration_error(run_.options, static_cast<double>(record_.steps())) + cut_error_;
}

// ---- result of a step ----

void ExecutionAutomaton::accept(const StepResult& result) {
    using StepOutcome = StepResult::StepOutcome;
    evaluations_ += result.evaluations;
    acting_ = next_.mode.seen_by_forces().within(model_->equations().in_forces);
    const bool shared = result.end == StepOutcome::ambiguous && !surfaces_->has_friction() &&
                        result.which < surfaces_->count() && continue_without(result.which, *result.state);
    if (result.end == StepOutcome::ambiguous && !shared && can_retry_tight()) return retry_tight();
    if (result.steps > 0) advance(result);
    next_.state = *result.state;
    note_scale();
    switch (result.end) {
        case StepOutcome::no_event:
            next_.begins = false;
            if (surfaces_->has_friction() && !check_friction_levels(next_.held().with(next_.mode.joints()))) return;
            return check_touching();
        case StepOutcome::impact:
            return land(result.which, result.contact);
        case StepOutcome::force_vanishes:
            return release(result.which);
        case StepOutcome::friction_event:
            return accept_friction_event(result.which);
        case StepOutcome::gap_rises:
            return count_again(result.which);
        case StepOutcome::guard_event:
            return accept_guard_event(result.which);
        case StepOutcome::ambiguous:
            if (is_pivot(result.which)) return accept_friction_event(result.which);  // also where it only touches 0
            if (shared) return continue_phase();
            if (!collapse_failure_.inequality.empty() && is_chatter()) return end_chatter({});
            return stop(Outcome::Kind::undecided, ambiguity_text(result));
        case StepOutcome::off_surface:
            return fail_projection();
        case StepOutcome::step_failed:
            return stop_at(result.failure);
    }
}

// Records the steps made, and moves to their end.
void ExecutionAutomaton::advance(const StepResult& result) {
    if (result.flow != nullptr) {
        record_.step(*result.flow, result.gap, next_.resting());
    } else {
        record_.steps(result.steps, result.gap);
    }
    stalled_ = result.state->t - next_.state.t > 0x1p-51 * std::abs(next_.state.t) ? 0 : stalled_ + 1;
    last_step_ = result.duration;
    for (std::size_t i = 0; i < next_.starts.size(); ++i) next_.starts[i] = result.starts[i];
}

void ExecutionAutomaton::note_scale() {
    const State& state = next_.state;
    scale_.q = scale_.q.cwiseMax(state.q.cwiseAbs());
    scale_.v = scale_.v.cwiseMax(state.v.cwiseAbs());
    scale_.t = std::max(scale_.t, std::abs(state.t));
}

// Begins a segment in this mode that ends at `until` (s) at the latest.
void ExecutionAutomaton::begin_stretch(Mode mode, double until) {
    prepare_stretch(mode, until);
    if (model_->has_latches()) latch_held();
    if (model_->do_forces_see_contact()) check_held_forces();
    if (!has_guards() || outcome_) return;
    update_inactive();
    start_guards();
}

void ExecutionAutomaton::prepare_stretch(Mode mode, double until) {
    next_.mode = mode;
    next_.first_step = 0.0;
    next_.until = until;
    next_.begins = true;
    next_.exactly = next_.keeps_stick = false;
    if (surfaces_->has_friction()) start_friction_functions();
}

// Updates the gap rates of open contacts after a velocity jump, except those in `but`.
void ExecutionAutomaton::change_other_rates(const Vector& v_before, ContactSet but) {
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (!next_.mode.is_held(i) && !but.contains(i) && !next_.touching.contains(i))
            next_.starts[i].gap.hdot += surfaces_->of(i).at(next_.state).g.dot(next_.state.v - v_before);
}

// False if the segment already uses exact_tolerance, or the run does.
bool ExecutionAutomaton::can_retry_tight() const {
    return ambiguity_policy_ == AmbiguityPolicy::retry_tight && !next_.exactly &&
           run_.options.tolerance > exact_tolerance;
}

// Returns to the start of the segment, to redo it at exact_tolerance.
void ExecutionAutomaton::retry_tight() {
    next_ = beginning_.next;
    record_.go_back(beginning_.recorded);
    last_step_ = beginning_.last_step;
    stalled_ = beginning_.stalled;
    next_.exactly = true;
}

// ---- end of the run ----

std::string ExecutionAutomaton::ambiguity_text(const StepResult& result) const {
    const std::string place = where(next_.state);
    if (result.which >= surfaces_->motion(next_.mode).first_guard())
        return fmt::format(
            "cannot decide whether the function of {} passes through zero: it is within integration error of zero "
            "just after {}",
            text_of_guard(result.which - surfaces_->motion(next_.mode).first_guard()), place);
    if (result.which < surfaces_->count() && next_.inactive.contains(result.which))
        return fmt::format(
            "cannot decide whether the gap of '{}' rises above zero: it is within integration error of "
            "zero just after {}",
            model_->description().constraints[result.which].name, place);
    if (result.which >= surfaces_->count()) {
        const bool is_short = last_step_ < 1e-6 * (1.0 + next_.state.t);
        return fmt::format(
            "cannot decide whether {} starts to slide, stops or reverses: its slip or its friction force is "
            "within integration error of the limit just after {}{}",
            name_of(model_->motion(next_.mode).friction[result.which - surfaces_->count()].contact), place,
            obstacle_ && is_short ? "; " + obstacle_text() : "");
    }
    if (next_.mode.is_held(result.which))
        return "cannot decide whether the contact is released: the contact force is within integration error of zero "
               "just after " +
               place;
    const std::string known = fmt::format("the gap is within integration error ({:.1g}) of zero", result.remainder);
    if (is_flat(*model_, run_.parameters, next_.state, result.which))
        return fmt::format("{}, and dh vanishes where h = 0, so the contact has no normal, just after {}; {}", known,
                           place, flat_hint);
    return fmt::format("{}: cannot decide whether an impact occurs just after {}", known, place);
}

void ExecutionAutomaton::stop_at(StepFailure failure) {
    if (failure == StepFailure::step_too_small && is_chatter()) return end_chatter({});
    if (failure == StepFailure::step_too_small && jumps_ > 1 && is_just_after_jump())
        return stop(Outcome::Kind::too_many_events,
                    "jumps follow one another in ever shorter times: they do not end, at " + where(next_.state));
    const std::string place = where(next_.state);
    if (failure == StepFailure::not_a_number)
        return stop(Outcome::Kind::not_a_number, "the motion diverges: the state is not finite just after " + place);
    const std::string edge = edge_of_domain(*model_, run_, next_.state);
    if (!edge.empty()) return stop(Outcome::Kind::left_the_domain, fmt::format("{}, just after {}", edge, place));
    if (failure == StepFailure::left_the_domain)
        return stop(Outcome::Kind::left_the_domain,
                    "M is not positive definite, or a function is undefined, just after " + place);
    stop(Outcome::Kind::step_too_small, "no step is small enough for the tolerance after " + place);
}

void ExecutionAutomaton::fail_projection() {
    const std::string edge = edge_of_contact(*model_, run_, next_.state), place = where(next_.state);
    if (!edge.empty()) return stop(Outcome::Kind::left_the_domain, fmt::format("{}, at {}", edge, place));
    bool is_flat = false;  // whether a gap has no slope here
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        const double slope = surfaces_->of(i).at(next_.state).g.norm();
        is_flat = is_flat || !(slope > 1e-6);
    }
    if (!is_flat)
        return stop(Outcome::Kind::undecided,
                    fmt::format("the state cannot be brought onto the contact surfaces{}, at {}; try a smaller "
                                "--tolerance",
                                next_.held().empty() ? "" : ", with " + names_of(next_.held()) + " held", place));
    stop(Outcome::Kind::left_the_domain,
         fmt::format("dh = 0 at the contact: the normal is not defined, at {}; {}", place, flat_hint));
}

void ExecutionAutomaton::stop(Outcome::Kind kind, std::string message) { outcome_ = Outcome{kind, std::move(message)}; }

void ExecutionAutomaton::run_out_of_memory() {
    stop(Outcome::Kind::out_of_memory,
         fmt::format("{} steps by t = {:.9g}, and no more memory is available on this machine", record_.steps(),
                     next_.state.t));
}

Trajectory ExecutionAutomaton::finish() {
    Trajectory trajectory = record_.finish(next_.state, std::move(*outcome_), evaluations_);
    trajectory.statistics.certificate_seconds = proving_;
    return trajectory;
}

}  // namespace achilles
