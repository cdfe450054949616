// A root, logarithm or arcsine whose argument reaches a nonsmooth point ends the run there. Approaching that point does
// not.
#include "model/domain_boundaries.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/systems.hpp"
#include "simulate/batch.hpp"

namespace achilles {
namespace {

// A ball thrown from x = -1, y = 1.5 with x' = 1, with these T, V and h.
std::shared_ptr<const Model> ball(const std::string& kinetic, const std::string& potential, const std::string& gap) {
    return test::typed(
        "title = \"edge\"\n[[coordinate]]\nname = \"x\"\nstart = -1.0\nrate = 1.0\n[[coordinate]]\nname = \"y\"\nstart "
        "= "
        "1.5\n[[parameter]]\nname = \"p\"\nvalue = -2.0\n[lagrangian]\nkinetic = \"" +
        kinetic + "\"\npotential = \"" + potential + "\"\n[[constraint]]\ngap = \"" + gap +
        "\"\nrestitution = 0.5\n[run]\nend_time = 5.0\n");
}

const std::string plain = "(x'^2 + y'^2)/2";
const double pi = std::acos(-1.0);

struct Kink {
    std::string name, kinetic, potential, gap;
    std::string part;  // named in the message
    double t, error;   // the instant in closed form; effect of the argument's rounding on it
};
void PrintTo(const Kink& kink, std::ostream* out) { *out << kink.name; }

const Kink kinks[] = {
    {"gap", plain, "y", "y - sqrt(x^2)", "sqrt(x^2) in the gap", 1.0, 1e-14},
    {"shifted", plain, "y", "y - sqrt((x + 1/3)^2)", "sqrt((x + 1/3)^2) in the gap", 2.0 / 3, 1e-14},
    {"power", plain, "y", "y - (x^2)^(3/2)", "(x^2)^(3/2) in the gap", 1.0, 1e-14},
    {"quartic", plain, "y", "y - (x^4)^(1/4)", "(x^4)^(1/4) in the gap", 1.0, 1e-14},
    {"plane", plain, "0", "2 - sqrt(x^2 + (y - 3/2)^2)", "sqrt(x^2 + (y - 3/2)^2) in the gap", 1.0, 1e-14},
    {"hidden", plain, "y", "y - exp(log(x^2)/2)", "log(x^2) in the gap", 1.0, 1e-14},
    {"wave", plain, "y", "y - acos(cos(x))", "acos(cos(x)) in the gap", 1.0, 1e-7},
    // x'' = 1/10 from x' = 1: t^2/20 + t = 1
    {"force", plain, "y + sqrt(x^2)/10", "y", "sqrt(x^2) in the potential", std::sqrt(120.0) - 10.0, 1e-9},
    // x' sqrt(2 + |x|) is constant: (2 - x)^(3/2) falls from 3^(3/2) to 2^(3/2)
    {"mass", "(2 + sqrt(x^2))*x'^2/2 + y'^2/2", "0", "y", "sqrt(x^2) in the kinetic energy",
     2.0 / 3 * (std::pow(3.0, 1.5) - std::pow(2.0, 1.5)) / std::sqrt(3.0), 1e-9},
};

class Kinks : public testing::TestWithParam<Kink> {};
INSTANTIATE_TEST_SUITE_P(Edges, Kinks, testing::ValuesIn(kinks), [](const auto& kink) { return kink.param.name; });

void expect_to_end(const Kink& kink, const Trajectory& trajectory) {
    const std::string& message = trajectory.outcome.message;
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::left_the_domain) << message;
    EXPECT_EQ(message.substr(0, kink.part.size()), kink.part) << message;
    EXPECT_NE(message.find(", just after t = "), message.npos) << message;
    EXPECT_NEAR(trajectory.end_time, kink.t, kink.error) << message;
    EXPECT_LE(trajectory.end_time, kink.t + 1e-9);
    EXPECT_GE(trajectory.statistics.least_gap, 0.0);
}

TEST_P(Kinks, EndTheRun) {
    const Kink& kink = GetParam();
    const auto model = ball(kink.kinetic, kink.potential, kink.gap);
    for (const Method method : test::both_methods) {
        auto run = model->default_run();
        run.options.method = method;
        expect_to_end(kink, simulate(model, run));
    }
}

// Regressions: near the kink a ratio of the series of its distance underflowed, and runs ended up to 2e-10 s early. A
// step over it was longer than 2^45 times the distance, and half of such a step was made without a check.
TEST(QuarticKink, EndsTheRunAtEveryTolerance) {
    const auto model = ball(plain, "y", "y - (x^4)^(1/4)");
    for (const Method method : test::both_methods)
        for (double tolerance = 1e-4; tolerance > 1e-15; tolerance *= 0.3) {
            auto run = model->default_run();
            run.options.method = method;
            run.options.tolerance = tolerance;
            const Trajectory trajectory = simulate(model, run);
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::left_the_domain) << trajectory.outcome.message;
            EXPECT_NEAR(trajectory.end_time, 1.0, 1e-14) << to_text(method) << ", tolerance " << tolerance;
        }
}

