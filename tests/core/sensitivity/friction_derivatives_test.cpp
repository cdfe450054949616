// Derivatives of runs with dry friction (theory-friction.md 6) against closed forms and differences of runs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "sensitivity/derivatives.hpp"
#include "sensitivity/error_estimate.hpp"

namespace achilles::test {
namespace {

Run tight_run(const Model& model, double end) {
    Run run = model.default_run();
    run.options.tolerance = 1e-15;
    run.options.end_time = end;
    return run;
}

// The variable of a direction: an initial coordinate or rate, or a parameter.
double& variable(Run& run, Eigen::Index direction) {
    const Eigen::Index n = run.q.size();
    if (direction < n) return run.q[direction];
    if (direction < 2 * n) return run.v[direction - n];
    return run.parameters[static_cast<std::size_t>(direction - 2 * n)];
}

// The final state and the times of the last events, `count` of them.
Eigen::VectorXd outcome_of(const Trajectory& run, std::size_t count) {
    const Eigen::Index n = run.end.q.size();
    Eigen::VectorXd all = Eigen::VectorXd::Zero(2 * n + static_cast<Eigen::Index>(count));
    all.head(2 * n) << run.end.q, run.end.v;
    for (std::size_t i = 0; i < std::min(count, run.events.size()); ++i)
        all[all.size() - 1 - static_cast<Eigen::Index>(i)] = run.events[run.events.size() - 1 - i].t;
    return all;
}

// Compares all derivatives of a run with central differences of fourth order. `expected` are the words of its events.
void expect_differences(const std::string& text, double end, const std::string& expected, double tolerance = 2e-9,
                        double step = 2e-4) {
    const auto model = typed(text);
    const Run start = tight_run(*model, end);
    const Trajectory run = simulate(model, start);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    const Derivatives d = differentiate(run);
    EXPECT_EQ(d.broken, "");
    ASSERT_TRUE(d.end);
    std::string events;
    for (const Event& event : run.events) events += std::string(names_of(event.kind).word) + " ";
    EXPECT_EQ(events, expected);
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(d.directions.size()); ++k) {
        const auto direction = static_cast<std::size_t>(k);
        if (!d.refused[direction].empty()) continue;
        const auto at = [&](double change) {
            Run other = start;
            variable(other, k) += change;
            const Trajectory moved = simulate(model, other);
            return outcome_of(moved, run.events.size());
        };
        const Eigen::VectorXd near = at(step) - at(-step), far = at(2.0 * step) - at(-2.0 * step);
        const Eigen::VectorXd differences = (8.0 * near - far) / (12.0 * step);
        const Eigen::Index n = run.end.q.size();
        ASSERT_EQ(d.events.size(), run.events.size());
        Eigen::VectorXd found(differences.size());
        found.head(2 * n) << d.end->q.col(k), d.end->v.col(k);
        for (std::size_t i = 0; i < d.events.size(); ++i)
            found[2 * n + static_cast<Eigen::Index>(i)] = d.events[i].t[k];
        EXPECT_LT((found - differences).cwiseAbs().maxCoeff(), tolerance * (1.0 + differences.cwiseAbs().maxCoeff()))
            << d.directions[direction] << "\nfound " << found.transpose() << "\ndifferences "
            << differences.transpose();
    }
}

const char* const oscillator = R"toml(parameter = [{name = "F", value = 5}, {name = "k", value = 1}]
coordinate = [{name = "x", start = 9, rate = 3}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "k*x^2/2"
friction = [{name = "joint", slip = "x'", level = "F"}]
)toml";

// It rests at 3 F - A, A^2 = (q0 + F)^2 + v0^2, pi after it reverses at atan(v0/(q0 + F)).
TEST(FrictionDerivatives, OfTheOscillatorAreExact) {
    const auto model = typed(oscillator);
    const Trajectory run = simulate(model, tight_run(*model, 5.0));
    const Derivatives d = differentiate(run);
    ASSERT_TRUE(d.end) << d.broken;
    const double A = std::sqrt(205.0);
    EXPECT_NEAR(d.end->q(0, 0), -0.9778024140774094837, 1e-14);
    EXPECT_NEAR(d.end->q(0, 1), -0.2095290887308734608, 1e-14);
    EXPECT_NEAR(d.end->q(0, 2), 3.0 - 14.0 / A, 1e-13);
    for (Eigen::Index k = 0; k < d.end->v.cols(); ++k) EXPECT_EQ(d.end->v(0, k), 0.0);
    ASSERT_EQ(d.events.size(), 2u);
    for (const Derivatives::EventSensitivity& event : d.events) {
        EXPECT_NEAR(event.t[0], -3.0 / 205.0, 1e-14);
        EXPECT_NEAR(event.t[1], 14.0 / 205.0, 1e-14);
        EXPECT_NEAR(event.t[2], -3.0 / 205.0, 1e-14);
        EXPECT_NEAR(event.v_after(0, 0), 0.0, 1e-14);
    }
    expect_differences(oscillator, 5.0, "reversal stick ");
}

// A block on a slope of a belt, which may stick or slip upwards.
std::string block(double mu, double speed) {
    return fmt::format(
        R"toml(parameter = [{{name = "mu", value = {}}}, {{name = "a", value = 0.5}}, {{name = "V", value = 0.1}}]
coordinate = [{{name = "x", rate = {}}}, {{name = "y"}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "(y - a*x)*(1 + x/50)"
constraint = [{{name = "foot", gap = "y", restitution = 0, slip = "x' + V", friction = "mu"}}]
)toml",
        mu, speed);
}
TEST(FrictionDerivatives, ThroughAReversal) { expect_differences(block(0.3, -1.0), 3.0, "reversal "); }
TEST(FrictionDerivatives, ThroughAStick) { expect_differences(block(0.7, 1.0), 9.0, "stick "); }

// A mass on a belt, held back by a spring, sticks and slips. With F_s > F the acceleration jumps where it slips.
std::string belt(double x, double rate, const std::string& more) {
    return fmt::format(
        R"toml(parameter = [{{name = "V", value = 0.2}}, {{name = "F", value = 0.4}}, {{name = "Fs", value = 1}},
             {{name = "k", value = 1}}]
coordinate = [{{name = "x", start = {}, rate = {}}}, {{name = "y", start = 0.1}}]
lagrangian.kinetic = "x'^2/2 + y'^2"
lagrangian.potential = "k*x^2/2 + (x - y)^2/20 + y^2"
friction = [{{name = "belt", slip = "x' - V", {}}}]
)toml",
        x, rate, more);
}
TEST(FrictionDerivatives, ThroughStartsOfASlip) {
    expect_differences(belt(0.8, 0.0, "level = \"F\", static_level = \"Fs\""), 14.0, "stick slip stick ");
    expect_differences(belt(0.8, 0.0, "level = \"F/(1 + 3*slip) + Fs/10\", static_level = \"Fs\""), 14.0,
                       "stick slip stick ");
}
// The slip of a perturbed start ends after a short time, in which the friction differs for the two signs.
TEST(FrictionDerivatives, FromAStartThatSticks) {
    expect_differences(belt(0.3, 0.2, "level = \"F\", static_level = \"Fs\""), 7.0, "slip stick ", 1e-4, 1e-6);
}
// With a slip to one side the block is carried along, with one to the other side it slides away.
TEST(FrictionDerivatives, RefuseADirectionInWhichOnlyStaticFrictionHolds) {
    const auto model = typed(belt(0.8, 0.2, "level = \"F\", static_level = \"Fs\""));
    const Derivatives d = differentiate(simulate(model, tight_run(*model, 4.0)));
    for (std::size_t k = 0; k < d.directions.size(); ++k) {
        const bool changes_slip = d.directions[k] == "x'" || d.directions[k] == "V";
        EXPECT_EQ(d.refused[k], changes_slip ? "the run starts at slip 0 ('belt'), where its friction jumps, and this "
                                               "direction changes the slip"
                                             : "");
    }
}
TEST(FrictionDerivatives, ThroughAStartOfASlipWithoutJump) {
    expect_differences(R"toml(parameter = [{name = "F", value = 0.8}, {name = "w", value = 0.7}]
coordinate = [{name = "x", start = 0.1, rate = 0.3, force = "sin(w*t)"}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{name = "joint", slip = "x'", level = "F*(1 + slip)"}]
)toml",
                       4.0, "stick slip stick ");
}

