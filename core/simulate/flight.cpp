// The steps of a free motion: the next impact.
#include <algorithm>
#include <cmath>

#include "simulate/event_stepper.hpp"

namespace achilles {

// The gap along the last step, as a polynomial in theta. It is the integrated increment; evaluating h(q) instead would
// leave a root uncertain by err(h)/w, which is longer than the last flights. Where h(q) at the step's end is known
// better (the difference is above its rounding), the polynomial is made to end there.
Polynomial EventStepper::gap_along() {
    const int multiplicity = request_->start.multiplicity;
    Polynomial h = flow_->event_function(contact);
    for (int j = 0; j < multiplicity; ++j) h.c[static_cast<std::size_t>(j)] = 0.0;  // known roots stay roots
    if (flow_->is_expansion()) return h;
    const Contact end = kinematics_->at(flow_->end());
    const double value = end.h - h(1.0), slope = end.hdot * flow_->duration() - h.slope(1.0);
    if (!kinematics_->within_gap_error(value, 4.0, end, flow_->end())) {
        // theta^m (value - b + b theta), with this value and slope at 1, and nothing below theta^m
        const int m = std::max(2, multiplicity);
        const double b = slope - m * value;
        h.c[static_cast<std::size_t>(m)] += value - b;
        h.c[static_cast<std::size_t>(m + 1)] += b;
    }
    return h;
}

// What the flow's last step came to.
StepResult::End EventStepper::find_impact() {
    const int multiplicity = request_->start.multiplicity;
    const bool asked_before = request_->start.asked_again;
    Polynomial h = gap_along();
    Descent descent = first_descent(h, multiplicity, flow_->remainder(contact, h));
    if (descent.kind == Descent::Kind::rose && end_step_at(descent.theta)) {  // a short step knows its start better
        h = gap_along();
        descent = first_descent(h, multiplicity, flow_->remainder(contact, h));
    }
    bool asked_again = false;
    switch (descent.kind) {
        case Descent::Kind::none:
            break;
        case Descent::Kind::root:
            if (descent.theta == 0.0) return land_here();
            if (const auto end = locate_impact(descent.theta)) return *end;
            h = gap_along();  // no impact after all, or the step became shorter
            break;
        case Descent::Kind::rose:
            if (!knows_its_start() || asked_before) return doubt_gap(0.0);
            break;
        case Descent::Kind::open:
            // It is asked again from where the doubt begins: what holds the end of a step lies inside the next one.
            asked_again = !asked_before && end_step_at(descent.theta);
            if (asked_again) h = gap_along();
            if (!asked_again && !(knows_its_start() && is_last() && h(1.0) >= 0.0)) return doubt_gap(descent.theta);
            break;
        case Descent::Kind::undecided:
            return doubt_gap(descent.theta);
    }
    const Contact end = kinematics_->at(flow_->end());
    Gap gap{h(1.0), h.slope(1.0) / flow_->duration()};
    if (!kinematics_->within_gap_error(end.h - gap.h, 4.0, end, flow_->end())) {
        if (end.h < 0.0) return land_under();
        gap = {end.h, end.hdot};
    }
    flow_->add_error(contact, h, gap);
    flow_->move_gap(contact, gap);
    result_.start = {gap, 0, asked_again};
    end_step(end.h);
    return End::no_event;
}

// Whether the gap closes cannot be told from theta on: the step ends there.
StepResult::End EventStepper::doubt_gap(double theta) {
    result_.remainder = flow_->remainder(contact, flow_->event_function(contact));
    if (end_step_at(theta)) end_step(kinematics_->at(flow_->end()).h);
    return End::doubt;
}

// The gap came down to zero within the remainder of the step before: where that ended.
StepResult::End EventStepper::land_here() {
    landed_ = request_->state;
    result_.state = &landed_;
    const auto landed = kinematics_->project(landed_, true);
    if (!landed) return End::off_surface;
    if (!(landed->hdot < 0.0)) return doubt_gap(0.0);
    result_.contact = *landed;
    return End::impact;
}

// The step's end lies under the surface by h(q), though the series of the gap, exact to the tolerance, stays above. Finds
// by bisection where h(q) crosses zero, making the step again to each middle, and lands there.
StepResult::End EventStepper::land_under() {
    const double duration = flow_->duration();
    double above = 0.0, under = 1.0;
    while (under - above > 0x1p-50) {
        const double middle = 0.5 * (above + under);
        if (!end_step_after(middle * duration)) break;
        (kinematics_->at(flow_->end()).h > 0.0 ? above : under) = middle;
    }
    if (!end_step_after(under * duration)) return doubt_gap(0.0);  // nothing of the step is kept
    return end_flight();
}

// Integrates to the root and corrects it by Newton's method until the rest is a Taylor step. Nothing if there is no
// impact in the step after all (it was the dense output that dipped).
std::optional<StepResult::End> EventStepper::locate_impact(double theta) {
    double duration = theta * flow_->duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto failure = flow_->redo_step(duration); failure != StepFailure::none) return fail(failure);
        if (flow_->is_expansion()) break;
        const bool shortened = flow_->duration() < duration * (1.0 - 1e-12);
        const Polynomial h = gap_along();
        const double hdot = h.slope(1.0) / flow_->duration();
        if (shortened || !(hdot < 0.0)) return std::nullopt;
        const double correction = -h(1.0) / hdot;
        if (std::abs(correction) < 1e-7 && std::abs(correction) < 1e-3 * duration) {
            flow_->shift_end(correction);
            break;
        }
        duration = std::max(duration + correction, 0.5 * duration);
    }
    return end_flight();
}

// The flow's last step ends on the surface.
StepResult::End EventStepper::end_flight() {
    const auto landed = kinematics_->project(flow_->edit_end(), true);
    if (landed) result_.contact = *landed;
    end_step(landed ? landed->h : kinematics_->at(flow_->end()).h);
    return landed ? End::impact : End::off_surface;
}

}  // namespace achilles
