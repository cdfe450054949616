#include "simulate/event_stepper.hpp"

namespace achilles {

EventStepper::EventStepper(const Model& model, const Run& run, ContactKinematics& kinematics)
    : model_(&model), run_(run), kinematics_(&kinematics), usual_(model, run) {}

const StepResult& EventStepper::step(const StepRequest& request) {
    request_ = &request;
    if (request.exactly && !exact_) {
        Run exact = run_;
        exact.options.tolerance = exact_tolerance;
        exact_ = std::make_unique<Flow>(*model_, exact);
    }
    flow_ = request.exactly ? exact_.get() : &usual_;
    const bool flying = request.held.empty();
    if (request.begins) flow_->start(request.held, request.state, std::span(&request.start.gap, 1), request.first_step);
    result_.flow = flow_;
    result_.steps = 0;
    result_.state = &request.state;
    const StepFailure failure = flow_->step(request.until);
    result_.end = failure != StepFailure::none ? fail(failure) : flying ? find_impact() : find_release();
    const long evaluations = usual_.evaluations() + (exact_ ? exact_->evaluations() : 0);
    result_.evaluations = evaluations - evaluations_;
    evaluations_ = evaluations;
    return result_;
}

// All that led there was as exact as can be.
bool EventStepper::knows_its_start() const { return run_.options.tolerance <= exact_tolerance; }

// Whether the step comes to where the motion ends at the latest.
bool EventStepper::is_last() const { return flow_->end_time() >= request_->until; }

// Makes the flow's last step end at a part of its length, if that is a step.
bool EventStepper::end_step_at(double theta) {
    return theta > 0.0 && theta < 1.0 && end_step_after(theta * flow_->duration());
}

bool EventStepper::end_step_after(double duration) { return flow_->redo_step(duration) == StepFailure::none; }

// The flow's last step, as it stands, is what came.
void EventStepper::end_step(double gap) {
    result_.steps = 1;
    result_.duration = flow_->duration();
    result_.state = &flow_->end();
    result_.gap = gap;
}

StepResult::End EventStepper::fail(StepFailure failure) {
    result_.failure = failure;
    return End::no_step;
}

}  // namespace achilles
