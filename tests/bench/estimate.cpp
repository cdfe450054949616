// Compares the error estimate with true errors, for random starts near those of a few systems at several tolerances.
// Measures its cost relative to the run.
// usage: bench_estimate [STARTS [SYSTEM...]]    default: 100 starts, the systems listed below
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "bench/measure.hpp"
#include "core/sensitivity/estimates.hpp"
#include "sensitivity/error_estimate.hpp"

using namespace achilles;
using namespace achilles::test;

namespace {

struct Setting {
    double tolerance, eps;
};
constexpr Setting settings[] = {{1e-6, 1e-6}, {1e-8, 1e-6}, {1e-10, 1e-6}, {1e-12, 1e-7}, {1e-14, 1e-5}, {1e-14, 1e-4}};

double quantile(std::vector<double> x, double part) {
    if (x.empty()) return 0.0;
    std::sort(x.begin(), x.end());
    return x[static_cast<std::size_t>(part * static_cast<double>(x.size() - 1))];
}

// Time of the estimate in percent of the run's, each the smallest of several measurements.
double cost(const std::shared_ptr<const Model>& model, const Run& run) {
    double of_run = 1e9, of_estimate = 1e9;
    for (int round = 0; round < 20; ++round) {
        Trajectory trajectory;
        of_run = std::min(of_run, bench::seconds([&] { trajectory = simulate(model, run); }));
        of_estimate = std::min(of_estimate, bench::seconds([&] { estimate_error(trajectory); }));
    }
    return 100.0 * of_estimate / of_run;
}

}  // namespace

int main(int argc, char** argv) {
    const int starts = argc > 1 ? std::atoi(argv[1]) : 100;
    std::vector<std::string> systems(argv + std::min(argc, 2), argv + argc);
    if (systems.empty())
        systems = {"ball_on_sine", "double_pendulum", "ball_on_hills", "cart_pendulum", "driven_double_pendulum"};
    fmt::print("{:<26}{:>9}{:>8}{:>10}{:>6}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>9}{:>8}\n", "system", "tolerance", "eps",
               "error", "runs", "other", "rated", "5%", "50%", "95%", "inside", "covered", "cost %");
    bool good = true;
    for (const std::string& name : systems) {
        const auto model = load(name);
        for (const Setting& setting : settings) {
            std::vector<double> ratios, errors;
            int runs = 0, other = 0, covered = 0, inside = 0;
            for (const Run& start : starts_around(*model, starts, 1)) {
                const RatedEstimate rated = rate(model, with(start, setting.tolerance, setting.eps));
                if (!rated.same) {
                    ++other;
                    continue;
                }
                ++runs;
                covered += rated.is_covered();
                errors.push_back(rated.error);
                if (!rated.has_ratio()) continue;
                ratios.push_back(rated.ratio());
                inside += ratios.back() >= 0.5 && ratios.back() <= 2.0;
            }
            fmt::print("{:<26}{:>9.0e}{:>8.0e}{:>10.1e}{:>6}{:>7}{:>7}{:>7.2f}{:>7.2f}{:>7.2f}{:>7}{:>9}{:>8.0f}\n",
                       name, setting.tolerance, setting.eps, quantile(errors, 0.5), runs, other, ratios.size(),
                       quantile(ratios, 0.05), quantile(ratios, 0.5), quantile(ratios, 0.95), inside, covered,
                       cost(model, with(model->default_run(), setting.tolerance, setting.eps)));
            good = good && inside == static_cast<int>(ratios.size()) && 100 * covered >= 98 * runs;
        }
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
