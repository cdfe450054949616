// Estimated errors of runs with dry friction against closed forms and tight runs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/sensitivity/estimates.hpp"
#include "core/systems.hpp"

namespace achilles::test {
namespace {

Run run_at(const Model& model, double end, double tolerance) {
    Run run = model.default_run();
    run.options.end_time = end;
    run.options.tolerance = tolerance;
    return run;
}

// It reverses at atan(3/14), and rests at 15 - sqrt(205) from pi later on.
TEST(FrictionErrorEstimate, CoversTheErrorOfTheOscillator) {
    const auto model = typed(R"toml(coordinate = [{name = "x", start = 9, rate = 3}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{name = "joint", slip = "x'", level = 5}]
)toml");
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
        const Trajectory run = simulate(model, run_at(*model, 5.0, tolerance));
        const ErrorEstimate estimate = estimate_error(run);
        ASSERT_TRUE(estimate.end) << estimate.no_estimate_reason;
        const double error = std::abs(run.end.q[0] - (15.0 - std::sqrt(205.0)));
        EXPECT_LE(error, estimate.end->reach()) << tolerance;
        EXPECT_LE(estimate.end->size(), 10.0 * error + 1e-14) << tolerance;
        ASSERT_EQ(estimate.events.size(), 2u);
        const double reversal = std::atan(3.0 / 14.0);
        EXPECT_LE(std::abs(run.events[0].t - reversal), 1.5 * estimate.events[0] + 1e-15);
        EXPECT_LE(std::abs(run.events[1].t - reversal - std::acos(-1.0)), 1.5 * estimate.events[1] + 1e-15);
    }
}

// Through a stick, starts of a slip and impacts.
TEST(FrictionErrorEstimate, CoversTheDifferenceFromATightRun) {
    const std::pair<const char*, double> systems[] = {
        {R"toml(coordinate = [{name = "x", start = 0.8}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2 + x^4/9"
friction = [{name = "belt", slip = "x' - 0.2", level = "0.4/(1 + slip)", static_level = 1}]
)toml",
         9.0},
        {R"toml(coordinate = [{name = "x", rate = 1}, {name = "y"}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y*(1 + x^2) - sin(x)/2"
constraint = [{name = "foot", gap = "y", restitution = 0, slip = "x'", friction = 0.6}]
)toml",
         3.0},
        {R"toml(coordinate = [{name = "x", rate = 1.5}, {name = "y", start = 1.3},
              {name = "phi", start = 1.1, rate = 0.3}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y + cos(3*x)/9"
constraint = [{name = "tip", gap = "y - sin(phi)", restitution = 0.5, slip = "x' + sin(phi)*phi'", friction = 0.3}]
)toml",
         1.2}};
    for (const auto& [text, end] : systems) {
        const auto model = typed(text);
        const Trajectory truth = simulate(model, run_at(*model, end, 1e-15));
        EXPECT_FALSE(truth.events.empty());
        for (const double tolerance : {1e-7, 1e-9, 1e-11}) {
            const Trajectory run = simulate(model, run_at(*model, end, tolerance));
            ASSERT_EQ(run.events.size(), truth.events.size());
            const ErrorEstimate estimate = estimate_error(run);
            ASSERT_TRUE(estimate.end) << estimate.no_estimate_reason;
            const double error = std::hypot((run.end.q - truth.end.q).norm(), (run.end.v - truth.end.v).norm());
            EXPECT_LE(error, estimate.end->reach() + 1e-14) << text << tolerance;
            EXPECT_LE(estimate.end->size(), 10.0 * error + 1e-13) << text << tolerance;
        }
    }
}

// W falls to 0 at 45 degrees (theory-friction.md 2).
TEST(FrictionErrorEstimate, NamesTheForceThatGrowsWithoutBound) {
    const auto model = typed(R"toml(coordinate = [{name = "x", rate = -8},
              {name = "y", start = "sin(pi/6)", rate = "1.5*cos(pi/6)"}, {name = "phi", start = "pi/6", rate = 1.5}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "9.81*y"
constraint = [{name = "tip", gap = "y - sin(phi)", restitution = 0, slip = "x' + sin(phi)*phi'", friction = "5/3"}]
)toml");
    const Trajectory run = simulate(model, run_at(*model, 0.2, 1e-10));
    ASSERT_EQ(run.outcome.kind, Outcome::Kind::painleve) << run.outcome.message;
    EXPECT_EQ(estimate_error(run).no_estimate_reason, "the contact force grows without bound where the run stops");
}

}  // namespace
}  // namespace achilles::test
