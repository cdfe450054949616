// The smallest gap of a run: at its start, at the ends of steps, and at minima between them.

#include <gtest/gtest.h>

#include "core/systems.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

TEST(LeastGap, IsThatOfTheStartWhereTheRunOnlyRises) {
    const auto hills = test::load("ball_on_hills");
    auto run = hills->default_run();
    run.options.end_time = 0.3;
    const Trajectory trajectory = simulate(hills, run);
    auto gap = hills->evaluator(hills->gap(), run.parameters);
    set_state(gap, run.start());
    gap.run();
    ASSERT_GT(trajectory.statistics.least_gap, gap.output(0) + 0.1);
    EXPECT_EQ(least_gap(trajectory), gap.output(0));
}

// At a loose tolerance the motion may dip below the surface just after a release at rate 0. The displayed motion
// counts.
TEST(LeastGap, IsNoLargerThanAnySample) {
    const auto mass = test::typed(
        "title = \"mass\"\n[[coordinate]]\nname = \"x\"\nstart = 0.5\nforce = \"3*cos(1.3*t) - 0.3*x'\"\n"
        "[lagrangian]\nkinetic = \"0.6*x'^2\"\npotential = \"2*(x + 0.3)^2\"\n[[constraint]]\ngap = \"x\"\n"
        "restitution = 0.6\n[run]\nend_time = 12\n");
    auto run = mass->default_run();
    run.options.method = Method::dopri5;
    run.options.tolerance = 1e-3;
    const Trajectory trajectory = simulate(mass, run);
    const double least = least_gap(trajectory);
    for (const Sample& sample : Sampler(trajectory).all(7)) EXPECT_GE(sample.state.q[0], least - 1e-15) << sample.t;
}

// Past valleys of the gap: depth 1/100 at x = 1 and a shallower one at x = 3, in one step or in many.
TEST(LeastGap, IsFoundInsideSteps) {
    const auto valleys = test::typed(
        "title = \"valleys\"\n[[coordinate]]\nname = \"x\"\nrate = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\n"
        "potential = \"0\"\n[[constraint]]\ngap = \"(x - 1)^2*(x - 3)^2 + (x + 1)/200\"\nrestitution = 0.5\n"
        "[run]\nend_time = 4.5\n");
    // Zero of the gap's derivative just before x = 1, computed separately by Newton's method.
    const double x = 0.9993755849629357;
    const double least = (x - 1) * (x - 1) * (x - 3) * (x - 3) + (x + 1) / 200;
    for (const Method method : test::both_methods)
        for (const double tolerance : {1e-4, 1e-10}) {
            auto run = valleys->default_run();
            run.options.method = method;
            run.options.tolerance = tolerance;
            const Trajectory trajectory = simulate(valleys, run);
            ASSERT_GT(trajectory.statistics.least_gap, 1.0001 * least);
            EXPECT_NEAR(least_gap(trajectory), least, 1e-12) << to_text(method) << tolerance;
        }
}

TEST(LeastGap, IsZeroToWithinRoundingAfterAnImpact) {
    for (const char* name : {"ball_on_sine", "double_pendulum_two_stops"}) {
        const auto model = test::load(name);
        const double least = least_gap(simulate(model, model->default_run()));
        EXPECT_GT(least, -1e-12) << name;
        EXPECT_LT(least, 1e-12) << name;
    }
}

}  // namespace
}  // namespace achilles
