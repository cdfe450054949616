// Extreme numbers: very small tolerances and very long times.
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "output/output.hpp"
#include "simulate/batch.hpp"

namespace achilles {
namespace {

TEST(SmallTolerances, AreToldAndRaised) {
    const auto model = test::load("ball_on_sine");
    auto run = model->default_run();
    EXPECT_TRUE(warnings(run.options).empty());
    run.options.end_time = 3.0;
    run.options.tolerance = 1e-15;
    run.options.truncation.eps_v = 1e-15;
    EXPECT_TRUE(warnings(run.options).empty());
    const Trajectory least = simulate(model, run);
    run.options.tolerance = 1e-30;
    run.options.truncation.eps_v = 9e-16;
    EXPECT_EQ(warnings(run.options),
              (std::vector<std::string>{"tolerance = 1e-30 is below what double precision supports; using 1e-15",
                                        "eps_v = 9e-16 is below what double precision supports; using 1e-15"}));
    const Trajectory raised = simulate(model, run);
    EXPECT_EQ(raised.run.options.tolerance, 1e-15);
    EXPECT_EQ(raised.run.options.truncation.eps_v, 1e-15);
    EXPECT_EQ(raised.run.options.truncation.eps_q, 1e-6);
    EXPECT_EQ(to_text(raised), to_text(least));
    simulate_ends(
        model, 1, [&](std::size_t) { return run; },
        [](std::size_t, RunResult&& attempt) { EXPECT_EQ(std::get<Trajectory>(attempt).run.options.tolerance, 1e-15); },
        1);
    run.options.tolerance = -1e-30;
    EXPECT_THROW(simulate(model, run), InputError);
}

void expect_numbers(const Trajectory& trajectory) {
    EXPECT_EQ(trajectory.outcome.message.find("nan"), std::string::npos) << trajectory.outcome.message;
    EXPECT_TRUE(trajectory.end.q.allFinite() && trajectory.end.v.allFinite()) << trajectory.outcome.message;
    const std::string text = summary(trajectory) + to_csv(trajectory) + to_text(trajectory);
    EXPECT_EQ(text.find("nan"), text.npos);
}

// After coming to rest vertically, the ball slides on at rate 1/2 forever. The motion is representable at any finite
// time.
TEST(LongTimes, AreReachedByUniformMotion) {
    const auto model = test::load("ball_on_floor");
    for (const Method method : test::both_methods)
        for (const double end : {1e12, 1e60, 1e149}) {
            auto run = model->default_run();
            run.options.method = method;
            run.options.end_time = end;
            const Trajectory trajectory = simulate(model, run);
            expect_numbers(trajectory);
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
            EXPECT_EQ(trajectory.end_time, end);
            EXPECT_NEAR(trajectory.end.q[0] / (0.5 * end), 1.0, 1e-12);
            EXPECT_NEAR(trajectory.end.v[0], 0.5, 1e-12);
        }
}

TEST(LongTimes, OverflowEndsTheRun) {
    const auto model = test::load("ball_on_floor");
    const std::string beginning = "the motion diverges: the state is not finite just after t = ";
    for (const double end : {1e154, 1e160, 1e300, 1e308}) {
        auto run = model->default_run();
        run.options.end_time = end;
        const Trajectory trajectory = simulate(model, run);
        expect_numbers(trajectory);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::not_a_number) << trajectory.outcome.message;
        EXPECT_EQ(trajectory.outcome.message.substr(0, beginning.size()), beginning);
        EXPECT_GT(trajectory.end_time, 1e147);
    }
}

// A fall beside the wall: y = -t^2/2.
TEST(LongTimes, EndAFall) {
    const auto model = test::typed(
        "title = \"fall\"\n[[coordinate]]\nname = \"x\"\nstart = 1\nrate = 1\n[[coordinate]]\nname = "
        "\"y\"\n[lagrangian]\n"
        "kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n");
    for (const double end : {1e70, 1e308}) {
        auto run = model->default_run();
        run.options.end_time = end;
        const Trajectory trajectory = simulate(model, run);
        expect_numbers(trajectory);
        EXPECT_EQ(trajectory.outcome.kind, end < 1e75 ? Outcome::Kind::end_time : Outcome::Kind::not_a_number)
            << trajectory.outcome.message;
    }
}

}  // namespace
}  // namespace achilles
