// The integration steps of one run, each ending at the first event or where the method's accuracy ends.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contacts/contact_law.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/flow.hpp"
#include "simulate/impact.hpp"

namespace achilles {

// ---- interface between Execution and the steppers ----

// The smallest tolerance that a step can meet; below it, rounding dominates.
inline constexpr double exact_tolerance = 1e-14;

// Initial data of an event function in a step: of a contact's gap if it is open, of its force if it is held; of
// friction.
struct EventStart {
    Gap gap;                    // for all but open contacts, only state_error is used
    int multiplicity = 0;       // order of its zero at the start: of h if open; 1 for a force that starts at 0
    bool is_shortened = false;  // the last step was shortened to its remainder (theory-truncation.md 6)
    bool is_below = false;      // of a watched guard: the function is negative, and its rise is the next event
};

// Request for a smooth step from state.t to `until` at the latest, or to the first event in (t, until]. Events are the
// closing of an open gap, a zero of the force of a held contact, the rise of the gap of an inactive contact, and those of
// friction and of watched guards. A zero at t itself, of the order given by `multiplicity`, is not an event.
struct StepRequest {
    Mode mode;            // its held contacts have independent gradients
    ContactSet touching;  // open in `mode`, but their gap stays 0: not checked for events
    // Touching contacts that stay closed because their gradients depend on those of the held ones: they may share the
    // load (theory-gaps.md 2.5). The other touching contacts carry no load.
    ContactSet load_sharing_candidates;
    ContactSet unwatched;  // held contacts not checked for events: the load may be shared otherwise
    ContactSet unpressed;  // held, not checked for events: nothing presses them (theory-gaps.md 2.7)
    ContactSet latched;    // held, not checked for events: they are held against any force (theory-modes.md 4)
    ContactSet inactive;   // open with a gap of at most 0: their rise is an event (theory-modes.md 1)
    State state;
    std::vector<EventStart> starts;  // at that state, for each event function (ModeDynamics)
    double until = 0.0;              // s, > state.t
    double first_step = 0.0;         // s; a known reasonable length for the first step of a flight; 0: none
    long most = 1;                   // largest number of steps to take at once if none has an event
    bool begins = true;              // starts a new segment; otherwise continues from the end of the last step
    bool exactly = false;            // use exact_tolerance instead of the tolerance of the run
    bool plain = false;              // may be answered by fast steps that detect only "no event" and plain impacts
    bool keeps_stick = false;        // what sticks goes on sticking, whatever force that needs: before a Zeno point

    ContactSet held() const { return mode.held(); }
    Mode resting() const { return mode.with(load_sharing_candidates, ContactState::held); }
};

// Result of a request: the state reached, with no event before it, and how the step ended there.
struct StepResult {
    enum class StepOutcome : char {
        no_event,        // continue from `state` with `starts`
        impact,          // the gap of `which` closes; `state` is on the contact surface, before the impact
        force_vanishes,  // of the held contact `which`
        friction_event,  // of the event function `which`
        gap_rises,       // of the inactive contact `which`
        guard_event,     // a zero of the event function `which` of a watched guard
        ambiguous,       // no event so far, but cannot decide whether one follows just after
        off_surface,     // `state` cannot be projected onto the contact surfaces where it belongs
        step_failed      // no step was possible, see `failure`; `state` is that of the request
    };
    StepOutcome end = StepOutcome::no_event;
    // Number of steps made. If 0, the time is that of the request: its event lies where the step before ended, within
    // the remainder of that step. `state` may still be moved onto the contact surface.
    long steps = 0;
    double duration = 0.0;           // s, of the last step
    const State* state = nullptr;    // valid until the next step
    double gap = 0.0;                // smallest gap at the end of the step, or at the ends of several steps
    std::vector<EventStart> starts;  // for each event function; meaningless for `which` at an event
    std::size_t which = 0;           // the contact of the event, or the further event function
    Contact contact;                 // at an impact: its contact quantities, in the mode of the request
    double remainder = 0.0;          // ambiguous gap: the bound on its error
    StepFailure failure = StepFailure::none;
    const Flow* flow = nullptr;  // the integrator with the whole last step; null if only the end is known
    long evaluations = 0;        // of the right-hand side, including those of failed steps
};

class EventStepper {
 public:
    // `surfaces` must belong to the same model and run; both must outlive this object. One object can serve consecutive
    // runs with the same parameters, tolerance and method.
    EventStepper(const Model& model, const Run& run, ContactCache& surfaces);

