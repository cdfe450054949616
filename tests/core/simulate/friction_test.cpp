// Dry friction against closed forms (theory-friction.md 1 to 3): times and places of stick, slip and
// reversal, heat, impacts, and what has no motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using Kind = Event::Kind;

// A block on a slope: gravity a across it and alpha along it. `more` are further keys of the constraint.
std::string block(double alpha, double speed, const std::string& more) {
    return fmt::format(R"(coordinate = [{{name = "x", rate = {}}}, {{name = "y"}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - {}*x"
constraint = [{{name = "foot", gap = "y", restitution = 0, {}}}]
)",
                       speed, alpha, more);
}

// A mass on a spring, with friction at a joint.
std::string oscillator(double x, double v, const std::string& joint) {
    return fmt::format(R"(coordinate = [{{name = "x", start = {}, rate = {}}}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{{name = "joint", {}}}]
)",
                       x, v, joint);
}

// The accuracy that each method must reach.
double accuracy(Method method) { return method == Method::taylor ? 1e-12 : 1e-7; }

// E(end) - E(start) - work + loss + heat, and the largest |T| + |V| of both.
std::pair<double, double> balance(const Trajectory& run) {
    const Model& model = *run.model;
    auto energy = model.evaluator(model.energy(), run.run.parameters);
    double difference = 0.0, size = 0.0;
    for (const auto& [state, sign] : {std::pair(run.run.start(), -1.0), std::pair(run.end, 1.0)}) {
        set_state(energy, state);
        energy.run();
        difference += sign * (energy.kinetic() + energy.potential());
        size = std::max(size, std::abs(energy.kinetic()) + std::abs(energy.potential()));
    }
    return {difference - run.work + run.loss + run.heat, size};
}

Trajectory run_of(const std::string& text, double end, Method method = Method::taylor) {
    const auto model = derive(parse_system(text));
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    run.options.method = method;
    run.options.tolerance = method == Method::taylor ? 1e-14 : 1e-10;
    Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_LT(trajectory.statistics.energy_drift, accuracy(method));
    const auto [difference, size] = balance(trajectory);
    EXPECT_NEAR(difference, 0.0, accuracy(method) * (size + trajectory.heat + std::abs(trajectory.work)));
    return trajectory;
}

std::vector<double> times_of(const Trajectory& trajectory, Kind kind) {
    std::vector<double> times;
    for (const Event& event : trajectory.events)
        if (event.kind == kind) times.push_back(event.t);
    return times;
}

// The same against references that were integrated numerically, with 29 digits.
double quadrature(Method method) { return method == Method::taylor ? 1e-9 : 1e-7; }

class Friction : public testing::TestWithParam<Method> {};

