// The two integrators against each other, and the accuracy of the Taylor method in long runs and near grazing.
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/sampler.hpp"
#include "simulate/stepper.hpp"

namespace achilles {
namespace {

// The model's default run with these values set.
Run with(const Model& model, std::initializer_list<const char*> settings) {
    Run run = model.default_run();
    for (const char* setting : settings) assign(run, model.description(), setting);
    return run;
}

double energy_of(const Model& model, const Run& run, const State& state) {
    auto program = model.evaluator(model.energy(), run.parameters);
    set_state(program, state);
    program.run();
    return program.output(0);
}

// The two integrators agree. With the paper's conditions they cut at nearly the same impacts. With the sharp ones at
// this eps the error of a cut is of third order in a speed of 1e-4.
TEST(Methods, AgreeOnEverySystem) {
    for (const char* asset : {"ball_on_sine", "double_pendulum", "falling_rod"}) {
        SCOPED_TRACE(asset);
        const auto model = test::load(asset);
        auto run = model->default_run();
        run.options.tolerance = 1e-12;
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-8;
        run.options.method = Method::taylor;
        const Trajectory taylor = simulate(model, run);
        run.options.method = Method::dopri5;
        const Trajectory dopri5 = simulate(model, run);
        ASSERT_EQ(taylor.outcome.kind, Outcome::Kind::end_time) << taylor.outcome.message;
        ASSERT_EQ(dopri5.outcome.kind, Outcome::Kind::end_time) << dopri5.outcome.message;
        ASSERT_EQ(taylor.events.size(), dopri5.events.size());
        for (std::size_t i = 0; i < taylor.events.size(); ++i) {
            const Event &a = taylor.events[i], &b = dopri5.events[i];
            ASSERT_EQ(a.kind, b.kind);
            EXPECT_NEAR(a.t, b.t, 2e-10);
            EXPECT_LE((a.q - b.q).norm(), 1e-9);
            EXPECT_LE((a.v_after - b.v_after).norm(), 1e-9);
        }
        EXPECT_LE((taylor.end.q - dopri5.end.q).norm(), 1e-10);
        EXPECT_LE((taylor.end.v - dopri5.end.v).norm(), 1e-10);
        Sampler a(taylor), b(dopri5);
        for (int i = 0; i <= 1000; ++i) {
            const double t = taylor.end_time * i / 1000.0;
            const Sample x = a.at(t), y = b.at(t);
            if (x.j == y.j) {
                EXPECT_LE((x.state.q - y.state.q).norm(), 1e-8) << t;
            }
        }
        EXPECT_LT(taylor.statistics.steps, dopri5.statistics.steps / 5);
    }
}

// dopri5 has seven stages. The last one is evaluated where the next step starts, so a try takes six evaluations. The
// start of a step is evaluated only after an impact or a projection, and not again for a repeated step.
TEST(Methods, Dopri5KeepsTheRatesAtTheEndsOfAStep) {
    const auto model = test::load("double_pendulum");
    auto run = model->default_run();
    run.options.method = Method::dopri5;
    run.options.tolerance = 1e-9;
    const Statistics statistics = simulate(model, run).statistics;
    EXPECT_LT(static_cast<double>(statistics.evaluations), 7.3 * static_cast<double>(statistics.steps));
}

// In flight the ball's motion is a polynomial, which the method integrates exactly. While the gap is far from zero, the
// bends of the floor below do not shorten the steps, and the impacts are found all the same.
TEST(Methods, AFloorFarBelowDoesNotShortenTheStepsOfDopri5) {
    const auto model = test::load("wavy_ramp");
    auto run = model->default_run();
    run.options.method = Method::taylor;
    const Trajectory taylor = simulate(model, run);
    run.options.method = Method::dopri5;
    const Trajectory dopri5 = simulate(model, run);
    ASSERT_EQ(taylor.events.size(), dopri5.events.size());
    for (std::size_t i = 0; i < taylor.events.size(); ++i) {
        EXPECT_EQ(taylor.events[i].kind, dopri5.events[i].kind);
        EXPECT_NEAR(taylor.events[i].t, dopri5.events[i].t, 1e-9);
    }
    EXPECT_GE(dopri5.statistics.least_gap, -1e-12);
    EXPECT_LT(dopri5.statistics.steps, 400);
}

// The gap of a ball that flies over a crest is known to stay positive if the crest is far below, not if it is near.
TEST(Methods, AGapThatComesNearZeroIsNotKnownToStayPositive) {
    const auto model = test::load("ball_on_sine");
    auto run = model->default_run();
    run.options.tolerance = 1e-8;
    run.q << std::acos(-1.0) / 2 - 0.005, 0.0;
    run.v << 1.0, 0.0;
    for (const double height : {1.0, 1e-2, 1e-5, 1e-12, -1e-3}) {
        run.q[1] = std::sin(run.q[0]) + height;
        ContactCache surfaces(*model, run);
        const auto stepper = make_dopri5(*model, run, surfaces);
        const Gap gap{height, -std::cos(run.q[0])};
        stepper->initialize({}, {run.q, run.v}, std::span(&gap, 1));
        ASSERT_EQ(stepper->do_step(0.0, 0.01, 0.01, 1e-15), StepFailure::none);
        EXPECT_EQ(stepper->stays_positive(0), height >= 1e-2) << height;
    }
}

// Nor is a gap smaller than its error from the steps before.
TEST(Methods, AGapWithinItsErrorIsNotKnownToStayPositive) {
    const auto model = test::drop();
    auto run = model->default_run();
    run.options.method = Method::dopri5;
    run.parameters[0] = 1e-11;
    for (const double height : {1e-3, 1e-7}) {
        run.q[0] = height;
        run.v[0] = 0.0;
        ContactCache surfaces(*model, run);
        const auto stepper = make_dopri5(*model, run, surfaces);
        const Gap gap{height, 0.0, 1e-6};
        stepper->initialize({}, {run.q, run.v}, std::span(&gap, 1));
        ASSERT_EQ(stepper->do_step(0.0, 0.1, 0.1, 1e-15), StepFailure::none);
        EXPECT_EQ(stepper->stays_positive(0), height == 1e-3) << height;
    }
}

// What is tolerated of a gap in flight is not tolerated of the force after the contact is held.
TEST(Methods, TheForceOfAHeldContactIsIntegratedToTheTolerance) {
    const auto model = test::load("ball_on_sine");
    auto run = model->default_run();
    run.options.tolerance = 1e-8;
    run.q << 0.5, std::sin(0.5);
    run.v << 1.0, std::cos(0.5);
    ContactCache surfaces(*model, run);
    const auto first = make_dopri5(*model, run, surfaces), flown = make_dopri5(*model, run, surfaces);
    const Gap far{1.0, 0.0}, none{};
    flown->initialize({}, {run.q + Vector::Unit(2, 1), run.v}, std::span(&far, 1));
    ASSERT_EQ(flown->do_step(0.0, 1e-3, 1e-3, 1e-15), StepFailure::none);
    Polynomial p[2];
    double remainders[2];
    for (const int i : {0, 1}) {
        Stepper& stepper = i == 0 ? *first : *flown;
        stepper.initialize(Mode::holding(ContactSet::of(0)), {run.q, run.v}, std::span(&none, 1));
        ASSERT_EQ(stepper.do_step(0.0, 1e-3, 1e-3, 1e-15), StepFailure::none);
        stepper.event_function(0, p[i]);
        remainders[i] = stepper.remainder(0, p[i]);
    }
    for (std::size_t k = 0; k <= 4; ++k) EXPECT_EQ(p[0].c[k], p[1].c[k]);
    EXPECT_EQ(remainders[0], remainders[1]);
}

// Against 40-digit references: the error at t = 20 is rounding.
TEST(Methods, TaylorReachesTheReferenceTo1e13) {
    for (const test::Problem& problem : test::problems) {
        SCOPED_TRACE(problem.key);
        const auto model = test::load(problem.asset);
        auto run = model->default_run();
        run.options.method = Method::taylor;
        run.options.tolerance = 1e-15;
        run.options.end_time = 20.0;
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-13;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        const auto expected = test::reference("fig4")["problems"][problem.key]["end_state"];
        for (Eigen::Index i = 0; i < 2; ++i) {
            EXPECT_NEAR(trajectory.end.q[i], test::number(expected[static_cast<std::size_t>(i)]), 1e-13);
            EXPECT_NEAR(trajectory.end.v[i], test::number(expected[static_cast<std::size_t>(i + 2)]), 1e-13);
        }
    }
}

// A ball slides to and fro in a valley: the gap, its rate and the energy are conserved.
TEST(LongRuns, AThousandSecondsInContact) {
    const auto model = test::load("ball_on_sine");
    auto run = with(*model, {"x=-1", "y=-0.8414709848078965", "x'=0.2", "y'=0.10806046117362795"});
    run.options.method = Method::taylor;
    run.options.tolerance = 1e-13;
    run.options.end_time = 1000.0;
    const Trajectory trajectory = simulate(model, run);
    ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    ASSERT_EQ(trajectory.phases.size(), 1u);
    ASSERT_EQ(trajectory.end_phase, Phase::Kind::constrained);
    auto surface = model->evaluator(model->contact_terms(), run.parameters);
    const double start = energy_of(*model, run, Sampler(trajectory).at(0.0).state);
    for (const Sample& sample : Sampler(trajectory).all(3)) {
        set_state(surface, sample.state);
        surface.run();
        ASSERT_LE(std::abs(surface.h()), 1e-13) << sample.t;
        ASSERT_LE(std::abs(surface.hdot()), 1e-13) << sample.t;
        ASSERT_LE(std::abs(energy_of(*model, run, sample.state) - start), 1e-11 * std::abs(start)) << sample.t;
    }
}

TEST(LongRuns, AThousandElasticImpacts) {
    for (const char* asset : {"ball_on_sine", "double_pendulum"}) {
        SCOPED_TRACE(asset);
        const auto model = test::load(asset);
        auto run = with(*model, {"e=1"});
        run.options.method = Method::taylor;
        run.options.tolerance = 1e-14;
        run.options.end_time = 1e5;
        run.options.max_impacts = 1000;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::too_many_impacts) << trajectory.outcome.message;
        ASSERT_EQ(trajectory.statistics.impacts, 1000);
        const double start = energy_of(*model, run, {run.q, run.v});
        EXPECT_NEAR(energy_of(*model, run, trajectory.end), start, 1e-10 * std::abs(start));
        EXPECT_GE(trajectory.statistics.least_gap, -1e-12);
    }
}

// A ball flies over a crest at pi/2 and clears it by `clearance`. With x = pi/2 + u t and y = 1 + clearance - t^2/2
// about the crest, h = clearance + (1 - cos(u t)) - t^2/2. Its minimum for u > 1 is `clearance` at t = 0. The start is
// one second earlier.
Trajectory graze(double clearance, double tolerance, Method method) {
    const auto model = test::load("ball_on_sine");
    constexpr double u = 1.25, ahead = 1.0;
    Run run = model->default_run();
    run.q << std::acos(-1.0) / 2 - u * ahead, 1.0 + clearance - 0.5 * ahead * ahead;
    run.v << u, ahead;
    run.options.method = method;
    run.options.tolerance = tolerance;
    run.options.end_time = 1.5;
    return simulate(model, run);
}

TEST(Grazing, IsRightAtTightTolerance) {
    for (const double clearance : {1e-6, 1e-10, 1e-13}) {
        const Trajectory above = graze(clearance, 1e-14, Method::taylor);
        EXPECT_EQ(above.outcome.kind, Outcome::Kind::end_time) << clearance << " " << above.outcome.message;
        EXPECT_EQ(above.statistics.impacts, 0) << clearance;
        const Trajectory below = graze(-clearance, 1e-14, Method::taylor);
        EXPECT_GE(below.statistics.impacts, 1) << clearance << " " << below.outcome.message;
    }
}

TEST(Grazing, IsRightOrUndecidedAtAnyTolerance) {
    for (const Method method : test::both_methods) {
        for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
            for (const double clearance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13, 0.0}) {
                const Trajectory above = graze(clearance, tolerance, method);
                EXPECT_EQ(above.statistics.impacts, 0) << to_text(method) << " " << tolerance << " " << clearance;
                if (above.outcome.kind != Outcome::Kind::end_time) {
                    EXPECT_EQ(above.outcome.kind, Outcome::Kind::undecided) << above.outcome.message;
                    EXPECT_LT(clearance, 100.0 * tolerance) << above.outcome.message;
                    EXPECT_NEAR(above.end_time, 1.0, 0.2) << above.outcome.message;
                }
                if (clearance == 0.0) continue;
                const Trajectory below = graze(-clearance, tolerance, method);
                if (below.statistics.impacts == 0) {
                    EXPECT_EQ(below.outcome.kind, Outcome::Kind::undecided)
                        << to_text(method) << " " << tolerance << " " << clearance << " " << below.outcome.message;
                }
            }
        }
    }
}

