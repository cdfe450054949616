// Estimated errors and true errors of runs.
#pragma once

#include <random>

#include "core/systems.hpp"
#include "sensitivity/error_estimate.hpp"

namespace achilles::test {

inline Run with(Run run, double tolerance, double eps) {
    run.options.tolerance = tolerance;
    for (double* each : {&run.options.truncation.eps_q, &run.options.truncation.eps_v, &run.options.truncation.eps_t})
        *each = eps;
    return run;
}

// Runs that start in flight, near the system's own start.
inline std::vector<Run> starts_around(const Model& model, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    constexpr double reach = 0.2;
    std::vector<Run> runs;
    for (int attempt = 0; attempt < 100 * count && static_cast<int>(runs.size()) < count; ++attempt) {
        Run run = model.default_run();
        for (double& x : run.q) x += reach * any(random);
        for (double& x : run.v) x += reach * any(random);
        bool open = true;
        for (std::size_t i = 0; i < model.contacts(); ++i) {
            auto gap = model.evaluator(model.gap(i), run.parameters);
            set_state(gap, run.start());
            gap.run();
            open = open && gap.output(0) > 0.01;
        }
        if (open) runs.push_back(run);
    }
    return runs;
}

// Errors of the final state: the estimate, and the difference from a run at the tightest tolerances. `doubt` is the
// estimated error of the latter.
struct RatedEstimate {
    bool same = false;  // both runs have the same Zeno points and releases, and an estimate
    double error = 0.0, estimate = 0.0, sigma = 0.0, reach = 0.0, doubt = 0.0;
    bool is_covered() const { return error <= reach + doubt; }
    // Whether the ratio is meaningful: the error dominates rounding and the error of the tight run, and is small enough
    // for first order.
    bool has_ratio() const { return error > 0.0 && error >= 10.0 * std::max(sigma, doubt) && error <= 1e-5; }
    double ratio() const { return estimate / error; }
};
inline RatedEstimate rate(const std::shared_ptr<const Model>& model, const Run& run) {
    const Trajectory rough = simulate(model, run), truth = simulate(model, with(run, 1e-14, 1e-9));
    const ErrorEstimate estimate = estimate_error(rough), remaining = estimate_error(truth);
    const auto same = [&](Event::Kind kind) { return count(rough, kind) == count(truth, kind); };
    RatedEstimate rated;
    rated.same = rough.outcome.kind == Outcome::Kind::end_time && truth.outcome.kind == Outcome::Kind::end_time &&
                 rough.end_phase == truth.end_phase && same(Event::Kind::zeno) && same(Event::Kind::release) &&
                 estimate.end && remaining.end;
    if (!rated.same) return rated;
    rated.error = std::hypot((truth.end.q - rough.end.q).norm(), (truth.end.v - rough.end.v).norm());
    rated.estimate = estimate.end->norm;
    rated.sigma = estimate.end->sigma;
    rated.reach = estimate.end->reach();
    rated.doubt = remaining.end->reach();
    return rated;
}

}  // namespace achilles::test
