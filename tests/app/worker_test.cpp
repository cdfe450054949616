// Runs on their own threads. This is the only test file that also runs under -fsanitize=thread.
#include "session/worker.hpp"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "app/hands.hpp"
#include "output/output.hpp"
#include "surface/interface.hpp"

namespace achilles {
namespace {

using namespace std::chrono_literals;

// A job that runs until it is stopped.
int endless(const std::stop_token& stop) {
    while (!stop.stop_requested()) std::this_thread::sleep_for(1ms);
    return -1;
}

TEST(Worker, GivesAResultOnce) {
    Worker<int> worker;
    EXPECT_FALSE(worker.take({})) << "nothing was asked for";
    worker.start([](const std::stop_token&) { return 7; });
    EXPECT_EQ(worker.take({}), 7);
    EXPECT_FALSE(worker.take({}));
}

TEST(Worker, ANewerJobStopsAnOlderOneWhoseResultIsNeverSeen) {
    std::atomic<int> stopped = 0;
    Worker<int> worker;
    for (int i = 0; i < 5; ++i) {
        worker.start([&](const std::stop_token& stop) {
            stopped += endless(stop) == -1 ? 1 : 0;
            return -1;
        });
        EXPECT_FALSE(worker.take(i == 0 ? 0.05 : 0.0));
    }
    worker.start([](const std::stop_token&) { return 3; });
    EXPECT_EQ(worker.take({}), 3);
    EXPECT_GE(stopped, 1) << "those that had not begun yet need no stopping";
}

TEST(Worker, RethrowsExceptionsOfAJob) {
    Worker<int> worker;
    worker.start([](const std::stop_token&) -> int { throw std::runtime_error("no"); });
    EXPECT_THROW(worker.take({}), std::runtime_error);
    worker.start([](const std::stop_token&) { return 1; });
    EXPECT_EQ(worker.take({}), 1);
}

TEST(Worker, TellsWhenAResultIsReadyAndEndsInTheMiddleOfAJob) {
    std::atomic<bool> told = false;
    {
        Worker<int> worker;
        worker.on_ready([&] { told = true; });
        worker.start([](const std::stop_token&) { return 1; });
        while (!told) std::this_thread::sleep_for(1ms);
        EXPECT_EQ(worker.take(0.0), 1);
        worker.start(endless);
        EXPECT_FALSE(worker.take(0.01));
    }
}

TEST(LiveSession, ShowsTheLastRunUntilTheNextIsThereAndEndsAsAPatientOne) {
    Session patient = test::session("ball_on_sine"), live = test::session("ball_on_sine");
    for (Session* session : {&patient, &live}) session->apply(command::SetEndTime{20000.0});
    live.set_patience(0.0);
    const std::string before = to_text(live.trajectory());
    for (Session* session : {&patient, &live}) {
        session->apply(command::Set{"e", 1.0});  // thousands of impacts
        session->apply(command::Seek{876.5});
    }
    ASSERT_NE(live.under_way(), nullptr) << "taken in by update() alone";
    for (int i = 0; i < 20000 && live.under_way() != nullptr; ++i) {
        EXPECT_EQ(live.run().parameters[2], 1.0) << "the sliders show what was asked for";
        EXPECT_TRUE(to_text(live.trajectory()) == before);
        std::this_thread::sleep_for(1ms);
        live.update();
    }
    EXPECT_EQ(live.under_way(), nullptr);
    // The error estimate is computed afterwards on another thread.
    for (int i = 0; i < 60000 && live.error_estimate() == nullptr; ++i) {
        std::this_thread::sleep_for(1ms);
        live.update();
    }
    EXPECT_TRUE(live.horizon()) << "choose a longer run";
    EXPECT_TRUE(to_text(live) == to_text(patient));
    EXPECT_EQ(live.time(), 876.5);
}

// All points of all plots, and of the trail; of a break the sign of its NaN does not count.
std::vector<Point> curve_points(const Session& session) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < session.plots().size(); ++i)
        for (const Curve& curve : session.drawn(i).curves)
            points.insert(points.end(), curve.points.begin(), curve.points.end());
    for (const WayPoint& point : session.trail().way) points.push_back(point.at);
    for (Point& point : points)
        if (!std::isfinite(point.x)) point = {-1e9, -1e9};
    return points;
}

