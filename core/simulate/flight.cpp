// The part of an execution in the air: free motion to the next impact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulate/execution.hpp"

namespace achilles {

void Execution::fly_to_impact() {
    if (!at_impact_) {
        const Beginning start = beginning();
        do {
            flow().fly(t_, state_, flight_start_.gap, first_step_);
            record_.stretch(state_);
            while (!outcome_ && !find_impact()) {
            }
        } while (doubt_ && try_exactly(start));
        settle();
    }
    at_impact_ = false;
    if (!outcome_) land();
}

// The gap along the last step, as a polynomial in theta. It is the integrated increment; evaluating h(q) instead would
// leave a root uncertain by err(h)/w, which is longer than the last flights. Where h(q) at the step's end is known
// better (the difference is above its rounding), the polynomial is made to end there.
Polynomial Execution::gap_along() {
    Polynomial h = flow().event_function();
    for (int j = 0; j < flight_start_.multiplicity; ++j)
        h.c[static_cast<std::size_t>(j)] = 0.0;  // known roots stay roots
    if (flow().is_expansion()) return h;
    const Contact contact = kinematics_.at(flow().end());
    const double value = contact.h - h(1.0), slope = contact.hdot * flow().duration() - h.slope(1.0);
    if (!kinematics_.within_gap_error(value, 4.0, contact, flow().end())) {
        // theta^m (value - b + b theta), with this value and slope at 1, and nothing below theta^m
        const int m = std::max(2, flight_start_.multiplicity);
        const double b = slope - m * value;
        h.c[static_cast<std::size_t>(m)] += value - b;
        h.c[static_cast<std::size_t>(m + 1)] += b;
    }
    return h;
}

// One step. True if the flight is over, by an impact, an outcome or a doubt.
bool Execution::find_impact() {
    if (!advance(run_.options.end_time)) return true;
    Polynomial h = gap_along();
    Descent descent = first_descent(h, flight_start_.multiplicity, flow().remainder(h));
    if (descent.kind == Descent::Kind::rose && end_step_at(descent.theta)) {  // a short step knows its start better
        h = gap_along();
        descent = first_descent(h, flight_start_.multiplicity, flow().remainder(h));
    }
    bool asked_again = false;
    switch (descent.kind) {
        case Descent::Kind::none:
            break;
        case Descent::Kind::root:
            if (descent.theta == 0.0) return land_here();
            if (locate_impact(descent.theta)) return true;
            h = gap_along();  // no impact after all, or the step became shorter
            break;
        case Descent::Kind::rose:
            if (!knows_its_start() || flight_start_.asked_again) return doubt_gap(0.0);
            break;
        case Descent::Kind::open:
            // It is asked again from where the doubt begins: what holds the end of a step lies inside the next one.
            asked_again = !flight_start_.asked_again && end_step_at(descent.theta);
            if (asked_again) h = gap_along();
            if (!asked_again && !(knows_its_start() && flow().end_time() >= run_.options.end_time && h(1.0) >= 0.0))
                return doubt_gap(descent.theta);
            break;
        case Descent::Kind::undecided:
            return doubt_gap(descent.theta);
    }
    const Contact contact = kinematics_.at(flow().end());
    Gap gap{h(1.0), h.slope(1.0) / flow().duration()};
    if (!kinematics_.within_gap_error(contact.h - gap.h, 4.0, contact, flow().end())) {
        if (contact.h < 0.0) return land_under();
        gap = {contact.h, contact.hdot};
    }
    flow().add_error(h, gap);
    flow().move_gap(gap);
    flight_start_ = {gap, 0, asked_again};
    accept_step(contact);
    return false;
}

// Makes the last step end at a part of its length, if that is a step.
bool Execution::end_step_at(double theta) {
    return theta > 0.0 && theta < 1.0 && end_step_after(theta * flow().duration());
}

bool Execution::end_step_after(double duration) { return flow().redo_step(duration) == StepFailure::none; }

// Whether the gap closes cannot be told from theta on: the motion goes there, and ends in doubt. Always true.
bool Execution::doubt_gap(double theta) {
    const double remainder = flow().remainder(flow().event_function());
    if (end_step_at(theta)) accept_step(kinematics_.at(flow().end()));
    doubt_ = fmt::format(
        "the gap comes closer to zero than the integration knows it (to {:.1g}): an impact or none cannot be told just "
        "after {}",
        remainder, where(t_, state_));
    return true;
}

// The gap came down to zero within the remainder of the last step: where that ended. Always true.
bool Execution::land_here() {
    const auto landed = kinematics_.project(state_, true);
    if (!landed) {
        fail_projection(t_, state_);
    } else if (!(landed->hdot < 0.0)) {
        return doubt_gap(0.0);
    } else {
        contact_ = *landed;
    }
    return true;
}

// h(q) came down where the series of the gap, as good as the tolerance, did not: where it did, by bisection of the
// step. True but where a step is too short.
bool Execution::land_under() {
    const double duration = flow().duration();
    double above = 0.0, under = 1.0;
    while (under - above > 0x1p-50) {
        const double middle = 0.5 * (above + under);
        if (!end_step_after(middle * duration)) break;
        (kinematics_.at(flow().end()).h > 0.0 ? above : under) = middle;
    }
    if (!end_step_after(under * duration)) return doubt_gap(0.0);
    return end_flight();
}

// Integrates to the root and corrects it by Newton's method until the rest is a Taylor step. False if there is no
// impact in the step after all (it was the dense output that dipped).
bool Execution::locate_impact(double theta) {
    double duration = theta * flow().duration();
    for (int round = 0; round < 8; ++round) {
        if (const auto failure = flow().redo_step(duration); failure != StepFailure::none) {
            stop_at(failure);
            return true;
        }
        if (flow().is_expansion()) break;
        const bool shortened = flow().duration() < duration * (1.0 - 1e-12);
        const Polynomial h = gap_along();
        const double hdot = h.slope(1.0) / flow().duration();
        if (shortened || !(hdot < 0.0)) return false;
        const double correction = -h(1.0) / hdot;
        if (std::abs(correction) < 1e-7 && std::abs(correction) < 1e-3 * duration) {
            flow().shift_end(correction);
            break;
        }
        duration = std::max(duration + correction, 0.5 * duration);
    }
    return end_flight();
}

// The last step ends on the surface. Always true.
bool Execution::end_flight() {
    const auto landed = kinematics_.project(flow().edit_end(), true);
    accept_step(landed ? *landed : kinematics_.at(flow().end()));
    if (!landed) fail_projection(t_, state_);
    return true;
}

}  // namespace achilles
