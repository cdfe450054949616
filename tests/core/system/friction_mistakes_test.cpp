// Every mistake of dry friction, one at a time: the exact message, location and caret.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

// A ball on a floor with friction, and a rough axle.
const std::string rough_ball =
    R"toml(coordinate = [{name = "x", start = 0.1, rate = 0.7}, {name = "y", start = 2}, {name = "phi"}]
parameter = [{name = "mu", value = 0.3}, {name = "R", value = 0.5}]
lagrangian.kinetic = "1/2*(x'^2 + y'^2 + R^2/2*phi'^2)"
lagrangian.potential = "y"
[[constraint]]
gap = "y - R"
slip = "x' + R*phi'"
friction = "mu"
static_friction = 0.4
restitution = 0.5
[[friction]]
name = "axle"
slip = "phi'"
level = 0.01
[truncation]
eps_q = 1e-6
)toml";

struct FrictionMistake {
    const char *name, *from, *to, *message;
};

void PrintTo(const FrictionMistake& one, std::ostream* out) { *out << one.name; }

class FrictionMistakes : public testing::TestWithParam<FrictionMistake> {};

TEST(RoughBall, HasNoMistake) { EXPECT_EQ(test::told(rough_ball), ""); }

TEST_P(FrictionMistakes, AreToldWithTheirPlace) {
    const FrictionMistake& one = GetParam();
    EXPECT_EQ(test::told(test::changed(rough_ball, {{one.from, one.to}})), one.message);
}

