// Periodic orbits with dry friction against references of 34 digits (theory-friction.md 8).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/orbit.hpp"
#include "core/systems.hpp"
#include "output/output.hpp"

namespace achilles::test {
namespace {

OrbitSearchResult search(const std::shared_ptr<const Model>& model, double end, const ReturnCondition& closing = {}) {
    OrbitProblem problem;
    problem.run = model->default_run();
    problem.run.options.tolerance = tightest_options().tolerance;
    problem.run.options.truncation = tightest_options().truncation;
    problem.run.options.end_time = end;
    problem.closing = closing;
    return find_orbit(model, problem);
}

// A mass on a spring, carried by a belt of speed 1/5.
std::shared_ptr<const Model> belt(double rate, const std::string& level) {
    return typed(fmt::format(R"toml(coordinate = [{{name = "x", start = 0.9, rate = {}}}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{{name = "belt", slip = "x' - 1/5", level = "{}", static_level = 1}}]
)toml",
                             rate, level));
}

// It sticks for 6 s, and slips for pi + 2 atan(1/3). The stick forgets the one direction besides the flow.
TEST(FrictionOrbit, OfTheBeltWithCoulombsLaw) {
    const OrbitSearchResult found = search(belt(0.0, "0.4"), 30.0);
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_NEAR(found.orbit->period, 6.0 + std::numbers::pi + 2.0 * std::atan(1.0 / 3.0), 1e-11);
    EXPECT_EQ(found.orbit->zero_multipliers, 1u);
    EXPECT_EQ(found.orbit->multipliers, (std::vector<std::complex<double>>{1.0, 0.0}));
    EXPECT_TRUE(found.orbit->stable);
}

TEST(FrictionOrbit, OfTheBeltWithAFallingCoefficient) {
    const OrbitSearchResult found = search(belt(0.0, "1/(1 + 3*slip)"), 40.0);
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_NEAR(found.orbit->period, 12.00103129483057864690, 1e-10);
    EXPECT_EQ(found.orbit->zero_multipliers, 1u);
}

// Glocker's woodpecker falls by 0.0194 m in each period. Contact 2 sticks, which forgets three directions. Of the
// others one is the flow, and one is a shift along the pole, which changes nothing.
TEST(FrictionOrbit, OfTheWoodpecker) {
    const OrbitSearchResult found =
        search(load("woodpecker"), 1.0,
               {{"0.14597606514375182", {}}, {{"-0.019445379284716526658", {}}, {"0", {}}, {"0", {}}}});
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_NEAR(found.orbit->period, 0.14597606514375182352691686, 1e-12);
    EXPECT_EQ(found.orbit->zero_multipliers, 3u);
    ASSERT_EQ(found.orbit->multipliers.size(), 6u);
    EXPECT_NEAR(found.orbit->multipliers[1].real(), 1.0, 1e-8);
    EXPECT_NEAR(found.orbit->multipliers[2].real(), -0.8391556530475859, 1e-8);
    EXPECT_EQ(found.orbit->multipliers[2].imag(), 0.0);
    EXPECT_EQ(stability_text(*found.orbit),
              "neutral: no perturbation grows, but some do not shrink (multipliers of size 1)");
    EXPECT_NE(orbit_answer(*found.orbit, nullptr).find("neutral periodic orbit"), std::string::npos);
}

// Nothing depends on the height of the woodpecker: how far it falls in a period is found, and is no instability.
TEST(FreeShift, OfTheWoodpeckerIsFoundWithItsOrbit) {
    const auto model = load("woodpecker");
    const ReturnCondition closing{{"0.14597606514375182", {}}, {{"free", {}}, {"0", {}}, {"0", {}}}};
    const OrbitSearchResult found = search(model, 1.0, closing);
    ASSERT_TRUE(found.orbit) << found.reason;
    const Orbit& orbit = *found.orbit;
    EXPECT_NEAR(orbit.period, 0.14597606514375182352691686, 1e-12);
    ASSERT_EQ(orbit.free.size(), 1u);
    EXPECT_EQ(orbit.free[0].first, "y");
    EXPECT_NEAR(orbit.free[0].second, -0.019445379284716526658, 1e-12);
    EXPECT_EQ(orbit.multipliers[1], 1.0);
    EXPECT_NEAR(orbit.multipliers[2].real(), -0.8391556530475859, 1e-8);
    EXPECT_TRUE(orbit.stable);
    EXPECT_EQ(multipliers_text(orbit, 4), "1 (along the motion), 1 (along y), -0.8392, 0, 0, 0 (the last 3 exactly)");
    // The derivatives of period and state by the restitution of the beak.
    const auto& parameters = model->description().parameters;
    const Eigen::Index e = std::find_if(parameters.begin(), parameters.end(),
                                        [](const auto& parameter) { return parameter.name == "e"; }) -
                           parameters.begin();
    constexpr double step = 1e-5;
    const auto at = [&](double change) {
        OrbitProblem problem;
        problem.run = model->default_run();
        problem.run.options.tolerance = tightest_options().tolerance;
        problem.run.parameters[static_cast<std::size_t>(e)] += change;
        problem.closing = closing;
        return find_orbit(model, problem).orbit.value();
    };
    const Orbit more = at(step), less = at(-step);
    EXPECT_NEAR(orbit.parameter_derivatives(6, e), (more.period - less.period) / (2.0 * step), 1e-8);
    for (const Eigen::Index i : {1, 2})
        EXPECT_NEAR(orbit.parameter_derivatives(i, e), (more.state.q[i] - less.state.q[i]) / (2.0 * step), 1e-7) << i;
    for (Eigen::Index i = 0; i < 3; ++i)
        EXPECT_NEAR(orbit.parameter_derivatives(3 + i, e), (more.state.v[i] - less.state.v[i]) / (2.0 * step), 1e-5)
            << i;
}

// A ball that is thrown up with the speed c whenever it falls to y = 0, and drifts along x. A free coordinate stays
// where the search begins, for all parameters: the other coordinates close the orbit.
TEST(FreeShift, LeavesItsCoordinateWhereTheSearchBegins) {
    const auto model = typed(R"toml(
coordinate = [{name = "x", start = 0.2, rate = 0.35, force = "0.3 - x'"}, {name = "y", start = 0.45, rate = 0.1}]
parameter = [{name = "c", value = 1}]
lagrangian = {kinetic = "(x'^2 + y'^2)/2", potential = "y"}
constraint = [{gap = "y + 1", restitution = 0}]
jump = [{name = "throw", on = "(y)", set = {"y'" = "c"}}]
)toml");
    const OrbitSearchResult found = search(model, 4.0, {{"2", {}}, {{"free", {}}, {"0", {}}}});
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_NEAR(found.orbit->period, 2.0, 1e-12);
    EXPECT_NEAR(found.orbit->free.at(0).second, 0.6, 1e-12);
    EXPECT_NEAR(found.orbit->state.q[0], 0.2, 1e-12);
    EXPECT_NEAR(found.orbit->parameter_derivatives(0, 0), 0.0, 1e-12);
    EXPECT_NEAR(found.orbit->parameter_derivatives(4, 0), 2.0, 1e-12);  // of the period
}

TEST(FreeShift, IsRefusedWhereTheMotionDependsOnTheCoordinate) {
    const OrbitSearchResult found =
        search(load("woodpecker"), 1.0, {{"0.146", {}}, {{"free", {}}, {"free", {}}, {"0", {}}}});
    ASSERT_FALSE(found.orbit);
    EXPECT_EQ(found.reason, "the motion depends on theta, so its shift cannot be free");
}

// A ball on a table that moves by 1.25 sin(t), with a spring along the table: one Zeno point in each period.
std::shared_ptr<const Model> on_table(const std::string& slip, const std::string& mu, const std::string& force) {
    return typed(fmt::format(R"toml(coordinate = [{{name = "x", force = "{}"}}, {{name = "y", start = 1.5}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y + x^2/8"
constraint = [{{name = "table", gap = "y - 1.25*sin(t)", restitution = 0.5, slip = "{}", friction = {}}}]
)toml",
                             force, slip, mu));
}

