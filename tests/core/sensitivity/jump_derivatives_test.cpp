// Derivatives through jumps and passes (theory-modes.md 6) against closed forms and differences of runs.
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "sensitivity/derivatives.hpp"
#include "sensitivity/error_estimate.hpp"

namespace achilles::test {
namespace {

Run tight(const Model& model, double end) {
    achilles::Run run = model.default_run();
    run.options.tolerance = 1e-15;
    run.options.end_time = end;
    return run;
}

double& entry(Run& run, Eigen::Index direction) {
    const Eigen::Index n = run.q.size();
    if (direction < n) return run.q[direction];
    if (direction < 2 * n) return run.v[direction - n];
    return run.parameters[static_cast<std::size_t>(direction - 2 * n)];
}

std::string words(const Trajectory& run) {
    std::string text;
    for (const Event& event : run.events) text += std::string(names_of(event.kind).word) + " ";
    return text;
}

// Compares the derivatives of the end and of all event times with central differences of fourth order.
void expect_jump_differences(const std::shared_ptr<const Model>& model, double end, const std::string& expected,
                             double step = 2e-4) {
    const achilles::Run start = tight(*model, end);
    const Trajectory run = simulate(model, start);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    EXPECT_EQ(words(run), expected);
    const Derivatives d = differentiate(run);
    EXPECT_EQ(d.broken, "");
    ASSERT_TRUE(d.end);
    ASSERT_EQ(d.events.size(), run.events.size());
    const Eigen::Index n = run.end.q.size();
    const auto numbers_of = [&](const Trajectory& of) {
        Eigen::VectorXd all(2 * n + static_cast<Eigen::Index>(run.events.size()));
        all.head(2 * n) << of.end.q, of.end.v;
        for (std::size_t i = 0; i < run.events.size(); ++i)
            all[2 * n + static_cast<Eigen::Index>(i)] = of.events.at(i).t;
        return all;
    };
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(d.directions.size()); ++k) {
        if (!d.refused[static_cast<std::size_t>(k)].empty()) continue;
        const auto at = [&](double change) {
            achilles::Run other = start;
            entry(other, k) += change;
            return numbers_of(simulate(model, other));
        };
        const Eigen::VectorXd differences =
            (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
        Eigen::VectorXd found(differences.size());
        found.head(2 * n) << d.end->q.col(k), d.end->v.col(k);
        for (std::size_t i = 0; i < d.events.size(); ++i)
            found[2 * n + static_cast<Eigen::Index>(i)] = d.events[i].t[k];
        EXPECT_LT((found - differences).cwiseAbs().maxCoeff(), 1e-8 * (1.0 + differences.cwiseAbs().maxCoeff()))
            << d.directions[static_cast<std::size_t>(k)] << "\nfound " << found.transpose() << "\ndifferences "
            << differences.transpose();
    }
}

// Two points in gravity, coupled by a spring.
std::string points(const std::string& more) {
    return R"toml(coordinate = [{name = "x", start = 1, rate = 0.3}, {name = "y", start = 2.5, rate = -0.4}]
parameter = [{name = "g", value = 1.3}, {name = "e", value = 0.6}]
lagrangian.kinetic = "x'^2/2 + y'^2"
lagrangian.potential = "g*(x + 2*y) + (y - x)^2/50"
)toml" + more +
           "\n";
}

TEST(JumpDerivatives, FollowAJumpWithItsOwnJacobian) {
    expect_jump_differences(typed(points(R"toml([[jump]]
name = "j"
on = "x + y/10 - sin(t)/20"
set = {x = "e*x + y'^2/50 + t/10", "x'" = "-e*x' + y*x", y = "y + e*sin(x')"})toml")),
                            2.2, "jump ");
}

TEST(JumpDerivatives, FollowSeveralJumpsAtOneInstant) {
    expect_jump_differences(typed(points(R"toml(jump = [{name = "a", on = "x + 0*y", set = {"x'" = "1 - e*x'"}},
    {name = "b", on = "(x)", set = {y = "y + x'*e"}}])toml")),
                            2.0, "jump jump ");
}

TEST(JumpDerivatives, FollowAJumpAfterAnImpact) {
    expect_jump_differences(typed(points(R"toml(constraint = [{name = "floor", gap = "x", restitution = "e"}]
jump = [{name = "swap", on = "floor", set = {x = "y + 0.5", "y'" = "x'*e - y'", y = "y + 0.4"}}])toml")),
                            1.9, "impact jump ");
}

TEST(JumpDerivatives, FollowAPass) {
    expect_jump_differences(
        typed(points(R"toml(constraint = [{name = "gate", gap = "x", restitution = "e", when = "0.1 - y'^2"},
    {name = "floor", gap = "x + 0.7", restitution = "e"}])toml")),
        2.2, "pass impact ");
}

// Its steps are so sensitive that the differences need a small step.
TEST(JumpDerivatives, FollowAWalker) { expect_jump_differences(load("simplest_walker"), 9.5, "jump jump ", 2e-5); }

// The legs of a walker on a flat floor: the contact is closed after the jump in every perturbed run.
TEST(JumpDerivatives, KeepAGapClosedThatIsClosedInEveryRun) {
    expect_jump_differences(
        typed(R"toml(coordinate = [{name = "x", start = 1, rate = 0}, {name = "y", start = 0.5, rate = 1}]
parameter = [{name = "g", value = 1}, {name = "e", value = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "g*x"
constraint = [{name = "floor", gap = "x", restitution = 0}]
jump = [{name = "throw", on = "floor", set = {"x'" = "e*y'"}}]
)toml"),
        3.0, "impact jump impact jump ");
}

// A knee that a force pulls, until its latch ends by an expression, or by the impact of a foot.
std::string latched_knee(const std::string& latch) {
    return R"toml(coordinate = [{name = "x", start = 1, rate = -2, force = "a + t/5 + y/4"}, {name = "y", start = 1}]
parameter = [{name = "a", value = 1}, {name = "g", value = 0.5}, {name = "e", value = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2) + x'*y'/4", potential = "g*y"}
constraint = [{name = "knee", gap = "x", restitution = 0, latch = ")toml" +
           latch + R"toml("}, {name = "foot", gap = "y", restitution = "e"}]
)toml";
}

TEST(JumpDerivatives, FollowTheEndOfALatch) {
    expect_jump_differences(typed(latched_knee("t - 1.3 + y/20 - a/50")), 1.45, "impact zeno release impact ");
}

TEST(JumpDerivatives, FollowALatchThatTakesAnImpulse) {
    expect_jump_differences(typed(latched_knee("foot")), 2.6, "impact zeno impact ");
}

// The same knee in a system with friction.
TEST(JumpDerivatives, FollowLatchesBesideFriction) {
    const auto with_brake = [](std::string text) {
        const auto insert = [&](const std::string& before, const std::string& more) {
            text.insert(text.find(before) + before.size(), more);
        };
        insert("coordinate = [", R"({name = "s", rate = 1}, )");
        insert("kinetic = \"", "s'^2/2 + s'*x'/10 + ");
        return typed("friction = [{name = \"brake\", slip = \"s'\", level = 0.05}]\n" + text);
    };
    expect_jump_differences(with_brake(latched_knee("t - 1.3 + y/20 - a/50")), 1.45, "impact zeno release impact ");
    expect_jump_differences(with_brake(latched_knee("foot")), 2.6, "impact zeno impact ");
}

// The acceleration jumps where the foot is released, and the force acts on both.
TEST(JumpDerivatives, FollowForcesThatDependOnContact) {
    expect_jump_differences(typed(R"toml(coordinate = [{name = "x", rate = 0.3, force = "a*x*held(foot)"},
    {name = "y", start = 0.5, rate = -0.2, force = "-1 + t/3 + x/5 - held(foot)*(t/6 - e*x'/4)"}]
parameter = [{name = "a", value = 1.2}, {name = "e", value = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2) + x'*y'/10", potential = "0"}
constraint = [{name = "foot", gap = "y", restitution = 0}]
)toml"),
                            4.0, "impact zeno release ");
}

// The forces see the foot from its Zeno point on, whose time depends on everything before it.
TEST(JumpDerivatives, FollowForcesThatSeeABouncingContactRest) {
    const auto model = typed(R"toml(coordinate = [{name = "x", rate = 0.3, force = "a*x*held(foot)"},
    {name = "y", start = 0.5, rate = -0.2, force = "-1 + t/30 + x/9 - held(foot)*(t/6 - e*x'/4)"}]
parameter = [{name = "a", value = 1.2}, {name = "e", value = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2) + x'*y'/10", potential = "0"}
constraint = [{name = "foot", gap = "y", restitution = "e"}]
)toml");
    const std::string expected = words(simulate(model, tight(*model, 4.0)));
    EXPECT_NE(expected.find("zeno"), std::string::npos);
    expect_jump_differences(model, 4.0, expected, 1e-4);
}

TEST(JumpDerivatives, SayWhereThereAreNone) {
    const auto broken = [](const std::string& more) {
        const auto model = typed(points(more));
        return differentiate(simulate(model, tight(*model, 2.0))).broken;
    };
    const auto lands_at = [](const std::string& y) {
        return R"toml(constraint = [{name = "floor", gap = "y", restitution = 0}]
jump = [{name = "land", on = "(x)", set = {y = ")toml" +
               y + R"toml(", "y'" = "1", x = "1"}}])toml";
    };
    EXPECT_EQ(broken(lands_at("0")), "");
    EXPECT_NE(broken(lands_at("e - 0.6")).find("after the jump 'land' the gap of 'floor' is zero"), std::string::npos);
    EXPECT_NE(broken(
                  R"toml(jump = [{name = "a", on = "x + 0", set = {"x'" = "1"}},
    {name = "b", on = "2*x", set = {y = "3"}}])toml")
                  .find("which is first depends on the direction"),
              std::string::npos);
}

TEST(JumpDerivatives, GiveAnErrorEstimate) {
    const auto model = load("simplest_walker");
    achilles::Run run = model->default_run();
    run.options.tolerance = 1e-9;
    const Trajectory rough = simulate(model, run);
    run.options.tolerance = 1e-15;
    const Trajectory exact = simulate(model, run);
    const ErrorEstimate estimate = estimate_error(rough);
    ASSERT_TRUE(estimate.end) << estimate.no_estimate_reason;
    Eigen::VectorXd error(4);
    error << rough.end.q - exact.end.q, rough.end.v - exact.end.v;
    EXPECT_LT((error + Eigen::VectorXd::Zero(4)).norm(), 10.0 * estimate.end->reach());
    EXPECT_LT(estimate.end->reach(), 1e-6);
}

// A thousand steps: the rounding of the estimate itself must not grow, and the walker keeps its period.
TEST(JumpDerivatives, EstimateTheErrorOfALongWalk) {
    const auto model = load("simplest_walker");
    for (const double tolerance : {1e-10, 1e-12, 1e-13}) {
        achilles::Run run = model->default_run();
        run.options.tolerance = tolerance;
        run.options.end_time = 3890.0;
        const Trajectory walk = simulate(model, run);
        ASSERT_EQ(walk.outcome.kind, Outcome::Kind::end_time) << walk.outcome.message;
        ASSERT_GT(walk.events.size(), 1000u);
        const ErrorEstimate estimate = estimate_error(walk);
        ASSERT_TRUE(estimate.end) << tolerance << ": " << estimate.no_estimate_reason;
        EXPECT_LT(estimate.end->reach(), 1e4 * tolerance) << tolerance;
        if (tolerance > 1e-13) continue;
        for (std::size_t k = 50; k < walk.events.size(); ++k)
            EXPECT_NEAR(walk.events[k].t - walk.events[k - 1].t, 3.882463752851374138, 1e-9) << k;
    }
}

}  // namespace
}  // namespace achilles::test
