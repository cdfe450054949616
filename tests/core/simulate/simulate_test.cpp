// Both problems of the paper's Fig. 4 against 40-digit results, and the starts and ends a run may have.
#include "simulate/simulate.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "core/systems.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

using test::Problem;

struct Bars {
    double tolerance, eps;
    double events, second_ball_zeno_state, end;  // allowed absolute errors
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
            if (problem.key == "double_pendulum") continue;  // its gap is a coordinate, exact near 0: 1e-14 can be met
            EXPECT_TRUE(event.certificate->below_rounding);
            EXPECT_GT(event.certificate->velocity_bound, 1e-14);  // the bound it has, not the one that was asked for
            EXPECT_LT(event.certificate->velocity_bound, 1e-5);
        }
    }
}

// Bounds that nothing meets, where the gap is a difference of large numbers: what puts proofs off does not keep the
// bouncing from ending where it must.
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
    for (const Event& event : points) EXPECT_TRUE(event.certificate->below_rounding);
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
            // Later Zeno times carry the small errors of earlier truncations, which a certificate does not cover.
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
        // Third order: far from the Zeno point, and still right at the end.
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
    EXPECT_EQ(trajectory.events[1].kind, Event::Kind::impact);  // hddot > 0 at the first
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

// Where hddot is constant the sharp bounds are equalities, and the Zeno time is exact; only what is seen decides.
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

// A run that would take hours: with restitution 1 every impact is followed by another.
Run endless(const Model& model) {
    Run run = model.default_run();
    run.parameters[2] = 1.0;
    run.options.end_time = 1e9;
    run.options.max_impacts = 1000000000;
    return run;
}

TEST(Watched, ARunEndsWhereAnotherThreadStopsIt) {
    const auto model = test::load("ball_on_sine");
    const auto run = endless(*model);
    std::stop_source source;
    Watch watch;
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
    // What there is of it is the beginning of the whole run.
    auto shorter = run;
    shorter.options.max_impacts = static_cast<int>(stopped.statistics.impacts);
    const Trajectory whole = simulate(model, shorter);
    ASSERT_EQ(whole.events.size(), stopped.events.size());
    EXPECT_EQ(whole.events.back().q, stopped.events.back().q);
}

TEST(Watched, ARunStoppedBeforehandIsItsStart) {
    const auto model = test::load("ball_on_sine");
    std::stop_source source;
    source.request_stop();
    Watch watch;
    watch.stop = source.get_token();
    const Trajectory start = simulate(model, model->default_run(), &watch);
    EXPECT_EQ(start.outcome.kind, Outcome::Kind::cancelled);
    EXPECT_EQ(start.end_time, 0.0);
    EXPECT_EQ(start.end.q, model->default_run().q);
    EXPECT_TRUE(start.pieces.empty());
    EXPECT_EQ(Sampler(start).all(3).size(), 1U);
}

TEST(Watched, ARunThatIsOnlyWatchedIsTheSameRun) {
    const auto model = test::load("ball_on_sine");
    Watch watch;
    const Trajectory alone = simulate(model, model->default_run());
    EXPECT_EQ(simulate(model, model->default_run(), &watch).coefficients, alone.coefficients);
    EXPECT_EQ(watch.impacts.load(), alone.statistics.impacts);
}

}  // namespace
}  // namespace achilles
