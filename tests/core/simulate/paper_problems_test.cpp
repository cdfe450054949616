// Both problems of the paper's Fig. 4 against 40-digit results.
#include <gtest/gtest.h>

#include "core/systems.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using test::Problem;

struct Bars {
    double tolerance, eps;
    double events, second_ball_zeno_state, end;  // tolerances, absolute errors
};

void expect_near(const Vector& q, const Vector& v, const nlohmann::json& state, double bar, const std::string& what) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
        EXPECT_NEAR(q[i], test::number(state[static_cast<std::size_t>(i)]), bar) << what << " q" << i;
        EXPECT_NEAR(v[i], test::number(state[static_cast<std::size_t>(i + q.size())]), bar) << what << " v" << i;
    }
}

void compare(const Problem& problem, const Bars& bars) {
    SCOPED_TRACE(problem.key);
    const auto model = test::load(problem.asset);
    auto run = model->default_run();
    run.options.tolerance = bars.tolerance;
    run.options.end_time = 20.0;
    run.options.truncation = {bars.eps, bars.eps, bars.eps, Conditions::paper, Reinitialization::kinetic};
    const Trajectory trajectory = simulate(model, run);
    const auto expected = test::reference("fig4")["problems"][problem.key];
    ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;

    const auto zenos = test::events_of(trajectory, Event::Kind::zeno);
    ASSERT_EQ(zenos.size(), expected["zeno_times"].size());
    for (std::size_t i = 0; i < zenos.size(); ++i) {
        const bool second_of_ball = problem.key == "ball" && i == 1;
        EXPECT_NEAR(zenos[i].t, test::number(expected["zeno_times"][i]), bars.events);
        expect_near(zenos[i].q, zenos[i].v_after, expected["zeno_states"][i],
                    second_of_ball ? bars.second_ball_zeno_state : bars.events, "zeno " + std::to_string(i));
        ASSERT_TRUE(zenos[i].certificate && zenos[i].certificate->certified);
    }
    const auto releases = test::events_of(trajectory, Event::Kind::release);
    ASSERT_EQ(releases.size(), expected["detach_times"].size());
    for (std::size_t i = 0; i < releases.size(); ++i) {
        EXPECT_NEAR(releases[i].t, test::number(expected["detach_times"][i]), bars.events);
        expect_near(releases[i].q, releases[i].v_after, expected["detach_states"][i], bars.events, "release");
    }
    // The reference lists the first impacts of each hybrid phase.
    std::size_t phase = 0, k = 0;
    for (const Event& event : trajectory.events) {
        if (event.kind == Event::Kind::zeno) {
            EXPECT_GE(k, expected["impacts"][phase].size());
            ++phase;
            k = 0;
        } else if (event.kind == Event::Kind::impact && k < expected["impacts"][phase].size()) {
            const auto& impact = expected["impacts"][phase][k++];
            EXPECT_NEAR(event.t, test::number(impact["t"]), bars.events);
            EXPECT_NEAR(-event.impact_speed, test::number(impact["hdot_minus"]), bars.events);
            expect_near(event.q, event.v_before, impact["state"], bars.events, "impact");
        }
    }
    expect_near(trajectory.end.q, trajectory.end.v, expected["end_state"], bars.end, "end");
    EXPECT_GE(trajectory.statistics.least_gap, -1e-12);
    EXPECT_LE(trajectory.statistics.energy_drift, 1e-9);
}

TEST(PaperProblems, DefaultToleranceIsWithin1e8OfTheReference) {
    for (const Problem& problem : test::problems) compare(problem, {1e-10, 1e-6, 1e-8, 1e-7, 1e-8});
}

TEST(PaperProblems, TightToleranceIsWithin1e9OfTheReferenceDespiteLooseEps) {
    for (const Problem& problem : test::problems) compare(problem, {1e-12, 1e-5, 1e-9, 1e-9, 1e-10});
}

