// Regression tests of events that were once missed or decided wrongly: releases in a dip of the contact force, low
// impacts, impacts below the floor, ambiguities reported at the wrong place, and states that could not be moved onto
// the surface.
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "simulate/batch.hpp"
#include "simulate/impact.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

using test::model_of, test::PlaneSystem;

Run with(const Model& model, Method method, double tolerance) {
    Run run = model.default_run();
    run.options.method = method;
    run.options.tolerance = tolerance;
    return run;
}

using test::count;

constexpr double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-13};

// The smallest contact force is -0.3 of a tolerance of 1e-6, and a step ends within that dip.
const PlaneSystem crest{.gap = "b - 0.25*cos(a)",
                        .a = -1.1410500000000001,
                        .b = 0.10416005219094915,
                        .a_rate = 2.0201237165063586,
                        .b_rate = 0.45910920882362767,
                        .end = 0.77};

TEST(Decisions, AReleaseInADipOfTheForceIsNotMissed) {
    const auto model = model_of(crest);
    for (const Method method : test::both_methods)
        for (const double tolerance : tolerances) {
            const Trajectory trajectory = simulate(model, with(*model, method, tolerance));
            if (trajectory.outcome.kind == Outcome::Kind::undecided) continue;
            EXPECT_EQ(count(trajectory, Event::Kind::release), 1u) << to_text(method) << ", " << tolerance;
            EXPECT_EQ(count(trajectory, Event::Kind::impact), 5u) << to_text(method) << ", " << tolerance;
        }
    const Trajectory usual = simulate(model, with(*model, Method::taylor, 1e-6));
    EXPECT_EQ(usual.outcome.kind, Outcome::Kind::end_time) << usual.outcome.message;
}

TEST(Decisions, BatchesDoNotMissAReleaseInADipOfTheForce) {
    const auto model = model_of(crest);
    for (const double tolerance : tolerances) {
        const auto run = with(*model, Method::taylor, tolerance);
        simulate_ends(
            model, 1, [&](std::size_t) { return run; },
            [&](std::size_t, RunResult&& attempt) {
                const auto& trajectory = std::get<Trajectory>(attempt);
                if (trajectory.outcome.kind == Outcome::Kind::undecided) return;
                EXPECT_EQ(trajectory.statistics.impacts, 5) << tolerance;
            },
            1);
    }
}

// hddot approaches zero, so a low bounce lasts long. The two runs have 7 impacts, and 4 with a last speed of 2.6e-7.
TEST(Decisions, LowImpactsAreFoundOrInDoubt) {
    const PlaneSystem seven{.kinetic = "0.9453125*(a'^2 + b'^2)",
                            .potential = "1.890625*b - 0.296875*a",
                            .gap = "b - 0.023681640625*sin(8.078125*a) - 0.09375*cos(1.484375*a)",
                            .e = "0.0625",
                            .a = 1.0480548592173542,
                            .b = 1.2339401331589663,
                            .a_rate = -1.7332196105057307,
                            .b_rate = -1.1107608947996346,
                            .end = 0.9508598332279208};
    const PlaneSystem four{.kinetic = "0.3046875*a'^2 + 0.4375*b'^2",
                           .potential = "0.875*b - 0.296875*a",
                           .gap = "b - 0.08642578125*sin(5.875*a) + 0.21875*cos(0.875*a)",
                           .e = "0.0625",
                           .a = -0.66499660396276272,
                           .b = 0.78582978907778978,
                           .a_rate = 1.4581090508588603,
                           .b_rate = -1.3785151046714215,
                           .end = 1.94655};
    for (const auto& [plane, impacts] : {std::pair{seven, 7u}, {four, 4u}}) {
        const auto model = model_of(plane);
        for (const Method method : test::both_methods)
            for (const double tolerance : {1e-8, 1e-9, 1e-10, 1e-13}) {
                const Trajectory trajectory = simulate(model, with(*model, method, tolerance));
                if (trajectory.outcome.kind == Outcome::Kind::undecided) continue;
                EXPECT_EQ(count(trajectory, Event::Kind::impact), impacts) << to_text(method) << ", " << tolerance;
            }
    }
}