TEST_P(Friction, ReversesOnASteepSlope) {
    const auto run = run_of(block(0.5, -1.0, R"(slip = "x'", friction = 0.3)"), 3.0, GetParam());
    ASSERT_EQ(run.events.size(), 1u);
    EXPECT_EQ(run.events[0].kind, Kind::reversal);
    EXPECT_NEAR(run.events[0].t, 1.25, accuracy(GetParam()));
    EXPECT_EQ(run.phases.front().mode.state(0), ContactState::slip_minus);
    EXPECT_EQ(run.end_mode.state(0), ContactState::slip_plus);
    EXPECT_NEAR(run.end.q[0], -0.31875, accuracy(GetParam()));
    EXPECT_NEAR(run.end.v[0], 0.35, accuracy(GetParam()));
    EXPECT_NEAR(run.heat, 0.279375, accuracy(GetParam()));
    EXPECT_EQ(run.loss, 0.0);
}

TEST_P(Friction, StopsInsideTheConeAndStays) {
    const auto run = run_of(block(0.5, 1.0, R"(slip = "x'", friction = 0.6)"), 1010.0, GetParam());
    ASSERT_EQ(times_of(run, Kind::stick).size(), 1u);
    const Event& stick = run.events[0];
    EXPECT_NEAR(stick.t, 10.0, accuracy(GetParam()));
    EXPECT_NEAR(stick.q[0], 5.0, accuracy(GetParam()));
    EXPECT_NEAR(run.heat, 3.0, accuracy(GetParam()));
    EXPECT_EQ(run.end.q[0], stick.q[0]);  // to the last bit
    EXPECT_EQ(run.end.v[0], 0.0);
}

TEST_P(Friction, IsCaughtByABelt) {
    const auto run = run_of(block(0.0, 0.0, R"(slip = "x' - 2", friction = 0.25)"), 10.0, GetParam());
    ASSERT_EQ(times_of(run, Kind::stick).size(), 1u);
    EXPECT_NEAR(run.events[0].t, 8.0, accuracy(GetParam()));
    EXPECT_NEAR(run.end.q[0], 12.0, accuracy(GetParam()));
    EXPECT_NEAR(run.heat, 2.0, accuracy(GetParam()));
    EXPECT_NEAR(run.work, 4.0, accuracy(GetParam()));
}

TEST_P(Friction, BringsABallToRolling) {
    for (const auto& [omega, speed] :
         {std::pair(0.5, 4.0 / 7.0), std::pair(1.5, 2.0 / 7.0), std::pair(2.0, 1.0 / 7.0)}) {
        const auto run =
            run_of(fmt::format(R"(coordinate = [{{name = "x", rate = 1}}, {{name = "y"}}, {{name = "phi", rate = {}}}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2/5*phi'^2)/2"
lagrangian.potential = "y"
constraint = [{{gap = "y", restitution = 0, slip = "x' + phi'", friction = 0.2}}]
)",
                               omega),
                   5.0, GetParam());
        ASSERT_EQ(times_of(run, Kind::stick).size(), 1u);
        EXPECT_NEAR(run.events[0].t, 2.0 * (1.0 + omega) / 1.4, accuracy(GetParam()));
        EXPECT_NEAR(run.end.v[0], speed, accuracy(GetParam()));
        EXPECT_NEAR(run.end.v[0] + run.end.v[2], 0.0, 1e-15);
        if (omega == 0.5) {
            EXPECT_NEAR(run.heat, 0.3214285714285714286, accuracy(GetParam()));
        }
    }
}

TEST_P(Friction, StopsAnOscillatorInsideItsCone) {
    const auto run = run_of(oscillator(9.0, 3.0, R"(slip = "x'", level = 5)"), 10.0, GetParam());
    ASSERT_EQ(run.events.size(), 2u);
    EXPECT_EQ(run.events[0].kind, Kind::reversal);
    EXPECT_EQ(run.events[1].kind, Kind::stick);
    EXPECT_NEAR(run.events[0].t, std::atan(3.0 / 14.0), accuracy(GetParam()));
    EXPECT_NEAR(run.events[1].t, std::atan(3.0 / 14.0) + std::numbers::pi, accuracy(GetParam()));
    EXPECT_NEAR(run.end.q[0], 15.0 - std::sqrt(205.0), accuracy(GetParam()));
}

TEST_P(Friction, SticksAndSlipsOnABelt) {
    const auto run =
        run_of(oscillator(0.0, 0.2, R"(slip = "x' - 0.2", level = 0.4, static_level = 1)"), 40.0, GetParam());
    const std::vector<double> slips = times_of(run, Kind::slip), sticks = times_of(run, Kind::stick);
    ASSERT_GE(slips.size(), 3u);
    EXPECT_NEAR(slips[0], 5.0, accuracy(GetParam()));
    const double slipping = std::numbers::pi + 2.0 * std::atan(1.0 / 3.0);
    EXPECT_NEAR(sticks[0] - slips[0], slipping, accuracy(GetParam()));
    EXPECT_NEAR(slips[1] - sticks[0], 6.0, 10.0 * accuracy(GetParam()));
    EXPECT_NEAR(slips[2] - slips[1], 6.0 + slipping, 10.0 * accuracy(GetParam()));
}

// Leine's curve: the level falls with the speed (reference: 29 digits by extrapolation).
TEST_P(Friction, FollowsAStribeckCurve) {
    const auto run = run_of(oscillator(0.0, 0.2, R"-(slip = "x' - 0.2", level = "1/(1 + 3*slip)")-"), 45.0, GetParam());
    const std::vector<double> slips = times_of(run, Kind::slip), sticks = times_of(run, Kind::stick);
    ASSERT_GE(slips.size(), 3u);
    EXPECT_NEAR(sticks[0] - slips[0], 4.29599952548015488336, quadrature(GetParam()));
    EXPECT_NEAR(slips[2] - slips[1], 12.00103129483057864690, quadrature(GetParam()));
    const auto other =
        run_of(oscillator(0.0, 0.2, R"-(slip = "x' - 0.2", level = "1/(1 + 2.5*slip)")-"), 45.0, GetParam());
    const std::vector<double> starts = times_of(other, Kind::slip);
    ASSERT_GE(starts.size(), 3u);
    EXPECT_NEAR(starts[2] - starts[1], 11.63686151895857427947654701, quadrature(GetParam()));
}

// A table that starts to move at V = 1 - cos t carries a block until sin t exceeds mu. The accelerations are continuous
// there, so u starts with a double root.
TEST_P(Friction, IsLeftBehindByATableThatSpeedsUp) {
    const auto run = run_of(block(0.0, 0.0, R"-(slip = "x' - (1 - cos(t))", friction = 0.5)-"), 4.2, GetParam());
    ASSERT_EQ(run.events.size(), 2u);
    EXPECT_EQ(run.events[0].kind, Kind::slip);
    EXPECT_EQ(run.events[1].kind, Kind::reversal);  // the table slows down too fast to stick
    const double start = std::numbers::pi / 6.0;
    double end = 3.8;  // cos start - cos t = (t - start)/2
    for (int i = 0; i < 50; ++i) end -= (std::cos(start) - std::cos(end) - 0.5 * (end - start)) / (std::sin(end) - 0.5);
    EXPECT_NEAR(run.events[0].t, start, accuracy(GetParam()));
    EXPECT_NEAR(run.events[1].t, end, 10.0 * accuracy(GetParam()));
    EXPECT_EQ(run.events[0].mode.state(0), ContactState::slip_minus);
}

// A static coefficient above the kinetic one: the acceleration jumps where the slip starts.
TEST_P(Friction, BreaksLooseFromTheConeOfRest) {
    const auto run = run_of(block(0.0, 0.0, R"-(slip = "x' - (1 - cos(t))", friction = 0.25, static_friction = 0.5)-"),
                            1.0, GetParam());
    ASSERT_EQ(run.events.size(), 1u);
    const double start = std::numbers::pi / 6.0;
    EXPECT_NEAR(run.events[0].t, start, accuracy(GetParam()));
    EXPECT_NEAR(run.end.v[0], 1.0 - std::cos(start) + 0.25 * (1.0 - start), accuracy(GetParam()));
}

// A block that slides up a slope of 0.5 comes to rest in the cone of rest, which is wider than that of sliding: it stays.
TEST_P(Friction, ComesToRestInTheConeOfRest) {
    const auto run =
        run_of(block(-0.5, 1.0, R"(slip = "x'", friction = 0.3, static_friction = 0.7)"), 10.0, GetParam());
    ASSERT_EQ(run.events.size(), 1u);
    EXPECT_EQ(run.events[0].kind, Kind::stick);
    EXPECT_NEAR(run.events[0].t, 1.25, accuracy(GetParam()));
    EXPECT_NEAR(run.end.q[0], 0.625, accuracy(GetParam()));
    EXPECT_EQ(run.end.v[0], 0.0);
}

// A wheel that rolls to and fro in a bowl: its point of contact stays at rest within the rounding of a step.
TEST_P(Friction, RollsWithoutDrift) {
    const auto run = run_of(R"-(coordinate = [{name = "x", start = 1}, {name = "y", start = 0.2}, {name = "phi"}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2/5*phi'^2)/2"
lagrangian.potential = "y"
constraint = [{gap = "y - 0.2*x^2", restitution = 0, slip = "x' + 0.4*x*y' + phi'", friction = 5}]
)-",
                            100.0, GetParam());
    EXPECT_TRUE(run.events.empty());
    EXPECT_LT(std::abs(run.end.v[0] + 0.4 * run.end.q[0] * run.end.v[1] + run.end.v[2]), 1e-14);
}

// A point that bounces on a slope (theory-friction.md 3): with alpha = 0.3 every impact sticks, with
// 0.45 only the first.
TEST_P(Friction, SticksOrSlidesAtImpacts) {
    const auto bouncing = [](double alpha) {
        return fmt::format(R"-(coordinate = [{{name = "x"}}, {{name = "y", start = 0.5}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - {}*x"
constraint = [{{gap = "y", restitution = 0.5, slip = "x'", friction = 0.5}}]
)-",
                           alpha);
    };
    const auto sticking = run_of(bouncing(0.3), 2.6, GetParam());
    const std::vector<double> times = times_of(sticking, Kind::impact);
    ASSERT_EQ(times.size(), 3u);
    for (const auto& [time, wanted] : {std::pair(times[0], 1.0), {times[1], 2.0}, {times[2], 2.5}})
        EXPECT_NEAR(time, wanted, accuracy(GetParam()));
    for (const Event& event : sticking.events) EXPECT_NEAR(event.v_after[0], 0.0, 1e-15);
    const auto sliding = run_of(bouncing(0.45), 2.6, GetParam());
    ASSERT_EQ(sliding.events.size(), 3u);
    EXPECT_NEAR(sliding.events[0].v_after[0], 0.0, 1e-15);
    EXPECT_NEAR(sliding.events[1].v_before[0], 0.45, accuracy(GetParam()));
    EXPECT_NEAR(sliding.events[1].v_after[0], 0.075, accuracy(GetParam()));
    ASSERT_TRUE(sliding.events[1].friction);
    EXPECT_NEAR(sliding.events[1].friction->tangential.at(0).second, -0.375, accuracy(GetParam()));
    EXPECT_NEAR(sliding.events[1].joint->impulses.at(0).second, 0.75, accuracy(GetParam()));
}

// A block 1 x 4 that rocks from one corner to the other (theory-friction.md 3).
TEST_P(Friction, RocksFromCornerToCorner) {
    const double least = 12.0 / 65.0;  // the friction that the sticking corner needs
    for (const auto& [mu, ratio] : {std::pair(0.2, 31.0 / 34.0), std::pair(0.1, 38.0 / 47.0),
                                    std::pair(least + 1e-9, 31.0 / 34.0), std::pair(least - 1e-9, 31.0 / 34.0)}) {
        const auto run = run_of(fmt::format(
                                    R"-(coordinate = [{{name = "x", rate = 2}}, {{name = "y", start = 2, rate = -0.5}},
              {{name = "phi", rate = -1}}]
parameter = [{{name = "mu", value = {}}}]
lagrangian.kinetic = "(x'^2 + y'^2 + 17/12*phi'^2)/2"
lagrangian.potential = "10*y"
[[constraint]]
name = "left"
gap = "y - sin(phi)/2 - 2*cos(phi)"
restitution = 0
slip = "x' + (sin(phi)/2 + 2*cos(phi))*phi'"
friction = "mu"
[[constraint]]
name = "right"
gap = "y + sin(phi)/2 - 2*cos(phi)"
restitution = 0
slip = "x' - (sin(phi)/2 - 2*cos(phi))*phi'"
friction = "mu"
)-",
                                    mu),
                                0.01, GetParam());
        ASSERT_FALSE(run.events.empty());
        const Event& impact = run.events[0];
        ASSERT_TRUE(impact.is_impact());
        EXPECT_NEAR(impact.v_after[2] / impact.v_before[2], ratio, mu < least && mu != 0.1 ? 1e-8 : 1e-13);
        EXPECT_FALSE(run.end_mode.is_held(0));
        EXPECT_EQ(impact.mode.state(1) == ContactState::held, mu > least);
    }
}

// What a box on two feet is besides its coordinates; the slips of its feet are equal.
constexpr const char* two_feet = R"-(
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2)/2"
lagrangian.potential = "y"
[[constraint]]
name = "left"
gap = "y - sin(phi) - cos(phi)"
restitution = 0
slip = "x' + (sin(phi) + cos(phi))*phi'"
friction = 0.5
[[constraint]]
name = "right"
gap = "y + sin(phi) - cos(phi)"
restitution = 0
slip = "x' - (sin(phi) - cos(phi))*phi'"
friction = 0.5
)-";

// A box on two feet: it slides, stops on both, and slides again when the push exceeds what both
// feet together can bear. How they share the friction force is not unique, and does not matter.
TEST_P(Friction, SticksOnTwoFeet) {
    const auto run = run_of(
        std::string(
            R"(coordinate = [{name = "x", rate = 1, force = "t/10"}, {name = "y", start = 1}, {name = "phi"}])") +
            two_feet,
        6.0, GetParam());
    ASSERT_EQ(run.events.size(), 2u);
    const ContactSet both = ContactSet::of(0).with(1);
    EXPECT_EQ(run.events[0].kind, Kind::stick);
    EXPECT_EQ(run.events[0].contacts, both);
    const double stop = 5.0 - std::sqrt(5.0);  // 1 - t/2 + t^2/20 = 0
    EXPECT_NEAR(run.events[0].t, stop, accuracy(GetParam()));
    EXPECT_EQ(run.events[1].kind, Kind::slip);
    EXPECT_EQ(run.events[1].contacts, both);
    EXPECT_NEAR(run.events[1].t, 5.0, accuracy(GetParam()));
    EXPECT_NEAR(run.events[1].q[0], run.events[0].q[0], 1e-15);
    EXPECT_NEAR(run.end.v[0], 0.05, accuracy(GetParam()));
    EXPECT_NEAR(run.end.q[2], 0.0, 1e-15);
}

// The left foot leaves the ground while both stick, and the right one alone bears the push: the box turns about it.
TEST_P(Friction, SticksOnTheFootThatStays) {
    const auto run = run_of(
        std::string(
            R"(coordinate = [{name = "x", force = 0.1}, {name = "y", start = 1}, {name = "phi", force = "-t/10"}])") +
            two_feet,
        9.5, GetParam());
    ASSERT_EQ(run.events.size(), 1u);
    EXPECT_EQ(run.events[0].kind, Kind::release);
    EXPECT_EQ(run.events[0].contacts, ContactSet::of(0));
    EXPECT_NEAR(run.events[0].t, 9.0, accuracy(GetParam()));
    EXPECT_EQ(run.events[0].mode.state(1), ContactState::held);
    const double phi = run.end.q[2];
    EXPECT_LT(run.end.v[2], -1e-4) << "it turns";
    EXPECT_NEAR(run.end.v[0], (std::sin(phi) - std::cos(phi)) * run.end.v[2], 1e-12);
}

// The impacts of a ball that nothing couples with a sliding block leave the block's slip as it is.
TEST_P(Friction, SlidesOnBesideABallThatBounces) {
    const auto run = run_of(R"-(coordinate = [{name = "x", rate = -1}, {name = "y"}, {name = "z", start = 1}]
lagrangian.kinetic = "(x'^2 + y'^2 + z'^2)/2"
lagrangian.potential = "y + z"
constraint = [
    {name = "block", gap = "y", restitution = 0, slip = "x'", friction = 0.1},
    {name = "ball", gap = "z", restitution = 0.5},
]
)-",
                            12.0, GetParam());
    ASSERT_FALSE(run.events.empty());
    const Event& last = run.events.back();
    EXPECT_EQ(last.kind, Kind::stick);
    EXPECT_NEAR(last.t, 10.0, accuracy(GetParam()));
    EXPECT_NEAR(run.end.q[0], -5.0, accuracy(GetParam()));
    EXPECT_GT(run.events.size(), 5u) << "the ball bounces meanwhile";
}

// A point that slides over hills: it leaves them, lands, and stops in a valley.
TEST_P(Friction, SlidesOverHills) {
    const auto run = run_of(R"-(coordinate = [{name = "x", rate = 3}, {name = "y", rate = 3}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{gap = "y - sin(x)", restitution = 0, slip = "x' + cos(x)*y'", friction = 0.2}]
)-",
                            60.0, GetParam());
    EXPECT_GE(times_of(run, Kind::release).size(), 1u);
    EXPECT_GE(times_of(run, Kind::reversal).size(), 1u);
    ASSERT_EQ(times_of(run, Kind::stick).size(), 1u);
    EXPECT_EQ(run.end_mode.state(0), ContactState::held);
    EXPECT_LT(std::abs(std::cos(run.end.q[0])), 0.2);  // the slope where it stopped
}

INSTANTIATE_TEST_SUITE_P(Methods, Friction, testing::Values(Method::taylor, Method::dopri5));

// A rod that slides on its end (theory-friction.md 2): for u < 0 at 60 degrees it has no motion, or two.
TEST(Painleve, EndsTheRun) {
    const auto outcome_of = [](double speed, double omega) {
        const auto model = derive(parse_system(fmt::format(
            R"-(coordinate = [{{name = "x", rate = {}}}, {{name = "y", start = "sin(pi/3)", rate = "{}*cos(pi/3)"}},
              {{name = "phi", start = "pi/3", rate = {}}}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y"
constraint = [{{name = "tip", gap = "y - sin(phi)", restitution = 0, slip = "x' + sin(phi)*phi'", friction = "5/3"}}]
)-",
            speed, omega, omega)));
        achilles::Run run = model->default_run();
        run.options.end_time = 0.1;
        return simulate(model, run).outcome;
    };
    const Outcome none = outcome_of(-3.0, 0.0), two = outcome_of(-3.0, -1.2);
    EXPECT_EQ(none.kind, Outcome::Kind::painleve);
    EXPECT_NE(none.message.find("no motion"), std::string::npos) << none.message;
    EXPECT_EQ(two.kind, Outcome::Kind::painleve);
    EXPECT_NE(two.message.find("more than one motion"), std::string::npos) << two.message;
    EXPECT_NE(two.message.find("'tip' slides at u = -4.03923 with W = -0.415064 and the free acceleration 0.247077"),
              std::string::npos)
        << two.message;
    EXPECT_EQ(outcome_of(3.0, 0.0).kind, Outcome::Kind::end_time);
}

// W = 1 + 3 cos phi (cos phi - mu sin phi) is negative between 45 degrees and atan 4.
TEST(Painleve, HasItsRegion) {
    const auto has_motion = [](double phi) {
        const auto model = derive(parse_system(fmt::format(
            R"-(coordinate = [{{name = "x", rate = -3}}, {{name = "y", start = "sin({0})"}},
              {{name = "phi", start = {0}}}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y"
constraint = [{{name = "tip", gap = "y - sin(phi)", restitution = 0, slip = "x' + sin(phi)*phi'", friction = "5/3"}}]
)-",
            phi)));
        achilles::Run run = model->default_run();
        run.options.end_time = 1e-9;
        return simulate(model, run).outcome.kind == Outcome::Kind::end_time;
    };
    EXPECT_TRUE(has_motion(0.25 * std::numbers::pi - 1e-6));
    EXPECT_FALSE(has_motion(0.25 * std::numbers::pi + 1e-6));
    EXPECT_FALSE(has_motion(std::atan(4.0) - 1e-6));
    EXPECT_TRUE(has_motion(std::atan(4.0) + 1e-6));
}

// While it slides into the region where W is negative, the force grows without bound: the run ends before.
TEST(Painleve, IsNotPassed) {
    const auto model = derive(parse_system(
        R"-(coordinate = [{name = "x", rate = -20}, {name = "y", start = "sin(0.6)", rate = "0.5*cos(0.6)"},
              {name = "phi", start = 0.6, rate = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y"
constraint = [{name = "tip", gap = "y - sin(phi)", restitution = 0, slip = "x' + sin(phi)*phi'", friction = "5/3"}]
)-"));
    achilles::Run run = model->default_run();
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::painleve) << trajectory.outcome.message;
    EXPECT_LT(trajectory.end.q[2], std::numbers::pi / 4.0);  // where W vanishes
    EXPECT_GT(trajectory.end.q[2], std::numbers::pi / 4.0 - 0.02);
}

TEST(NeverSlides, StaysOnASteepSlope) {
    const auto run = run_of(block(2.0, 0.0, R"(slip = "x'", friction = "inf")"), 10.0);
    EXPECT_TRUE(run.events.empty());
    EXPECT_EQ(run.end.q[0], 0.0);
}

// The toy woodpecker by Glocker and Pfeiffer: it slides and sticks on a pole, with impacts of three contacts. Its orbit
// attracts with the multiplier -0.84; times after the start of slip are from extrapolation with 113 bits.
TEST_P(Friction, MakesAWoodpeckerPeck) {
    const double wanted = quadrature(GetParam());
    const auto run = run_of(R"-(coordinate = [{name = "y", rate = -0.01}, {name = "pM", start = "-0.0006/0.0058"},
              {name = "pS", start = -0.205, rate = 17.57}]
parameter = [{name = "mM", value = 3e-4}, {name = "JM", value = 5e-9}, {name = "mS", value = 4.5e-3},
             {name = "JS", value = 7e-7}, {name = "lM", value = 0.01}, {name = "lG", value = 0.015},
             {name = "c", value = 5.6e-3}, {name = "g", value = 9.81}]
lagrangian.kinetic = """(mS + mM)*y'^2/2 + mS*y'*(lM*pM' + lG*pS') + (JM + mS*lM^2)*pM'^2/2 + mS*lM*lG*pM'*pS'
    + (JS + mS*lG^2)*pS'^2/2"""
lagrangian.potential = "g*((mS + mM)*y + mS*(lM*pM + lG*pS)) + c/2*(pM - pS)^2"
[[constraint]]
name = "beak"
gap = "0.0024 - 0.02*pS"
restitution = 0.5
slip = "y' + lM*pM' + (lG - 0.0201)*pS'"
friction = 0.3
[[constraint]]
name = "low"
gap = "0.0006 + 0.0058*pM"
restitution = 0
slip = "y' + 0.0031*pM'"
friction = 0.3
[[constraint]]
name = "up"
gap = "0.0006 - 0.0058*pM"
restitution = 0
slip = "y' + 0.0031*pM'"
friction = 0.3
)-",
                            40.0, GetParam());
    std::size_t start = run.events.size(), end = start;
    for (std::size_t i = 0; i < run.events.size(); ++i)
        if (run.events[i].kind == Kind::slip) start = std::exchange(end, i);
    ASSERT_LT(end, run.events.size());
    const struct {
        Kind kind;
        std::size_t contact;
        double t;
    } reference[] = {{Kind::release, 1, 0.0058207572348098022545}, {Kind::impact, 2, 0.016709825280643503296},
                     {Kind::impact, 0, 0.019811178939636432686},   {Kind::impact, 2, 0.020390700477988666383},
                     {Kind::release, 2, 0.022245391272032776592},  {Kind::impact, 1, 0.057533801960158213398},
                     {Kind::impact, 1, 0.060262535991420886919},   {Kind::stick, 1, 0.10638265814428988435},
                     {Kind::slip, 1, 0.14597606514375182352691686}};
    std::size_t i = start;
    for (const auto& [kind, contact, t] : reference) {
        do ++i;
        while (i < end && run.events[i].is_zeno());  // the plastic impacts
        ASSERT_LE(i, end);
        EXPECT_EQ(run.events[i].kind, kind) << t;
        EXPECT_EQ(run.events[i].contacts, ContactSet::of(contact)) << t;
        EXPECT_NEAR(run.events[i].t - run.events[start].t, t, wanted);
    }
    EXPECT_EQ(i, end);
    EXPECT_NEAR(run.events[end].q[2], -0.20513534924352575665, wanted);
    EXPECT_NEAR(run.events[end].v_after[2], 17.5746662055760778630163, 20.0 * wanted);
    EXPECT_NEAR(run.events[start].q[0] - run.events[end].q[0], 0.019445379284716526658, wanted);
    // The reference books the heat of impacts as their loss: its heat is that of contact. At the impact of the beak the
    // slip reverses, and friction does positive work.
    const double slips[3][3] = {{1.0, 0.01, 0.015 - 0.0201}, {1.0, 0.0031, 0.0}, {1.0, 0.0031, 0.0}};
    double heat_of_impacts = 0.0;
    for (std::size_t k = start; k < end; ++k)
        if (run.events[k].is_impact())
            for (const auto& [contact, p] : run.events[k].friction->tangential)
                for (int c = 0; c < 3; ++c)
                    heat_of_impacts -=
                        0.5 * p * slips[contact][c] * (run.events[k].v_before + run.events[k].v_after)[c];
    EXPECT_LT(heat_of_impacts, -1e-6);
    const double heat = run.events[end].heat - run.events[start].heat,
                 loss = run.events[end].loss - run.events[start].loss;
    EXPECT_NEAR(heat - heat_of_impacts, 0.0007911296664896863568764, 1e-3 * wanted);
    EXPECT_NEAR(loss + heat_of_impacts, 0.0001245143532690454504081, 1e-3 * wanted);
}

}  // namespace
}  // namespace achilles
