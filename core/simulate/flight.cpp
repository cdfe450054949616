// EventStepper: impacts of open contacts, zeros of the forces of held ones, and zeros of further functions: of friction
// and of guards, and the rise of the gaps of inactive contacts.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "simulate/event_stepper.hpp"

namespace achilles {

namespace {

constexpr std::uint64_t bit_of(std::size_t event) { return std::uint64_t{1} << event; }

}  // namespace

// The gap polynomial of a contact, computed once for the current step.
const Polynomial& EventStepper::gap_along(std::size_t contact) {
    Polynomial& h = along_[contact];
    if (!known_.contains(contact)) make_gap(contact, h);
    known_ = known_.with(contact);
    return h;
}

// The gap along the last step, as a polynomial in theta. It is the integrated increment; a root of h(q) itself would be
// uncertain by err(h)/w, which exceeds the last flights. If h(q) at the end of the step is more accurate (the
// difference exceeds its rounding), the polynomial is corrected to end there.
void EventStepper::make_gap(std::size_t contact, Polynomial& h) {
    const int multiplicity = start_of(contact).multiplicity;
    flow_->event_function(contact, h);
    for (int j = 0; j < multiplicity; ++j) h.c[static_cast<std::size_t>(j)] = 0.0;  // known roots stay roots
    if (flow_->is_expansion()) return;
    ContactKinematics& surface = surfaces_->of(contact);
    const Contact& end = contact_at_end(contact);
    const Polynomial::EndValue reached = h.at_end();
    const double value = end.h - reached.value, slope = end.hdot * flow_->duration() - reached.slope;
    if (!surface.within_gap_error(value, 4.0, end, flow_->end())) {
        // Adds theta^m (value - b + b theta), which has this value and slope at theta = 1 and no lower powers.
        const int m = std::max(2, multiplicity);
        const double b = slope - m * value;
        h.c[static_cast<std::size_t>(m)] += value - b;
        h.c[static_cast<std::size_t>(m + 1)] += b;
    }
}

// A gap that surely stays open is not searched for a zero, and its polynomial is not corrected.
FirstCrossing EventStepper::gap_descent() {
    if (flow_->stays_positive(contact_)) {
        clear_ = clear_.with(contact_);
        return {};
    }
    const Polynomial& h = gap_along(contact_);
    return first_descent(h, start_of(contact_).multiplicity, flow_->remainder(contact_, h));
}

// Returns nullopt if the gap stays open along the step, which may have been shortened.
std::optional<StepResult::StepOutcome> EventStepper::meet_gap(FirstCrossing descent) {
    const bool was_shortened = start_of(contact_).is_shortened;
    if (descent.kind == FirstCrossing::Kind::increasing && end_step_at(descent.theta))  // its remainder is smaller
        descent = gap_descent();
    switch (descent.kind) {
        case FirstCrossing::Kind::none:
            break;
        case FirstCrossing::Kind::root:
            if (descent.theta == 0.0) return land_here();
            return locate_impact(descent.theta);  // nullopt: no impact, or the step was shortened
        case FirstCrossing::Kind::increasing:
            if (!has_exact_start() || was_shortened) return doubt_gap(0.0);
            break;
        case FirstCrossing::Kind::open:
            // Try again from where the gap enters its remainder: an event near the end of this step is then inside the
            // next one.
            if (!was_shortened && end_step_at(descent.theta)) {
                shortened_ |= bit_of(contact_);
            } else if (surely_closes_at_start()) {
                return land_here();
            } else if (!(has_exact_start() && is_last() && gap_along(contact_)(1.0) >= 0.0)) {
                return doubt_gap(descent.theta);
            }
            break;
        case FirstCrossing::Kind::undecided:
            return doubt_gap(descent.theta);
    }
    return std::nullopt;
}

// Computes the start of the next step for all contacts except `but`, and updates the smallest gap. Returns false, with
// the contact in contact_, if h(q) is negative at the end although the polynomial stays positive.
bool EventStepper::settle_gaps(ContactSet but, double& least) {
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (but.contains(i)) continue;
        if (watched_of(i) != WatchedFunction::gap) {
            result_.starts[i] = {{}, 0, (shortened_ & bit_of(i)) != 0};
            continue;
        }
        if (!is_watched(i)) {
            result_.starts[i] = {{0.0, 0.0}, 1, false};
            continue;
        }
        const bool is_clear = clear_.contains(i);  // then h(q) is accurate enough
        if (is_clear) flow_->event_function(i, along_[i]);
        const Polynomial& h = is_clear ? along_[i] : gap_along(i);
        const Contact& end = contact_at_end(i);
        const Polynomial::EndValue reached = is_clear ? Polynomial::EndValue{} : h.at_end();
        Gap gap{reached.value, reached.slope / flow_->duration()};
        if (is_clear || !surfaces_->of(i).within_gap_error(end.h - gap.h, 4.0, end, flow_->end())) {
            if (end.h < 0.0 && !is_inactive(i)) {
                contact_ = i;
                return false;
            }
            gap = {end.h, end.hdot};
        }
        flow_->add_error(i, h, gap);
        flow_->move_gap(i, gap);
        result_.starts[i] = {gap, 0, (shortened_ & bit_of(i)) != 0};
        if (!is_inactive(i)) least = std::min(least, end.h);
    }
    for (std::size_t i = surfaces_->count(); i < events(); ++i)
        result_.starts[i] = {{}, 0, (shortened_ & bit_of(i)) != 0, start_of(i).is_below};
    return true;
}