const FrictionMistake friction_mistakes[] = {
    {"AnotherWordForInf", "friction = \"mu\"\nstatic_friction = 0.4", "friction = \"infinity\"",
     "f.toml:8:13: unknown name 'infinity'\n    friction = \"infinity\"\n                ^\nwrite friction = \"inf\" "
     "for a contact that never slides"},
    {"WithoutSlip", "slip = \"x' + R*phi'\"\n", "",
     "f.toml:7:12: friction needs the sliding velocity: 'slip' is missing\n    friction = \"mu\"\n               "
     "^\nadd slip, scaled like the gap: for gap = \"y - r\" it is \"x' + r*phi'\", or \"x'\" for a point; with "
     "'between' in place of 'gap' it is derived"},
    {"SlipNotAffine", "\"x' + R*phi'\"", "\"x' + R*phi'^2\"",
     "f.toml:7:14: the slip is not affine in the rates: R*phi'^2\n    slip = \"x' + R*phi'^2\"\n                 ^\na "
     "slip is a velocity: rates times functions of coordinates, t and parameters, plus the speed of a surface, as in "
     "x' + R*phi' - V"},
    {"SlipOfAFunction", "\"x' + R*phi'\"", "\"x' - R*sin(phi')\"",
     "f.toml:7:14: the slip is not affine in the rates: R*sin(phi')\n    slip = \"x' - R*sin(phi')\"\n                 "
     "^\na slip is a velocity: rates times functions of coordinates, t and parameters, plus the speed of a surface, as "
     "in x' + R*phi' - V"},
    {"SlipNotAffineAsAWhole", "\"x' + R*phi'\"", "\"(x' + R)*(phi' - 1)\"",
     "f.toml:7:9: the slip is not affine in the rates: (x' + R)*(phi' - 1)\n    slip = \"(x' + R)*(phi' - 1)\"\n       "
     "     ^\na slip is a velocity: rates times functions of coordinates, t and parameters, plus the speed of a "
     "surface, as in x' + R*phi' - V"},
    {"SlipZeroEverywhere", "\"x' + R*phi'\"", "\"x' - x'\"",
     "f.toml:7:9: the slip is 0 everywhere\n    slip = \"x' - x'\"\n            ^\na slip is the sliding velocity, as "
     "in x'"},
    {"SlipWithoutRate", "\"x' + R*phi'\"", "\"R*t\"",
     "f.toml:7:9: the slip depends on no rate: nothing slides\n    slip = \"R*t\"\n            ^\na slip is the "
     "sliding velocity, as in x'"},
    {"SlipOfAnUnknownName", "\"x' + R*phi'\"", "\"x' + r*phi'\"",
     "f.toml:7:14: unknown name 'r'; did you mean 'R'?\n    slip = \"x' + r*phi'\"\n                 ^"},
    {"SlipOfForces", "\"x' + R*phi'\"", "\"x' + lambda\"",
     "f.toml:7:14: 'lambda' is allowed only in a [[view]]\n    slip = \"x' + lambda\"\n                 ^"},
    {"TwoSlips", "\"x' + R*phi'\"", "[\"x'\", \"phi'\"]",
     "f.toml:7:8: two slips in one [[constraint]]: friction is planar\n    slip = [\"x'\", \"phi'\"]\n           "
     "^\nwrite one expression, the sliding velocity along the tangent; friction in space is not covered"},
    {"Negative", "friction = \"mu\"", "friction = \"mu - 1\"",
     "f.toml:8:13: the friction of 'contact' is negative at the start: -0.7\n    friction = \"mu - 1\"\n               "
     " ^\nfriction is 0 or more, whatever the direction of the slip"},
    {"NegativeStatic", "static_friction = 0.4", "static_friction = -0.4",
     "f.toml:9:19: the static friction of 'contact' is negative at the start: -0.4\n    static_friction = -0.4\n       "
     "               ^\nfriction is 0 or more, whatever the direction of the slip"},
    {"NegativeLevel", "level = 0.01", "level = \"x - 1\"",
     "f.toml:14:10: the level of 'axle' is negative at the start: -0.9\n    level = \"x - 1\"\n             "
     "^\nfriction is 0 or more, whatever the direction of the slip"},
    {"StaticBelowFriction", "static_friction = 0.4", "static_friction = 0.2",
     "f.toml:9:19: the static friction of 'contact' is 0.2 at the start, below its friction at slip 0, 0.3\n    "
     "static_friction = 0.2\n                      ^\nthe limit of sticking is at least the friction with which "
     "sliding begins"},
    {"StaticBelowFrictionAtSlipZero", "friction = \"mu\"", "friction = \"mu + exp(-9*slip)\"",
     "f.toml:9:19: the static friction of 'contact' is 0.4 at the start, below its friction at slip 0, 1.3\n    "
     "static_friction = 0.4\n                      ^\nthe limit of sticking is at least the friction with which "
     "sliding begins"},
    {"StaticLevelBelowLevel", "level = 0.01", "level = 0.01\nstatic_level = 0.001",
     "f.toml:15:16: the static level of 'axle' is 0.001 at the start, below its level at slip 0, 0.01\n    "
     "static_level = 0.001\n                   ^\nthe limit of sticking is at least the friction with which sliding "
     "begins"},
    {"SlipInStaticFriction", "static_friction = 0.4", "static_friction = \"0.4 + slip\"",
     "f.toml:9:26: 'slip' is not allowed here: this is the limit at slip 0\n    static_friction = \"0.4 + slip\"\n     "
     "                        ^"},
    {"SlipInStaticLevel", "level = 0.01", "level = 0.01\nstatic_level = \"slip\"",
     "f.toml:15:17: 'slip' is not allowed here: this is the limit at slip 0\n    static_level = \"slip\"\n             "
     "       ^"},
    {"StaticWithoutFriction", "friction = \"mu\"\n", "",
     "f.toml:8:19: 'static_friction' in [[constraint]] goes with 'friction'\n    static_friction = 0.4\n               "
     "       ^\nadd friction, the coefficient while sliding"},
    {"StaticBesidesInf", "friction = \"mu\"", "friction = \"inf\"",
     "f.toml:9:19: 'static_friction' together with friction = \"inf\"\n    static_friction = 0.4\n"
     "                      ^\nleave it out: a contact that never slides has no limit"},
    {"InfInAProduct", "friction = \"mu\"", "friction = \"2*inf\"",
     "f.toml:8:15: 'inf' stands alone: friction = \"inf\"\n    friction = \"2*inf\"\n                  ^"},
    {"InfiniteLevel", "level = 0.01", "level = \"inf\"",
     "f.toml:14:9: 'level' in [[friction]] must be finite\n    level = \"inf\"\n            ^\nwhat never slides needs "
     "no coordinate: leave that coordinate out"},
    {"RateInFriction", "friction = \"mu\"", "friction = \"mu + phi'\"",
     "f.toml:8:18: the rate phi' is not allowed in the friction: use slip, the sliding speed\n    friction = \"mu + "
     "phi'\"\n                     ^"},
    {"RateInStaticFriction", "static_friction = 0.4", "static_friction = \"x'\"",
     "f.toml:9:20: the rate x' is not allowed in the friction: it may depend only on coordinates, parameters and "
     "time\n    static_friction = \"x'\"\n                       ^"},
    {"ForceInFriction", "friction = \"mu\"", "friction = \"mu*lambda\"",
     "f.toml:8:16: 'lambda' is not allowed here: friction that depends on forces is not covered\n    friction = "
     "\"mu*lambda\"\n                   ^"},
    {"HeatInAForce", "{name = \"phi\"}", "{name = \"phi\", force = \"heat\"}",
     "f.toml:1:103: 'heat' is allowed only in a [[view]]\n    ... 0.7}, {name = \"y\", start = 2}, {name = \"phi\", "
     "force = \"heat\"}]\n                                                               ^"},
    {"SlipInAForce", "{name = \"phi\"}", "{name = \"phi\", force = \"slip\"}",
     "f.toml:1:103: 'slip' is allowed only in friction, in a level and in a [[view]]\n    ... 0.7}, {name = \"y\", "
     "start = 2}, {name = \"phi\", force = \"slip\"}]\n                                                               "
     "^"},
    {"UndefinedAtSlipZero", "friction = \"mu\"", "friction = \"mu/slip\"",
     "f.toml:8:13: the friction mu/slip is not defined at slip 0\n    friction = \"mu/slip\"\n                ^\nit "
     "must have a value for every slip from 0 on, as 0.2 + 0.3*exp(-slip/v0) has"},
    {"UndefinedAtTheStart", "friction = \"mu\"", "friction = \"sqrt(x - 1)\"",
     "f.toml:8:13: the friction of 'contact' is not defined at the start: sqrt(x - 1), with x - 1 = -0.9\n    friction "
     "= \"sqrt(x - 1)\"\n                ^"},
    {"LevelUndefinedAtTheSlipOfTheStart", "level = 0.01", "level = \"sqrt(slip - 1)\"",
     "f.toml:14:10: the level of 'axle' is not defined at the start: sqrt(slip - 1), with slip - 1 = -1\n    level = "
     "\"sqrt(slip - 1)\"\n             ^"},
    {"WithoutLevel", "level = 0.01\n", "", "f.toml:11:1: missing key 'level' in [[friction]]\n    [[friction]]\n    ^"},
    {"WithoutName", "name = \"axle\"\n", "",
     "f.toml:11:1: missing key 'name' in [[friction]]\n    [[friction]]\n    ^\nit is the name in outputs, as in "
     "slip_NAME"},
    {"WithoutJointSlip", "slip = \"phi'\"\n", "",
     "f.toml:11:1: missing key 'slip' in [[friction]]\n    [[friction]]\n    ^"},
    {"NameOfAContact", "name = \"axle\"", "name = \"contact\"",
     "f.toml:12:9: the name 'contact' is used twice\n    name = \"contact\"\n            ^\nit is already the name at "
     "line 5"},
    {"NameUsedTwice", "[[friction]]", "[[friction]]\nname = \"axle\"\nslip = \"x'\"\nlevel = 1\n[[friction]]",
     "f.toml:16:9: the name 'axle' is used twice\n    name = \"axle\"\n            ^\nit is already the name at line "
     "12"},
    {"NameWithASpace", "name = \"axle\"", "name = \"the axle\"",
     "f.toml:12:9: 'the axle' is not a name\n    name = \"the axle\"\n            ^\na name is a letter followed by "
     "letters, digits and underscores"},
    {"FrictionOfAJoint", "level = 0.01", "friction = 0.01",
     "f.toml:14:1: unknown key 'friction' in [[friction]]; did you mean 'level'?\n    friction = 0.01\n    ^\nknown "
     "keys: name, slip, level, static_level"},
    {"LevelOfAContact", "friction = \"mu\"", "level = \"mu\"",
     "f.toml:8:1: unknown key 'level' in [[constraint]]; did you mean 'friction'?\n    level = \"mu\"\n    ^\nknown "
     "keys: name, gap, between, longest, normal, slip, friction, static_friction, restitution, when, latch, begins, "
     "ends, "
     "drawing"},
    {"WordOfAnotherProgram", "friction = \"mu\"", "mu = 0.3",
     "f.toml:8:1: unknown key 'mu' in [[constraint]]; did you mean 'friction'?\n    mu = 0.3\n    ^\nknown keys: name, "
     "gap, between, longest, normal, slip, friction, static_friction, restitution, when, latch, begins, ends, drawing"},
    {"FrictionOfACoordinate", "{name = \"phi\"}", "{name = \"phi\", friction = 1}",
     "f.toml:1:94: unknown key 'friction' in [[coordinate]]\n    ...1, rate = 0.7}, {name = \"y\", start = 2}, {name = "
     "\"phi\", friction = 1}]\n                                                               ^\nfriction is a key of "
     "a [[constraint]]; without a gap it is a table of its own, [[friction]]"},
    {"OneTable", "[[friction]]", "[friction]",
     "f.toml:11:2: 'friction' must be an array of tables, not a table\n    [friction]\n     ^\nwrite one [[friction]] "
     "for each"},
    {"OneTableThatAViewNeeds", "[[friction]]", "[[view]]\nname = \"v\"\nx = \"t\"\ny = [\"slip_axle\"]\n[friction]",
     "f.toml:15:2: 'friction' must be an array of tables, not a table\n    [friction]\n     ^\nwrite one [[friction]] "
     "for each"},
    {"ReservedSlip", "parameter = [", "parameter = [{name = \"slip\", value = 1}, ",
     "f.toml:2:23: the name 'slip' is reserved\n    parameter = [{name = \"slip\", value = 1}, {name = \"mu\", value = "
     "0.3}, {name = \"...\n                          ^\nwith friction slip, friction_force, heat and inf are reserved: "
     "choose another name"},
    {"ReservedInf", "parameter = [", "parameter = [{name = \"inf\", value = 1}, ",
     "f.toml:2:23: the name 'inf' is reserved\n    parameter = [{name = \"inf\", value = 1}, {name = \"mu\", value = "
     "0.3}, {name = \"R...\n                          ^\nwith friction slip, friction_force, heat and inf are "
     "reserved: choose another name"},
    {"ReservedOfSeveral", "parameter = [", "parameter = [{name = \"slip_1\", value = 1}, ",
     "f.toml:2:23: the name 'slip_1' is reserved\n    parameter = [{name = \"slip_1\", value = 1}, {name = \"mu\", "
     "value = 0.3}, {name =...\n                          ^\nwith friction slip_NAME and friction_force_NAME are "
     "reserved: choose another name"},
    {"Euclidean", "eps_q = 1e-6", "reinitialization = \"euclidean\"",
     "f.toml:16:20: the euclidean reinitialization cannot be used with friction\n    reinitialization = \"euclidean\"\n"
     "                       ^\nuse the default, kinetic"},
    {"RowThatVanishes", "slip = \"phi'\"", "slip = \"(x - 0.1)*phi'\"",
     "f.toml:13:9: the slip of 'axle' contains no rate at the start: its factors are 0\n    slip = \"(x - "
     "0.1)*phi'\"\n            ^\nchoose another start: friction cannot act there"},
    {"UnknownEnergyGain", "[truncation]", "[run]\nenergy_gain = \"limit\"\n[truncation]",
     "f.toml:16:16: unknown energy_gain 'limit'\n    energy_gain = \"limit\"\n                   ^\nknown: cap, stop"},
    {"ViewOfOneOfSeveral", "[truncation]", "[[view]]\nname = \"s\"\nx = \"t\"\ny = [\"slip\"]\n[truncation]",
     "f.toml:18:7: 'slip' needs a name here: slip_contact, slip_axle\n    y = [\"slip\"]\n          ^"},
};
INSTANTIATE_TEST_SUITE_P(AllKinds, FrictionMistakes, testing::ValuesIn(friction_mistakes),
                         [](const auto& one) { return one.param.name; });

