// What an execution asks of whoever makes its steps, and what it is told: all that passes between the two.
#pragma once

#include <vector>

#include "simulate/flow.hpp"
#include "simulate/impact.hpp"

namespace achilles {

// The least tolerance that steps can serve: below it they are rounding.
inline constexpr double exact_tolerance = 1e-14;

// How what the law of a contact watches along a step leaves the step's start: its gap, or its force.
struct EventStart {
    Gap gap;                   // in contact its state_error alone has a meaning
    int multiplicity = 0;      // of the zero there: of h in flight; of the force 1 where it starts from zero
    bool asked_again = false;  // the step before was ended where it entered its remainder (theory-truncation.md 6)
};

// A step of smooth motion, from the state's t to `until` at the latest, or to the first event in (t, until]: an open gap
// closes, the force of a held contact vanishes. A zero at t itself is none, as often as multiplicity says.
struct StepRequest {
    Mode mode;            // what it holds has independent gradients
    ContactSet touching;  // open as far as the motion goes, but their gap stays 0: no event of theirs is looked for
    // Of those touching, what rests with the held ones since its gradient depends on theirs: it may bear a part of the
    // forces that the held ones are reckoned to bear (theory-gaps.md 2.5). The others that touch bear none.
    ContactSet carried;
    ContactSet unwatched;  // of the held ones: no event of theirs is looked for, since others share what they bear
    ContactSet
        unpressed;  // of the held ones: no event of theirs is looked for, since nothing presses them (theory-gaps.md 2.7)
    State state;
    std::vector<EventStart> starts;  // at that state, of each contact
    double until = 0.0;              // s, > state.t
    double first_step = 0.0;         // s, where a flight begins: a length that is known to be sensible; 0: none is
    long most = 1;                   // as many steps may be made at once where none has an event
    bool begins = true;    // a stretch of motion begins here; else the step goes on from where the last one ended
    bool exactly = false;  // at exact_tolerance instead of the run's
    bool plain = false;    // steps that show at once that they have no event, or just an impact, may answer it

    ContactSet held() const { return mode.held(); }
    Mode resting() const { return mode.with(carried, ContactState::held); }
};

// What came of a request: from its state to that of the result there is no event, and there what `end` says.
struct StepResult {
    enum class End : char {
        no_event,        // none: the next step starts there, as `starts` says
        impact,          // a gap closes, as `contact` says; `state` is on the surface, before the impact
        force_vanishes,  // of a held contact
        doubt,           // none, but whether one follows just after cannot be told
        off_surface,     // `state` cannot be moved onto the surfaces on which it belongs
        no_step          // no step could be made, for the reason of `failure`: `state` is that of the request
    };
    End end = End::no_event;
    // Steps that were made. Where there is none, its t is that of the request: an event there is one that the end of the
    // step before had come to, within its remainder. Then `state` may still be moved onto the surface.
    long steps = 0;
    double duration = 0.0;           // s; of the last step
    const State* state = nullptr;    // it stands until the next step
    double gap = 0.0;                // the least there; the least of several steps' ends
    std::vector<EventStart> starts;  // of each contact; without a meaning for the one that the event is of
    std::size_t which = 0;           // the contact that the event is of
    Contact contact;                 // it, as the motion sees it that holds those of the request
    double remainder = 0.0;          // doubt of a gap: what it is known to
    StepFailure failure = StepFailure::none;
    const Flow* flow = nullptr;  // that made the step, with all of it; null where the end alone is known
    long evaluations = 0;        // of the motion, also for what led to no step
};

}  // namespace achilles