// After a cut, the contact force dips to less than the cut's error (1e-10). The true motion is released for an instant
// at t = 0.74854; the computed one would stay in contact until 0.92694.
TEST(Decisions, ErrorOfACutDecidesNoRelease) {
    const auto model =
        model_of({.kinetic = "0.5498046875*a'^2 + 0.482421875*b'^2",
                  .potential = "1.462890625*b - 0.30517578125*a",
                  .gap = "b - 0.00121307373046875*sin(34.666259765625*a) - 0.2373046875*cos(1.49609375*a)",
                  .e = "0.0625",
                  .a = -0.35020769547921282,
                  .b = 0.24183519816013632,
                  .a_rate = 0.85542267914520842,
                  .b_rate = -0.91234390916457708,
                  .end = 1.3823409117317282});
    for (const double tolerance : tolerances) {
        const Trajectory trajectory = simulate(model, with(*model, Method::taylor, tolerance));
        const auto releases = test::events_of(trajectory, Event::Kind::release);
        if (releases.empty()) {
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided) << tolerance;
        } else {
            EXPECT_NEAR(releases[0].t, 0.7485, 1e-4) << tolerance;
        }
    }
}

// The last step ends below the floor by more than the error at tolerance 1e-4. The run is redone at a tighter
// tolerance.
TEST(Decisions, ARunDoesNotEndUnderTheFloor) {
    const auto model = model_of({.kinetic = "0.604248046875*(a'^2 + b'^2)",
                                 .potential = "1.26025390625*b + 0.4189453125*a",
                                 .gap = "b - 0.005596160888671875*sin(49.696044921875*a) - "
                                        "0.021240234375*cos(0.577392578125*a)",
                                 .e = "0.8",
                                 .a = 0.17209538869403804,
                                 .b = 0.025421120637304569,
                                 .a_rate = -1.3863676384596546,
                                 .b_rate = 0.24962142206433918,
                                 .end = 2.2559460269367495});
    for (const double tolerance : tolerances) {
        const Trajectory trajectory = simulate(model, with(*model, Method::taylor, tolerance));
        EXPECT_EQ(count(trajectory, Event::Kind::impact), 2u) << tolerance;
        EXPECT_GE(trajectory.statistics.least_gap, -1e-12) << tolerance;
    }
}

TEST(Decisions, NoImpactIsStoredUnderTheFloor) {
    const auto model = test::load("double_pendulum");
    auto run = model->default_run();
    run.q << -0.16239388192238202, 0.92954240928458709;
    run.v << 0.36799511273198648, -1.1148232405731877;
    run.options.end_time = 4.0;
    for (const Method method : test::both_methods)
        for (const double tolerance : tolerances) {
            run.options.method = method;
            run.options.tolerance = tolerance;
            const Trajectory trajectory = simulate(model, run);
            EXPECT_GE(count(trajectory, Event::Kind::impact), 3u);
            for (const Event& event : trajectory.events) EXPECT_GE(event.q[1], -1e-15) << to_text(method) << tolerance;
            // No run ends there, although the integrated gap may be wrong by as much as the tolerance.
            EXPECT_GE(trajectory.statistics.least_gap, -1e-15) << to_text(method) << tolerance;
        }
}

// A wall so steep that the Taylor series at the start, truncated where its terms are small, misses it. One step leads
// into the wall, where h(q) < 0 although the series of the gap gives 1/2. The impact is at h(q) = 0: a^power = 1/2. The
// 60th power is missed at exact_tolerance too, where no tighter run can find the impact instead.
TEST(Decisions, NoStepEndsInsideASteepWall) {
    for (const int power : {20, 60})
        for (const double end : {0.9, 0.95, 1.0}) {
            const auto model = model_of({.potential = "0",
                                         .gap = fmt::format("b - a^{}", power),
                                         .e = "0.1",
                                         .a = 0.1,
                                         .b = 0.5,
                                         .a_rate = 1.0,
                                         .end = end});
            for (const double tolerance : {1e-10, 1e-14}) {
                const Trajectory trajectory = simulate(model, with(*model, Method::taylor, tolerance));
                EXPECT_GE(trajectory.statistics.least_gap, -1e-12) << end;
                ASSERT_GE(count(trajectory, Event::Kind::impact), 1u) << end << ": " << trajectory.outcome.message;
                EXPECT_NEAR(trajectory.events[0].t, std::pow(0.5, 1.0 / power) - 0.1, 1e-9) << end;
                EXPECT_NEAR(trajectory.events[0].q[1], 0.5, 1e-9) << end;
            }
        }
}