// A rod that falls on its end: its slip and gap are coupled.
std::string rod(const std::string& friction, double e, double rate) {
    return fmt::format(
        R"toml(parameter = [{{name = "mu", value = 0.3}}, {{name = "e", value = {}}},
             {{name = "V", value = 0.1}}]
coordinate = [{{name = "x", rate = {}}}, {{name = "y", start = 1.3, rate = -0.2}},
              {{name = "phi", start = 1.1, rate = 0.3}}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y"
[[constraint]]
name = "tip"
gap = "y - sin(phi)"
restitution = "e"
slip = "x' + sin(phi)*phi' - V*cos(t)"
friction = "{}"
)toml",
        e, rate, friction);
}
TEST(FrictionDerivatives, ThroughAnImpactThatSlides) {
    expect_differences(rod("mu", 0.5, 1.5), 1.2, "impact ");
    expect_differences(rod("mu", 0.5, -1.5), 1.2, "impact ");
}
TEST(FrictionDerivatives, ThroughAnImpactThatSticks) { expect_differences(rod("mu + 0.4", 0.5, 0.1), 1.2, "impact "); }
TEST(FrictionDerivatives, ThroughAnImpactWhoseFrictionDependsOnTheSlip) {
    expect_differences(rod("mu/(1 + slip) + 0.1*x", 0.5, 1.5), 1.2, "impact ");
    expect_differences(rod("mu/(1 + slip)", 0.5, -1.5), 1.2, "impact ");
}
TEST(FrictionDerivatives, ThroughAPlasticImpact) {
    std::string text = rod("mu", 0.0, 1.5);
    text.replace(text.find("restitution = \"e\""), 17, "restitution = 0");
    expect_differences(text, 1.2, "impact zeno ");
    text = rod("mu + 2", 0.0, 0.1);
    text.replace(text.find("restitution = \"e\""), 17, "restitution = 0");
    expect_differences(text, 1.2, "impact zeno ");
}

