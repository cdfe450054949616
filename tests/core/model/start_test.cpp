// Invalid starts: parameters that have lost digits, and energies or gaps without a value.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/systems.hpp"
#include "model/read_system.hpp"
#include "number/float_environment.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

using test::told;

std::string text_with(const std::string& mass, const std::string& kinetic, const std::string& potential,
                      const std::string& gap) {
    return "title = \"edge\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n[[parameter]]\nname = \"m\"\nvalue = " + mass +
           "\n[lagrangian]\nkinetic = \"" + kinetic + "\"\npotential = \"" + potential +
           "\"\n[[constraint]]\ngap = \"" + gap + "\"\nrestitution = 0.5\n";
}

// ---- small parameters ----

TEST(SubnormalParameters, AreNumbersThatHaveLostDigits) {
    constexpr double min_normal = std::numeric_limits<double>::min();
    for (const double x : {5e-324, -5e-324, 0.5 * min_normal, std::nextafter(min_normal, 0.0)})
        EXPECT_TRUE(is_subnormal(x)) << x;
    for (const double x : {0.0, -0.0, min_normal, -min_normal, 1.0, 1e308, HUGE_VAL}) EXPECT_FALSE(is_subnormal(x));
}

TEST(SubnormalParameters, AreRefusedWhereTheyStand) {
    EXPECT_EQ(told(text_with("5e-324", "m*x'^2/2", "m*x", "x")),
              "f.toml:7:9: the parameter 'm' is 5e-324: such a small number is not represented with full precision\n   "
              " value = 5e-324\n            ^\nuse 0, or choose units in which it is at least 2.3e-308 in size");
    EXPECT_EQ(told(text_with("3e-308", "m*x'^2/2", "m*x", "x")), "");
    EXPECT_EQ(told(text_with("0", "x'^2/2", "m*x", "x")), "");
}

TEST(SubnormalParameters, AreRefusedWhereTheyAreSet) {
    const SystemDescription description = parse_system(text_with("1", "m*x'^2/2", "m*x", "x"), "f.toml");
    auto set = default_run(description);
    try {
        assign(set, description, "m=-1e-310");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "--set m=-1e-310: the parameter 'm' is -1e-310: such a small number is not represented with full "
                  "precision\nuse 0, or choose units in which it is at least 2.3e-308 in size");
    }
    assign(set, description, "x=5e-324");  // start values may be subnormal
    const auto model = test::typed(text_with("1", "m*x'^2/2", "m*x", "x"));
    auto run = model->default_run();
    run.parameters[0] = 5e-324;
    EXPECT_THROW(model->check(run), InputError);
}

// ---- terms without a value at the start ----

TEST(StartsWithoutAValue, NeedAPotential) {
    // The force has a value, 1/(x - 2) = -1; only the potential has none.
    EXPECT_EQ(told(text_with("1", "x'^2/2", "log(x - 2)", "x")),
              "f.toml:10:14: the potential is not defined at the start: log(x - 2), with x - 2 = -1\n"
              "    potential = \"log(x - 2)\"\n                 ^");
    EXPECT_EQ(told(text_with("1", "x'^2/2", "m*x + 1/(x - 1)", "x")),
              "f.toml:10:14: the potential is not defined at the start: 1/(x - 1), with x - 1 = 0\n"
              "    potential = \"m*x + 1/(x - 1)\"\n                 ^");
    EXPECT_EQ(told(text_with("1", "x'^2/2", "exp(1000*x)", "x")),
              "f.toml:10:14: the potential is not finite at the start\n"
              "    potential = \"exp(1000*x)\"\n                 ^");
    // The value exists, its derivative does not.
    EXPECT_EQ(told(text_with("1", "x'^2/2", "sqrt(x - 1)", "x")),
              "f.toml:10:14: a derivative of the potential is not defined at the start: 1/2/sqrt(x - 1), with "
              "sqrt(x - 1) = 0\n    potential = \"sqrt(x - 1)\"\n                 ^");
}

TEST(StartsWithoutAValue, NeedAKineticEnergy) {
    EXPECT_EQ(told(text_with("1", "(5 + log(x - 2))*x'^2/2", "x", "x")),
              "f.toml:9:12: the kinetic energy is not defined at the start: log(x - 2), with x - 2 = -1\n"
              "    kinetic = \"(5 + log(x - 2))*x'^2/2\"\n               ^");
    EXPECT_EQ(told(text_with("1", "x'^2/2/(x - 1)^2", "x", "x")),
              "f.toml:9:12: the kinetic energy is not defined at the start: x'^2/(x - 1)^2, with (x - 1)^2 = 0\n"
              "    kinetic = \"x'^2/2/(x - 1)^2\"\n               ^");
}

TEST(StartsWithoutAValue, NeedAGap) {
    EXPECT_EQ(told(text_with("1", "x'^2/2", "x", "5 + log(x - 2)")),
              "f.toml:12:8: the gap is not defined at the start: log(x - 2), with x - 2 = -1\n"
              "    gap = \"5 + log(x - 2)\"\n           ^");
    // A kink at the start.
    const std::string message = told(text_with("1", "x'^2/2", "x", "x - sqrt((x - 1)^2)"));
    EXPECT_EQ(message.substr(0, 57), "f.toml:12:8: a derivative of the gap is not defined at th") << message;
    const std::string infinite = told(text_with("1", "x'^2/2", "x", "exp(1000*x)"));
    EXPECT_EQ(infinite.substr(0, 50), "f.toml:12:8: the gap is not finite at the start\n  ") << infinite;
}

TEST(Start, IsOfTheSameSystem) {
    const auto of_five = test::load("ball_down_a_wave"), of_three = test::load("ball_on_sine");
    EXPECT_THROW(simulate(of_five, of_three->default_run()), InputError);
    EXPECT_THROW(simulate(of_three, achilles::Run{}), InputError);
    EXPECT_THROW(Model(SystemDescription{}), InputError);
}

TEST(Start, IsFollowedByTimesThatAreNumbers) {
    const auto model = test::load("ball_on_sine");
    const Trajectory run = simulate(model, model->default_run());
    EXPECT_THROW(run(std::numeric_limits<double>::quiet_NaN()), InputError);
    EXPECT_EQ(run(1e9).t, run.end_time);
}

}  // namespace
}  // namespace achilles
