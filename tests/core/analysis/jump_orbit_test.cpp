// Periodic orbits through jumps: the simplest walking model against its published data.
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/orbit.hpp"
#include "core/systems.hpp"

namespace achilles::test {
namespace {

TEST(JumpOrbit, OfTheSimplestWalkerIsThePublishedOne) {
    const auto model = load("simplest_walker");
    const SystemDescription& system = model->description();
    OrbitProblem problem;
    problem.run = model->default_run();
    problem.run.options.tolerance = 1e-15;
    problem.closing = {system.orbit->period, system.orbit->shift};
    problem.is_guess = true;
    for (std::size_t i = 0; i < 2; ++i) {
        problem.run.q[static_cast<Eigen::Index>(i)] = system.orbit->q[i];
        problem.run.v[static_cast<Eigen::Index>(i)] = system.orbit->v[i];
    }
    const OrbitSearchResult found = find_orbit(model, problem);
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_NEAR(found.orbit->period, 3.882463752851374138, 1e-11);
    std::vector<std::complex<double>> multipliers(found.orbit->multipliers.begin(), found.orbit->multipliers.end());
    ASSERT_EQ(multipliers.size(), 4u);
    const auto nearest = [&](std::complex<double> z) {
        return std::abs(*std::min_element(multipliers.begin(), multipliers.end(), [&](auto a, auto b) {
            return std::abs(a - z) < std::abs(b - z);
        }) - z);
    };
    const std::complex<double> pinned(-0.1900998410658881, 0.5575987766820683);
    EXPECT_LT(nearest(pinned), 1e-10);
    EXPECT_LT(nearest(std::conj(pinned)), 1e-10);
    EXPECT_LT(nearest(1.0), 1e-12);
    EXPECT_LT(nearest(0.0), 1e-10);
    EXPECT_TRUE(found.orbit->stable);
}

TEST(JumpOrbit, KeepsItsPeriodOverAThousandSteps) {
    const auto model = load("simplest_walker");
    achilles::Run run = model->default_run();
    run.options.tolerance = 1e-14;
    run.options.end_time = 3884.0;
    run.options.max_events = 2000;
    const Trajectory walk = simulate(model, run);
    EXPECT_EQ(walk.outcome.kind, Outcome::Kind::end_time) << walk.outcome.message;
    ASSERT_EQ(walk.events.size(), 1000u);
    EXPECT_NEAR((walk.events[999].t - walk.events[499].t) / 500.0, 3.882463752851374138, 1e-9);
}

}  // namespace
}  // namespace achilles::test
