// Forces, dissipation and time in a system file: the terms of the equations, and errors.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"
#include "model/read_expressions.hpp"

namespace achilles {
namespace {

using test::changed, test::good, test::told_by_reading;

const std::string x_name = "name = \"x\"\n", theta_name = "name = \"theta\"\n",
                  potential_line = "potential = \"m*x\"\n", kinetic_text = "m/2*(x'^2 + theta'^2)",
                  gap_text = "x - sin(theta)/9";

// Terms of a file's equations at x = 0.7, theta = -0.4, x' = 1.5, theta' = 2.5, m = 3, e = 0.5, t = 6.
class Ingredients {
 public:
    explicit Ingredients(const std::string& text) : system_(parse_system(text)) {
        Names names;
        ErrorCollector mistakes;
        read_equations(system_, layout_, graph_, names, equations, mistakes);
        EXPECT_EQ(mistakes.count(), 0u);
    }
    double value(Expression expression) const {
        const Program program(std::span(&expression, 1), layout_.slots());
        Evaluator<double> result(program);
        const double inputs[] = {0.7, -0.4, 1.5, 2.5, 3.0, 0.5, 6.0};
        for (std::size_t i = 0; i < std::size(inputs); ++i) result.input(i) = inputs[i];
        result.fix();
        result.run();
        return result.output(0);
    }
    Equations equations;

 private:
    SystemDescription system_;
    Layout layout_{2, 2};
    Graph graph_;
};

TEST(Forces, AreZeroByDefault) {
    const Ingredients none(good);
    ASSERT_EQ(none.equations.Q.size(), 2u);
    EXPECT_TRUE(none.equations.Q[0].is_zero());
    EXPECT_TRUE(none.equations.Q[1].is_zero());
}

TEST(Forces, MayHaveCoordinatesRatesTimeAndParameters) {
    const Ingredients one(changed(good, {{theta_name, theta_name + "force = \"m*cos(2*t) - x*theta'^3\"\n"}}));
    EXPECT_TRUE(one.equations.Q[0].is_zero());
    EXPECT_NEAR(one.value(one.equations.Q[1]), 3.0 * std::cos(12.0) - 0.7 * 2.5 * 2.5 * 2.5, 1e-12);
    const Ingredients number(changed(good, {{theta_name, theta_name + "force = -2\n"}}));
    EXPECT_EQ(number.value(number.equations.Q[1]), -2.0);
}

TEST(Forces, MinusTheRateDerivativesOfTheDissipationBelongToThem) {
    const std::string text = changed(
        good, {{x_name, x_name + "force = \"m*x\"\n"},
               {potential_line, potential_line + "dissipation = \"t/2*(theta' - x')^2 + m*x'^4/4 + x*theta'\"\n"}});
    const Ingredients both(text);
    EXPECT_NEAR(both.value(both.equations.Q[0]), 3.0 * 0.7 + 6.0 * (2.5 - 1.5) - 3.0 * 1.5 * 1.5 * 1.5, 1e-12);
    EXPECT_NEAR(both.value(both.equations.Q[1]), -6.0 * (2.5 - 1.5) - 0.7, 1e-12);
}

TEST(Time, MayStandInThePotentialAndTheGap) {
    const Ingredients moving(changed(good, {{"\"m*x\"", "\"m*x*t\""}, {gap_text, "x - 0.1*sin(t)"}}));
    EXPECT_NEAR(moving.value(moving.equations.potential), 3.0 * 0.7 * 6.0, 1e-12);
    EXPECT_NEAR(moving.value(moving.equations.gaps[0]), 0.7 - 0.1 * std::sin(6.0), 1e-12);
}

// One change of the valid text, and the whole message for it.
struct WrongForce {
    std::string from, to, message;
};

void PrintTo(const WrongForce& change, std::ostream* out) { *out << change.to; }

class WrongForces : public testing::TestWithParam<WrongForce> {};

TEST_P(WrongForces, IsToldWithItsPlace) {
    const WrongForce& change = GetParam();
    EXPECT_EQ(told_by_reading(changed(good, {{change.from, change.to}})), change.message);
}

const WrongForce wrong_forces[] = {
    {"restitution = \"e\"", "restitution = \"e*t\"",
     "f.toml:19:18: 't' is not allowed in the restitution: use only parameters\n    restitution = \"e*t\"\n            "
     "         ^"},
    {"\"m*x\"", "\"m*x'\"",
     "f.toml:16:16: the rate x' is not allowed in the potential: write terms with rates in a force or in the "
     "dissipation\n    potential = \"m*x'\"\n                   ^"},
    {gap_text, "x + theta'",
     "f.toml:18:12: the rate theta' is not allowed in the gap: it may depend only on coordinates, parameters and "
     "time\n    gap = \"x + theta'\"\n               ^"},
    {theta_name, theta_name + "force = \"m*thta'\"\n",
     "f.toml:8:12: unknown name thta'; did you mean theta'?\n    force = \"m*thta'\"\n               ^"},
    {theta_name, theta_name + "force = \"m*x +\"\n",
     "f.toml:8:15: the expression ends where a value is expected\n    force = \"m*x +\"\n                  ^"},
    {theta_name, theta_name + "force = \"m*lambda\"\n",
     "f.toml:8:12: 'lambda' is allowed only in a [[view]]\n    force = \"m*lambda\"\n               ^"},
    {theta_name, theta_name + "force = \"m*x''\"\n",
     "f.toml:8:12: the acceleration x'' is not allowed in an expression: it follows from the equations of motion\n    "
     "force = \"m*x''\"\n               ^"},
    {theta_name, theta_name + "force = \"\"\n",
     "f.toml:8:10: 'force' in [[coordinate]] is empty\n    force = \"\"\n             ^\nan expression is expected"},
    {theta_name, theta_name + "force = true\n",
     "f.toml:8:9: 'force' in [[coordinate]] must be an expression (a string or a number), not true or false\n    force "
     "= true\n            ^"},
    {theta_name, theta_name + "forces = \"m\"\n",
     "f.toml:8:1: unknown key 'forces' in [[coordinate]]; did you mean 'force'?\n    forces = \"m\"\n    ^\nknown "
     "keys: name, start, rate, force, unit, range, rate_range"},
    {potential_line, potential_line + "dissipation = \"c/2*x'^2\"\n",
     "f.toml:17:16: unknown name 'c'\n    dissipation = \"c/2*x'^2\"\n                   ^"},
};
INSTANTIATE_TEST_SUITE_P(Reading, WrongForces, testing::ValuesIn(wrong_forces));

}  // namespace
}  // namespace achilles
