// Every mistake of `when` and [[jump]], one at a time: the exact message, location and caret.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

const std::string thrown_ball =
    R"toml(coordinate = [{name = "x", start = 0.1}, {name = "y", start = 2}]
parameter = [{name = "g", value = 1}]
lagrangian = {kinetic = "(x'^2 + y'^2)/2", potential = "g*y"}
[[constraint]]
name = "floor"
gap = "y"
when = "x"
restitution = 0.5
[[jump]]
name = "throw it"
on = "floor"
when = "x - t"
set = {x = "-x", "y'" = "x' + g*t"}
)toml";

struct JumpMistake {
    const char *name, *from, *to, *message;
};

void PrintTo(const JumpMistake& one, std::ostream* out) { *out << one.name; }

class JumpMistakes : public testing::TestWithParam<JumpMistake> {};

TEST(ThrownBall, HasNoMistake) { EXPECT_EQ(test::told(thrown_ball), ""); }

TEST(ThrownBall, NeedsNoContact) {
    EXPECT_EQ(test::told(R"(coordinate = [{name = "x"}]
lagrangian = {kinetic = "x'^2", potential = "x"}
jump = [{name = "j", on = "x + 1", set = {x = 1}}]
)"),
              "");
}

TEST_P(JumpMistakes, AreToldWithTheirPlace) {
    const JumpMistake& one = GetParam();
    EXPECT_EQ(test::told(test::changed(thrown_ball, {{one.from, one.to}})), one.message);
}

