// Symmetric, redundant and just-touching starts and impacts, which users type but random tests never produce. Such runs
// continue and report how the ambiguity was resolved (theory-gaps.md 2.4, 2.5).
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"

namespace achilles {
namespace {

using Rates = std::vector<std::pair<std::size_t, double>>;

// A uniform rod of length 1 and mass 1, dropped flat from 0.5 onto the ground.
std::shared_ptr<const Model> flat_rod(double e, const std::string& more = "") {
    return test::typed(fmt::format(R"toml(
title = "Rod dropped flat"
coordinate = [{{ name = "y", start = 0.5 }}, {{ name = "theta", start = 0.0 }}]
lagrangian = {{ kinetic = "1/2*y'^2 + 1/24*theta'^2", potential = "y" }}
constraint = [{{ name = "left", gap = "y - sin(theta)/2", restitution = {0} }},
              {{ name = "right", gap = "y + sin(theta)/2", restitution = {0} }}]
[run]
end_time = 1.5
{1}
)toml",
                                   e, more));
}

void expect_rates(const Rates& rates, double left, double right, double speed) {
    ASSERT_EQ(rates.size(), 2u);
    EXPECT_EQ(rates[0].first, 0u);
    EXPECT_EQ(rates[1].first, 1u);
    EXPECT_NEAR(rates[0].second, left * speed, 1e-12);
    EXPECT_NEAR(rates[1].second, right * speed, 1e-12);
}

TEST(SymmetricRuns, ARodDroppedFlatGoesOnAndTellsWhatEachOrderWouldGive) {
    const auto model = flat_rod(0.5);
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    ASSERT_FALSE(trajectory.events.empty());
    const Event& landing = trajectory.events[0];
    EXPECT_NEAR(landing.t, 1.0, 1e-12);
    EXPECT_EQ(landing.contacts, ContactSet::of(0).with(1));
    ASSERT_TRUE(landing.joint);
    EXPECT_TRUE(landing.joint->order_matters);
    EXPECT_FALSE(landing.joint->is_nonunique);
    EXPECT_EQ(trajectory.ambiguous_impacts, 1);
    EXPECT_NEAR(landing.v_after[0], 0.5, 1e-12);
    EXPECT_NEAR(landing.v_after[1], 0.0, 1e-12);
    const auto& all = landing.joint->alternatives;
    ASSERT_EQ(all.size(), 3u);
    EXPECT_FALSE(all[0].first);
    expect_rates(all[0].rates_after, 0.5, 0.5, 1.0);
    EXPECT_EQ(all[1].first, 0u);
    expect_rates(all[1].rates_after, 0.40625, 0.265625, 1.0);
    EXPECT_EQ(all[2].first, 1u);
    expect_rates(all[2].rates_after, 0.265625, 0.40625, 1.0);
}

TEST(SymmetricRuns, ARodDroppedFlatStopsWhereThatIsAsked) {
    const auto model = flat_rod(0.5, "simultaneous = \"stop\"");
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(to_text(trajectory.outcome.kind), "simultaneous impacts");
    EXPECT_NEAR(trajectory.end_time, 1.0, 1e-12);
    for (const char* part : {"'left'", "'right'", "simultaneous = \"stop\""})
        EXPECT_NE(trajectory.outcome.message.find(part), std::string::npos) << trajectory.outcome.message;
}

// A slightly tilted rod has a definite impact order. In the limit it follows one of the reported alternatives.
TEST(SymmetricRuns, ARodDroppedNearlyFlatDoesWhatAnAlternativeTells) {
    const auto model = flat_rod(0.5);
    for (const bool left_first : {true, false}) {
        auto run = model->default_run();
        run.q[1] = left_first ? 1e-7 : -1e-7;
        run.options.end_time = 1.01;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        EXPECT_EQ(trajectory.ambiguous_impacts, 0);
        const double left = left_first ? 0.40625 : 0.265625, right = left_first ? 0.265625 : 0.40625;
        EXPECT_EQ(trajectory.events.at(0).contacts, ContactSet::of(left_first ? 0 : 1));
        const double fall = trajectory.end_time - trajectory.events.back().t;
        EXPECT_NEAR(trajectory.end.v[0] - trajectory.end.v[1] / 2 + fall, left, 1e-5);
        EXPECT_NEAR(trajectory.end.v[0] + trajectory.end.v[1] / 2 + fall, right, 1e-5);
    }
}

TEST(SymmetricRuns, AGapThatIsGivenTwiceIsOneWhoseForceMayBeShared) {
    const auto ball = [](const std::string& constraints, double end) {
        return test::typed(fmt::format(R"toml(
title = "Ball on a floor"
coordinate = [{{ name = "x", start = 0, rate = 0.3 }}, {{ name = "y", start = 0.5 }}]
lagrangian = {{ kinetic = "1/2*(x'^2 + y'^2)", potential = "y" }}
constraint = [{}]
[run]
end_time = {}
)toml",
                                       constraints, end));
    };
    for (const double e : {0.0, 0.5}) {
        SCOPED_TRACE(e);
        const double end = e == 0.0 ? 3.0 : 1.5;
        const auto once = ball(fmt::format("{{ name = \"a\", gap = \"y\", restitution = {} }}", e), end);
        const auto twice = ball(fmt::format("{{ name = \"a\", gap = \"y\", restitution = {0} }}, {{ name = \"b\", gap "
                                            "= \"2*y\", restitution = {0} }}",
                                            e),
                                end);
        const Trajectory one = simulate(once, once->default_run()), two = simulate(twice, twice->default_run());
        EXPECT_EQ(two.outcome.kind, Outcome::Kind::end_time) << two.outcome.message;
        ASSERT_FALSE(two.events.empty());
        ASSERT_TRUE(two.events[0].joint);
        EXPECT_TRUE(two.events[0].joint->is_nonunique);
        EXPECT_NEAR(two.events[0].t, one.events[0].t, 1e-12);
        EXPECT_LT((two.end.q - one.end.q).norm(), 1e-12);
        EXPECT_LT((two.end.v - one.end.v).norm(), 1e-12);
    }
}