// x'' = -4 x^3 from x = 0: only every fourth term of the series is nonzero. The first zeros must not be taken for the
// end of the series.
TEST(Methods, SymmetryDoesNotHideTerms) {
    const auto model = test::typed(
        "title = \"spring\"\n[[coordinate]]\nname = \"x\"\nstart = 0\nrate = 1\n"
        "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^4\"\n"
        "[[constraint]]\ngap = \"x + 10\"\nrestitution = 0.5\n");
    auto run = model->default_run();
    run.options.end_time = 2.0;
    run.options.tolerance = 1e-12;
    const State end = simulate(model, run).end;
    run.options.method = Method::dopri5;
    const State other = simulate(model, run).end;
    EXPECT_NEAR(end.q[0], other.q[0], 1e-10);
    EXPECT_NEAR(end.v[0], other.v[0], 1e-10);
}

// A constant contact force smaller than its remainder is not known to stay positive: hddot = -g.
TEST(Methods, AForceWithinItsRemainderIsNotKnownToStay) {
    const auto model = test::drop();
    auto run = model->default_run();
    for (const double g : {1.0, 1e-11, -1.0}) {
        run.parameters[0] = g;
        ContactCache surfaces(*model, run);
        const auto stepper = make_taylor(*model, run, surfaces);
        const Gap gap;
        stepper->initialize(Mode::holding(ContactSet::of(0)), {run.q, run.v}, std::span(&gap, 1));
        ASSERT_EQ(stepper->do_step(0.0, 1.0, 0.0, 1e-15), StepFailure::none);
        EXPECT_EQ(stepper->stays_negative(0), g == 1.0) << g;
    }
}

}  // namespace
}  // namespace achilles
