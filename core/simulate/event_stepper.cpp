#include "simulate/event_stepper.hpp"

#include <limits>

namespace achilles {

EventStepper::EventStepper(const Model& model, const Run& run, ContactCache& surfaces)
    : model_(&model),
      surfaces_(&surfaces),
      usual_(model, run, surfaces),
      gaps_(surfaces.count()),
      along_(surfaces.count()),
      at_end_(surfaces.count()) {
    result_.starts.resize(surfaces.count());
}

namespace {

constexpr std::uint64_t bit(std::size_t event) { return std::uint64_t{1} << event; }

}  // namespace

const StepResult& EventStepper::step(const StepRequest& request) {
    request_ = &request;
    if (request.exactly && !exact_) {
        Run exact = surfaces_->run();
        exact.options.tolerance = exact_tolerance;
        exact_ = std::make_unique<Flow>(*model_, exact, *surfaces_);
    }
    flow_ = request.exactly ? exact_.get() : &usual_;
    if (request.begins) {
        gaps_.resize(events());
        result_.starts.resize(events());
        for (std::size_t i = 0; i < gaps_.size(); ++i) gaps_[i] = request.starts[i].gap;
        flow_->start(request.mode, request.state, gaps_, request.first_step);
    }
    result_.flow = flow_;
    result_.steps = 0;
    result_.state = &request.state;
    shortened_ = 0;
    forget_step();
    const StepFailure failure = flow_->step(request.until);
    // The end of a step is evaluated at first use, because a flight mostly ends earlier, with an impact.
    if (failure == StepFailure::none && !surfaces_->varying().empty() && !is_friction_allowed(flow_->end()))
        end_where_friction_is_not_allowed();
    result_.end = failure != StepFailure::none ? fail(failure) : find_event();
    result_.which = contact_;
    const long evaluations = usual_.evaluations() + (exact_ ? exact_->evaluations() : 0);
    result_.evaluations = evaluations - evaluations_;
    evaluations_ = evaluations;
    return result_;
}

// Finds the first event in the last step. A candidate that proves to be no event may have shortened the step, which is
// then checked again for the other contacts.
StepResult::StepOutcome EventStepper::find_event() {
    std::uint64_t met = 0;
    while (const auto incident = first_incident(met)) {
        if (const auto end = meet(*incident)) return *end;
        met |= bit(incident->contact);
    }
    return end_without_event();
}

// Whether the coefficients of friction that act are in the domain of their law.
bool EventStepper::is_friction_allowed(const State& state) {
    for (const std::size_t i : surfaces_->varying().within(held().with(request_->mode.joints())))
        if (!surfaces_->friction_levels(i, state).are_allowed()) return false;
    return true;
}

// Shortens the last step, whose end is not allowed, to end just after the motion leaves the domain.
void EventStepper::end_where_friction_is_not_allowed() {
    std::vector<double> coefficients;
    const DenseSegment piece = flow_->piece(coefficients);
    double inside = 0.0, outside = 1.0;
    for (double middle = 0.5; middle > inside && middle < outside; middle = 0.5 * (inside + outside)) {
        const double t = piece.start + middle * (piece.end - piece.start);
        (is_friction_allowed(state_in(piece, coefficients, model_->dof(), t)) ? inside : outside) = middle;
    }
    end_step_at(outside);
}

bool EventStepper::is_slip_of_frictionless(std::size_t event) {
    if (surfaces_->frictionless().empty()) return false;
    const FrictionEvent& friction = surfaces_->motion(request_->mode).friction()[event - surfaces_->count()];
    return friction.watched == FrictionFunction::slip && surfaces_->frictionless().contains(friction.contact);
}

std::optional<EventStepper::EventCandidate> EventStepper::first_incident(std::uint64_t but) {
    std::optional<EventCandidate> first;
    for (std::size_t i = 0; i < events(); ++i) {
        if ((but & bit(i)) != 0) continue;
        const bool is_friction = is_further(i) && !is_guard(i);
        if (is_friction ? is_slip_of_frictionless(i) || is_kept(i) : !is_further(i) && !is_watched(i)) continue;
        contact_ = i;
        const FirstCrossing descent = this->descent();
        if (descent.kind == FirstCrossing::Kind::none) continue;
        if (!first || descent.theta < first->descent.theta) first = EventCandidate{i, descent};
    }
    return first;
}

// Whether this is the limit of a contact that is kept sticking.
bool EventStepper::is_kept(std::size_t event) const {
    if (!request_->keeps_stick) return false;
    const FrictionEvent& limit = model_->motion(request_->mode).friction[event - surfaces_->count()];
    return !is_joint(limit.contact) &&
           (limit.watched == FrictionFunction::upper_limit || limit.watched == FrictionFunction::lower_limit);
}

// First zero crossing of the contact's event function in the last step.
FirstCrossing EventStepper::descent() {
    if (is_further(contact_) || is_inactive(contact_)) return further_descent();
    switch (watched_of(contact_)) {
        case WatchedFunction::gap:
            return gap_descent();
        case WatchedFunction::normal_force:
            return force_descent();
    }
    return {};
}

std::optional<StepResult::StepOutcome> EventStepper::meet(const EventCandidate& incident) {
    contact_ = incident.contact;
    if (is_further(contact_) || is_inactive(contact_)) return meet_force(incident.descent);
    switch (watched_of(contact_)) {
        case WatchedFunction::gap:
            return meet_gap(incident.descent);
        case WatchedFunction::normal_force:
            return meet_force(incident.descent);
    }
    return std::nullopt;
}

StepResult::StepOutcome EventStepper::end_without_event() {
    double least = std::numeric_limits<double>::infinity();
    if (!(request_->mode == Mode())) {
        if (!end_on_surface()) return StepOutcome::off_surface;
        least = result_.gap;
    }
    if (!settle_gaps({}, least)) return land_under();
    end_step(least);
    return StepOutcome::no_event;
}

// Whether the segment's start is as accurate as possible, because the run uses exact_tolerance or less.
bool EventStepper::has_exact_start() const { return surfaces_->run().options.tolerance <= exact_tolerance; }

// Whether the step reaches the time `until`.
bool EventStepper::is_last() const { return flow_->end_time() >= request_->until; }

// Forgets what was computed for the last step, which is replaced.
void EventStepper::forget_step() {
    known_ = known_at_end_ = clear_ = {};
    is_projected_ = false;
}

// A contact at the end of the last step, evaluated once.
const Contact& EventStepper::contact_at_end(std::size_t contact) {
    if (!known_at_end_.contains(contact)) surfaces_->of(contact).evaluate(flow_->end(), at_end_[contact]);
    known_at_end_ = known_at_end_.with(contact);
    return at_end_[contact];
}

// Shortens the last step to a fraction of its length. Returns false if the result would not be a step.
bool EventStepper::end_step_at(double theta) {
    return theta > 0.0 && theta < 1.0 && end_step_after(theta * flow_->duration());
}

bool EventStepper::end_step_after(double duration) {
    forget_step();
    return flow_->redo_step(duration) == StepFailure::none;
}

// Reports the last step as the result.
void EventStepper::end_step(double gap) {
    result_.steps = 1;
    result_.duration = flow_->duration();
    result_.state = &flow_->end();
    result_.gap = gap;
}

StepResult::StepOutcome EventStepper::fail(StepFailure failure) {
    result_.failure = failure;
    return StepOutcome::step_failed;
}

}  // namespace achilles
