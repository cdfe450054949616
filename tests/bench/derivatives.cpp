// What the derivatives of the paper's two runs cost beside the runs, by eight directions and by all: microseconds, medians.
#include <fmt/format.h>

#include "bench/measure.hpp"
#include "depend/derivatives.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

using namespace achilles;

namespace {

template <class Work>
double microseconds(const Work& work) {
    std::vector<double> times;
    for (int i = 0; i < 101; ++i) times.push_back(1e6 * bench::seconds(work));
    return bench::median(times);
}

}  // namespace

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
        const double alone = microseconds([&] { simulate(model, run); });
        const double by_eight = microseconds([&] { differentiate(trajectory, eight); });
        const double by_all = microseconds([&] { differentiate(trajectory); });
        fmt::print("{:<20}{:>8.1f}{:>10.1f}{:>8.1f}{:>10.1f}{:>8.1f}\n", name, alone, by_eight, by_eight / alone,
                   by_all, by_all / alone);
    }
}