TEST_P(Kinks, EndManyRuns) {
    const Kink& kink = GetParam();
    const auto model = ball(kink.kinetic, kink.potential, kink.gap);
    simulate_ends(
        model, 9, [&](std::size_t) { return model->default_run(); },
        [&](std::size_t, RunResult&& attempt) { expect_to_end(kink, std::get<Trajectory>(attempt)); }, 1);
}

// Poles with coefficients below the tolerance, in time, position and rate, in forces, potential and gap. Regression:
// both methods stepped over them silently.
TEST(Poles, EndTheRunHoweverWeakTheyAre) {
    struct Pole {
        std::string force, potential, gap, part;
    };
    for (const auto& [force, potential, gap, part] : {Pole{"1e-10/(1 - t)^2", "0", "x + 3", "in the forces"},
                                                      Pole{"1e-12*(1 - t)^-3", "0", "x + 3", "in the forces"},
                                                      Pole{"1e-12*tan(pi*t/2)", "0", "x + 3", "in the forces"},
                                                      Pole{"0", "1e-13*x/(2 - 2*t)", "x + 3", "in the potential"},
                                                      Pole{"1e-12/((x - 1)*(t + 4))", "0", "x + 3", "in the forces"},
                                                      Pole{"0", "-1e-13/(x - 1)^2", "x + 3", "in the potential"},
                                                      Pole{"0", "0", "x + 3 + 1e-12/(x - 1)^2", "in the gap"},
                                                      Pole{"1e-14*log(1 - t)", "0", "x + 3", "in the forces"}}) {
        const auto model = test::typed("title = \"pole\"\n[[coordinate]]\nname = \"x\"\nrate = 1.0\nforce = \"" +
                                       force + "\"\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"" + potential +
                                       "\"\n[[constraint]]\ngap = \"" + gap + "\"\nrestitution = 0.5\n");
        for (const Method method : test::both_methods) {
            auto run = model->default_run();
            run.options.method = method;
            const Trajectory trajectory = simulate(model, run);
            const std::string& message = trajectory.outcome.message;
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::left_the_domain) << force << potential << gap << message;
            EXPECT_NE(message.find(part), message.npos) << message;
            EXPECT_NE(message.find(", just after t = "), message.npos) << message;
            EXPECT_NEAR(trajectory.end_time, 1.0, 1e-6) << message;
        }
    }
}

