// Periodic orbits and their branches against pinned numbers (theory-derivatives.md 11) and closed forms.
#include "analysis/orbit.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/systems.hpp"

namespace achilles::test {
namespace {

using std::numbers::pi;

// An orbit problem of a system: from its [orbit] table or its start, with these settings.
OrbitProblem asked(const Model& model, const std::vector<std::string>& settings, const std::string& period = "",
                   double start_time = 0.0) {
    const SystemDescription& system = model.description();
    OrbitProblem asked;
    asked.run = model.default_run();
    asked.run.options.tolerance = tightest_options().tolerance;
    asked.run.options.truncation = tightest_options().truncation;
    if (system.orbit && period.empty()) {
        asked.closing = {system.orbit->period, system.orbit->shift};
        asked.is_guess = true;
        for (std::size_t i = 0; i < system.orbit->q.size(); ++i) {
            asked.run.q[static_cast<Eigen::Index>(i)] = system.orbit->q[i];
            asked.run.v[static_cast<Eigen::Index>(i)] = system.orbit->v[i];
        }
        start_time = system.orbit->t.value_or(start_time);
    }
    if (!period.empty()) asked.closing.period = {period, {}};
    for (const std::string& setting : settings) assign(asked.run, system, setting);
    asked.run.options.start_time = start_time;
    asked.run.options.end_time += start_time;
    return asked;
}

Orbit found(const std::shared_ptr<const Model>& model, const OrbitProblem& asked) {
    const OrbitSearchResult search = find_orbit(model, asked);
    EXPECT_TRUE(search.orbit.has_value()) << search.reason;
    return search.orbit.value_or(Orbit{});
}

Branch followed(const std::shared_ptr<const Model>& model, const OrbitProblem& asked, const std::string& name,
                double low, double high) {
    const auto& parameters = model->description().parameters;
    const auto at = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
    return follow(model, asked, found(model, asked), static_cast<std::size_t>(at - parameters.begin()), low, high);
}

double time_of(const Orbit& orbit, Event::Kind kind) {
    for (const Event& event : orbit.run.events)
        if (event.kind == kind) return event.t - orbit.state.t;
    return -1.0;
}

// Derivative with respect to the parameter of this name.
double slope(const Orbit& orbit, Eigen::Index row, const std::string& name) {
    const auto& parameters = orbit.run.model->description().parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k)
        if (parameters[k].name == name) return orbit.parameter_derivatives(row, static_cast<Eigen::Index>(k));
    return 0.0;
}

constexpr double of_orbit = 1e-12, of_multiplier = 1e-10, of_slope = 1e-9;

TEST(Orbit, LossOfAZenoPointHasThePinnedExponents) {
    EXPECT_NEAR(loss_exponent(0.3), 0.608896305611, 1e-12);
    EXPECT_NEAR(loss_exponent(0.5), 0.603031441718, 1e-12);
    EXPECT_NEAR(loss_exponent(0.7), 0.600811097843, 1e-12);
    EXPECT_NEAR(loss_exponent(0.9), 0.600071021716, 1e-12);
}

TEST(Orbit, OfTheBallDownAWaveIsThePinnedOne) {
    const auto model = load("ball_down_a_wave");
    const Orbit orbit = found(model, asked(*model, {}));
    EXPECT_TRUE(orbit.is_at_release);
    EXPECT_EQ(orbit.state.t, 0.0);
    EXPECT_NEAR(orbit.state.q[0], 0.8593599338715185793874, of_orbit);
    EXPECT_NEAR(orbit.period, 3.544294646668781307, of_orbit);
    EXPECT_NEAR(time_of(orbit, Event::Kind::zeno), 2.436860155357754023, of_orbit);
    EXPECT_NEAR(time_of(orbit, Event::Kind::release), orbit.period, of_orbit);
    EXPECT_NEAR(*orbit.margins.a_inf, 2.873801974252921, 1e-10);
    ASSERT_EQ(orbit.multipliers.size(), 4u);
    EXPECT_EQ(orbit.multipliers[0], 1.0);
    EXPECT_NEAR(orbit.multipliers[1].real(), -0.7014332700695572695, of_multiplier);
    EXPECT_EQ(orbit.multipliers[2], 0.0);
    EXPECT_EQ(orbit.multipliers[3], 0.0);
    EXPECT_EQ(orbit.zero_multipliers, 2u);
    EXPECT_TRUE(orbit.stable);
    EXPECT_NEAR(slope(orbit, 0, "e"), 0.025807339069433757, of_slope);
    EXPECT_NEAR(slope(orbit, 0, "A"), 0.346277283620642544, of_slope);
    EXPECT_NEAR(slope(orbit, 0, "b"), -1.62553706857792739, of_slope);
    EXPECT_NEAR(slope(orbit, 4, "e"), -0.00642568784374441, of_slope);
}

// With e = 0 nothing bounces. A plastic impact also makes two multipliers zero, and e enters only in third order.
TEST(Orbit, OfTheBallDownAWaveThatLandsPlasticallyIsThePinnedOne) {
    const auto model = load("ball_down_a_wave");
    const Orbit orbit = found(model, asked(*model, {"e=0"}));
    EXPECT_NEAR(orbit.state.q[0], 0.8524668995470183673043, of_orbit);
    EXPECT_NEAR(orbit.period, 3.541998452231108848, of_orbit);
    EXPECT_NEAR(orbit.multipliers[1].real(), -0.7691129326582522291, of_multiplier);
    EXPECT_EQ(orbit.zero_multipliers, 2u);
    EXPECT_NEAR(slope(orbit, 0, "e"), 0.0, of_slope);
}

// From the default start of the file: an attracting orbit needs no guess.
TEST(Orbit, IsFoundFromTheStartOfARun) {
    const auto model = load("ball_down_a_wave");
    OrbitProblem from_start;
    from_start.run = model->default_run();
    from_start.run.options.tolerance = 1e-14;
    from_start.run.options.truncation = tightest_options().truncation;
    from_start.closing.shift = model->description().orbit->shift;
    const Orbit orbit = found(model, from_start);
    EXPECT_NEAR(orbit.period, 3.544294646668781307, of_orbit);
    EXPECT_NEAR(std::remainder(orbit.state.q[0] - 0.8593599338715186, 2 * pi), 0.0, of_orbit);
}

// A shorter wave, hence a shorter shift. The mass m is used as the wave number, because nothing else depends on it.
TEST(Orbit, MovesWithAShiftThatDependsOnAParameter) {
    SystemDescription system = load("ball_down_a_wave")->description();
    system.constraints[0].gap.text = "y - A*sin(m*x)";
    system.orbit->shift[0].text = "2*pi/m";
    const auto model = std::make_shared<const Model>(std::move(system));
    const auto at = [&](double m) { return found(model, asked(*model, {fmt::format("m={}", m)})); };
    constexpr double h = 1e-4;
    const Orbit orbit = at(1.0), before = at(1.0 - h), after = at(1.0 + h);
    EXPECT_NEAR(orbit.period, 3.544294646668781307, of_orbit);
    EXPECT_NEAR(slope(orbit, 0, "m"), (after.state.q[0] - before.state.q[0]) / (2 * h), 1e-5);
    EXPECT_NEAR(slope(orbit, 4, "m"), (after.period - before.period) / (2 * h), 1e-5);
}

TEST(Branch, OfTheBallDownAWaveFlipsWhereItIsPinned) {
    const auto model = load("ball_down_a_wave");
    const Branch branch = followed(model, asked(*model, {"e=0.3"}), "b", 0.04, 0.08);
    ASSERT_EQ(branch.flips.size(), 1u);
    EXPECT_NEAR(branch.value(branch.flips[0]), 0.06669076049860875, 1e-11);
    EXPECT_NEAR(branch.flips[0].state.q[0], 0.833681155737035739, 1e-10);
    EXPECT_NEAR(branch.flips[0].period, 3.50627824305801994, 1e-10);
    EXPECT_NEAR(branch.flips[0].multipliers[1].real(), -1.0, of_multiplier);
    EXPECT_TRUE(branch.folds.empty() && branch.neimark_sacker.empty() && branch.zeno_lost.empty() &&
                branch.changes.empty());
    EXPECT_EQ(branch.value(branch.points.front()), 0.04);
    EXPECT_EQ(branch.value(branch.points.back()), 0.08);
    EXPECT_TRUE(branch.points.front().stable);
    EXPECT_FALSE(branch.points.back().stable);
    for (std::size_t i = 1; i < branch.points.size(); ++i)
        EXPECT_LT(branch.value(branch.points[i - 1]), branch.value(branch.points[i]));
}

// x'' + c x' + x = F cos(om t) above a floor that it never reaches. The multipliers are exp((-c/2 +- i w) T) with w^2 =
// 1 - c^2/4 and T = 2 pi/om. At c = 0 both are on the unit circle, with arguments +- T.
TEST(Branch, OfADrivenOscillatorCrossesTheUnitCircleWithoutDamping) {
    const auto model = typed(R"toml(
title = "A driven oscillator above a floor"
coordinate = [{name = "x", start = 0.5, force = "-c*x' - x + F*cos(om*t)"}]
parameter = [{name = "c", value = 0.1, range = [-1, 1]}, {name = "F", value = 0.3}, {name = "om", value = 1.5}]
lagrangian = {kinetic = "x'^2/2", potential = "0"}
constraint = [{gap = "x + 5", restitution = 0.8}]
)toml");
    const Branch branch = followed(model, asked(*model, {}, "2*pi/om"), "c", -0.1, 0.2);
    ASSERT_EQ(branch.neimark_sacker.size(), 1u);
    EXPECT_NEAR(branch.value(branch.neimark_sacker[0]), 0.0, 1e-10);
    EXPECT_NEAR(branch.neimark_sacker[0].multipliers[0].real(), std::cos(2 * pi / 1.5), 1e-10);
    EXPECT_NEAR(std::abs(branch.neimark_sacker[0].multipliers[0].imag()), std::abs(std::sin(2 * pi / 1.5)), 1e-10);
    EXPECT_TRUE(branch.folds.empty() && branch.flips.empty() && branch.zeno_lost.empty() && branch.changes.empty());
}

TEST(Branch, OfTheBallDownAWaveLosesItsZenoPointWhereItIsPinned) {
    const auto model = load("ball_down_a_wave");
    const Branch branch = followed(model, asked(*model, {}), "e", 0.4, 0.8);
    ASSERT_EQ(branch.zeno_lost.size(), 1u);
    const OrbitPoint& lost = branch.zeno_lost[0];
    EXPECT_NEAR(branch.value(lost), 0.6632133961, 1e-8);
    EXPECT_NEAR(lost.state.q[0], 0.857302836, 1e-8);
    EXPECT_NEAR(lost.multipliers[1].real(), -0.36917866, 1e-7);
    EXPECT_EQ(branch.value(branch.points.back()), branch.value(lost)) << "the branch stops there";
    EXPECT_NE(branch.ends[1].find("lost"), std::string::npos) << branch.ends[1];
}

// All parameters 1, as in theory-derivatives.md 11.
const std::vector<std::string> ones{"L1=1",   "L2=1",        "g=1",         "d=0",          "tau=0.2",
                                    "om=0.8", "theta1=0.98", "theta2=0.08", "theta1'=0.64", "theta2'=0.3"};

// At b = 0 the ball has no drive. Its flights become lower towards that value, and the branch ends for that reason.
TEST(Branch, SaysThatTheFlightsVanish) {
    const auto model = load("ball_down_a_wave");
    const Branch branch = followed(model, asked(*model, {}), "b", 0.0, 0.06);
    EXPECT_LT(branch.value(branch.points.front()), 1e-6);
    EXPECT_NE(branch.ends[0].find("the flights shrink to zero: the gap never exceeds"), std::string::npos)
        << branch.ends[0];
    EXPECT_EQ(branch.value(branch.points.back()), 0.06);
}

TEST(Orbit, OfTheDrivenPendulumIsThePinnedOne) {
    const auto model = load("driven_double_pendulum");
    const OrbitProblem question = asked(*model, ones, "2*pi/om", 1.2 / 0.8);
    const Orbit orbit = found(model, question);
    EXPECT_NEAR(orbit.state.q[0], 0.983716935385824871, of_orbit);
    EXPECT_NEAR(orbit.state.q[1], 0.076725792486358360, of_orbit);
    EXPECT_NEAR(orbit.state.v[0], 0.645342701899440874, of_orbit);
    EXPECT_NEAR(orbit.state.v[1], 0.297679402942710255, of_orbit);
    EXPECT_NEAR(time_of(orbit, Event::Kind::zeno), 6.266769984218518394, of_orbit);
    EXPECT_NEAR(time_of(orbit, Event::Kind::release), 7.187434352689227061, of_orbit);
    ASSERT_EQ(orbit.multipliers.size(), 4u);
    EXPECT_NEAR((orbit.multipliers[0] + orbit.multipliers[1]).real(), 0.6076423983354976202, of_multiplier);
    EXPECT_NEAR((orbit.multipliers[0] * orbit.multipliers[1]).real(), 0.0616532246843024767, of_multiplier);
    EXPECT_EQ(orbit.zero_multipliers, 2u);
    // The derivative with respect to a parameter, against orbits at neighboring values.
    const double h = 1e-4;
    const auto beside = [&](double e) {
        std::vector<std::string> settings = ones;
        settings.push_back(fmt::format("e={}", e));
        return found(model, asked(*model, settings, "2*pi/om", 1.2 / 0.8)).state.q[0];
    };
    EXPECT_NEAR(slope(orbit, 0, "e"), (beside(0.5 + h) - beside(0.5 - h)) / (2 * h), 1e-7);
}

TEST(Branch, OfTheDrivenPendulumLosesItsZenoPointWhereItIsPinned) {
    const auto model = load("driven_double_pendulum");
    const Branch branch = followed(model, asked(*model, ones, "2*pi/om", 1.2 / 0.8), "e", 0.499, 0.6);
    ASSERT_EQ(branch.zeno_lost.size(), 1u);
    EXPECT_NEAR(branch.value(branch.zeno_lost[0]), 0.5427797769, 1e-8);
    EXPECT_NEAR(branch.zeno_lost[0].state.q[0], 0.990300203, 1e-8);
    EXPECT_NEAR(branch.zeno_lost[0].multipliers[0].real(), 0.475677175, 1e-8);
    EXPECT_NEAR(branch.zeno_lost[0].multipliers[1].real(), 0.144902433, 1e-8);
}

// One degree of freedom and a clock: all multipliers are zero.
TEST(Orbit, ThatSticksInOneDegreeOfFreedomForgetsEverything) {
    const auto table = load("ball_on_vibrating_table");
    const Orbit ball = found(table, asked(*table, {"a=1.25", "om=1", "g=1", "e=0.5", "m=1", "y=1.5"}, "2*pi/om"));
    EXPECT_NEAR(std::fmod(time_of(ball, Event::Kind::zeno) + ball.state.t, 2 * pi), 4.447361519020118, of_orbit);
    EXPECT_NEAR(std::fmod(time_of(ball, Event::Kind::release) + ball.state.t, 2 * pi), std::asin(0.8), of_orbit);
    EXPECT_EQ(ball.multipliers, std::vector<std::complex<double>>(2, 0.0));
    EXPECT_EQ(ball.zero_multipliers, 2u);
    EXPECT_TRUE(ball.stable);
    const auto oscillator = typed(
        "title = \"x'' + x = cos(t/2), x <= 0\"\n[[coordinate]]\nname = \"x\"\nstart = -1\nforce = \"cos(t/2)\"\n"
        "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[[constraint]]\ngap = \"-x\"\nrestitution = 0.5\n");
    const Orbit stuck = found(oscillator, asked(*oscillator, {}, "4*pi"));
    EXPECT_NEAR(std::remainder(0.5 * (time_of(stuck, Event::Kind::zeno) + stuck.state.t) - 0.498067468978199, 2 * pi),
                0.0, of_orbit);
    EXPECT_NEAR(std::remainder(0.5 * (time_of(stuck, Event::Kind::release) + stuck.state.t) - pi / 2, 2 * pi), 0.0,
                of_orbit);
    EXPECT_EQ(stuck.zero_multipliers, 2u);
}

// A ball hits a table once per cycle at the same speed: gT/2 - u = e (gT/2 + u), where u = a cos(phi) is the speed of
// the table. Nothing comes to rest, so the product of the multipliers is e^2. As a increases, the orbits appear in a
// fold, at the phase where the table is fastest.
TEST(Branch, OfABallThatStrikesOnceACycleFoldsWhereItsClosedFormDoes) {
    const auto model = load("ball_on_vibrating_table");
    const double e = 0.8, u = pi * (1 - e) / (1 + e), a = 0.4, phase = std::acos(u / a);
    const std::vector<std::string> settings{
        "om=1", "g=1", "m=1", "a=0.4", "e=0.8", "y'=0", fmt::format("y={}", a * std::sin(phase) + pi * pi / 2 + 1e-3)};
    const OrbitProblem question = asked(*model, settings, "2*pi/om", phase + pi);
    const Orbit orbit = found(model, question);
    EXPECT_EQ(orbit.zero_multipliers, 0u);
    ASSERT_EQ(orbit.run.events.size(), 1u);
    EXPECT_NEAR(std::cos(orbit.run.events[0].t), u / a, of_orbit);
    EXPECT_NEAR(std::abs(orbit.multipliers[0] * orbit.multipliers[1] - e * e), 0.0, of_multiplier);
    const Branch branch = followed(model, question, "a", 0.3, 0.45);
    ASSERT_EQ(branch.folds.size(), 1u);
    EXPECT_NEAR(branch.value(branch.folds[0]), u, 1e-10);
    const auto& at_fold = branch.folds[0].multipliers;
    EXPECT_LT(std::min(std::abs(at_fold[0] - 1.0), std::abs(at_fold[1] - 1.0)), 1e-6);
    // The branch has two ends at the limit of the range: one directly, one past the fold with the opposite stability.
    EXPECT_EQ(branch.value(branch.points.front()), 0.45);
    EXPECT_EQ(branch.value(branch.points.back()), 0.45);
    EXPECT_NE(branch.points.front().stable, branch.points.back().stable);
}

TEST(Orbit, RejectsInvalidPeriods) {
    const auto model = load("driven_double_pendulum");
    const auto told = [&](const std::string& period) -> std::string {
        OrbitProblem question = asked(*model, {}, "1");
        question.closing.period.text = period;
        try {
            find_orbit(model, question);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(told("").find("the period of the drive must be given"), std::string::npos) << told("");
    EXPECT_NE(told("1.3*pi/om").find("do not repeat"), std::string::npos) << told("1.3*pi/om");
    EXPECT_NE(told("-2*pi/om").find("must be positive"), std::string::npos) << told("-2*pi/om");
    EXPECT_NE(told("2*pi/on").find("did you mean 'om'"), std::string::npos) << told("2*pi/on");
    // The force on this ball is constant; only the gap is periodic.
    const auto table = load("ball_on_vibrating_table");
    EXPECT_THROW(find_orbit(table, asked(*table, {}, "1.3*pi/om")), InputError);
}

// In a flight without events the equations of return contradict each other, so a step of least squares vanishes although
// the run does not return. From 5 m the search goes on to another guess; from 500 m all guesses are in the first flight.
TEST(Orbit, IsNotAFlightThatDoesNotReturn) {
    const auto model = load("ball_on_vibrating_table");
    const Orbit orbit = found(model, asked(*model, {"y=5", "y'=2"}, "2*pi/om"));
    EXPECT_NEAR(orbit.period, 2.0 * pi / 12.5, 1e-12);
    EXPECT_FALSE(orbit.run.events.empty());
    const OrbitSearchResult search = find_orbit(model, asked(*model, {"y=500", "y'=2"}, "2*pi/om"));
    EXPECT_FALSE(search.orbit);
    EXPECT_NE(search.reason.find("does not return"), std::string::npos) << search.reason;
}

TEST(Orbit, IsNotFoundIfTheRunComesToRest) {
    const auto model = load("ball_on_floor");
    const OrbitSearchResult search = find_orbit(model, asked(*model, {}));
    EXPECT_FALSE(search.orbit.has_value());
    EXPECT_NE(search.reason, "");
}

TEST(Orbit, OfAFileIsReadWithItsMistakes) {
    const std::string text =
        "title = \"drop\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = "
        "\"x\"\n[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n[[parameter]]\nname = \"om\"\nvalue = 2\n[orbit]\n";
    const SystemDescription system =
        parse_system(text + "q = [\"1/2\"]\nv = [0]\nt = 0.5\nperiod = \"2*pi/om\"\nshift = [\"om\"]\n", "f.toml");
    ASSERT_TRUE(system.orbit.has_value());
    EXPECT_EQ(system.orbit->q, std::vector<double>{0.5});
    EXPECT_EQ(system.orbit->t, 0.5);
    EXPECT_EQ(system.orbit->period.text, "2*pi/om");
    EXPECT_EQ(system.orbit->shift[0].text, "om");
    const auto told = [&](const std::string& more) { return told_by_reading(text + more); };
    EXPECT_NE(told("q = [1]\nv = [0]\nperiode = 3\n")
                  .find("f.toml:17:1: unknown key 'periode' in [orbit]; did you "
                        "mean 'period'?"),
              std::string::npos)
        << told("q = [1]\nv = [0]\nperiode = 3\n");
    EXPECT_NE(told("q = [1, 2]\nv = [0]\n").find("a value for each of 1 coordinate"), std::string::npos);
    EXPECT_NE(told("v = [0]\n").find("missing key 'q' in [orbit]"), std::string::npos);
    EXPECT_NE(told("q = [1]\nv = [0]\nperiod = \"2*pi/on\"\n").find("did you mean 'om'"), std::string::npos);
    EXPECT_NE(told("q = [1]\nv = [0]\nperiod = \"x\"\n").find("the coordinate 'x'"), std::string::npos)
        << told("q = [1]\nv = [0]\nperiod = \"x\"\n");
}

}  // namespace
}  // namespace achilles::test