// It is ambiguous from theta on whether the gap closes: ends the step there.
StepResult::StepOutcome EventStepper::doubt_gap(double theta) {
    Polynomial h;
    flow_->event_function(contact_, h);
    result_.remainder = flow_->remainder(contact_, h);
    if (end_step_at(theta) && (held().empty() || end_on_surface()))
        end_step(surfaces_->of(contact_).at(flow_->end()).h);
    return StepOutcome::ambiguous;
}

// Whether the gap starts within its remainder and closes so fast that it must pass through zero before it could turn
// around. The impact is then certain, and only its time has this uncertainty.
bool EventStepper::surely_closes_at_start() {
    const EventStart& start = start_of(contact_);
    if (start.multiplicity > 0) return false;
    const Polynomial& h = gap_along(contact_);
    return surely_falls(h, flow_->remainder(contact_, h), start.gap.rate_error);
}

// The same of any function along the step, with these bounds on its error and on that of its rate.
bool EventStepper::surely_falls(const Polynomial& h, double remainder, double rate_error) const {
    const double span = flow_->duration(), rate = h.c[1] / span;
    if (!(h.c[0] <= remainder) || !(rate < -4.0 * rate_error)) return false;
    double acceleration = 0.0;  // upper bound over the step
    for (int k = 2; k <= h.degree; ++k) acceleration += k * (k - 1) * std::abs(h.c[static_cast<std::size_t>(k)]);
    const double passage = 2.0 * (std::abs(h.c[0]) + remainder) / -rate;
    return passage * acceleration / (span * span) < -0.25 * rate;
}

// Impact at the start of the step: the gap reached zero within the remainder of the step before.
StepResult::StepOutcome EventStepper::land_here() {
    landed_ = request_->state;
    result_.state = &landed_;
    if (!surfaces_->land(landed_, contact_, request_->mode, result_.contact)) return StepOutcome::off_surface;
    if (!(result_.contact.hdot < 0.0)) return doubt_gap(0.0);
    return StepOutcome::impact;
}

// The step ends below the contact surface by h(q), although the gap polynomial, accurate to the tolerance, stays
// positive. Finds the zero of h(q) by bisection, repeating the step to each midpoint, and impacts there.
StepResult::StepOutcome EventStepper::land_under() {
    const double duration = flow_->duration();
    double above = 0.0, under = 1.0;
    while (under - above > 0x1p-50) {
        const double middle = 0.5 * (above + under);
        if (!end_step_after(middle * duration)) break;
        (surfaces_->of(contact_).at(flow_->end()).h > 0.0 ? above : under) = middle;
    }
    if (!end_step_after(under * duration)) return doubt_gap(0.0);  // the step is discarded
    return end_flight();
}

// Integrates to the root and corrects it by Newton's method until the rest is within a Taylor step. Returns nullopt if
// the step contains no impact (only the dense output crossed zero).
std::optional<StepResult::StepOutcome> EventStepper::locate_impact(double theta) {
    double duration = theta * flow_->duration();
    for (int round = 0; round < 8; ++round) {
        forget_step();
        if (const auto failure = flow_->redo_step(duration); failure != StepFailure::none) return fail(failure);
        if (flow_->is_expansion()) break;
        const bool shortened = flow_->duration() < duration * (1.0 - 1e-12);
        const Polynomial& h = gap_along(contact_);
        const double hdot = h.slope(1.0) / flow_->duration();
        if (shortened || !(hdot < 0.0)) return std::nullopt;
        const double correction = -h(1.0) / hdot;
        if (std::abs(correction) < 1e-7 && std::abs(correction) < 1e-3 * duration) {
            forget_step();
            flow_->shift_end(correction);
            break;
        }
        duration = std::max(duration + correction, 0.5 * duration);
    }
    return end_flight();
}

