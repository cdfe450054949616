// Possible starts and ends of runs, energy, and monitoring from another thread.
#include "simulate/simulate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <thread>

#include "core/systems.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

using test::Problem;

TEST(Restitution, FourValuesThatBrokeCarefulCode) {
    const auto model = test::load("ball_on_sine");
    const auto expected = test::reference("ball_restitution");
    for (const char* e : {"0.35", "0.46", "0.505", "0.52"}) {
        auto run = model->default_run();
        assign(run, model->description(), std::string("e=") + e);
        const Trajectory trajectory = simulate(model, run);
        const auto zenos = test::events_of(trajectory, Event::Kind::zeno);
        const auto releases = test::events_of(trajectory, Event::Kind::release);
        ASSERT_EQ(zenos.size(), 2u) << e;
        ASSERT_EQ(releases.size(), 1u) << e;
        EXPECT_NEAR(zenos[0].t, expected[e][0].get<double>(), 1e-6);
        EXPECT_NEAR(releases[0].t, expected[e][1].get<double>(), 1e-6);
        EXPECT_NEAR(zenos[1].t, expected[e][2].get<double>(), 1e-6);
    }
}

double energy(const Model& model, const Run& run, const State& state) {
    auto program = model.evaluator(model.energy(), run.parameters);
    set_state(program, state);
    program.run();
    return program.output(0);
}

TEST(Restitution, OneNeverTruncatesAndKeepsItsEnergy) {
    const auto elastic = test::load("ball_on_sine");
    auto run = elastic->default_run();
    assign(run, elastic->description(), "e=1");
    run.options.end_time = 1000.0;
    run.options.max_impacts = 200;
    const Trajectory trajectory = simulate(elastic, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::too_many_impacts);
    EXPECT_NE(trajectory.outcome.message.find("restitution 1"), std::string::npos) << trajectory.outcome.message;
    EXPECT_EQ(trajectory.statistics.impacts, 200);
    EXPECT_TRUE(test::events_of(trajectory, Event::Kind::zeno).empty());
    const double start = energy(*elastic, run, {run.q, run.v});
    EXPECT_NEAR(energy(*elastic, run, trajectory.end), start, 1e-8 * start);
}

TEST(Restitution, ZeroIsCapturedAtTheFirstImpactWithNegativeNormalAcceleration) {
    const auto plastic = test::load("ball_on_sine");
    auto run = plastic->default_run();
    assign(run, plastic->description(), "e=0");
    const Trajectory trajectory = simulate(plastic, run);
    ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    auto normal = plastic->evaluator(plastic->release_terms(), run.parameters);
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (event.kind != Event::Kind::impact) continue;
        set_state(normal, State{event.q, event.v_after});
        normal.run();
        const bool captured = i + 1 < trajectory.events.size() && trajectory.events[i + 1].kind == Event::Kind::zeno;
        EXPECT_EQ(captured, normal.hddot() < 0.0);
        if (captured) {
            EXPECT_EQ(event.t, trajectory.events[i + 1].t);
            EXPECT_EQ(event.v_after, trajectory.events[i + 1].truncation->v);
        }
    }
    ASSERT_GE(trajectory.events.size(), 3u);
    EXPECT_EQ(trajectory.events[1].kind, Event::Kind::impact);  // hddot > 0 at the first impact
    EXPECT_EQ(trajectory.events[2].kind, Event::Kind::zeno);
}

TEST(Energy, NeverRisesAtAnImpact) {
    for (const Problem& problem : test::problems) {
        const auto model = test::load(problem.asset);
        const auto run = model->default_run();
        const Trajectory trajectory = simulate(model, run);
        for (const Event& event : test::events_of(trajectory, Event::Kind::impact))
            EXPECT_LT(energy(*model, run, {event.q, event.v_after}), energy(*model, run, {event.q, event.v_before}));
    }
}

// ---- starts ----

const char* const floor_text = R"toml(
title = "Ball on a floor"
[[coordinate]]
name = "x"
[[coordinate]]
name = "y"
START
[[parameter]]
name = "g"
value = 1.0
[lagrangian]
kinetic = "1/2*(x'^2 + y'^2)"
potential = "g*y"
[[constraint]]
gap = "y"
restitution = 0.5
)toml";

Trajectory on_floor(const std::string& start, Conditions conditions = Conditions::paper) {
    std::string text = floor_text;
    text.replace(text.find("START"), 5, start);
    const auto model = test::typed(text);
    Run run = model->default_run();
    run.options.truncation.conditions = conditions;
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    return trajectory;
}