// The same words are free in a file without friction.
TEST(Friction, ReservesItsWordsOnlyWhereItIs) {
    const std::string plain =
        test::changed(rough_ball, {{"friction = \"mu\"\nstatic_friction = 0.4\n", ""},
                                   {"[[friction]]\nname = \"axle\"\nslip = \"phi'\"\nlevel = 0.01\n", ""}});
    EXPECT_EQ(test::told(test::changed(plain, {{"name = \"mu\"", "name = \"slip\""}})), "");
    EXPECT_EQ(test::told(test::changed(plain, {{"name = \"mu\"", "name = \"heat\""}})), "");
    EXPECT_EQ(test::told(test::changed(plain, {{"name = \"mu\"", "name = \"slip_1\""}})), "");
}

TEST(Friction, IsWithoutAGapAtMostEightTimes) {
    std::string text = rough_ball;
    for (int i = 1; i <= 7; ++i)
        text += "[[friction]]\nname = \"b" + std::to_string(i) + "\"\nslip = \"x'\"\nlevel = 1\n";
    EXPECT_EQ(test::told(text), "");
    text += "[[friction]]\nname = \"b8\"\nslip = \"x'\"\nlevel = 1\n";
    EXPECT_EQ(test::told(text), "f.toml:45:1: more than 8 [[friction]]\n    [[friction]]\n    ^");
}