const JumpMistake jump_mistakes[] = {
    {"UnknownContact", "on = \"floor\"", "on = \"flor\"",
     "f.toml:11:7: no [[constraint]] is named 'flor'; did you mean 'floor'?\n    on = \"flor\"\n          ^\nthe "
     "contacts "
     "are floor"},
    {"NameAlone", "on = \"floor\"", "on = \"y\"",
     "f.toml:11:7: 'y' in [[jump]] is no contact\n    on = \"y\"\n          ^\none word is the name of a contact; an "
     "expression that is one name stands in parentheses: on = \"(y)\""},
    {"UnknownNameInOn", "on = \"floor\"", "on = \"z - 1\"",
     "f.toml:11:7: unknown name 'z'\n    on = \"z - 1\"\n          ^"},
    {"UnknownNameInWhen", "when = \"x - t\"", "when = \"x - tt\"",
     "f.toml:12:13: unknown name 'tt'; did you mean 't'?\n    when = \"x - tt\"\n                ^"},
    {"UnknownNameInTheConditionOfAContact", "when = \"x\"", "when = \"u\"",
     "f.toml:7:9: unknown name 'u'\n    when = \"u\"\n            ^"},
    {"ForceInWhen", "when = \"x\"", "when = \"lambda\"",
     "f.toml:7:9: 'lambda' is allowed only in a [[view]]\n    when = \"lambda\"\n            ^"},
    {"SetOfAnUnknownName", "{x = \"-x\"", "{z = \"-x\"",
     "f.toml:13:8: unknown name 'z' in set\n    set = {z = \"-x\", \"y'\" = \"x' + g*t\"}\n           ^\na jump sets "
     "x, "
     "y, x', y'; the name of a rate stands in quotes, as in \"x'\" = \"0\""},
    {"SetOfAParameter", "{x = \"-x\"", "{g = \"-x\"",
     "f.toml:13:8: 'g' is a parameter: a jump sets coordinates and rates\n    set = {g = \"-x\", \"y'\" = \"x' + "
     "g*t\"}\n           ^\nwhat a jump shall change is a coordinate of its own; its kinetic energy may be that of a "
     "unit "
     "mass"},
    {"UnknownNameInAValue", "\"-x\"", "\"-z\"",
     "f.toml:13:14: unknown name 'z'\n    set = {x = \"-z\", \"y'\" = \"x' + g*t\"}\n                 ^"},
    {"SetsNothing", "set = {x = \"-x\", \"y'\" = \"x' + g*t\"}", "set = {}",
     "f.toml:13:7: 'set' in [[jump]] must name the new values\n    set = {}\n          ^\nwrite set = {x = \"-x\"}"},
    {"SetOfAnotherKind", "set = {x = \"-x\", \"y'\" = \"x' + g*t\"}", "set = \"x\"",
     "f.toml:13:7: 'set' in [[jump]] must name the new values\n    set = \"x\"\n          ^\nwrite set = {x = \"-x\"}"},
    {"WithoutSet", "set = {x = \"-x\", \"y'\" = \"x' + g*t\"}", "",
     "f.toml:9:1: missing key 'set' in [[jump]]\n    [[jump]]\n    ^"},
    {"WithoutOn", "on = \"floor\"\n", "", "f.toml:9:1: missing key 'on' in [[jump]]\n    [[jump]]\n    ^"},
    {"WithoutName", "name = \"throw it\"\n", "",
     "f.toml:9:1: missing key 'name' in [[jump]]\n    [[jump]]\n    ^\nit is the name of its events, as in name = "
     "\"legs swap\""},
    {"NameUsedTwice", "[[jump]]", "[[jump]]\nname = \"throw it\"\non = \"floor\"\nset = {x = 1}\n[[jump]]",
     "f.toml:14:9: the name 'throw it' is used twice\n    name = \"throw it\"\n            ^\nit is already the name "
     "at "
     "line 10"},
    {"WordOfAnotherProgram", "[[jump]]", "[[reset]]",
     "f.toml:9:3: unknown key 'reset' in a system file; did you mean 'jump'?\n    [[reset]]\n      ^\nknown keys: "
     "title, "
     "source, coordinate, parameter, lagrangian, constraint, friction, jump, world, body, ground, spring, damper, "
     "force, "
     "torque, run, view, drawing, truncation, orbit, extra"},
    {"LatchOfItself", "restitution = 0.5", "restitution = 0.5\nlatch = \"floor\"",
     "f.toml:9:9: the latch of 'floor' ends with an impact of 'floor' itself\n    latch = \"floor\"\n            ^\na "
     "held contact has no impact: name another contact, or write an expression that rises through zero"},
    {"LatchOfAnUnknownContact", "restitution = 0.5", "restitution = 0.5\nlatch = \"flor\"",
     "f.toml:9:10: no [[constraint]] is named 'flor'; did you mean 'floor'?\n    latch = \"flor\"\n             ^\nthe "
     "contacts are floor"},
    {"LatchWithAName", "restitution = 0.5", "restitution = 0.5\nlatch = \"y\"",
     "f.toml:9:10: 'y' in [[constraint]] is no contact\n    latch = \"y\"\n             ^\none word is the name of a "
     "contact; an expression that is one name stands in parentheses: latch = \"(y)\""},
    {"LatchWithFriction", "restitution = 0.5", "restitution = 0.5\nslip = \"x'\"\nfriction = 0.3\nlatch = \"t - 1\"",
     "f.toml:11:9: 'floor' has a latch and friction\n    latch = \"t - 1\"\n            ^\na latched contact is held "
     "against any force, which leaves its friction undetermined: leave out one of the two"},
    {"HeldInAPotential", "g*y", "g*y*held(floor)",
     "f.toml:3:61: held(NAME) is allowed only in a force and in the dissipation; write what else depends on contact as "
     "a force\n    ...angian = {kinetic = \"(x'^2 + y'^2)/2\", potential = \"g*y*held(floor)\"}\n                      "
     "                                         ^"},
    {"HeldInAGap", "gap = \"y\"", "gap = \"y + held(floor)\"",
     "f.toml:6:12: held(NAME) is allowed only in a force and in the dissipation; write what else depends on contact as "
     "a force\n    gap = \"y + held(floor)\"\n               ^"},
    {"HeldInWhen", "when = \"x\"", "when = \"held(floor)\"",
     "f.toml:7:9: held(NAME) is allowed only in a force and in the dissipation; write what else depends on contact as "
     "a force\n    when = \"held(floor)\"\n            ^"},
    {"HeldInARestitution", "restitution = 0.5", "restitution = \"held(floor)\"",
     "f.toml:8:16: held(NAME) is allowed only in a force and in the dissipation; write what else depends on contact as "
     "a force\n    restitution = \"held(floor)\"\n                   ^"},
    {"HeldOfAnUnknownContact", "start = 0.1", "start = 0.1, force = \"held(flor)\"",
     "f.toml:1:55: no contact is named 'flor'; did you mean 'floor'?\n    coordinate = [{name = \"x\", start = 0.1, "
     "force = \"held(flor)\"}, {name = \"y\", start = 2}]\n                                                          "
     "^"},
    {"HeldWithoutAContact", "start = 0.1", "start = 0.1, force = \"held()\"",
     "f.toml:1:55: held(NAME) takes the name of a contact, and nothing else\n    coordinate = [{name = \"x\", start = "
     "0.1, force = \"held()\"}, {name = \"y\", start = 2}]\n                                                          "
     "^"},
    {"HeldOfAnExpression", "start = 0.1", "start = 0.1, force = \"held(floor + 1)\"",
     "f.toml:1:55: held(NAME) takes the name of a contact, and nothing else\n    coordinate = [{name = \"x\", start = "
     "0.1, force = \"held(floor + 1)\"}, {name = \"y\", start = 2}]\n                                                  "
     "        ^"},
    {"HeldAlone", "start = 0.1", "start = 0.1, force = \"held\"",
     "f.toml:1:50: held(NAME) takes the name of a contact, and nothing else\n    coordinate = [{name = \"x\", start = "
     "0.1, force = \"held\"}, {name = \"y\", start = 2}]\n                                                     ^"},
    {"InactiveInAnOrbitIsUnknown", "[[jump]]", "[orbit]\nq = [1, 1]\nv = [1, 1]\ninactive = [\"flor\"]\n[[jump]]",
     "f.toml:12:13: no [[constraint]] is named 'flor'; did you mean 'floor'?\n    inactive = [\"flor\"]\n              "
     " "
     " ^"},
    {"InactiveInAnOrbitAlwaysCounts", "when = \"x\"\nrestitution = 0.5",
     "restitution = 0.5\n[orbit]\nq = [1, 1]\nv = [1, 1]\ninactive = [\"floor\"]",
     "f.toml:11:13: 'floor' always counts: it has no 'when'\n    inactive = [\"floor\"]\n                ^\nonly a "
     "contact with when can be inactive"},
};
INSTANTIATE_TEST_SUITE_P(AllKinds, JumpMistakes, testing::ValuesIn(jump_mistakes),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace achilles