// A table of mass 1 on a subset of four legs at (+-1, +-1), under a load at (x, y) on its top.
std::shared_ptr<const Model> table(const std::string& load, const std::string& x, const std::string& y,
                                   const std::vector<int>& legs = {0, 1, 2, 3}) {
    const char* const signs[] = {"- u - v", "+ u - v", "- u + v", "+ u + v"};
    std::string constraints;
    for (const int leg : legs)
        constraints += fmt::format("{}{{ name = \"leg{}\", gap = \"z {}\", restitution = 0 }}",
                                   constraints.empty() ? "" : ", ", leg, signs[leg]);
    return test::typed(fmt::format(R"toml(
title = "Table"
coordinate = [{{ name = "s", start = 0, rate = 1 }}, {{ name = "z", start = 0, force = "-({0})" }},
              {{ name = "u", start = 0, force = "-({0})*({1})" }}, {{ name = "v", start = 0, force = "-({0})*({2})" }}]
lagrangian = {{ kinetic = "(s'^2 + z'^2 + u'^2 + v'^2)/2", potential = "z" }}
constraint = [{3}]
[run]
end_time = 4
)toml",
                                   load, x, y, constraints));
}

// Three legs carry a load off the diagonals, two carry one on a diagonal. The load may change and move.
TEST(SymmetricRuns, ATableWithOneLegTooManyStandsUnderAnyLoad) {
    struct Load {
        const char *load, *x, *y;
    };
    for (const auto& [load, x, y] : {Load{"2", "0.3", "0.1"}, Load{"1 + cos(t)^2", "0.3", "0.1"},
                                     Load{"2", "0.5*cos(3*t)", "0.5*sin(3*t)"}, Load{"1", "s/4 - 1/2", "0.2"}}) {
        const auto model = table(load, x, y);
        const Trajectory trajectory = simulate(model, model->default_run());
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << x << " " << trajectory.outcome.message;
        EXPECT_NEAR(trajectory.end.q.tail(3).norm() + trajectory.end.v.tail(3).norm(), 0.0, 1e-12) << x;
    }
    for (const char* load : {"2", "2*cos(t)^2", "0"}) {
        auto model = table(load, "0", "0");
        auto run = model->default_run();
        run.v[0] = 0.0;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << load << " " << trajectory.outcome.message;
        EXPECT_NEAR(trajectory.end.q.norm() + trajectory.end.v.norm(), 0.0, 1e-12) << load;
        EXPECT_EQ(trajectory.end_mode.held().count(), 4) << load;
    }
}

// The same for the gallery's table, which has no free coordinate. Its contact forces have no rates to decide by.
TEST(SymmetricRuns, TheTableOfTheGalleryStandsUnderALoadOnItsMiddle) {
    const auto model = test::load("table_on_legs");
    auto run = model->default_run();
    for (std::size_t i = 0; i < run.parameters.size(); ++i)
        if (const auto& name = model->description().parameters[i].name; name == "R" || name == "side")
            run.parameters[i] = 0.0;
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_EQ(trajectory.end_mode.held().count(), 4);
    EXPECT_NEAR(trajectory.end.q.norm() + trajectory.end.v.norm(), 0.0, 1e-12);
}

