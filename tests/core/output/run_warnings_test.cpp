// Warnings about how a run was made: each is given once, and is true.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/systems.hpp"
#include "output/output.hpp"

namespace achilles {
namespace {

// A drop from 2e-7 m: the first impact is below eps_q = 1e-6, so the whole bouncing is cut.
TEST(RunWarnings, ABoundAsLargeAsTheMotion) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    assign(run, floor->description(), "y=0.0600002");
    assign(run, floor->description(), "y'=0");
    run.options.end_time = 0.1;
    const std::vector<RunWarning> large = remarks(simulate(floor, run));
    ASSERT_GE(large.size(), 1u);
    EXPECT_NE(large[0].sentence.find("eps_q = 1e-06 is large for this motion: the impact sequence was cut at its first "
                                     "impact, t = 0.000201"),
              std::string::npos)
        << large[0].sentence;
    EXPECT_EQ(nlohmann::json::parse(to_json(simulate(floor, run)))["warnings"][0], large[0].sentence);
    EXPECT_NE(large[0].sentence.find("the gap never exceeds 2e-07: try --eps 1e-11"), std::string::npos)
        << large[0].sentence;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-11;
    const Trajectory better = simulate(floor, run);
    EXPECT_GT(better.statistics.impacts, 3);
    for (const RunWarning& remark : remarks(better)) EXPECT_NE(remark.label, large[0].label);
}

// Certificates start from the computed state. If that has a larger error, their interval means little.
TEST(RunWarnings, ALooseTolerance) {
    const auto ball = test::load("ball_on_sine");
    auto run = ball->default_run();
    const Trajectory trajectory = simulate(ball, run);
    run.options.tolerance = 1e-3;
    const Trajectory loose = simulate(ball, run);
    const std::vector<RunWarning> said = remarks(loose);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].sentence.find("may have shifted this time by"), std::string::npos);
    const auto zeno_of = [](const Trajectory& of) {
        return *std::find_if(of.events.rbegin(), of.events.rend(),
                             [](const Event& e) { return e.kind == Event::Kind::zeno; });
    };
    EXPECT_LT(zeno_of(trajectory).t, zeno_of(loose).certificate->zeno_low);  // it is indeed outside
    EXPECT_TRUE(remarks(trajectory).empty());
}

// Sliding along the surface does not count as omitted bounces.
TEST(RunWarnings, SlidingIsNoBouncing) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    run.options.truncation.conditions = Conditions::paper;
    assign(run, floor->description(), "y=0.06001");
    assign(run, floor->description(), "x'=0.5");
    run.options.end_time = 0.1;
    for (const RunWarning& remark : remarks(simulate(floor, run))) EXPECT_NE(remark.label, "eps is large here");
}

// Bouncing below the resolution of double precision is cut anyway. Then the tolerances eps are reported as not met.
TEST(RunWarnings, AnEpsThatIsNotMet) {
    const auto ball = test::load("ball_on_sine");
    auto run = ball->default_run();
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-15;
    run.options.tolerance = 1e-14;
    const Trajectory fine = simulate(ball, run);
    const auto missed = std::find_if(fine.events.begin(), fine.events.end(), [](const Event& event) {
        return event.certificate && event.certificate->cut_at_resolution &&
               event.certificate->decision->closest().left > event.certificate->decision->closest().right;
    });
    ASSERT_NE(missed, fine.events.end());
    const std::string told = sentence(*missed->certificate, ball->description());
    EXPECT_NE(told.find("the truncation criterion is not met: "), std::string::npos) << told;
    EXPECT_EQ(told.find("least room"), std::string::npos) << told;
    const std::vector<RunWarning> said = remarks(fine);
    EXPECT_EQ(std::count_if(said.begin(), said.end(), [](const RunWarning& r) { return r.label == "eps is not met"; }),
              1);
}

// A run that ends between a cut and its Zeno point does not have that event yet.
TEST(RunWarnings, AnEndBeforeTheZenoPoint) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    const Trajectory whole = simulate(floor, run);
    const auto zeno = std::find_if(whole.events.begin(), whole.events.end(),
                                   [](const Event& e) { return e.kind == Event::Kind::zeno; });
    ASSERT_NE(zeno, whole.events.end());
    EXPECT_TRUE(remarks(whole).empty());
    run.options.end_time = 0.5 * (zeno->truncation->t + zeno->t);
    const std::vector<RunWarning> told = remarks(simulate(floor, run));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].sentence.find(fmt::format("between a cut, t = {:.9g}, and its Zeno point", zeno->truncation->t)),
              std::string::npos)
        << told[0].sentence;
    run.options.end_time = zeno->truncation->t - 1e-3;
    EXPECT_TRUE(remarks(simulate(floor, run)).empty());
}

// A run that stops at a release is not before a Zeno point: its last phase is still empty.
TEST(RunWarnings, AnEndAtARelease) {
    Trajectory trajectory = simulate(test::load("ball_on_sine"), test::load("ball_on_sine")->default_run());
    std::size_t release = 0, phase = 0;
    while (trajectory.events[release].kind != Event::Kind::release) ++release;
    while (trajectory.phases[phase].kind != Phase::Kind::constrained) ++phase;
    trajectory.events.resize(release + 1);
    trajectory.pieces.resize(trajectory.phases[phase].last_piece);
    trajectory.phases.resize(phase + 2);
    trajectory.phases.back().last_piece = trajectory.phases.back().first_piece;
    trajectory.phases.back().end = trajectory.phases.back().start;
    trajectory.end_time = trajectory.pieces.back().end;
    ASSERT_FALSE(trajectory.pieces.back().mode.held().empty());
    ASSERT_TRUE(trajectory.phases.back().mode.held().empty());
    for (const RunWarning& remark : remarks(trajectory)) EXPECT_NE(remark.label, "ends before a Zeno point");
}

// A plastic impact omits no bounces.
TEST(RunWarnings, AnEndAtALanding) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    assign(run, floor->description(), "e=0");
    const Trajectory whole = simulate(floor, run);
    ASSERT_FALSE(whole.events.empty());
    run.options.end_time = whole.events[0].t;
    for (const RunWarning& remark : remarks(simulate(floor, run))) EXPECT_NE(remark.label, "ends before a Zeno point");
}

// The same if a later impact is cut, while the certified bound is large relative to the motion.
TEST(RunWarnings, ABoundAsLargeAsTheMotionAfterSeveralImpacts) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    assign(run, floor->description(), "y=0.06002");  // 2e-5 m above
    assign(run, floor->description(), "y'=0");
    assign(run, floor->description(), "e=0.7");
    run.options.end_time = 0.1;
    const std::vector<RunWarning> large = remarks(simulate(floor, run));
    ASSERT_GE(large.size(), 1u);
    EXPECT_NE(large[0].sentence.find("the impact sequence was cut after "), std::string::npos) << large[0].sentence;
}

}  // namespace
}  // namespace achilles