bool have_same_curves(const Session& a, const Session& b) {
    const std::vector<Point> of_a = curve_points(a), of_b = curve_points(b);
    return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                      [](const Point& p, const Point& q) { return p.x == q.x && p.y == q.y; });
}

// Only the curves of a long run are coarse, and only at first.
TEST(LiveSession, ALongRunHasCoarseCurvesFirst) {
    Session patient = test::session("ball_on_sine"), live = test::session("ball_on_sine");
    live.set_patience(20.0);
    for (Session* session : {&patient, &live}) session->apply(command::SetEndTime{200.0});
    EXPECT_FALSE(live.has_coarse_curves()) << "a short run is exact at once";
    EXPECT_TRUE(have_same_curves(live, patient));
    for (Session* session : {&patient, &live}) session->apply(command::SetEndTime{2000.0});
    EXPECT_FALSE(patient.has_coarse_curves());
    ASSERT_TRUE(live.has_coarse_curves());
    EXPECT_TRUE(to_text(live.trajectory()) == to_text(patient.trajectory()));
    EXPECT_LT(4 * curve_points(live).size(), curve_points(patient).size());
    EXPECT_GT(curve_points(live).size(), 500u);
    EXPECT_EQ(live.error_estimate(), nullptr) << "it would delay the coarse curves";
    live.update();
    EXPECT_TRUE(live.has_coarse_curves()) << "they are not on the screen before the next update";
    for (int i = 0; i < 20000 && (live.has_coarse_curves() || live.error_estimate() == nullptr); ++i) {
        live.update();
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_TRUE(have_same_curves(live, patient));
    EXPECT_NE(live.error_estimate(), nullptr);
    EXPECT_TRUE(to_text(live) == to_text(patient));
    for (std::size_t i = 0; i < live.plots().size(); ++i) EXPECT_EQ(live.plots()[i].y.high, patient.plots()[i].y.high);
}

TEST(LiveSession, WhatLeavesItHasNoCoarseCurves) {
    Session patient = test::session("ball_on_sine"), live = test::session("ball_on_sine");
    live.set_patience(20.0);
    for (Session* session : {&patient, &live}) session->apply(command::SetEndTime{2000.0});
    ASSERT_TRUE(live.has_coarse_curves());
    for (Session* session : {&patient, &live}) session->apply(command::Copy{"plots"});
    EXPECT_FALSE(live.has_coarse_curves());
    EXPECT_TRUE(have_same_curves(live, patient));
    for (Session* session : {&patient, &live}) session->apply(command::Set{"e", 0.45});
    ASSERT_TRUE(live.has_coarse_curves());
    patient.apply(command::Copy{"plots"});
    live.set_patience(0.0);
    live.apply(command::SetEndTime{20000.0});
    live.apply(command::Copy{"plots"});
    ASSERT_NE(live.under_way(), nullptr);
    EXPECT_FALSE(live.has_coarse_curves()) << "nor while another run is under way";
    EXPECT_TRUE(have_same_curves(live, patient));
}

// A zoom meanwhile is kept, and another value stops the exact curves of the last one.
TEST(LiveSession, ACommandDuringCoarseCurvesCounts) {
    Session patient = test::session("ball_on_sine"), live = test::session("ball_on_sine");
    live.set_patience(20.0);
    for (Session* session : {&patient, &live}) {
        session->apply(command::SetEndTime{2000.0});
        session->apply(command::Zoom{1, 100.0, 200.0, 10.0, 12.0});
    }
    ASSERT_TRUE(live.has_coarse_curves());
    live.settle();
    EXPECT_TRUE(have_same_curves(live, patient));
    for (const double e : {0.4, 0.45}) {
        for (Session* session : {&patient, &live}) session->apply(command::Set{"e", e});
        for (int i = 0; i < 3; ++i) live.update();  // the exact curves have begun
    }
    live.settle();
    EXPECT_FALSE(live.has_coarse_curves());
    EXPECT_TRUE(have_same_curves(live, patient));
}

// Before it they would slow its picture down. A window updates the session twice until it shows a run.
TEST(LiveSession, EstimatesAndProvesWhatIsOnTheScreen) {
    std::atomic<int> results = 0;
    Session session = test::session("ball_on_sine");
    session.prove_behind();
    session.set_patience(20.0);
    session.apply(command::Set{"e", 0.45});
    std::this_thread::sleep_for(500ms);  // long enough for an estimate, if it had begun
    session.on_ready([&] { ++results; });
    session.update();
    EXPECT_EQ(session.error_estimate(), nullptr);
    std::this_thread::sleep_for(500ms);
    EXPECT_EQ(results, 0) << "nothing begins at the first update";
    for (int i = 0; i < 20000 && session.shown_proof() == nullptr; ++i) {
        session.update();
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_NE(session.error_estimate(), nullptr);
    EXPECT_NE(session.shown_proof(), nullptr);
}

TEST(LiveSession, ANewerValueCancelsALongRun) {
    Session session = test::session("ball_on_sine");
    session.set_patience(0.02);
    test::ask_for_a_long_run(session);
    ASSERT_NE(session.under_way(), nullptr) << "choose a longer run";
    for (int i = 0; i < 5000 && session.under_way()->impacts < 100; ++i) std::this_thread::sleep_for(1ms);
    EXPECT_GE(session.under_way()->impacts, 100);
    session.set_patience(5.0);
    session.apply(command::SetEndTime{20.0});
    session.apply(command::Set{"e", 0.5});
    EXPECT_EQ(session.under_way(), nullptr);
    EXPECT_EQ(session.trajectory().run.parameters[2], 0.5);
    EXPECT_EQ(session.trajectory().outcome.kind, Outcome::Kind::end_time);
}

TEST(LiveSession, WaitsNoLongerThanItsPatience) {
    Session session = test::session("ball_on_sine");
    session.set_patience(0.02);
    test::ask_for_a_long_run(session);
    for (int i = 0; i < 10; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        session.apply(command::Set{"g", 1.0 + 0.1 * i});
        session.update();
        // The whole run takes seconds; a busy machine may delay this thread.
        EXPECT_LT(std::chrono::steady_clock::now() - begin, 500ms);
        ASSERT_NE(session.under_way(), nullptr);
    }
}

TEST(LiveSession, AValueThatCannotStartIsRefusedAtOnce) {
    Session session = test::session("ball_on_sine");
    session.set_patience(0.0);
    session.apply(command::Set{"y", -5.0});
    EXPECT_NE(session.error(), "");
    EXPECT_EQ(session.under_way(), nullptr);
    EXPECT_EQ(session.run().q[1], 2.0);
}

TEST(LiveSession, ShowsTheStartOfAnotherSystemUntilItsRunIsThere) {
    Session session = test::session("ball_on_sine");
    session.set_patience(0.0);
    session.apply(command::Seek{5.0});
    session.apply(command::Open{"double_pendulum"});
    EXPECT_EQ(session.description().coordinates[0].name, "theta1");
    EXPECT_EQ(session.now().state.q.size(), session.run().q.size());
    EXPECT_EQ(session.plots().size(), 4U);
    for (int i = 0; i < 20000 && session.under_way() != nullptr; ++i) {
        EXPECT_EQ(session.trajectory().end_time, 0.0);
        EXPECT_EQ(session.now().state.q, session.run().q);
        std::this_thread::sleep_for(1ms);
        session.update();
    }
    EXPECT_EQ(to_text(session), to_text(test::session("double_pendulum")));
}

// As in the window: frames are drawn while the run is computed, each of them complete, and then the result arrives.
TEST(LiveSession, FramesGoOnDuringARunOf100000Impacts) {
    Interface interface(test::surface());
    const Interface::Active active(interface);
    Session session = test::session("ball_on_floor");
    session.set_patience(0.0);
    session.apply(command::Set{"e", 1.0});
    session.apply(command::SetEndTime{100000.0});
    PanelState panels = test::panels();
    int frames = 0;
    for (bool is_done = false; !is_done && frames < 20000; ++frames) {
        is_done = session.under_way() == nullptr;
        apply(Input{});
        const ImDrawData& data = interface.frame([&] { explorer(session, panels); }, 1280, 800, 1.0 / 60.0);
        EXPECT_GT(data.TotalVtxCount, 1000);
        session.update();
    }
    EXPECT_GT(frames, 2) << "the run was waited for";
    EXPECT_EQ(session.trajectory().outcome.kind, Outcome::Kind::end_time);
    EXPECT_GE(session.trajectory().statistics.impacts, 100000);
}

// For a new system whose run is under way only the start is shown, without results; for another value the previous run.
TEST(LiveSession, NothingIsSaidOfARunThatIsNotFinished) {
    int times = 0;
    for (const char* shown : {"equations", "energy", "events"}) {
        test::Hands hands("ball_on_sine");
        hands.session.apply(command::Show{shown, true});
        hands.session.apply(command::SetEndTime{20000.0});
        hands.session.apply(command::Pin{});
        hands.session.set_patience(0.0);
        hands.session.apply(command::Set{"e", 1.0});
        hands.rest(2);
        ASSERT_NE(hands.session.under_way(), nullptr);
        std::string letters = hands.letters();
        EXPECT_NE(letters.find("thepreviousrunisshownuntilthen"), std::string::npos) << letters;
        EXPECT_EQ(letters.find("bouncesneverdieout"), std::string::npos) << "the run that is seen has e = 0.5";
        hands.session.apply(command::Open{"double_pendulum"});
        if (hands.session.under_way() == nullptr) continue;  // a short run may be finished at once
        ++times;
        hands.rest(2);
        letters = hands.letters();
        for (const char* said : {"therunbeforethisone", "cancelled", "stopped", "noZenopoint", "bouncesout", "never",
                                 "Zeno1", "certifiedto"})
            EXPECT_EQ(letters.find(said), std::string::npos) << shown << ": " << said << ": " << letters;
    }
    EXPECT_GT(times, 0);
}

// The remaining time is shown in a window, not in a picture, which must not depend on the clock.
TEST(LiveSession, SaysHowLongARunStillTakes) {
    EXPECT_EQ(time_left(0.2, 0.5), "") << "too early to tell";
    EXPECT_EQ(time_left(10.0, 0.0), "");
    EXPECT_EQ(time_left(2.0, 0.9), "about 1 s left");
    EXPECT_EQ(time_left(4.0, 0.25), "about 12 s left");
    EXPECT_EQ(time_left(10.0, 0.2), "about 40 s left");
    EXPECT_EQ(time_left(60.0, 0.1), "about 9 min left");
    EXPECT_EQ(time_left(60.0, 0.002), "about 8 h left");
    EXPECT_EQ(time_left(600.0, 0.002), "more than a day left");
    test::Hands hands("ball_on_sine");
    hands.session.set_patience(0.02);
    test::ask_for_a_long_run(hands.session);
    const RunMonitor* const watch = hands.session.under_way();
    ASSERT_NE(watch, nullptr);
    for (int i = 0; i < 1000 && (hands.session.seconds_under_way() < 0.6 || watch->impacts < 3000); ++i)
        std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(hands.says("left")) << "this surface is no window";
    hands.state.in_window = true;
    EXPECT_TRUE(hands.says("left")) << hands.letters();
}

TEST(LiveSession, ClosesInTheMiddleOfARun) {
    const auto begin = std::chrono::steady_clock::now();
    {
        Session session = test::session("ball_on_sine");
        session.set_patience(0.02);
        test::ask_for_a_long_run(session);
        ASSERT_NE(session.under_way(), nullptr);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
}

}  // namespace
}  // namespace achilles
