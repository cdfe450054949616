// The steps of one run, each as long as its motion allows, or to the first event in it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contacts/contact_law.hpp"
#include "simulate/flow.hpp"
#include "simulate/impact.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

// What an execution asks of whoever makes its steps, and what it is told: all that passes between the two.

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

class EventStepper {
 public:
    // `surfaces` are of the same model and run; both outlive this. It serves every run of these parameters, this
    // tolerance and this method, one after the other.
    EventStepper(const Model& model, const Run& run, Surfaces& surfaces);

    // One step, by the method of the run, with any end that StepResult knows, and with `flow`; it stands until the next
    // step. A request that begins nothing goes on from the step before, which must have ended without event; after any
    // other end the next request begins a stretch.
    const StepResult& step(const StepRequest& request);

 private:
    using End = StepResult::End;
    // What may be an event of a contact along the flow's last step.
    struct Incident {
        std::size_t contact = 0;
        Descent descent;
    };
    End find_event();
    std::optional<Incident> first_incident(ContactSet but);
    Descent descent();
    std::optional<End> meet(const Incident& incident);
    End end_without_event();

    // Of open gaps (flight.cpp).
    Descent gap_descent();
    std::optional<End> meet_gap(Descent descent);
    const Polynomial& gap_along(std::size_t contact);
    void make_gap(std::size_t contact, Polynomial& h);
    End doubt_gap(double theta);
    bool surely_closes_at_start();
    End land_here();
    End land_under();
    std::optional<End> locate_impact(double theta);
    End end_flight();
    bool settle_gaps(ContactSet but, double& least);
    // Of the forces of held contacts (flight.cpp).
    Descent force_descent();
    std::optional<End> meet_force(Descent descent);
    End doubt_force(double theta);
    std::optional<End> locate_release(double theta);
    bool end_on_surface();
    // Of both.
    bool end_step_at(double theta);
    bool end_step_after(double duration);
    void end_step(double gap);
    End fail(StepFailure failure);
    bool knows_its_start() const;
    bool is_last() const;
    ContactSet held() const { return request_->held(); }
    WatchedFunction watched_of(std::size_t contact) const { return law_of(request_->mode.state(contact)).watched; }
    bool is_watched(std::size_t contact) const {
        return !request_->touching.with(request_->unwatched).with(request_->unpressed).contains(contact);
    }
    const EventStart& start_of(std::size_t contact) const { return request_->starts[contact]; }

    const Model* model_;
    Run run_;
    Surfaces* surfaces_;
    Flow usual_;                   // at the run's tolerance
    std::unique_ptr<Flow> exact_;  // made where it is first asked for
    // Of the last step.
    const StepRequest* request_ = nullptr;
    Flow* flow_ = nullptr;     // what makes it
    std::size_t contact_ = 0;  // whose event is looked at
    ContactSet asked_again_;   // the step was ended where these entered their remainder
    StepResult result_;
    State landed_;                   // an impact without a step
    std::vector<Gap> gaps_;          // where a stretch starts
    std::vector<Polynomial> along_;  // gap_along() of those that are known of the step as it now is
    ContactSet known_;
    long evaluations_ = 0;  // told so far
};

}  // namespace achilles