TEST(Friction, ThatNeverSlidesMayNotStartWithASlip) {
    const std::string foot =
        test::changed(rough_ball, {{"friction = \"mu\"\nstatic_friction = 0.4", "friction = \"inf\""},
                                   {"start = 2", "start = 0.5"},
                                   {", rate = 0.7", ""}});
    EXPECT_EQ(test::told(foot), "");
    EXPECT_EQ(test::told(test::changed(foot, {{"{name = \"phi\"}", "{name = \"phi\", rate = 1}"}})),
              "f.toml:7:9: 'contact' starts in contact with the slip 0.5, but never slides\n    slip = \"x' + "
              "R*phi'\"\n            ^\nchoose rates for which the slip is 0, or a finite friction");
    // Rolling as typed by hand is a slip of 0, and a contact that opens or closes is no sliding start.
    EXPECT_EQ(test::told(test::changed(foot, {{"start = 0.1", "start = 0.1, rate = -0.15"},
                                              {"{name = \"phi\"}", "{name = \"phi\", rate = 0.3}"}})),
              "");
    for (const char* rate : {"start = 0.5, rate = 1", "start = 0.5, rate = -1"})
        EXPECT_EQ(test::told(
                      test::changed(foot, {{"start = 0.5", rate}, {"{name = \"phi\"}", "{name = \"phi\", rate = 1}"}})),
                  "")
            << rate;
}

