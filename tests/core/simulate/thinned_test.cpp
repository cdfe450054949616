// Thinning a very long trajectory for display keeps its events.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/systems.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

// In a run of two thousand seconds all events are in the first twelve. Uniform thinning would show a straight line
// there.
TEST(ThinnedTrajectory, StepsAroundEventsStay) {
    const auto ball = test::load("ball_on_sine");
    auto run = ball->default_run();
    run.options.end_time = 2000.0;
    const Trajectory trajectory = simulate(ball, run);
    constexpr std::size_t most = 500;
    ASSERT_GT(trajectory.pieces.size(), 4 * most);
    const std::vector<Sample> samples = Sampler(trajectory).some(most, 0);
    EXPECT_LE(samples.size(), 6 * most);
    for (const Event& event : trajectory.events)
        EXPECT_TRUE(std::any_of(samples.begin(), samples.end(), [&](const Sample& s) { return s.t == event.t; }))
            << event.t;
    const auto early = std::count_if(samples.begin(), samples.end(), [](const Sample& s) { return s.t < 12.5; });
    EXPECT_GE(early, static_cast<long>(trajectory.events.size()));
    EXPECT_TRUE(std::is_sorted(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.t < b.t; }));
}

// A run may end at an event before its first step.
TEST(ThinnedTrajectory, ARunWithoutStepsHasItsEvents) {
    const auto floor = test::load("ball_on_floor");
    Trajectory trajectory = simulate(floor, floor->default_run());
    trajectory.pieces.clear();
    EXPECT_EQ(Sampler(trajectory).some(500, 0).size(), Sampler(trajectory).all().size());
}

// The limit also holds if there are events everywhere.
TEST(ThinnedTrajectory, ManyImpactsAreThinnedToo) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    assign(run, floor->description(), "e=1");
    run.options.end_time = 2000.0;
    const Trajectory trajectory = simulate(floor, run);
    ASSERT_GT(trajectory.pieces.size(), 2000U);
    EXPECT_LE(Sampler(trajectory).some(500, 0).size(), 4 * 500U);
}

}  // namespace
}  // namespace achilles
