// The steps of one run, each as long as its motion allows, or to the first event in it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contacts/contact_law.hpp"
#include "simulate/step.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

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
    // Of the forces of held contacts (contact.cpp).
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