// A load that moves past the edge tips the table about two legs. The other two are released at once, and the motion is
// that of a table with two legs.
TEST(SymmetricRuns, ATableTipsOverItsEdge) {
    const auto four = table("2", "s", "0.1"), two = table("2", "s", "0.1", {1, 3});
    const Trajectory trajectory = simulate(four, four->default_run());
    ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    // Here 2 s = 3: the load and the weight balance on the edge.
    const Event& tips = trajectory.events.back();
    EXPECT_NEAR(tips.t, 1.5, 1e-9);
    EXPECT_EQ(tips.contacts, ContactSet::of(0).with(2));
    EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(1).with(3));
    auto run = two->default_run();
    run.q = tips.q;
    run.v = tips.v_after;
    run.options.start_time = tips.t;
    const Trajectory alone = simulate(two, run);
    ASSERT_EQ(alone.outcome.kind, Outcome::Kind::end_time) << alone.outcome.message;
    EXPECT_LT((alone.end.q - trajectory.end.q).norm(), 1e-9);
    EXPECT_GT(trajectory.end.q.norm(), 0.1);
}

std::shared_ptr<const Model> cradle(double e, double gap) {
    return test::typed(fmt::format(R"toml(
title = "Three balls in a row"
coordinate = [{{ name = "x1", start = 0, rate = 1 }}, {{ name = "x2", start = {1} }}, {{ name = "x3", start = {2} }}]
lagrangian = {{ kinetic = "1/2*(x1'^2 + x2'^2 + x3'^2)", potential = "0" }}
constraint = [{{ name = "first", gap = "x2 - x1 - 1", restitution = {0} }},
              {{ name = "second", gap = "x3 - x2 - 1", restitution = {0} }}]
[run]
end_time = 2
)toml",
                                   e, 1.0 + gap, 2.0 + 2.0 * gap));
}

TEST(SymmetricRuns, ATouchingCradleGoesOn) {
    const auto touching = cradle(1.0, 0.0);
    const Trajectory trajectory = simulate(touching, touching->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    ASSERT_EQ(trajectory.events.size(), 1u);
    EXPECT_TRUE(trajectory.events[0].joint && trajectory.events[0].joint->order_matters);
    const double together[] = {-1.0 / 3, 2.0 / 3, 2.0 / 3};
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(trajectory.end.v[i], together[i], 1e-12);
    EXPECT_NEAR(trajectory.end.q[2] - trajectory.end.q[1], 1.0, 1e-12);
    EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(1));  // closed, although nothing presses it

    const auto apart = cradle(1.0, 1e-3);
    const Trajectory one_by_one = simulate(apart, apart->default_run());
    EXPECT_EQ(one_by_one.outcome.kind, Outcome::Kind::end_time) << one_by_one.outcome.message;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(one_by_one.end.v[i], i == 2 ? 1.0 : 0.0, 1e-12);
}

TEST(SymmetricRuns, APendulumAtRestThatJustTouchesItsStopGoesOn) {
    const auto model = test::typed(R"toml(
title = "Pendulum that touches its stop"
coordinate = [{ name = "theta", start = 0 }]
lagrangian = { kinetic = "1/2*theta'^2", potential = "-cos(theta)" }
constraint = [{ gap = "theta", restitution = 0.5 }]
[run]
end_time = 5
)toml");
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_EQ(trajectory.end.q[0], 0.0);
    EXPECT_EQ(trajectory.end.v[0], 0.0);
}

// A force that is 0, which no algebra proves: the point rests, and its gap, which stays 0, raises no doubt.
TEST(SymmetricRuns, APointAtRestThatJustTouchesIsNotRunAgain) {
    const auto model = test::typed(R"toml(
title = "Point that touches its stop"
coordinate = [{ name = "x", start = 0, force = "sqrt(4) - 2" }]
lagrangian = { kinetic = "x'^2/2", potential = "0" }
constraint = [{ gap = "x", restitution = 0.5 }]
[run]
end_time = 5
)toml");
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_FALSE(trajectory.rerun_options) << trajectory.rerun_reason;
    EXPECT_TRUE(trajectory.events.empty());
    EXPECT_EQ(trajectory.end.q[0], 0.0);
}

}  // namespace
}  // namespace achilles
