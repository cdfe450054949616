// The cost of the derivatives of the paper's two runs, by eight directions and by all. Medians in microseconds.
#include <fmt/format.h>

#include "bench/measure.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "sensitivity/derivatives.hpp"
#include "simulate/simulate.hpp"

using namespace achilles;

int main() {
    fmt::print("{:<20}{:>8}{:>10}{:>8}{:>10}{:>8}\n", "", "run", "K = 8", "ratio", "all", "ratio");
    for (const char* name : {"ball_on_sine", "double_pendulum"}) {
        const auto model = std::make_shared<const Model>(
            read_system(fmt::format("{}/assets/systems/{}.toml", ACHILLES_SOURCE_DIR, name)));
        const Run run = model->default_run();
        const Trajectory trajectory = simulate(model, run);
        const Eigen::Index n = model->dof(), P = static_cast<Eigen::Index>(run.parameters.size());
        const Eigen::Index all = 2 * n + P, K = std::min<Eigen::Index>(8, all);
        const Eigen::MatrixXd eight = Eigen::MatrixXd::Identity(all + 1, K);
        std::vector<double> runs, eights, alls;  // interleaved, since the speed of a processor varies
        for (int i = 0; i < 201; ++i) {
            runs.push_back(1e6 * bench::seconds([&] { simulate(model, run); }));
            eights.push_back(1e6 * bench::seconds([&] { differentiate(trajectory, eight); }));
            alls.push_back(1e6 * bench::seconds([&] { differentiate(trajectory); }));
        }
        const double alone = bench::median(runs), by_eight = bench::median(eights), by_all = bench::median(alls);
        fmt::print("{:<20}{:>8.1f}{:>10.1f}{:>8.1f}{:>10.1f}{:>8.1f}\n", name, alone, by_eight, by_eight / alone,
                   by_all, by_all / alone);
    }
}