    // Makes one step by the method of the run. Sets `flow`; the result is valid until the next step. A request with
    // begins = false continues the last step, which must have ended without an event; after any other end, the next
    // request must begin a segment.
    const StepResult& step(const StepRequest& request);

 private:
    using StepOutcome = StepResult::StepOutcome;
    // A possible event of a contact in the last step.
    struct EventCandidate {
        std::size_t contact = 0;
        FirstCrossing descent;
    };
    StepOutcome find_event();
    std::optional<EventCandidate> first_incident(std::uint64_t but);
    FirstCrossing descent();
    std::optional<StepOutcome> meet(const EventCandidate& incident);
    StepOutcome end_without_event();

    // Gaps of open contacts (flight.cpp).
    FirstCrossing gap_descent();
    std::optional<StepOutcome> meet_gap(FirstCrossing descent);
    const Polynomial& gap_along(std::size_t contact);
    void make_gap(std::size_t contact, Polynomial& h);
    StepOutcome doubt_gap(double theta);
    bool surely_closes_at_start();
    bool surely_falls(const Polynomial& h, double remainder, double rate_error) const;
    StepOutcome land_here();
    StepOutcome land_under();
    std::optional<StepOutcome> locate_impact(double theta);
    StepOutcome end_flight();
    bool settle_gaps(ContactSet but, double& least);
    // Forces of held contacts (flight.cpp).
    FirstCrossing force_descent();
    std::optional<StepOutcome> meet_force(FirstCrossing descent);
    StepOutcome doubt_force(double theta);
    std::optional<StepOutcome> locate_release(double theta);
    // The function that vanishes at the event, up to its sign, and its rate.
    double value_at(const State& state);
    double rate_at(const State& state);
    // Functions of friction, watched guards, and gaps of inactive contacts (flight.cpp).
    Polynomial further_function();
    bool surely_passes_at_start();
    FirstCrossing further_descent();
    StepOutcome vanishing() const;
    bool end_on_surface();
    // Events of either kind.
    const Contact& contact_at_end(std::size_t contact);
    void project_end();
    void forget_step();
    bool end_step_at(double theta);
    bool end_step_after(double duration);
    void end_step(double gap);
    StepOutcome fail(StepFailure failure);
    bool has_exact_start() const;
    bool is_last() const;
    ContactSet held() const { return request_->held(); }
    WatchedFunction watched_of(std::size_t contact) const { return law_of(request_->mode.state(contact)).watched; }
    bool is_further(std::size_t event) const { return event >= surfaces_->count(); }
    bool is_guard(std::size_t event) const { return event >= events() - model_->watched_guards().size(); }
    bool is_inactive(std::size_t event) const { return !is_further(event) && request_->inactive.contains(event); }
    bool is_slip_of_frictionless(std::size_t event);
    bool is_friction_allowed(const State& state);
    void end_where_friction_is_not_allowed();
    std::size_t events() const { return request_->starts.size(); }
    bool is_kept(std::size_t event) const;
    bool is_watched(std::size_t contact) const {
        return !request_->touching.with(request_->unwatched)
                    .with(request_->unpressed)
                    .with(request_->latched)
                    .contains(contact);
    }
    const EventStart& start_of(std::size_t contact) const { return request_->starts[contact]; }

    const Model* model_;
    ContactCache* surfaces_;
    Flow usual_;                   // at the tolerance of the run
    std::unique_ptr<Flow> exact_;  // at exact_tolerance; created at first use
    // The last step.
    const StepRequest* request_ = nullptr;
    Flow* flow_ = nullptr;         // the integrator in use
    std::size_t contact_ = 0;      // whose event function is examined, or the number of a function of friction
    std::uint64_t shortened_ = 0;  // event functions at whose remainder the step was shortened, by bits
    StepResult result_;
    State landed_;                   // state of an impact without a step
    std::vector<Gap> gaps_;          // at the start of a segment
    std::vector<Polynomial> along_;  // gap polynomials of the contacts in known_, for the current step
    ContactSet known_;
    ContactSet clear_;             // contacts whose gap is known to stay positive along the current step
    std::vector<Contact> at_end_;  // contacts at the end of the step, of those in known_at_end_
    ContactSet known_at_end_;
    // The end of the step, projected onto the surfaces of the held contacts, and their smallest gap; nullopt if that
    // fails. Kept while is_projected_.
    State projected_;
    std::optional<double> projected_gap_;
    bool is_projected_ = false;
    long evaluations_ = 0;  // reported so far
};

}  // namespace achilles