// A point lands on a hill, slides over its crest and leaves it.
TEST(FrictionDerivatives, ThroughARelease) {
    expect_differences(R"toml(parameter = [{name = "mu", value = 0.2}, {name = "A", value = 1}]
coordinate = [{name = "x", start = -0.3, rate = 0.7}, {name = "y", start = 0.05}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
[[constraint]]
name = "hill"
gap = "y + A*x^4/4"
restitution = 0
slip = "x' - A*x^3*y'"
friction = "mu"
)toml",
                       3.0, "impact zeno release ");
}

// The sentence that says why there are no derivatives at the end of a run.
std::string reason_of(const std::string& text, double end) {
    const auto model = typed(text);
    const Trajectory run = simulate(model, tight_run(*model, end));
    const Derivatives d = differentiate(run);
    EXPECT_FALSE(d.end);
    EXPECT_EQ(estimate_error(run).no_estimate_reason, d.broken);
    return d.broken;
}
TEST(FrictionDerivatives, SayWhereThereAreNone) {
    EXPECT_EQ(reason_of(R"toml(coordinate = [{name = "x", rate = 1}, {name = "y", rate = 1}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "0"
friction = [{name = "a", slip = "x'", level = 1}, {name = "b", slip = "y'", level = 1}]
)toml",
                        2.0),
              "the friction of several contacts changes at the same time: which is first depends on the direction of "
              "the perturbation");
    const std::string kane = R"toml(coordinate = [{name = "x", rate = 0.5}, {name = "y", start = 0.72, rate = -1},
              {name = "phi", start = "pi/4"}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y"
[[constraint]]
name = "tip"
gap = "y - sin(phi)"
restitution = 0.9
slip = "x' + sin(phi)*phi'"
friction = 1
)toml";
    EXPECT_EQ(reason_of(kane, 0.1),
              "an impact would gain energy, and its restitution is reduced: derivatives are not computed past it");
    EXPECT_NE(reason_of(R"toml(coordinate = [{name = "x", rate = -20},
              {name = "y", start = "sin(0.6)", rate = "0.5*cos(0.6)"}, {name = "phi", start = 0.6, rate = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2 + phi'^2/3)/2"
lagrangian.potential = "y"
constraint = [{name = "tip", gap = "y - sin(phi)", restitution = 0, slip = "x' + sin(phi)*phi'", friction = "5/3"}]
)toml",
                        10.0)
                  .find("the run stops where its motion is not determined: 'tip' slides"),
              std::string::npos);
}

}  // namespace
}  // namespace achilles::test
