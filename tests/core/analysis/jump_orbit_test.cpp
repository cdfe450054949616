// Periodic orbits through jumps, and their branches: walkers against published data and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/orbit.hpp"
#include "core/systems.hpp"

namespace achilles::test {
namespace {

// The orbit problem of the file's [orbit].
OrbitProblem gait_of(const Model& model) {
    const SystemDescription& system = model.description();
    OrbitProblem problem;
    problem.run = model.default_run();
    problem.run.options.tolerance = 1e-15;
    problem.closing = {system.orbit->period, system.orbit->shift};
    problem.is_guess = true;
    for (std::size_t i = 0; i < system.orbit->q.size(); ++i) {
        problem.run.q[static_cast<Eigen::Index>(i)] = system.orbit->q[i];
        problem.run.v[static_cast<Eigen::Index>(i)] = system.orbit->v[i];
    }
    return problem;
}

TEST(JumpOrbit, OfTheSimplestWalkerIsThePublishedOne) {
    const auto model = load("simplest_walker");
    const OrbitProblem problem = gait_of(*model);
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

// The multiplier of the square of the rate is cos(2 alpha)^2 = 1/2, and the rate after a strike has a closed form.
TEST(JumpOrbit, OfTheRimlessWheelIsItsClosedForm) {
    const auto model = load("rimless_wheel");
    const OrbitSearchResult found = find_orbit(model, gait_of(*model));
    ASSERT_TRUE(found.orbit) << found.reason;
    const double pi = std::numbers::pi, alpha = pi / 8.0, slope = pi / 30.0, c = std::cos(2.0 * alpha);
    ASSERT_EQ(found.orbit->run.events.size(), 1u);
    EXPECT_NEAR(found.orbit->run.events[0].v_after[0],
                c / std::sin(2.0 * alpha) * std::sqrt(4.0 * 9.81 * std::sin(slope) * std::sin(alpha)), 1e-12);
    EXPECT_NEAR(found.orbit->multipliers[1].real(), 0.5, 1e-12);
}

// The first period doubling of the compass gait on a slope.
TEST(JumpBranch, OfTheCompassGaitFlipsWhereItIsPinned) {
    const auto model = load("compass_gait");
    const OrbitProblem problem = gait_of(*model);
    const OrbitSearchResult found = find_orbit(model, problem);
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_NEAR(found.orbit->period, 0.734346391158, 1e-11);
    const Branch branch = follow(model, problem, *found.orbit, 0, 0.05, 0.08);
    ASSERT_EQ(branch.flips.size(), 1u);
    EXPECT_NEAR(branch.value(branch.flips[0]) * 180.0 / std::numbers::pi, 4.390898, 1e-6);
}

// A system without contacts has no gap that could shrink: its branch ends where the foot no longer counts.
TEST(JumpBranch, DoesNotEndByGapsWhereThereAreNone) {
    const auto model = load("simplest_walker");
    const OrbitProblem problem = gait_of(*model);
    const OrbitSearchResult found = find_orbit(model, problem);
    ASSERT_TRUE(found.orbit) << found.reason;
    const Branch branch = follow(model, problem, *found.orbit, 0, 1e-5, 0.01);
    EXPECT_GT(branch.value(branch.points.front()), 1e-5);
    EXPECT_EQ(branch.ends[0].find("gap"), std::string::npos) << branch.ends[0];
}

// Feet that touch the ground and legs that swap are two descriptions of one walker.
TEST(CompassGait, WithAFloatingBaseTakesTheStepsOfTheLegsThatSwap) {
    const auto swap = load("compass_gait"), floating = load("compass_gait_floating");
    const auto walk = [](const std::shared_ptr<const Model>& model) {
        achilles::Run run = model->default_run();
        run.options.tolerance = 1e-13;
        run.options.end_time = 8.0;
        return simulate(model, run);
    };
    const Trajectory jumps = walk(swap), steps = walk(floating);
    ASSERT_EQ(jumps.outcome.kind, Outcome::Kind::end_time) << jumps.outcome.message;
    ASSERT_EQ(steps.outcome.kind, Outcome::Kind::end_time) << steps.outcome.message;
    std::vector<Event> strikes;
    for (const Event& event : steps.events)
        if (event.is_impact()) strikes.push_back(event);
    ASSERT_EQ(jumps.events.size(), 10u);
    ASSERT_EQ(strikes.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_NEAR(strikes[i].t, jumps.events[i].t, 1e-9) << i;
        const Eigen::Index stance = i % 2 == 0 ? 3 : 2, swing = 5 - stance;
        const double slope = std::numbers::pi / 60.0;  // the legs of one are measured from the vertical
        EXPECT_NEAR(slope - strikes[i].q[stance], jumps.events[i].q[0], 1e-8) << i;
        EXPECT_NEAR(strikes[i].q[swing] - slope, jumps.events[i].q[1], 1e-8) << i;
        EXPECT_NEAR(-strikes[i].v_after[stance], jumps.events[i].v_after[0], 1e-8) << i;
        EXPECT_NEAR(strikes[i].v_after[swing], jumps.events[i].v_after[1], 1e-8) << i;
    }
}

// Its period of two steps starts in contact. The multipliers are those of one step, squared; three more are 0.
TEST(CompassGait, WithAFloatingBaseHasTheOrbitOfTheLegsThatSwap) {
    const auto swap = load("compass_gait"), floating = load("compass_gait_floating");
    const OrbitSearchResult step = find_orbit(swap, gait_of(*swap)), both = find_orbit(floating, gait_of(*floating));
    ASSERT_TRUE(step.orbit) << step.reason;
    ASSERT_TRUE(both.orbit) << both.reason;
    EXPECT_NEAR(both.orbit->period, 2.0 * step.orbit->period, 1e-11);
    ASSERT_EQ(both.orbit->free.size(), 1u);
    EXPECT_NEAR(both.orbit->free[0].second, 2.0 * 0.53544541543, 1e-10);
    EXPECT_EQ(both.orbit->zero_multipliers, 3u);
    ASSERT_EQ(both.orbit->multipliers.size(), 8u);
    EXPECT_TRUE(both.orbit->stable);
    for (std::size_t i = 1; i < 4; ++i) {
        const std::complex<double> expected = step.orbit->multipliers[i] * step.orbit->multipliers[i];
        const auto near = std::min_element(
            both.orbit->multipliers.begin(), both.orbit->multipliers.end(),
            [&](const auto& a, const auto& b) { return std::abs(a - expected) < std::abs(b - expected); });
        EXPECT_LT(std::abs(*near - expected), 1e-9) << expected;
    }
    // The period's derivative by the slope, the first parameter of both.
    EXPECT_NEAR(both.orbit->parameter_derivatives(8, 0), 2.0 * step.orbit->parameter_derivatives(4, 0), 1e-8);
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
