#include "simulate/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <string>
#include <utility>

#include "number/ground.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

Trajectory execute(const std::shared_ptr<const Model>& model, const Run& run, Watch* watch, Keep keep) {
    Surfaces surfaces(*model, run);
    Execution execution(model, run, surfaces, watch, keep, Execution::InDoubt::ask_exactly);
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
Trajectory simulate(const std::shared_ptr<const Model>& model, const Run& run, Watch* watch, Keep keep) {
    const Ground ground;
    model->check(run);
    const auto clock = std::chrono::steady_clock::now();
    Run used = run;
    raise_to_least(used.options);
    Trajectory trajectory = execute(model, used, watch, keep);
    if (trajectory.outcome.kind == Outcome::Kind::undecided && used.options.tolerance > exact_tolerance) {
        Run exact = used;
        exact.options.tolerance = exact_tolerance;
        for (double* eps : {&exact.options.truncation.eps_q, &exact.options.truncation.eps_v})
            *eps = std::min(*eps, 1e-12);
        std::string undecided = std::move(trajectory.outcome.message);
        trajectory = execute(model, exact, watch, keep);
        trajectory.run = used;
        trajectory.undecided = std::move(undecided);
        trajectory.made_again_by = exact.options;
    }
    trajectory.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return trajectory;
}

}  // namespace achilles