// A fast belt pulls with a force that does not depend on x: the multipliers besides the two zeros are those of the
// damped spring, exp(2 pi z) with z^2 + z/5 + 1/4 = 0.
TEST(FrictionOrbit, ThroughAZenoPointThatSlides) {
    const OrbitSearchResult found = search(on_table("x' - 9", "0.1", "-x'/5"), 40.0, {{"2*pi", {}}, {}});
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_EQ(found.orbit->zero_multipliers, 2u);
    ASSERT_EQ(found.orbit->multipliers.size(), 4u);
    const std::complex<double> expected =
        std::exp(2.0 * std::numbers::pi * std::complex<double>(-0.1, std::sqrt(0.24)));
    EXPECT_NEAR(found.orbit->multipliers[0].real(), expected.real(), 1e-9);
    EXPECT_NEAR(std::abs(found.orbit->multipliers[0].imag()), std::abs(expected.imag()), 1e-9);
}

// With much friction every impact stops x'. At x = 0 a flight of the length T multiplies a change of x by cos(T/2), so
// that the multiplier besides the three zeros is the product over all flights. Those after the cut are T e, T e^2, ...
TEST(FrictionOrbit, ThroughAZenoPointThatSticks) {
    const OrbitSearchResult found = search(on_table("x'", "2", "0"), 20.0, {{"2*pi", {}}, {}});
    ASSERT_TRUE(found.orbit) << found.reason;
    EXPECT_EQ(found.orbit->zero_multipliers, 3u);
    ASSERT_EQ(found.orbit->multipliers.size(), 4u);
    // The orbit starts within its longest flight.
    std::vector<double> flights{-found.orbit->run.run.options.start_time};
    for (const Event& event : found.orbit->run.events) {
        if (event.is_impact()) {
            flights.back() += event.t;
            flights.push_back(-event.t);
        }
        if (event.is_release()) flights.front() += found.orbit->run.end_time - event.t;
    }
    ASSERT_GE(flights.size(), 4u);
    flights.back() = 0.5 * flights[flights.size() - 2];
    double product = 1.0;
    for (int i = 0; i < 60; ++i) flights.push_back(0.5 * flights.back());
    for (const double flight : flights) product *= std::cos(0.5 * flight);
    EXPECT_NEAR(std::abs(found.orbit->multipliers[0]), std::abs(product), 1e-9);
}

}  // namespace
}  // namespace achilles::test