// With bodies: the same messages, at the places in the file.
const std::string rough_disc =
    R"toml(coordinate = [{name = "x"}, {name = "y", start = 2}, {name = "phi"}]
world = {gravity = [0, -1], points = {hook = [0, 5]}}
body = [{name = "disc", mass = 1, disc = 0.5, at = ["x", "y"], angle = "phi"}]
ground = [{name = "floor", line = [[-2, 0], [2, 0]]}]
constraint = [{between = ["disc", "floor"], friction = 0.3, restitution = 0.5}]
friction = [{name = "axle", slip = "disc.angle'", level = 0.1}]
)toml";

TEST(RoughDisc, HasNoMistake) { EXPECT_EQ(test::told(rough_disc), ""); }

const FrictionMistake mechanism_friction_mistakes[] = {
    {"OfAString", "[\"disc\", \"floor\"]", "[\"world.hook\", \"disc\"], longest = 9",
     "f.toml:5:74: a string has no friction\n    ...tween = [\"world.hook\", \"disc\"], longest = 9, friction = 0.3, "
     "restitution = 0.5}]\n                                                               ^\nleave out 'friction'"},
    {"SlipBesidesBetween", "friction = 0.3", "friction = 0.3, slip = \"x'\"",
     "f.toml:5:68: 'slip' is derived from 'between'\n    ...= [{between = [\"disc\", \"floor\"], friction = 0.3, slip "
     "= \"x'\", restitution = 0.5}]\n                                                               ^\nleave one of "
     "them out"},
    {"BodyInFriction", "friction = 0.3", "friction = \"0.3*disc\"",
     "f.toml:5:61: 'disc' is a body, and a number is needed here\n    ...traint = [{between = [\"disc\", \"floor\"], "
     "friction = \"0.3*disc\", restitution = 0.5}]\n                                                               "
     "^\nwrite disc.x or disc.y, or disc.angle"},
    {"PointInSlip", "disc.angle'", "disk.angle'",
     "f.toml:6:37: unknown body or ground 'disk'; did you mean 'disc'?\n    friction = [{name = \"axle\", slip = "
     "\"disk.angle'\", level = 0.1}]\n                                        ^\nbodies and grounds are: world, floor, "
     "disc"},
};
class MechanismFrictionMistakes : public testing::TestWithParam<FrictionMistake> {};
TEST_P(MechanismFrictionMistakes, AreToldWithTheirPlace) {
    const FrictionMistake& one = GetParam();
    EXPECT_EQ(test::told(test::changed(rough_disc, {{one.from, one.to}})), one.message);
}
INSTANTIATE_TEST_SUITE_P(AllKinds, MechanismFrictionMistakes, testing::ValuesIn(mechanism_friction_mistakes),
                         [](const auto& one) { return one.param.name; });

TEST(Friction, NeedsAMotionAlongTheTangent) {
    EXPECT_EQ(test::told("coordinate = [{name = \"y\", start = 2}]\nworld = {gravity = [0, -1]}\n"
                         "body = [{name = \"disc\", mass = 1, disc = 0.5, at = [0, \"y\"]}]\n"
                         "ground = [{name = \"floor\", line = [[-2, 0], [2, 0]]}]\n"
                         "constraint = [{between = [\"disc\", \"floor\"], friction = 0.3, restitution = 0.5}]\n"),
              "f.toml:5:26: the slip is 0 everywhere\n"
              "    constraint = [{between = [\"disc\", \"floor\"], friction = 0.3, restitution = 0.5}]\n"
              "                             ^\n"
              "the touching point moves only along the normal: leave the friction out");
}

}  // namespace
}  // namespace achilles