// Ends the last step on the contact surface, with an impact.
StepResult::StepOutcome EventStepper::end_flight() {
    const std::size_t contact = contact_;
    known_at_end_ = {};
    const bool landed = surfaces_->land(flow_->edit_end(), contact, request_->mode, result_.contact);
    double least = landed ? result_.contact.h : surfaces_->of(contact).at(flow_->end()).h;
    if (landed) {
        if (surfaces_->count() > 1)
            settle_gaps(ContactSet::of(contact), least);  // other contacts that have closed as well impact at this time
        contact_ = contact;
    }
    end_step(least);
    return landed ? StepOutcome::impact : StepOutcome::off_surface;
}

// ---- forces of held contacts, and functions of friction ----

// Returns nullopt if the force, or the function of friction, stays positive along the step, which may have been
// shortened.
std::optional<StepResult::StepOutcome> EventStepper::meet_force(FirstCrossing descent) {
    const bool was_shortened = start_of(contact_).is_shortened;
    if (descent.kind == FirstCrossing::Kind::increasing && end_step_at(descent.theta)) descent = this->descent();
    switch (descent.kind) {
        case FirstCrossing::Kind::none:
            break;
        case FirstCrossing::Kind::root:
            if (descent.theta == 0.0) return vanishing();
            return locate_release(descent.theta);  // nullopt: the step was shortened
        case FirstCrossing::Kind::increasing:
            if (!has_exact_start() || was_shortened) return doubt_force(0.0);
            break;
        case FirstCrossing::Kind::open:
            // As for gaps: an event near the end of this step is then inside the next one.
            if (!was_shortened && end_step_at(descent.theta)) {
                shortened_ |= bit_of(contact_);
            } else if (surely_passes_at_start()) {
                return vanishing();
            } else if (!(has_exact_start() && is_last())) {
                return doubt_force(descent.theta);
            }
            break;
        case FirstCrossing::Kind::undecided:
            return doubt_force(descent.theta);
    }
    return std::nullopt;
}

// Computes projected_.
void EventStepper::project_end() {
    if (is_projected_) return;
    projected_ = flow_->end();
    projected_gap_ = surfaces_->settle(projected_, request_->mode);
    is_projected_ = true;
}

// Projects the end of the last step onto the surfaces of the held contacts. Returns false if that fails.
bool EventStepper::end_on_surface() {
    State& end = flow_->edit_end();
    known_at_end_ = {};
    std::optional<double> gap = projected_gap_;
    if (is_projected_)
        end = projected_;
    else
        gap = surfaces_->settle(end, request_->mode);
    end_step(gap ? *gap : is_further(contact_) ? 0.0 : surfaces_->of(contact_).at(flow_->end()).h);
    return gap.has_value();
}

double EventStepper::value_at(const State& state) {
    if (is_inactive(contact_)) return surfaces_->of(contact_).at(state).h;
    if (surfaces_->has_friction() || is_further(contact_))
        return surfaces_->motion(request_->mode).at(state, contact_).value;
    return surfaces_->of(contact_, model_->unconstrained(request_->mode, contact_)).normal_acceleration(state);
}
double EventStepper::rate_at(const State& state) {
    if (is_inactive(contact_)) return surfaces_->of(contact_).at(state).hdot;
    if (surfaces_->has_friction() || is_further(contact_))
        return surfaces_->motion(request_->mode).at(state, contact_).rate;
    return surfaces_->of(contact_, model_->unconstrained(request_->mode, contact_)).jerk(state);
}

// What the zero of the function that is examined means.
StepResult::StepOutcome EventStepper::vanishing() const {
    if (is_inactive(contact_)) return StepOutcome::gap_rises;
    if (!is_further(contact_)) return StepOutcome::force_vanishes;
    return is_guard(contact_) ? StepOutcome::guard_event : StepOutcome::friction_event;
}

// The gap of an inactive contact, or a function of friction or of a guard, along the last step.
Polynomial EventStepper::further_function() {
    if (is_inactive(contact_)) return gap_along(contact_);
    Polynomial function;
    flow_->event_function(contact_, function);
    return function;
}