// A series far from a thin post misses it, too. The post is monitored as an Edge: exp(-400 (a - 1)^2) = 1/2.
TEST(Decisions, NoStepPassesThroughAThinPost) {
    for (const double steep : {400.0, 200.0})
        for (const double end : {0.97, 0.99, 1.0, 1.02, 3.0}) {
            const auto model = model_of({.potential = "0",
                                         .gap = fmt::format("b - exp(-{}*(a - 1)^2)", steep),
                                         .b = 0.5,
                                         .a_rate = 1.0,
                                         .end = end});
            const Trajectory trajectory = simulate(model, model->default_run());
            ASSERT_GE(count(trajectory, Event::Kind::impact), 1u) << end << ": " << trajectory.outcome.message;
            EXPECT_NEAR(trajectory.events[0].t, 1.0 - std::sqrt(std::log(2.0) / steep), 1e-9) << end;
            EXPECT_NEAR(trajectory.events[0].q[1], 0.5, 1e-9) << end;
        }
}

// A dip that leaves the remainder's range at the end of a step, within rounding, begins where it enters that range.
TEST(Decisions, ADipUpToTheEndOfAStepIsNotPassedOver) {
    for (const double place : {4.9390187770179645, 4.9390187796429652}) {
        const auto model = model_of({.potential = "0",
                                     .gap = fmt::format("b + (2*(1 - cos(a - {})) - 2.9999999999999998e-15)", place),
                                     .a_rate = 1.0,
                                     .end = 8.0});
        const Trajectory trajectory = simulate(model, with(*model, Method::taylor, 1e-14));
        if (trajectory.outcome.kind == Outcome::Kind::undecided) {
            EXPECT_NEAR(trajectory.end_time, place, 1e-3);
        } else {
            EXPECT_EQ(count(trajectory, Event::Kind::impact), 1u) << place << ": " << trajectory.outcome.message;
        }
    }
}

// A dip to 1e-12 at t = 1 is reported as undecided there, or decided at tolerance 1e-14.
TEST(Decisions, UndecidedEventsAreReportedAtTheirTime) {
    const auto cut_at_resolution = model_of(
        {.kinetic = "1/2*(a'^2 + b'^2)", .potential = "0", .gap = "b + (a - 1)^2 - 1e-16", .a_rate = 1.0, .end = 2.0});
    const Trajectory undecided = simulate(cut_at_resolution, cut_at_resolution->default_run());
    ASSERT_EQ(undecided.outcome.kind, Outcome::Kind::undecided);
    EXPECT_NEAR(undecided.end_time, 1.0, 1e-5);
    EXPECT_GT(undecided.end_time, 0.99);
    EXPECT_NE(undecided.outcome.message.find("just after t = 0.99999"), std::string::npos) << undecided.outcome.message;

    const auto known = model_of({.potential = "0", .gap = "b + (a - 1)^2 - 1e-12", .a_rate = 1.0, .end = 2.0});
    const Trajectory decided = simulate(known, known->default_run());
    EXPECT_EQ(decided.outcome.kind, Outcome::Kind::end_time) << decided.outcome.message;
    ASSERT_EQ(count(decided, Event::Kind::impact), 1u);
    EXPECT_NEAR(decided.events[0].t, 1.0 - 1e-6, 1e-9);
}

