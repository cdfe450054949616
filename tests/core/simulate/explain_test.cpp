// Explanations of a run's events.
#include "simulate/explain.hpp"

#include <gtest/gtest.h>

#include "core/systems.hpp"

namespace achilles {
namespace {

TEST(Reasons, AnImpactCostsWhatRestitutionSays) {
    const auto model = test::load("ball_on_sine");
    const Trajectory trajectory = simulate(model, model->default_run());
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (event.kind != Event::Kind::impact) continue;
        const ImpactReason reason = explain_impact(trajectory, i);
        // Loss (1 - e^2) w^2/(2 W) with W = |grad h|^2/m = 1 + cos^2 x.
        const double w = event.impact_speed, W = 1 + std::pow(std::cos(event.q[0]), 2);
        EXPECT_NEAR(reason.energy_before - reason.energy_after, 0.75 * w * w / (2 * W), 1e-14) << i;
    }
}

// The paper's ball. At its first impact hddot > 0, so truncation is impossible. Later impacts violate an inequality,
// until the one that is cut.
TEST(Reasons, AnImpactThatIsNotCutFailsSomething) {
    for (const auto conditions : {Conditions::paper, Conditions::sharp}) {
        const auto model = test::load("ball_on_sine");
        auto run = model->default_run();
        run.options.truncation.conditions = conditions;
        const Trajectory trajectory = simulate(model, run);
        const ImpactReason first = explain_impact(trajectory, 0);
        EXPECT_GT(first.normal_acceleration, 0.0);
        EXPECT_FALSE(first.attempt);
        int failing = 0;
        for (std::size_t i = 1; i < trajectory.events.size(); ++i) {
            if (trajectory.events[i].kind != Event::Kind::impact) continue;
            const ImpactReason reason = explain_impact(trajectory, i);
            EXPECT_EQ(reason.cut,
                      i + 1 < trajectory.events.size() && trajectory.events[i + 1].kind == Event::Kind::zeno);
            if (!reason.attempt || reason.cut) continue;
            bool failed = false;
            for (const Inequality& inequality : reason.attempt->inequalities())
                failed = failed || !(inequality.left < inequality.right);
            EXPECT_TRUE(failed) << "event " << i;
            ++failing;
        }
        EXPECT_GT(failing, 3);
    }
}

TEST(Reasons, AReleaseIsWhereTheForceVanishesUpwards) {
    for (const auto& problem : test::problems) {
        const auto model = test::load(problem.asset);
        const Trajectory trajectory = simulate(model, model->default_run());
        int releases = 0;
        for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
            if (trajectory.events[i].kind != Event::Kind::release) continue;
            const ReleaseReason reason = explain_release(trajectory, i);
            EXPECT_NEAR(reason.lambda, 0.0, 1e-9);
            EXPECT_GT(reason.jerk, 0.0);
            EXPECT_LT(reason.lambda_rate, 0.0);
            // During contact the contact force is positive, and it decreases towards the release.
            ASSERT_GT(reason.force.size(), 10U);
            for (std::size_t k = 0; k + 1 < reason.force.size(); ++k) EXPECT_GT(reason.force[k].second, 0.0);
            const auto& [t, lambda] = reason.force[reason.force.size() - 2];
            EXPECT_NEAR(lambda, reason.lambda_rate * (t - trajectory.events[i].t), 0.1 * lambda);
            EXPECT_EQ(reason.force.back().first, trajectory.events[i].t);
            ++releases;
        }
        EXPECT_GT(releases, 0);
    }
}

}  // namespace
}  // namespace achilles