TEST(PaperProblems, TinyEpsEndsBelowRoundingAndNeverLoops) {
    for (const Problem& problem : test::problems) {
        const auto model = test::load(problem.asset);
        auto run = model->default_run();
        run.options.truncation = {1e-9, 1e-9, 1e-9, Conditions::paper, Reinitialization::kinetic};
        const Trajectory trajectory = simulate(model, run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        EXPECT_LT(trajectory.statistics.impacts, 150);
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-14;
        const Trajectory tiny = simulate(model, run);
        EXPECT_EQ(tiny.outcome.kind, Outcome::Kind::end_time) << tiny.outcome.message;
        for (const Event& event : test::events_of(tiny, Event::Kind::zeno)) {
            EXPECT_TRUE(event.certificate->certified);
            if (problem.key == "double_pendulum") continue;  // its gap is a coordinate, exact near 0
            EXPECT_TRUE(event.certificate->cut_at_resolution);
            EXPECT_GT(event.certificate->velocity_bound, 1e-14);  // the actual bound, not the requested one
            EXPECT_LT(event.certificate->velocity_bound, 1e-5);
        }
    }
}

// Tolerances below what is possible, where the gap is a difference of large numbers. Postponed proofs must not keep the
// bouncing from ending at the resolution.
TEST(PaperProblems, BoundsThatNothingMeetsEndBelowRounding) {
    const auto model = test::typed(
        "title = \"high up\"\n[[coordinate]]\nname = \"x\"\nrate = 1.5\n[[coordinate]]\nname = \"y\"\nstart = 1002\n"
        "[lagrangian]\nkinetic = \"1/2*(x'^2 + y'^2)\"\npotential = \"y\"\n"
        "[[constraint]]\ngap = \"y - 1000 - sin(x)\"\nrestitution = 0.5\n[run]\nend_time = 20\n");
    auto run = model->default_run();
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-15;
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_LT(trajectory.statistics.impacts, 150);
    const auto points = test::events_of(trajectory, Event::Kind::zeno);
    EXPECT_FALSE(points.empty());
    for (const Event& event : points) EXPECT_TRUE(event.certificate->cut_at_resolution);
}

TEST(PaperProblems, SharpConditionsCutEarlierAndAreRight) {
    for (const Problem& problem : test::problems) {
        SCOPED_TRACE(problem.key);
        const auto model = test::load(problem.asset);
        auto run = model->default_run();
        run.options.tolerance = 1e-12;
        const auto expected = test::reference("fig4")["problems"][problem.key];
        ASSERT_EQ(run.options.truncation.conditions, Conditions::sharp);
        const Trajectory sharp = simulate(model, run);
        ASSERT_EQ(sharp.outcome.kind, Outcome::Kind::end_time) << sharp.outcome.message;
        const auto zenos = test::events_of(sharp, Event::Kind::zeno);
        ASSERT_EQ(zenos.size(), expected["zeno_times"].size());
        for (std::size_t i = 0; i < zenos.size(); ++i) {
            const Certificate& c = *zenos[i].certificate;
            // Later Zeno times contain the small errors of earlier truncations, which a certificate does not include.
            const double allowed = i == 0 ? 1e-11 : 1e-8;
            EXPECT_GE(test::number(expected["zeno_times"][i]), c.zeno_low - allowed);
            EXPECT_LE(test::number(expected["zeno_times"][i]), c.zeno_high + allowed);
            EXPECT_NEAR(zenos[i].t, test::number(expected["zeno_times"][i]), 1e-6);
            EXPECT_LE(*c.shadowing_position, 1e-6);
            EXPECT_LE(*c.shadowing_velocity, 1e-6);
        }
        run.options.truncation.conditions = Conditions::paper;
        const Trajectory paper = simulate(model, run);
        EXPECT_LE(sharp.statistics.impacts, paper.statistics.impacts - 11 * static_cast<long>(zenos.size()));
        // Third order: accurate at the end although the cut is far from the Zeno point.
        expect_near(sharp.end.q, sharp.end.v, expected["end_state"], 5e-9, "end");
        run.options.truncation = {1e-15, 1e-15, 1e-15, Conditions::sharp, Reinitialization::kinetic};
        const Trajectory tiny = simulate(model, run);
        EXPECT_EQ(tiny.outcome.kind, Outcome::Kind::end_time) << tiny.outcome.message;
        for (const Event& event : test::events_of(tiny, Event::Kind::zeno)) EXPECT_TRUE(event.certificate->certified);
    }
}

TEST(PaperProblems, TheFirstImpactsOfTheReferenceAreNotTruncated) {
    for (const Problem& problem : test::problems) {
        const auto model = test::load(problem.asset);
        auto run = model->default_run();
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 10.0;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_FALSE(trajectory.events.empty());
        EXPECT_EQ(trajectory.events.front().kind, Event::Kind::impact);  // hddot > 0 there, or theta1 > 0
    }
}

}  // namespace
}  // namespace achilles