// Whether a guard starts within its remainder of zero and passes through it so fast that it cannot turn around before:
// the step before has ended just short of its zero.
bool EventStepper::surely_passes_at_start() {
    const EventStart& start = start_of(contact_);
    if (!is_further(contact_) || !is_guard(contact_) || start.multiplicity > 0) return false;
    Polynomial function = further_function();
    for (int k = 0; start.is_below && k <= function.degree; ++k) function.c[static_cast<std::size_t>(k)] *= -1.0;
    const double remainder = flow_->remainder(contact_, function);
    return surely_falls(function, remainder, remainder / flow_->duration());
}

// First zero in the last step of a function of friction, of a watched guard, or of the gap of an inactive contact. What is
// negative is watched for its rise. At a start at 0 that is not a known root, theta is 0.
FirstCrossing EventStepper::further_descent() {
    const EventStart& start = start_of(contact_);
    const int multiplicity = start.multiplicity;
    const bool is_gap = is_inactive(contact_), rises = is_gap || start.is_below;
    Polynomial function = further_function();
    if (!is_gap && !flow_->is_expansion()) {
        State end = flow_->end();
        surfaces_->settle(end, request_->mode);
        function.c[static_cast<std::size_t>(std::max(2, multiplicity))] += value_at(end) - function(1.0);
    }
    for (int k = 0; k < multiplicity; ++k) function.c[static_cast<std::size_t>(k)] = 0.0;
    const auto terms = std::span(function.c).first(static_cast<std::size_t>(function.degree + 1));
    const auto is_zero = [](double c) { return c == 0.0; };
    if ((is_gap || is_guard(contact_)) && std::all_of(terms.begin(), terms.end(), is_zero)) return {};  // it stays 0
    for (double& c : terms) c = rises ? -c : c;
    if (multiplicity == 0 && !(function.c[0] > 0.0)) return {FirstCrossing::Kind::root, 0.0};
    return first_descent(function, multiplicity, flow_->remainder(contact_, function));
}

// It is ambiguous from theta on whether the force vanishes: ends the step there.
StepResult::StepOutcome EventStepper::doubt_force(double theta) {
    if (!end_step_at(theta)) return StepOutcome::ambiguous;
    if (!end_on_surface()) return StepOutcome::off_surface;
    const std::size_t contact = contact_;
    settle_gaps({}, result_.gap);
    contact_ = contact;
    return StepOutcome::ambiguous;
}

// First zero of the contact force -hddot = W lambda in the last step; theta = 0 if it is zero at the start within
// rounding.
FirstCrossing EventStepper::force_descent() {
    if (flow_->stays_negative(contact_)) return {};
    const int multiplicity = start_of(contact_).multiplicity;
    Polynomial force;
    flow_->event_function(contact_, force);
    for (int i = 0; i <= force.degree; ++i) force.c[static_cast<std::size_t>(i)] *= -1.0;
    if (!flow_->is_expansion()) {
        project_end();
        force.c[2] += -value_at(projected_) - force(1.0);
    }
    if (multiplicity > 0) {
        force.c[0] = 0.0;
    } else if (!(force.c[0] > 0.0)) {
        return {FirstCrossing::Kind::root, 0.0};
    }
    return first_descent(force, multiplicity, flow_->remainder(contact_, force));
}

// Like locate_impact, for hddot = 0 along the constrained motion, or for a function of friction.
std::optional<StepResult::StepOutcome> EventStepper::locate_release(double theta) {
    const double longest = flow_->duration();  // limits Newton's method, which diverges if the force only touches zero
    double duration = theta * longest;
    for (int round = 0; round < 8; ++round) {
        forget_step();
        if (const auto failure = flow_->redo_step(duration); failure != StepFailure::none) return fail(failure);
        const bool projected = surfaces_->settle(flow_->edit_end(), request_->mode).has_value();
        if (!projected || flow_->duration() < duration * (1.0 - 1e-12)) return std::nullopt;
        const State& end = flow_->end();
        const double correction = -value_at(end) / rate_at(end);
        const bool close = std::abs(correction) < 1e-7;
        if (close) {
            forget_step();
            flow_->shift_end(correction);
            surfaces_->settle(flow_->edit_end(), request_->mode);
            break;
        }
        if (!std::isfinite(correction)) break;  // the force only touches zero; release() decides
        duration = std::clamp(duration + correction, 0.5 * duration, longest);
    }
    const std::size_t contact = contact_;
    double least = std::numeric_limits<double>::infinity();
    if (!is_further(contact) && !is_inactive(contact)) least = surfaces_->of(contact).at(flow_->end()).h;
    settle_gaps({}, least);
    contact_ = contact;
    end_step(least);
    return vanishing();
}

}  // namespace achilles
