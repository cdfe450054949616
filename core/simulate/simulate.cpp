#include "simulate/simulate.hpp"

#include <algorithm>
#include <chrono>

#include "number/ground.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

// Defs. 4 and 5: a hybrid execution that converges to its Zeno point is followed by a constrained one, which a
// vanishing contact force releases into the next hybrid execution.
Trajectory execute(const std::shared_ptr<const Model>& model, const Run& run, Watch* watch, Keep keep) {
    Execution execution(model, run, watch, keep);
    execution.begin();
    while (execution.running()) {
        if (execution.completing()) {
            execution.wait_for_zeno_point();
        } else if (execution.constrained()) {
            execution.stay_until_release();
        } else {
            execution.fly_to_impact();
        }
    }
    return execution.finish();
}

}  // namespace

// What is undecided may be so since the state had become wrong before, by steps or by a cut: then the whole run is made
// once more, as exactly as double precision allows.
Trajectory simulate(std::shared_ptr<const Model> model, const Run& run, Watch* watch, Keep keep) {
    const Ground ground;
    model->check(run);
    const auto clock = std::chrono::steady_clock::now();
    Run used = run;
    raise_to_least(used.options);
    Trajectory trajectory = execute(model, used, watch, keep);
    if (trajectory.outcome.kind == Outcome::Kind::undecided && used.options.tolerance > Execution::least_tolerance) {
        Run exact = used;
        exact.options.tolerance = Execution::least_tolerance;
        for (double* eps : {&exact.options.truncation.eps_q, &exact.options.truncation.eps_v})
            *eps = std::min(*eps, 1e-12);
        trajectory = execute(model, exact, watch, keep);
        trajectory.run = used;
    }
    trajectory.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return trajectory;
}

}  // namespace achilles