// V = a b on the floor b = 0: the contact force is a, which starts at zero and grows.
TEST(Decisions, AForceThatStartsFromZeroAndRisesHolds) {
    const auto model = model_of({.potential = "a*b", .a_rate = 1.0, .end = 2.0});
    for (const Method method : test::both_methods) {
        const Trajectory trajectory = simulate(model, with(*model, method, 1e-10));
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        ASSERT_EQ(trajectory.phases.size(), 1u);
        EXPECT_EQ(trajectory.phases[0].kind, Phase::Kind::constrained);
        EXPECT_NEAR(trajectory.end.q[0], 2.0, 1e-9);
    }
    const auto falling = model_of({.potential = "a*b", .a_rate = -1.0, .end = 1.0});
    const Trajectory leaves = simulate(falling, falling->default_run());
    EXPECT_EQ(leaves.phases[0].kind, Phase::Kind::hybrid);
    EXPECT_EQ(leaves.outcome.kind, Outcome::Kind::end_time) << leaves.outcome.message;
}

TEST(Decisions, TimeNeverRunsBack) {
    for (const std::string& system : test::all_systems()) {
        const auto model = test::load(system);
        for (const Method method : test::both_methods) {
            const Trajectory trajectory = simulate(model, with(*model, method, 1e-8));
            double t = 0.0;
            for (const Sample& sample : Sampler(trajectory).all(1)) {
                EXPECT_GE(sample.t, t) << system;
                t = sample.t;
            }
            std::size_t piece = 0;
            for (const Event& event : trajectory.events) {
                while (piece < trajectory.pieces.size() && trajectory.pieces[piece].start < event.t) ++piece;
                if (piece > 0) {
                    EXPECT_LE(trajectory.pieces[piece - 1].end, event.t) << system << ", " << event.t;
                }
            }
            EXPECT_LE(trajectory.end_time, trajectory.run.options.end_time) << system;
        }
    }
}

// A ball lands at t and stays until the end of the run. In floating point t + (end - t) may be the double after or
// before the end. The heights and ends here include both cases; the run must end exactly at the end time.
TEST(Decisions, RunEndsExactlyAtTheEndTime) {
    const auto model = model_of({.e = "0", .b = 1.0});
    auto run = model->default_run();
    int past = 0, before = 0;
    for (int i = 60; i <= 180; ++i)
        for (const double end : {3.9, std::nextafter(3.9, 4.0)}) {
            run.q[1] = 0.01 * i;
            run.options.end_time = end;
            const Trajectory trajectory = simulate(model, run);
            ASSERT_EQ(trajectory.events.size(), 2u);
            const double t = trajectory.events[1].t, sum = t + (end - t);
            if (sum > end) ++past;
            if (sum < end) ++before;
            EXPECT_EQ(trajectory.end_time, end) << run.q[1];
            ASSERT_FALSE(trajectory.pieces.empty());
            EXPECT_EQ(trajectory.pieces.back().end, end) << run.q[1];
        }
    EXPECT_GE(past, 5);
    EXPECT_GE(before, 5);
}

// dh vanishes on none of these surfaces.
TEST(Decisions, AProductOfGapsIsAGap) {
    for (const char* gap :
         {"(2 + sin(a))*b", "b/(1 + a^2)", "b*exp(a)", "b*(9 - a)", "(b - 0.1*sin(a))*(2 + cos(a))"}) {
        for (int i = 0; i < 10; ++i) {
            const auto model = model_of({.gap = gap, .e = "0.6", .a = -0.5, .b = 1.0, .a_rate = 0.05 * i, .end = 8.0});
            for (const Method method : test::both_methods) {
                const Trajectory trajectory = simulate(model, with(*model, method, 1e-10));
                EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time)
                    << gap << ", " << i << ": " << trajectory.outcome.message;
                EXPECT_EQ(count(trajectory, Event::Kind::zeno), 1u) << gap << ", " << i;
            }
        }
    }
}

TEST(Decisions, AVanishingGradientIsStillTold) {
    const auto model = model_of({.gap = "b^2", .b = 1.0, .end = 5.0});
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_NE(trajectory.outcome.kind, Outcome::Kind::end_time);
}

}  // namespace
}  // namespace achilles
