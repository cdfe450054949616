// Enclosed events matched with the events of a run.
#include "output/proof.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/systems.hpp"
#include "enclose/initial_uncertainty.hpp"

namespace achilles::test {

// A run that cuts earlier than the proof has the same Zeno points, releases and impacts.
TEST(EnclosedEvents, AreThoseOfTheRun) {
    for (const std::string name :
         {"ball_on_sine", "double_pendulum", "ball_on_hills", "impact_oscillator", "double_pendulum_two_stops"}) {
        SCOPED_TRACE(name);
        const auto model = load(name);
        achilles::Run run = model->default_run();
        run.options.end_time = std::min(run.options.end_time, 8.0);
        const Trajectory trajectory = simulate(model, run);
        const Enclosure proof = prove(model, problem_from_decimals(run));
        const auto enclosed = enclosed_events(trajectory, proof);
        ASSERT_EQ(enclosed.size(), trajectory.events.size());
        ASSERT_FALSE(enclosed.empty());
        for (std::size_t i = 0; i < enclosed.size(); ++i) {
            ASSERT_NE(enclosed[i], nullptr) << i;
            EXPECT_EQ(enclosed[i]->kind, trajectory.events[i].kind);
            EXPECT_TRUE(trajectory.events[i].contacts.contains(enclosed[i]->contact));
            EXPECT_EQ(enclosed[i]->opened, trajectory.events[i].opened);
            EXPECT_NEAR(mid(enclosed[i]->t), trajectory.events[i].t, 1e-5) << i;
        }
    }
}

// After the instant where a proof becomes undecided there are none.
TEST(EnclosedEvents, EndWhereTheProofDoes) {
    const auto model = load("ball_on_sine");
    achilles::EnclosureProblem claim = problem_from_decimals(model->default_run());
    inflate(claim, 1e-3);
    const Enclosure proof = prove(model, claim);
    ASSERT_EQ(proof.outcome.kind, Enclosure::ProofOutcome::Kind::undecided);
    const Trajectory trajectory = simulate(model, model->default_run());
    const auto enclosed = enclosed_events(trajectory, proof);
    for (std::size_t i = 0; i < enclosed.size(); ++i)
        if (enclosed[i] != nullptr) {
            EXPECT_LE(enclosed[i]->t.lo(), proof.proved_until) << i;
        }
    EXPECT_EQ(enclosed.back(), nullptr);
}

}  // namespace achilles::test
