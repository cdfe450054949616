#include "simulate/simulate.hpp"

#include <chrono>

#include "number/ground.hpp"
#include "simulate/execution.hpp"

namespace achilles {

// Defs. 4 and 5: a hybrid execution that converges to its Zeno point is followed by a constrained one, which a
// vanishing contact force releases into the next hybrid execution.
Trajectory simulate(std::shared_ptr<const Model> model, const Run& run, Watch* watch, Keep keep) {
    const Ground ground;
    model->check(run);
    const auto clock = std::chrono::steady_clock::now();
    Run used = run;
    raise_to_least(used.options);
    Execution execution(std::move(model), used, watch, keep);
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
    Trajectory trajectory = execution.finish();
    trajectory.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return trajectory;
}

}  // namespace achilles
