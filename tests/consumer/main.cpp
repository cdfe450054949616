#include <cmath>
#include <cstdio>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

int main(int, char** argv) {
    const auto model = std::make_shared<const achilles::Model>(achilles::read_system(argv[1]));
    const achilles::Trajectory trajectory = achilles::simulate(model, model->default_run());
    for (const achilles::Event& event : trajectory.events) {
        if (event.kind != achilles::Event::Kind::zeno) continue;
        std::printf("Zeno point at t = %.6f\n", event.t);
        return std::abs(event.t - 2.725142) < 5e-6 ? 0 : 1;
    }
    return 1;
}