TEST(Starts, AtRestInContactStaysThere) {
    const Trajectory trajectory = on_floor("start = 0.0\nrate = 0.0");
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time);
    ASSERT_EQ(trajectory.phases.size(), 1u);
    EXPECT_EQ(trajectory.phases[0].kind, Phase::Kind::constrained);
    EXPECT_TRUE(trajectory.events.empty());
    EXPECT_EQ(trajectory.end.q[1], 0.0);
}

TEST(Starts, InACollisionBouncesAtOnce) {
    const Trajectory trajectory = on_floor("start = 0.0\nrate = -1.0");
    ASSERT_GE(trajectory.events.size(), 2u);
    EXPECT_EQ(trajectory.events[0].kind, Event::Kind::impact);
    EXPECT_EQ(trajectory.events[0].t, 0.0);
    EXPECT_NEAR(trajectory.events[1].t, 1.0, 1e-14);  // 2 e v/g
    // tau_inf = 2 e v1/(g (1 - e))
    EXPECT_NEAR(test::events_of(trajectory, Event::Kind::zeno).at(0).t, 2.0, 1e-12);
}

TEST(Starts, LeavingTheFloorDoesNotCountItsOwnStartAsAnImpact) {
    const Trajectory trajectory = on_floor("start = 0.0\nrate = 1.0");
    ASSERT_FALSE(trajectory.events.empty());
    EXPECT_NEAR(trajectory.events[0].t, 2.0, 1e-14);
}

TEST(Starts, AboveTheFloorEndsAtTheClosedFormZenoTime) {
    const Trajectory trajectory = on_floor("start = 0.5\nrate = 0.0");
    // t1 = 1, v1 = 1: tau_inf = t1 + 2 e v1/(g (1 - e)) = 3
    EXPECT_NEAR(test::events_of(trajectory, Event::Kind::zeno).at(0).t, 3.0, 1e-12);
    EXPECT_EQ(trajectory.end_phase, Phase::Kind::constrained);
}

// With constant hddot the sharp bounds are attained and the Zeno time is exact. Only the uniform bound determines the
// cut.
TEST(Starts, AboveAFlatFloorTheCertificateIsTheClosedForm) {
    const Trajectory trajectory = on_floor("start = 0.5\nrate = 0.0", Conditions::sharp);
    const Event zeno = test::events_of(trajectory, Event::Kind::zeno).at(0);
    EXPECT_EQ(zeno.impacts, 10);  // from a height of 0.5: 0.5/4^10 < 1e-6 < 0.5/4^9
    EXPECT_NEAR(*zeno.certificate->uniform_position, 0.5 * std::pow(0.25, 10), 1e-12);
    EXPECT_NEAR(zeno.t, 3.0, 1e-13);
    EXPECT_LE(zeno.certificate->zeno_high - zeno.certificate->zeno_low, 1e-12);
    EXPECT_LE(*zeno.certificate->shadowing_velocity, 1e-12);
}

TEST(Starts, BelowTheFloorIsRefused) { EXPECT_THROW(on_floor("start = -0.5"), InputError); }

// ---- sampling ----

TEST(Samples, TimesRiseAndStatesMeetTheEventsTheyBorder) {
    for (const Problem& problem : test::problems) {
        const auto model = test::load(problem.asset);
        const auto run = model->default_run();
        const Trajectory trajectory = simulate(model, run);
        Sampler sampler(trajectory);
        auto surface = model->evaluator(model->contact_terms(), run.parameters);
        const std::vector<Sample> samples = sampler.all(5);
        EXPECT_EQ(samples.front().t, 0.0);
        EXPECT_NEAR(samples.back().t, 20.0, 1e-12);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (i > 0) {
                EXPECT_GE(samples[i].t, samples[i - 1].t);
                EXPECT_GE(samples[i].j, samples[i - 1].j);
            }
            set_state(surface, samples[i].state);
            surface.run();
            EXPECT_GE(surface.h(), -1e-12) << "t = " << samples[i].t;
            if (samples[i].contact) {
                EXPECT_LE(std::abs(surface.hdot()), 1e-13);
            }
        }
        for (std::size_t i = 0; i + 1 < trajectory.events.size(); ++i) {
            const Event &event = trajectory.events[i], &next = trajectory.events[i + 1];
            if (event.kind != Event::Kind::impact) continue;
            const Vector& v = next.truncation ? next.truncation->v : event.v_after;
            EXPECT_LE((sampler.at(event.t).state.v - v).norm(), 1e-12);
            EXPECT_LE((sampler.at(event.t).state.q - event.q).norm(), 1e-12);
        }
    }
}

