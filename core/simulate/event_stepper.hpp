// The steps of one run, each as long as its motion allows, or to the first event in it.
#pragma once

#include <memory>
#include <optional>

#include "simulate/step.hpp"

namespace achilles {

class EventStepper {
 public:
    // `kinematics` is of the same model and run; both outlive this. It serves every run of these parameters, this
    // tolerance and this method, one after the other.
    EventStepper(const Model& model, const Run& run, ContactKinematics& kinematics);

    // One step, by the method of the run, with any end that StepResult knows, and with `flow`; it stands until the next
    // step. A request that begins nothing goes on from the step before, which must have ended without event; after any
    // other end the next request begins a stretch.
    const StepResult& step(const StepRequest& request);

 private:
    using End = StepResult::End;
    static constexpr std::size_t contact = 0;  // that is watched: the only one

    // In flight (flight.cpp).
    End find_impact();
    Polynomial gap_along();
    End doubt_gap(double theta);
    End land_here();
    End land_under();
    std::optional<End> locate_impact(double theta);
    End end_flight();
    // In contact (contact.cpp).
    End find_release();
    Descent force_descent();
    End doubt_force(double theta);
    std::optional<End> locate_release(double theta);
    bool end_on_surface();
    // In both.
    bool end_step_at(double theta);
    bool end_step_after(double duration);
    void end_step(double gap);
    End fail(StepFailure failure);
    bool knows_its_start() const;
    bool is_last() const;

    const Model* model_;
    Run run_;
    ContactKinematics* kinematics_;
    Flow usual_;                   // at the run's tolerance
    std::unique_ptr<Flow> exact_;  // made where it is first asked for
    // Of the last step.
    const StepRequest* request_ = nullptr;
    Flow* flow_ = nullptr;  // what makes it
    StepResult result_;
    State landed_;          // an impact without a step
    long evaluations_ = 0;  // told so far
};

}  // namespace achilles