// A thin repulsive wall of the potential reverses the motion. Regression: it was stepped over.
TEST(Poles, TurnTheMotionWhereTheyRepelIt) {
    const auto model = test::typed(
        "title = \"wall\"\n[[coordinate]]\nname = \"x\"\nrate = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n"
        "potential = \"1e-13/(x - 1)^2\"\n[[constraint]]\ngap = \"x + 30\"\nrestitution = 0.5\n");
    for (const Method method : test::both_methods) {
        auto run = model->default_run();
        run.options.method = method;
        const Trajectory trajectory = simulate(model, run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        EXPECT_NEAR(trajectory.end.v[0], -1.0, 1e-4);
        EXPECT_NEAR(trajectory.end.q[0], -8.0, 1e-3);
    }
}

// A quotient that stays finite where its divisor vanishes has no pole.
TEST(Poles, AreNoneWhereTheNumeratorVanishesToo) {
    for (const char* force : {"sin(x - 1)/(x - 1)", "(1 - cos(t - 1))/(t - 1)^2", "1/(1 + x^2)"}) {
        const auto model = test::typed(
            std::string("title = \"no pole\"\n[[coordinate]]\nname = \"x\"\nrate = 1.0\nforce = \"") + force +
            "\"\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"0\"\n"
            "[[constraint]]\ngap = \"x + 3\"\nrestitution = 0.5\n");
        EXPECT_EQ(simulate(model, model->default_run()).outcome.kind, Outcome::Kind::end_time) << force;
    }
}

// In contact as well: a bead slides along a roof to its ridge.
TEST(KinksInContact, EndTheRun) {
    const auto model = ball(plain, "y", "y + sqrt(x^2) - 3");
    for (const Method method : test::both_methods) {
        auto run = model->default_run();
        run.options.method = method;
        run.q << -1.0, 2.0;
        run.v << 2.0, 2.0;  // up the slope: x'' = -1/2
        const Trajectory trajectory = simulate(model, run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::left_the_domain) << trajectory.outcome.message;
        EXPECT_NEAR(trajectory.end_time, 4.0 - std::sqrt(12.0), 1e-9);
    }
}

// sqrt(x^2 + d^2) along y = 0. The series at x = -1 does not resolve d, but a step over x = 0 would have the wrong
// sign. In the limit the ball bounces off a V: the floors y = -x and y = x, one after the other.
TEST(NarrowBends, ArePassedAsTheyAre) {
    for (const Method method : test::both_methods) {
        std::vector<double> last;
        for (const char* square : {"1e-13", "1e-16", "1e-20", "1e-26"}) {
            const auto model = ball(plain, "y", std::string("y - sqrt(x^2 + ") + square + ")");
            auto run = model->default_run();
            run.options.method = method;
            run.v << 0.9, 0.1;
            run.options.end_time = 3.5;
            const Trajectory trajectory = simulate(model, run);
            ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
            EXPECT_LT(trajectory.statistics.energy_drift, 1e-9) << square;
            EXPECT_GT(trajectory.statistics.least_gap, -1e-12) << square;
            // y = 3/2 + t/10 - t^2/2 meets y = x = 9/10 t - 1: t^2/2 + 4/5 t = 5/2
            const auto impacts = test::events_of(trajectory, Event::Kind::impact);
            ASSERT_FALSE(impacts.empty());
            EXPECT_NEAR(impacts[0].t, std::sqrt(0.64 + 5.0) - 0.8, 1e-8) << square;
        }
    }
}

// Only expressions that can reach their domain boundary during the motion are monitored; parameters alone cannot.
TEST(DomainBoundaries, OnlyMovingExpressionsAreMonitored) {
    EXPECT_EQ(test::load("ball_on_sine")->edges().size(), 0u);
    EXPECT_EQ(test::load("bead_in_ring")->edges().size(), 0u);
    EXPECT_EQ(ball(plain, "y*sqrt(p^2)", "y")->edges().size(), 0u);
    EXPECT_EQ(ball(plain, "2^1.5 + sqrt(2)*y", "y")->edges().size(), 0u);
    EXPECT_EQ(ball(plain, "2^y + exp(x) + 2*exp(x)", "y")->edges().size(), 2u);                  // narrow features
    EXPECT_EQ(ball(plain, "y + sqrt(x^2)", "y - sqrt(x^2) + (x^2)^(1/3)")->edges().size(), 1u);  // same argument
    EXPECT_EQ(ball(plain, "asin(x/3) + acos(x/3) + log(y)", "y")->edges().size(), 2u);
}

// A ball flies towards a post whose height is negligible at the start. Far from the post the series of the flight is
// that of a flat floor. The impact is where the parabola meets the post, known in closed form.
TEST(DomainBoundaries, FindsImpactsOnNarrowPosts) {
    for (const std::string post :
         {"exp(-400*(x - 1)^2)", "2^(-577*(x - 1)^2)", "1/cosh(30*(x - 1))^2", "(1 - tanh(30*(x - 1))^2)"}) {
        const auto model = ball(plain, "y", "y - 0.4*" + post);
        for (const Method method : test::both_methods) {
            auto run = model->default_run();
            run.options.method = method;
            run.options.end_time = 1.0;
            run.q << 0.6, 0.1;
            run.v << 0.6, 0.5;
            const Trajectory trajectory = simulate(model, run);
            const auto impacts = test::events_of(trajectory, Event::Kind::impact);
            ASSERT_FALSE(impacts.empty()) << post << ", " << to_text(method);
            EXPECT_LT(impacts[0].q[0], 1.0) << post;
            EXPECT_GT(impacts[0].q[1], 0.1) << post;
            EXPECT_NEAR(impacts[0].q[1], 0.1 + 0.5 * impacts[0].t - 0.5 * impacts[0].t * impacts[0].t, 1e-9) << post;
        }
    }
}

// A circle in Cartesian coordinates works as well as in polar ones: the ball bounces inside it and comes to rest.
TEST(DomainBoundaries, LeaveALegitimateRootAlone) {
    const auto model = ball(plain, "y", "2 - sqrt(x^2 + y^2)");
    auto run = model->default_run();
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_LE(trajectory.statistics.steps, 16);
    const auto squared = ball(plain, "y", "4 - x^2 - y^2");
    const Trajectory other = simulate(squared, run);
    EXPECT_LT((trajectory.end.q - other.end.q).norm(), 1e-8);
}

}  // namespace
}  // namespace achilles