TEST(Repeatability, TheSameRunGivesTheSameBits) {
    const auto model = test::load("double_pendulum");
    const Trajectory a = simulate(model, model->default_run()), b = simulate(model, model->default_run());
    EXPECT_EQ(a.coefficients, b.coefficients);
    EXPECT_EQ(a.end.q, b.end.q);
}

TEST(Simulate, AMotionTooFastForItsEndTimeEnds) {
    const auto model = test::typed(
        "title = \"a floor that trembles\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n"
        "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x\"\n"
        "[[constraint]]\ngap = \"1.0001 + sin(1e9*x)\"\nrestitution = 0.5\n");
    auto run = model->default_run();
    run.options.max_steps = 1000;
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::too_many_steps);
    EXPECT_EQ(trajectory.outcome.message.rfind("1000 steps by t = ", 0), 0u) << trajectory.outcome.message;
    EXPECT_EQ(trajectory.statistics.steps, 1000);
    run.options.max_steps = 0;
    EXPECT_THROW(simulate(model, run), InputError);
}

// A run ends when the data that it stores reach the memory limit. What was stored until then is kept.
TEST(Simulate, ARunEndsWhereItsMemoryDoes) {
    const auto model = test::load("ball_in_bowl");
    auto run = model->default_run();
    run.options.end_time = 1e8;
    double last = 0.0;
    for (const double memory : {1e5, 1e7, 3e7}) {
        run.options.memory = memory;
        const Trajectory trajectory = simulate(model, run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::out_of_memory);
        EXPECT_NE(trajectory.outcome.message.find(fmt::format("the {:.4g} MB", memory / 1e6)), std::string::npos)
            << trajectory.outcome.message;
        const double kept = static_cast<double>(trajectory.coefficients.size() * sizeof(double) +
                                                trajectory.pieces.size() * sizeof(DenseSegment));
        EXPECT_GT(kept, 0.7 * memory);  // the rest are events
        EXPECT_LT(kept, memory + 4096.0);
        EXPECT_GT(trajectory.end_time, last);
        last = trajectory.end_time;
        EXPECT_EQ(trajectory.pieces.back().end, last);
    }
}

// A run that would take hours: with restitution 1 every impact is followed by another one.
Run endless(const Model& model) {
    Run run = model.default_run();
    run.parameters[2] = 1.0;
    run.options.end_time = 1e9;
    run.options.max_impacts = 1000000000;
    return run;
}

TEST(MonitoredRun, ARunEndsWhereAnotherThreadStopsIt) {
    const auto model = test::load("ball_on_sine");
    const auto run = endless(*model);
    std::stop_source source;
    RunMonitor watch;
    watch.stop = source.get_token();
    std::thread hand([&] {
        while (watch.impacts.load() < 20) std::this_thread::yield();
        source.request_stop();
    });
    const Trajectory stopped = simulate(model, run, &watch);
    hand.join();
    EXPECT_EQ(stopped.outcome.kind, Outcome::Kind::cancelled);
    EXPECT_GE(stopped.statistics.impacts, 20);
    EXPECT_EQ(watch.impacts.load(), stopped.statistics.impacts);
    EXPECT_EQ(watch.time.load(), stopped.end_time);
    // The stopped trajectory is the beginning of the whole one.
    auto shorter = run;
    shorter.options.max_impacts = static_cast<int>(stopped.statistics.impacts);
    const Trajectory whole = simulate(model, shorter);
    ASSERT_EQ(whole.events.size(), stopped.events.size());
    EXPECT_EQ(whole.events.back().q, stopped.events.back().q);
}

TEST(MonitoredRun, ARunStoppedBeforehandIsItsStart) {
    const auto model = test::load("ball_on_sine");
    std::stop_source source;
    source.request_stop();
    RunMonitor watch;
    watch.stop = source.get_token();
    const Trajectory start = simulate(model, model->default_run(), &watch);
    EXPECT_EQ(start.outcome.kind, Outcome::Kind::cancelled);
    EXPECT_EQ(start.end_time, 0.0);
    EXPECT_EQ(start.end.q, model->default_run().q);
    EXPECT_TRUE(start.pieces.empty());
    EXPECT_EQ(Sampler(start).all(3).size(), 1U);
}

TEST(MonitoredRun, ARunThatIsOnlyWatchedIsTheSameRun) {
    const auto model = test::load("ball_on_sine");
    RunMonitor watch;
    const Trajectory alone = simulate(model, model->default_run());
    EXPECT_EQ(simulate(model, model->default_run(), &watch).coefficients, alone.coefficients);
    EXPECT_EQ(watch.impacts.load(), alone.statistics.impacts);
}

}  // namespace
}  // namespace achilles
