// Periodic orbits in the explorer: search, continuation, branch, undo, and saved sessions.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "app/hands.hpp"
#include "session/replay_script.hpp"
#include "session/study_jobs.hpp"

namespace achilles {
namespace {

using test::Hands;

Session on(const std::string& system, const std::string& text) {
    Session session = test::session(system);
    session.apply(command::FindOrbit{text});
    EXPECT_EQ(session.error(), "");
    return session;
}

double period_of(const Session& session) { return session.orbit()->answer.orbit->period; }

// Distance between the state after one period and the initial state plus the shift.
double missed(const Session& session, double period, double shift) {
    const double begin = session.run().options.start_time;
    const State first = session.at(begin).state, last = session.at(begin + period).state;
    return std::abs(last.q[0] - first.q[0] - shift) + (last.v - first.v).norm();
}

TEST(OrbitSession, FindsWhatTheFileGuessesAndGoesOnIt) {
    Session session = on("ball_down_a_wave", "");
    ASSERT_TRUE(session.orbit() && session.orbit()->answer.orbit);
    EXPECT_TRUE(session.scene().shows("orbit"));
    EXPECT_NEAR(period_of(session), 3.544294646668781, 1e-12);
    EXPECT_FALSE(session.orbit_point()) << "nothing has been changed yet";
    const double length = session.run().options.end_time - session.run().options.start_time;
    session.apply(command::SelectBranchPoint{1});
    ASSERT_EQ(session.error(), "");
    EXPECT_EQ(session.orbit_point(), 0u);
    EXPECT_EQ(session.run().options.end_time - session.run().options.start_time, length);
    EXPECT_LT(missed(session, period_of(session), 2.0 * M_PI), 1e-8);
    EXPECT_LT(missed(session, 3.0 * period_of(session), 6.0 * M_PI), 1e-6);
    // The session's tolerances are kept.
    EXPECT_EQ(session.run().options.tolerance, session.file_run().options.tolerance);
    session.apply(command::Undo{});
    EXPECT_EQ(session.run(), session.file_run());
    EXPECT_FALSE(session.orbit_point());
}

// A driven system keeps the phase of its drive.
TEST(OrbitSession, GoesOnADriveInItsPhase) {
    Session session = on("driven_double_pendulum", "");
    ASSERT_TRUE(session.orbit()->answer.orbit) << session.orbit()->answer.reason;
    session.apply(command::SelectBranchPoint{1});
    ASSERT_EQ(session.error(), "");
    EXPECT_LT(missed(session, period_of(session), 0.0), 1e-7);
}

TEST(OrbitSession, FollowsABranchAsOneChange) {
    Session session = on("ball_down_a_wave", "--continue b=0.04:0.06");
    const auto found = session.orbit();
    ASSERT_TRUE(found && found->answer.branch);
    ASSERT_GT(found->count(), 3u);
    EXPECT_EQ(found->point(found->first()).parameters, session.run().parameters);
    for (std::size_t i = 0; i < found->count(); ++i) {
        session.apply(command::SelectBranchPoint{static_cast<int>(i) + 1});
        ASSERT_EQ(session.error(), "");
        ASSERT_EQ(session.orbit_point(), i);
        EXPECT_EQ(*session.value("b"), found->answer.branch->value(found->point(i)));
        EXPECT_LT(missed(session, found->point(i).period, 2.0 * M_PI), 1e-7) << i;
    }
    session.apply(command::Undo{});
    EXPECT_EQ(session.run(), session.file_run()) << "a slider that is dragged is one change";
    session.apply(command::SelectBranchPoint{0});
    EXPECT_NE(session.error().find("the branch has no point 0"), std::string::npos) << session.error();
    session.apply(command::SelectBranchPoint{static_cast<int>(found->count()) + 1});
    EXPECT_NE(session.error().find("numbered from 1 to"), std::string::npos) << session.error();
}

// The run with e = 0.6 finds the same orbit as that with e = 0.5: the search uses the slider values.
TEST(OrbitSession, SearchesFromThePresentRun) {
    Session session = test::session("ball_down_a_wave");
    session.apply(command::Set{"e", 0.6});
    session.apply(command::FindOrbit{"--from end"});
    ASSERT_EQ(session.error(), "");
    ASSERT_TRUE(session.orbit()->answer.orbit) << session.orbit()->answer.reason;
    EXPECT_EQ(session.orbit()->answer.orbit->parameters, session.run().parameters);
    EXPECT_GT(std::abs(period_of(session) - 3.544294646668781), 1e-5);
}

TEST(OrbitSession, ReportsInvalidRequestsAndFailedSearches) {
    Session session = test::session("ball_on_floor");
    for (const auto& [text, words] :
         {std::pair{"--continue q=0:1", "there is no parameter 'q'"},
          std::pair{"--from where", "start or end is expected"},
          std::pair{"--shift x", "a name and a value are expected"}, std::pair{"--over e=0:1", "not expected here"},
          std::pair{"--from start --from end", "it is given twice"}, std::pair{"--from", "a value is missing"},
          std::pair{"--period 0", "the period must be positive, but it is 0 s"}}) {
        session.apply(command::FindOrbit{text});
        EXPECT_NE(session.error().find(words), std::string::npos) << text << ": " << session.error();
        EXPECT_EQ(session.orbit(), nullptr);
    }
    session.apply(command::SelectBranchPoint{1});
    EXPECT_NE(session.error().find("no periodic run has been found yet"), std::string::npos) << session.error();
    session.apply(command::FindOrbit{""});
    EXPECT_EQ(session.error(), "");
    ASSERT_TRUE(session.orbit());
    EXPECT_FALSE(session.orbit()->answer.orbit);
    EXPECT_FALSE(session.orbit()->answer.reason.empty());
    EXPECT_NE(to_text(session).find("orbit : none, "), std::string::npos);
    session.apply(command::StopOrbit{});
    EXPECT_EQ(session.orbit(), nullptr);
}

TEST(OrbitSession, LeavesWithItsSystem) {
    Session session = on("ball_down_a_wave", "");
    session.apply(command::Open{"ball_on_sine"});
    EXPECT_EQ(session.orbit(), nullptr);
}

// The commands that lead to a session include its periodic orbit.
TEST(OrbitSession, IsFoundAgainByTheRecipe) {
    Session session = on("ball_down_a_wave", "--continue b=0.045:0.055");
    session.apply(command::SelectBranchPoint{2});
    Session again = test::session("ball_on_sine");
    for (const Command& step : recipe(session)) again.apply(step);
    EXPECT_EQ(again.error(), "");
    EXPECT_EQ(again.run(), session.run());
    ASSERT_TRUE(again.orbit() && again.orbit()->answer.branch);
    EXPECT_NEAR(period_of(again), session.orbit()->point(1).period, 1e-9);
    session.apply(command::Set{"e", 0.2});
    for (const Command& step : recipe(session)) EXPECT_NE(to_text(step).substr(0, 5), "orbit");
}

// With a timeout the search runs in the background; a stop request ends it.
TEST(OrbitSession, IsSearchedBesideTheWindow) {
    Session session = test::session("ball_down_a_wave");
    session.set_patience(0.0);
    session.apply(command::FindOrbit{"--continue e=0.1:0.9"});
    ASSERT_NE(session.orbit_under_way(), nullptr);
    EXPECT_EQ(session.orbit(), nullptr);
    session.apply(command::SelectBranchPoint{1});
    EXPECT_NE(session.error().find("under way"), std::string::npos) << session.error();
    session.apply(command::StopOrbit{});
    EXPECT_EQ(session.orbit_under_way(), nullptr);
    session.apply(command::FindOrbit{""});
    session.settle();
    ASSERT_TRUE(session.orbit());
    EXPECT_GT(period_of(session), 3.5);
}

TEST(OrbitSession, CommandsAreLinesOfAJournal) {
    for (const char* line : {"orbit \"--from start --shift \\\"x=2*pi\\\"\"", "orbit \"\"", "orbit off", "branch 12"})
        EXPECT_EQ(to_text(parse_command(line)), line);
}

// ---- user input ----

TEST(OrbitPanel, MakesTheRunPeriodic) {
    Hands hands("ball_down_a_wave");
    hands.press_with_control('6');
    hands.rest(2);
    EXPECT_TRUE(hands.says("returns to its start"));
    hands.click("make periodic");
    hands.session.settle();
    hands.rest(4);
    EXPECT_EQ(hands.session.orbit_point(), 0u);
    EXPECT_TRUE(hands.says("run is on the orbit"));
    EXPECT_TRUE(hands.says("period 3.544294647 s"));
    EXPECT_TRUE(hands.says("stable: perturbations shrink to 0.7014 of their size per period"));
    hands.session.apply(command::Set{"e", 0.55});
    hands.rest(3);
    EXPECT_TRUE(hands.says("run is off the orbit"));
}

TEST(OrbitPanel, GoesAlongTheBranch) {
    Hands hands("ball_down_a_wave", test::surface(1600, 1000));
    hands.session.apply(command::Set{"e", 0.3});
    hands.press_with_control('6');
    hands.rest(2);
    hands.click("orbit along");
    hands.click("orbit along b");  // starts the search
    hands.session.settle();
    hands.rest(4);
    const auto found = hands.session.orbit();
    ASSERT_TRUE(found && found->answer.branch);
    hands.click("branch", 0.02);
    EXPECT_EQ(hands.session.orbit_point(), 0u);
    hands.click("branch plot 1", 0.97);
    ASSERT_TRUE(hands.session.orbit_point());
    EXPECT_GT(*hands.session.orbit_point(), found->count() / 2);
    ASSERT_EQ(found->answer.branch->flips.size(), 1u);
    hands.click("orbit period doubling 1");
    EXPECT_NEAR(*hands.session.value("b"), found->answer.branch->value(found->answer.branch->flips[0]), 0.01);
    hands.click("tab events");
    EXPECT_FALSE(hands.session.scene().shows("orbit"));
}

// Prints positions for orbit_window_test.sh.
TEST(OrbitPanel, TellsWhereItIs) {
    Hands hands("ball_down_a_wave");
    hands.press_with_control('6');
    hands.rest(3);
    const Point button = hands.middle("make periodic");
    std::cout << "periodic " << std::lround(button.x) << " " << std::lround(button.y) << "\n";
}

}  // namespace
}  // namespace achilles
