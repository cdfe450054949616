// Units follow from those in the file. Where the file gives none, there is none.
#include "system/units.hpp"

#include <gtest/gtest.h>

#include "core/systems.hpp"
#include "model/read_system.hpp"

namespace achilles {
namespace {

std::string unit(const std::string& system, const std::string& expression) {
    return unit_of_expression(test::load(system)->description(), expression);
}

TEST(Units, FollowFromThoseOfTheFile) {
    EXPECT_EQ(unit("ball_on_sine", "t"), "s");
    EXPECT_EQ(unit("ball_on_sine", "gap"), "m");
    EXPECT_EQ(unit("ball_on_sine", "gap'"), "m/s");
    EXPECT_EQ(unit("ball_on_sine", "gap''"), "m/s^2");
    EXPECT_EQ(unit("ball_on_sine", "lambda"), "N");
    EXPECT_EQ(unit("ball_on_sine", "energy"), "J");
    EXPECT_EQ(unit("ball_on_sine", "sqrt(x'^2 + y'^2)"), "m/s");
    EXPECT_EQ(unit("ball_on_sine", "m*y'"), "kg*m/s");
    EXPECT_EQ(unit("ball_on_sine", "energy/(m*g)"), "m");
    EXPECT_EQ(unit("ball_on_sine", "x'*t - 2*x"), "m");
    EXPECT_EQ(unit("ball_on_sine", "1/(x*t)"), "1/(m*s)");
    EXPECT_EQ(unit("ball_on_sine", "(x'^2)^0.75"), "");  // non-integer powers
    EXPECT_EQ(unit("ball_in_bowl", "c*x"), "");          // 1/m times m
    EXPECT_EQ(unit("bead_in_ring", "r*sin(phi)"), "m");
    EXPECT_EQ(unit("impact_oscillator", "k*x"), "N");  // N/m
    EXPECT_EQ(unit("swinging_leg", "c"), "J");         // "N m", which as a product cannot be distinguished from work
}

TEST(Units, OfAngles) {
    EXPECT_EQ(unit("double_pendulum", "gap"), "rad");
    EXPECT_EQ(unit("double_pendulum", "theta1 + theta2"), "rad");
    EXPECT_EQ(unit("double_pendulum", "gap''"), "rad/s^2");
    EXPECT_EQ(unit("double_pendulum", "L1*theta1'"), "m/s");
    EXPECT_EQ(unit("double_pendulum", "lambda"), "N*m");
    EXPECT_EQ(unit("double_pendulum", " lambda "), "N*m");
    EXPECT_EQ(unit("double_pendulum", "energy"), "J");
    EXPECT_EQ(unit("ball_on_sine", "atan(y/x)"), "rad");
}

// No unit if one term's unit is unknown, or if two terms disagree.
TEST(Units, AreNothingWhereTheyAreNotKnown) {
    const std::string head =
        "title = \"\"\n[[coordinate]]\nname = \"x\"\nstart = 1\nunit = \"m\"\n[[coordinate]]\nname = \"y\"\n"
        "[[coordinate]]\nname = \"z\"\nunit = \"inch\"\n[[parameter]]\nname = \"k\"\nvalue = 1\n";
    const SystemDescription system = parse_system(head +
                                                      "[lagrangian]\nkinetic = \"x'^2+y'^2+z'^2\"\npotential = \"y\"\n"
                                                      "[[constraint]]\ngap = \"x - k\"\nrestitution = 0.5\n",
                                                  "typed.toml");
    for (const char* text : {"y", "z", "y'", "x + y", "k*x", "x + x'", "gap", "lambda", "energy", "nothing", "x +"})
        EXPECT_EQ(unit_of_expression(system, text), "") << text;
    EXPECT_EQ(unit_of_expression(system, "x + 1"), "m");
    EXPECT_EQ(unit_of_expression(system, "x + sin(y)"), "m");
}

// With several constraints each has a gap and a contact force.
TEST(Units, OfSeveralGaps) {
    const SystemDescription system = parse_system(
        "title = \"\"\n[[coordinate]]\nname = \"x\"\nstart = 1\nunit = \"m\"\n[[coordinate]]\nname = \"a\"\nunit = "
        "\"rad\"\n"
        "[[parameter]]\nname = \"J\"\nvalue = 1\nunit = \"kg*m^2\"\n[[parameter]]\nname = \"M\"\nvalue = 1\nunit = "
        "\"kg\"\n[lagrangian]\nkinetic = \"J*a'^2 + M*x'^2\"\npotential = 0\n"
        "[[constraint]]\nname = \"wall\"\ngap = \"x\"\nrestitution = 0\n"
        "[[constraint]]\nname = \"stop\"\ngap = \"a\"\nrestitution = 0\n");
    EXPECT_EQ(unit_of_expression(system, "gap_wall'"), "m/s");
    EXPECT_EQ(unit_of_expression(system, "lambda_wall"), "N");
    EXPECT_EQ(unit_of_expression(system, "gap_stop''"), "rad/s^2");
    EXPECT_EQ(unit_of_expression(system, " lambda_stop "), "N*m");
    EXPECT_EQ(unit_of_expression(system, "gap"), "");
}

}  // namespace
}  // namespace achilles
