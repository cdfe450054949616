#include "simulate/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <string>
#include <utility>

#include "number/float_environment.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

Trajectory execute(const std::shared_ptr<const Model>& model, const Run& run, RunMonitor* watch, Recording keep) {
    ContactCache surfaces(*model, run);
    ExecutionAutomaton execution(model, run, surfaces, watch, keep, ExecutionAutomaton::AmbiguityPolicy::retry_tight);
    EventStepper stepper(*model, run, surfaces);
    try {
        while (const StepRequest* request = execution.next()) execution.accept(stepper.step(*request));
    } catch (const std::bad_alloc&) {
        execution.run_out_of_memory();
    }
    return execution.finish();
}

}  // namespace

// A run may be undecided because the state has become inaccurate before, by steps or by truncations. Such a run is
// repeated once from its start at exact_tolerance.
Trajectory simulate(const std::shared_ptr<const Model>& model, const Run& run, RunMonitor* watch, Recording keep) {
    const FloatEnvironmentGuard ground;
    model->check(run);
    const auto clock = std::chrono::steady_clock::now();
    Run used = run;
    clamp_tolerances(used.options);
    Trajectory trajectory = execute(model, used, watch, keep);
    if (trajectory.outcome.kind == Outcome::Kind::undecided && used.options.tolerance > exact_tolerance) {
        Run exact = used;
        exact.options.tolerance = exact_tolerance;
        for (double* eps : {&exact.options.truncation.eps_q, &exact.options.truncation.eps_v})
            *eps = std::min(*eps, 1e-12);
        std::string rerun_reason = std::move(trajectory.outcome.message);
        trajectory = execute(model, exact, watch, keep);
        trajectory.run = used;
        trajectory.rerun_reason = std::move(rerun_reason);
        trajectory.rerun_options = exact.options;
    }
    trajectory.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return trajectory;
}

}  // namespace achilles
