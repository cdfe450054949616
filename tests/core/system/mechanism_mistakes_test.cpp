// Every mistake of a mechanism, one at a time: the exact message, location and caret.
#include <gtest/gtest.h>

#include <ctime>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

const std::string ball_over_floor =
    R"toml(coordinate = [{name = "x", start = 0.1}, {name = "y", start = 2}, {name = "phi"}]
parameter = [{name = "m", value = 1}, {name = "r", value = 0.3}, {name = "g", value = 9.81}]
world = {gravity = [0, "-g"], points = {hook = [0, 5]}}
body = [
  {name = "ball", mass = "m", disc = "r", at = ["x", "y"], angle = "phi"},
]
ground = [{name = "floor", line = [[-2, 0], [2, 0]]}]
spring = [{between = ["world.hook", "ball"], stiffness = 3, rest = 1}]
constraint = [{between = ["ball", "floor"], restitution = 0.5}]
)toml";

struct MechanismMistake {
    const char *name, *from, *to, *message;
};

void PrintTo(const MechanismMistake& one, std::ostream* out) { *out << one.name; }

class MechanismMistakes : public testing::TestWithParam<MechanismMistake> {};

TEST(BallOverFloor, HasNoMistake) { EXPECT_EQ(test::told(ball_over_floor), ""); }

TEST_P(MechanismMistakes, AreToldWithTheirPlace) {
    const MechanismMistake& one = GetParam();
    EXPECT_EQ(test::told(test::changed(ball_over_floor, {{one.from, one.to}})), one.message);
}

// Words of MJCF, URDF, Modelica and of formulas, in place of the keys.
TEST(WordsOfOtherPrograms, LeadToTheKeysOfBodies) {
    for (const auto& [from, to, question] :
         {std::tuple{"mass = \"m\"", "m = \"m\"", "unknown key 'm' in [[body]]; did you mean 'mass'?"},
          {"disc = \"r\"", "radius = \"r\"", "unknown key 'radius' in [[body]]; did you mean 'disc'?"},
          {"angle = \"phi\"", "rotation = \"phi\"", "unknown key 'rotation' in [[body]]; did you mean 'angle'?"},
          {"stiffness = 3", "k = 3", "unknown key 'k' in [[spring]]; did you mean 'stiffness'?"},
          {"rest = 1", "s_unstretched = 1", "unknown key 's_unstretched' in [[spring]]; did you mean 'rest'?"},
          {"gravity = [", "g = [", "unknown key 'g' in [world]; did you mean 'gravity'?"},
          {"spring = [{", "gravity = -9.81\nspring = [{", "with bodies write world = {gravity = [0, -9.81]}"}}) {
        const std::string message = test::told(test::changed(ball_over_floor, {{from, to}}));
        EXPECT_NE(message.find(question), std::string::npos) << message;
    }
}

const MechanismMistake mechanism_mistakes[] = {
    {"Acceleration", R"m(0]]}]
)m",
     R"m(0]]}]
view = [{name = "v", x = "t", y = ["ball.x''"]}]
)m",
     R"m(f.toml:8:37: ball.x'' is an acceleration
    view = [{name = "v", x = "t", y = ["ball.x''"]}]
                                        ^
it follows from the equations of motion)m"},
    {"AngleOfAPoint", R"m(0]]}]
)m",
     R"m(0]]}]
view = [{name = "v", x = "t", y = ["ball.center.angle"]}]
)m",
     R"m(f.toml:8:37: the point 'ball.center' has no angle
    view = [{name = "v", x = "t", y = ["ball.center.angle"]}]
                                        ^
write ball.angle)m"},
    {"CenterWithoutInertia", R"m(disc = "r", )m", R"m(disc = "r", center = [0.1, 0], )m",
     R"m(f.toml:5:52: 'ball' has a center of its own, so its mass is not spread evenly: 'inertia' is missing
      {name = "ball", mass = "m", disc = "r", center = [0.1, 0], at = ["x", "y"], angle = "phi"},
                                                       ^
add inertia, about the center of mass)m"},
    {"BodiesInACircle", R"m(at = [")m", R"m(at = "arm.end"},
  {name = "arm", rod = [[0, 0], [1, 0]], at = ["ball.)m",
     R"m(f.toml:5:12: the bodies are placed on each other in a circle: ball -> arm -> ball
      {name = "ball", mass = "m", disc = "r", at = "arm.end"},
               ^
place one of them by coordinates; for a closed loop choose coordinates that close the loop, or use a stiff spring)m"},
    {"BodyOnItself", R"m("x", ")m", R"m("x", "ball.)m",
     R"m(f.toml:5:12: the bodies are placed on each other in a circle: ball -> ball
      {name = "ball", mass = "m", disc = "r", at = ["x", "ball.y"], ang...
               ^
place one of them by coordinates; for a closed loop choose coordinates that close the loop, or use a stiff spring)m"},
    {"LineOfNoLength", R"m([[-2, 0], [2, 0]])m", R"m([["m - 3", 0], [-2, 0]])m",
     R"m(f.toml:7:35: 'line' in [[ground]]: its ends are one point
    ground = [{name = "floor", line = [["m - 3", 0], [-2, 0]]}]
                                      ^)m"},
    {"MassWithUnit", R"m(mass = "m")m", R"m(mass = "2 mg")m",
     R"m(f.toml:5:29: 'mg' may not follow a number: write numbers without units (a file has the key unit for that) and products with '*'
      {name = "ball", mass = "2 mg", disc = "r", at = ["x", "y"], angle = "phi"},
                                ^
write the number alone, in kg, m, s, rad and N)m"},
    {"OneEnd", R"m(["ball", "floor"])m", R"m(["ball"])m",
     R"m(f.toml:9:26: 'between' in [[constraint]] must be [what touches, what is touched], not 1 item
    constraint = [{between = ["ball"], restitution = 0.5}]
                             ^)m"},
    {"ThirdAxis", R"m(0]]}]
)m",
     R"m(0]]}]
view = [{name = "v", x = "t", y = ["ball.center.z"]}]
)m",
     R"m(f.toml:8:37: 'ball.center.z' is not a coordinate of a point
    view = [{name = "v", x = "t", y = ["ball.center.z"]}]
                                        ^
write ball.center.x or ball.center.y)m"},
    {"UnknownShape", R"m(disc = "r")m", R"m(rodd = "r")m",
     R"m(f.toml:5:31: unknown key 'rodd' in [[body]]; did you mean 'rod'?
      {name = "ball", mass = "m", rodd = "r", at = ["x", "y"], angle = "phi"},
                                  ^
known keys: name, at, angle, on, mass, rod, disc, ring, box, polygon, center, inertia, points, color, width, hidden)m"},
    {"UnknownShapeOfAGround", R"m(line = [[-2)m", R"m(lin = [[-2)m",
     R"m(f.toml:7:28: unknown key 'lin' in [[ground]]; did you mean 'line'?
    ground = [{name = "floor", lin = [[-2, 0], [2, 0]]}]
                               ^
known keys: name, line, curve, over, disc, ring, at, on, speed)m"},
    {"UnknownTable", R"m(body = [)m", R"m(bodies = [)m",
     R"m(f.toml:4:1: unknown key 'bodies' in a system file; did you mean 'body'?
    bodies = [
    ^
known keys: title, source, coordinate, parameter, lagrangian, constraint, friction, jump, world, body, ground, spring, damper, force, torque, run, view, drawing, truncation, orbit, extra)m"},
    {"Color", R"m(disc = "r", )m", R"m(disc = "r", color = "red", )m",
     R"m(f.toml:5:52: 'red' is not a color
      {name = "ball", mass = "m", disc = "r", color = "red", at = ["x", "y"], angle = "phi"},
                                                       ^
write a color as "#rrggbb")m"},
    {"DiscOnACurve", R"m(line = [[-2, 0], [2, 0])m", R"m(curve = "sin(x)/9", over = [-1, 1)m",
     R"m(f.toml:9:26: the distance of the disc 'ball' from the curve 'floor' has no closed form
    constraint = [{between = ["ball", "floor"], restitution = 0.5}]
                             ^
use coordinates s, along the curve, and d: place the body with on = "floor", at = ["s", "r + d"]; then between = ["ball", "floor"] gives the gap d, exact while r + d is below the radius of curvature of every valley)m"},
    {"TwoDots", R"m("phi"},)m", R"m("phi"}, {name = "k", mass = 1, at = "ball.foo.bar"},)m",
     R"m(f.toml:5:105: 'ball.foo.bar' is not a point
    ..."x", "y"], angle = "phi"}, {name = "k", mass = 1, at = "ball.foo.bar"},
                                                               ^
a point is [x, y], a body, or a body and a point, as in "thigh.end")m"},
    {"GapBesidesBetween", R"m("floor"], )m", R"m("floor"], gap = "y", )m",
     R"m(f.toml:9:51: 'gap' is derived from 'between'
    constraint = [{between = ["ball", "floor"], gap = "y", restitution = 0.5}]
                                                      ^
leave one of them out)m"},
    {"GroundWithoutShape", R"m("floor", line = [[-2, 0], [2, 0]])m", R"m("floor")m",
     R"m(f.toml:7:11: the ground 'floor' has no shape
    ground = [{name = "floor"}]
              ^
write one of: line = [from, to], curve = "f(x)", disc = r, ring = r)m"},
    {"UnknownKey", R"m("ball", mass)m", R"m("ball", masss)m",
     R"m(f.toml:5:19: unknown key 'masss' in [[body]]; did you mean 'mass'?
      {name = "ball", masss = "m", disc = "r", at = ["x", "y"], angle = "phi"}...
                      ^
known keys: name, at, angle, on, mass, rod, disc, ring, box, polygon, center, inertia, points, color, width, hidden)m"},
    {"KineticBesidesBodies", R"m(0]]}]
)m",
     R"m(0]]}]
lagrangian = {kinetic = "x'^2"}
)m",
     R"m(f.toml:8:25: 'kinetic' is derived from the bodies, and may not be given besides
    lagrangian = {kinetic = "x'^2"}
                            ^
leave it out, or leave out [[body]]; potential, dissipation and force may be given)m"},
    {"StringTooShort", R"m("ball", "floor"])m", R"m("world.hook", "ball"], longest = 1)m",
     R"m(f.toml:9:26: 'world.hook' and 'ball' start 2.002 farther apart than the string is long
    constraint = [{between = ["world.hook", "ball"], longest = 1, restitution = 0.5}]
                             ^
choose a nearer start or a longer string)m"},
    {"LongestWithoutBetween", R"m(between = ["ball", "floor"])m", R"m(gap = "y", longest = 1)m",
     R"m(f.toml:9:37: 'longest' in [[constraint]] goes with 'between'
    constraint = [{gap = "y", longest = 1, restitution = 0.5}]
                                        ^)m"},
    {"NormalOfAString", R"m("ball", "floor"])m", R"m("world.hook", "ball"], longest = 10, normal = true)m",
     R"m(f.toml:9:73: 'normal' goes with a curve only: every other gap is a distance
    ...etween = ["world.hook", "ball"], longest = 10, normal = true, restitution = 0.5}]
                                                               ^
leave it out)m"},
    {"MassThatChanges", R"m(mass = "m)m", R"m(mass = "m*x)m",
     R"m(f.toml:5:29: the coordinate 'x' is not allowed here: use only parameters
      {name = "ball", mass = "m*x", disc = "r", at = ["x", "y"], angle = "phi"},
                                ^)m"},
    {"NegativeInertia", R"m(disc = "r", )m", R"m(disc = "r", inertia = -1, )m",
     R"m(f.toml:5:53: 'inertia' in [[body]] must not be negative, not -1
      {name = "ball", mass = "m", disc = "r", inertia = -1, at = ["x", "y"], angle = "phi"},
                                                        ^)m"},
    {"NegativeMass", R"m(mass = ")m", R"m(mass = "-)m",
     R"m(f.toml:5:27: 'mass' in [[body]] must not be negative, not -1
      {name = "ball", mass = "-m", disc = "r", at = ["x", "y"], angle = "phi"},
                              ^)m"},
    {"NegativeRadius", R"m(disc = ")m", R"m(disc = "-)m",
     R"m(f.toml:5:39: 'disc' in [[body]] must be positive, not -0.3
      {name = "ball", mass = "m", disc = "-r", at = ["x", "y"], angle = "phi"},
                                          ^)m"},
    {"GapWithoutCoordinate", R"m(["ball)m", R"m(["world.hook)m",
     R"m(f.toml:9:26: the gap of world.hook on floor depends on no coordinate: h = 5
    constraint = [{between = ["world.hook", "floor"], restitution = 0.5}]
                             ^
what touches or what is touched must move with a coordinate)m"},
    {"BoxWithoutCorner", R"m(disc = "r")m", R"m(box = [1, "r"])m",
     R"m(f.toml:9:28: 'ball' cannot touch as a whole: only a point or a disc touches
    constraint = [{between = ["ball", "floor"], restitution = 0.5}]
                               ^
name a corner, one [[constraint]] for each: ball.lower_left, ball.lower_right, ball.upper_left, ball.upper_right)m"},
    {"SpringWithoutRest", R"m(3, rest = 1)m", R"m(3)m",
     R"m(f.toml:8:11: missing key 'rest' in [[spring]]: its length without force
    spring = [{between = ["world.hook", "ball"], stiffness = 3}]
              ^
write rest = 0 for a spring that pulls its ends together)m"},
    {"GroundWithoutName", R"m(name = "floor", )m", R"m()m",
     R"m(f.toml:7:11: missing key 'name' in [[ground]]
    ground = [{line = [[-2, 0], [2, 0]]}]
              ^)m"},
    {"NothingTouched", R"m("ball", "floor)m", R"m("ball", "world.hook)m",
     R"m(f.toml:9:36: 'world.hook' has nothing that can be touched
    constraint = [{between = ["ball", "world.hook"], restitution = 0.5}]
                                       ^
a ground, or a body with a rod, a disc or a ring can; for a string between two points add longest = its length; two points that stay together are a closed loop: choose coordinates that close the loop, or use a stiff spring)m"},
    {"PointTouched", R"m("ball", "floor")m", R"m("ball", [0, 1])m",
     R"m(f.toml:9:35: nothing can be touched at a point
    constraint = [{between = ["ball", [0, 1]], restitution = 0.5}]
                                      ^
name a ground or a body; for a string between two points add longest = its length; two points that stay together are a closed loop: choose coordinates that close the loop, or use a stiff spring)m"},
    {"OnAGroundWithoutPlace", R"m(at = ["x", "y"])m", R"m(on = "floor")m",
     R"m(f.toml:5:3: 'ball' is on the ground 'floor': 'at' must be [s, d]
      {name = "ball", mass = "m", disc = "r", on = "floor", an...
      ^
s is the place along the ground, d the distance from it to the free side)m"},
    {"SpringOnOneBody", R"m("world.hook", "ball)m", R"m("ball", "ball.center)m",
     R"m(f.toml:8:22: both ends are on one body, ball
    spring = [{between = ["ball", "ball.center"], stiffness = 3, rest = 1}]
                         ^
an end belongs to another body, or to the world)m"},
    {"ContactOnOneBody", R"m("ball", "floor)m", R"m("ball.center", "ball)m",
     R"m(f.toml:9:26: both ends are on one body, 'ball': their distance does not change
    constraint = [{between = ["ball.center", "ball"], restitution = 0.5}]
                             ^
a contact is between two bodies, or a body and a ground)m"},
    {"Penetration", R"m("y", start = )m", R"m("y", start = -0.)m",
     R"m(f.toml:9:26: 'ball' starts 0.5 behind 'floor'
    constraint = [{between = ["ball", "floor"], restitution = 0.5}]
                             ^
a line is free on the left of from-to; swap its ends?)m"},
    {"NoMassMoved", R"m(mass = "m", )m", R"m(mass = "m", inertia = "0*m", )m",
     R"m(f.toml:1:76: no mass moves with 'phi', so M is singular
    ... = "x", start = 0.1}, {name = "y", start = 2}, {name = "phi"}]
                                                               ^
give a body whose place or angle depends on 'phi' a mass or an inertia)m"},
    {"MassZeroAtTheStart", R"m("m", value = 1}, {name = "r", value = 0.3}, {name = "g", value = 9.81}]
world = {gravity = [0, "-g"], points = {hook = [0, 5]}}
body = [
  {name = "ball", mass = "m)m",
     R"m("J", value = 0}, {name = "m", value = 1}, {name = "r", value = 0.3}, {name = "g", value = 9.81}]
world = {gravity = [0, "-g"], points = {hook = [0, 5]}}
body = [
  {name = "ball", mass = "m", inertia = "J)m",
     R"m(f.toml:1:76: the mass matrix is not positive definite at the start (the pivot of 'phi' is 0)
    ... = "x", start = 0.1}, {name = "y", start = 2}, {name = "phi"}]
                                                               ^
every coordinate needs a positive inertia)m"},
    {"BodyAsNumber", R"m(angle = "phi)m", R"m(angle = "phi + ball)m",
     R"m(f.toml:5:75: 'ball' is a body, and a number is needed here
    ...mass = "m", disc = "r", at = ["x", "y"], angle = "phi + ball"},
                                                               ^
write ball.x or ball.y, or ball.angle)m"},
    {"BodyAsNumberInGap", R"m(between = ["ball", "floor"])m", R"m(gap = "y + ball")m",
     R"m(f.toml:9:27: 'ball' is a body, and a number is needed here
    constraint = [{gap = "y + ball", restitution = 0.5}]
                              ^
write ball.x or ball.y, or ball.angle)m"},
    {"PointAsNumberInView", R"m(0]]}]
)m",
     R"m(0]]}]
view = [{name = "v", x = "t", y = ["ball.center"]}]
)m",
     R"m(f.toml:8:37: 'ball.center' is a point, and a number is needed here
    view = [{name = "v", x = "t", y = ["ball.center"]}]
                                        ^
write ball.center.x or ball.center.y)m"},
    {"BodyAsNumberInView", R"m(0]]}]
)m",
     R"m(0]]}]
view = [{name = "v", x = "t", y = ["ball"]}]
)m",
     R"m(f.toml:8:37: 'ball' is a body, and a number is needed here
    view = [{name = "v", x = "t", y = ["ball"]}]
                                        ^
write ball.x or ball.y, or ball.angle)m"},
    {"ReservedPoint", R"m(disc = "r", )m", R"m(disc = "r", points = {center = [0,1]}, )m",
     R"m(f.toml:5:53: the point name 'center' is reserved
      {name = "ball", mass = "m", disc = "r", points = {center = [0,1]}, at = ["x", "y"], angle = "phi"},
                                                        ^
choose another name)m"},
    {"RateInAPlace", R"m(at = ["x)m", R"m(at = ["x')m",
     R"m(f.toml:5:50: the rate x' is not allowed here: use only coordinates, parameters and t
      {name = "ball", mass = "m", disc = "r", at = ["x'", "y"], angle = "phi"},
                                                     ^)m"},
    {"InertiaZero", R"m(mass = "m", )m", R"m(mass = "m", inertia = 0, )m",
     R"m(f.toml:1:76: no mass moves with 'phi', so M is singular
    ... = "x", start = 0.1}, {name = "y", start = 2}, {name = "phi"}]
                                                               ^
give a body whose place or angle depends on 'phi' a mass or an inertia)m"},
    {"SpringBetweenAndAngle", R"m(rest = 1)m", R"m(rest = 1, angle = "phi")m",
     R"m(f.toml:8:79: [[spring]] needs either 'between' or 'angle'
    ..."world.hook", "ball"], stiffness = 3, rest = 1, angle = "phi"}]
                                                               ^)m"},
    {"EndsMeet", R"m(rest = 1})m", R"m(rest = 1}, {between = [[0.1, "y"], "ball"], stiffness = 1, rest = 0.1})m",
     R"m(f.toml:8:72: the ends of the spring meet at the start, so its direction is not defined
    ...een = ["world.hook", "ball"], stiffness = 3, rest = 1}, {between = [[0.1, "y"], "ball"], stiffness = 1, rest = 0...
                                                               ^
choose another start, or rest = 0)m"},
    {"SpringWithoutEnds", R"m(between = ["world.hook", "ball"], )m", R"m()m",
     R"m(f.toml:8:11: [[spring]] needs either 'between' or 'angle'
    spring = [{stiffness = 3, rest = 1}]
              ^
between = [point, point], or angle = "an expression")m"},
    {"LineTheWrongWay", R"m(-2, 0], [)m", R"m(2, 0], [-)m",
     R"m(f.toml:9:26: 'ball' starts 2.3 behind 'floor'
    constraint = [{between = ["ball", "floor"], restitution = 0.5}]
                             ^
a line is free on the left of from-to; swap its ends?)m"},
    {"Syntax", R"m("x", "y)m", R"m("x", "y +)m",
     R"m(f.toml:5:58: the expression ends where a value is expected
    ... {name = "ball", mass = "m", disc = "r", at = ["x", "y +"], angle = "phi"},
                                                               ^)m"},
    {"TimeInM", R"m("phi"},
)m",
     R"m("phi"},
 {name = "table", angle = "t"}, {name = "b", mass = 1, on = "table", at = "ball"},  {name = "c", mass = 1, at = ["x", "y*t"]},
)m",
     R"m(f.toml:6:85: the inertia of 'c' depends on t: T = x'^2/2 + t^2*y'^2/2
    ..."}, {name = "b", mass = 1, on = "table", at = "ball"},  {name = "c", mass = 1, at = ["x", "y*t"]},
                                                               ^
a coordinate may not move a mass in a direction that turns with t; measure it in axes that turn as well, with 'on')m"},
    {"NameTwice", R"m(= "floor)m", R"m(= "ball)m",
     R"m(f.toml:5:12: the name 'ball' is used twice
      {name = "ball", mass = "m", disc = "r", at = ["x", "y"], angle = ...
               ^
it is already the name at line 7: bodies and grounds need different names)m"},
    {"TwoShapes", R"m(disc = "r", )m", R"m(disc = "r", ring = 2, )m",
     R"m(f.toml:5:50: 'ball' has two shapes: disc and ring
      {name = "ball", mass = "m", disc = "r", ring = 2, at = ["x", "y"], angle = "phi"},
                                                     ^
write one [[body]] for each, the second with on = "ball")m"},
    {"UndefinedInASpring", R"m(rest = 1})m", R"m(rest = 1}, {angle = "log(phi)", stiffness = 1})m",
     R"m(f.toml:8:72: the potential is not defined at the start: log(phi), with phi = 0
    ...een = ["world.hook", "ball"], stiffness = 3, rest = 1}, {angle = "log(phi)", stiffness = 1}]
                                                               ^)m"},
    {"UnknownBody", R"m(["ball)m", R"m(["bal)m",
     R"m(f.toml:9:28: unknown body or ground 'bal'; did you mean 'ball'?
    constraint = [{between = ["bal", "floor"], restitution = 0.5}]
                               ^
bodies and grounds are: world, floor, ball)m"},
    {"UnknownGround", R"m("ball", "floo)m", R"m("ball", "flo)m",
     R"m(f.toml:9:36: unknown body or ground 'flor'; did you mean 'floor'?
    constraint = [{between = ["ball", "flor"], restitution = 0.5}]
                                       ^
bodies and grounds are: world, floor, ball)m"},
    {"UnknownInView", R"m(0]]}]
)m",
     R"m(0]]}]
view = [{name = "v", x = "t", y = ["ball.x + bal.y"]}]
)m",
     R"m(f.toml:8:46: unknown body or ground 'bal'; did you mean 'ball'?
    view = [{name = "v", x = "t", y = ["ball.x + bal.y"]}]
                                                 ^
bodies and grounds are: world, floor, ball)m"},
    {"UnknownName", R"m("x", "y)m", R"m("x", "y + q)m",
     R"m(f.toml:5:59: unknown name 'q'
    ...{name = "ball", mass = "m", disc = "r", at = ["x", "y + q"], angle = "phi"},
                                                               ^)m"},
    {"UnknownPointOfWorld", R"m("world.hoo)m", R"m("world.ho)m",
     R"m(f.toml:8:24: unknown point 'hok' of 'world'; did you mean 'hook'?
    spring = [{between = ["world.hok", "ball"], stiffness = 3, rest = 1}]
                           ^
points of 'world' are: origin, hook)m"},
    {"UnknownPoint", R"m("world.hook", "ball)m", R"m("world.hook", "ball.centre)m",
     R"m(f.toml:8:38: unknown point 'centre' of 'ball'; did you mean 'center'?
    spring = [{between = ["world.hook", "ball.centre"], stiffness = 3, rest = 1}]
                                         ^
points of 'ball' are: origin, center)m"},
    {"NameWorld", R"m(= "floor)m", R"m(= "world)m",
     R"m(f.toml:7:20: the name 'world' is reserved
    ground = [{name = "world", line = [[-2, 0], [2, 0]]}]
                       ^
choose another name)m"},
};
INSTANTIATE_TEST_SUITE_P(OneAtATime, MechanismMistakes, testing::ValuesIn(mechanism_mistakes),
                         [](const auto& one) { return one.param.name; });

// Words of other programs, keys in the wrong table, and what has no effect: what the message says.
struct ForeignWord {
    const char *from, *to, *answer;
};
void PrintTo(const ForeignWord& one, std::ostream* out) { *out << one.to; }

class ForeignWords : public testing::TestWithParam<ForeignWord> {};

TEST_P(ForeignWords, AreAnsweredWithTheKey) {
    const ForeignWord& one = GetParam();
    const std::string answer = test::told(test::changed(ball_over_floor, {{one.from, one.to}}));
    EXPECT_NE(answer.find(one.answer), answer.npos) << answer;
    EXPECT_EQ(answer.find("f.toml:"), 0U) << answer;
}

const ForeignWord foreign_words[] = {
    {"body = [", "bodies = [", "did you mean 'body'?"},
    {"mass = \"m\"", "m = \"m\"", "did you mean 'mass'?"},
    {"disc = \"r\"", "radius = \"r\"", "did you mean 'disc'?"},
    {"disc = \"r\"", "length = 1", "did you mean 'rod'?"},
    {"disc = \"r\"", "disc = \"r\", com = [0, 1]", "did you mean 'center'?"},
    {"disc = \"r\"", "disc = \"r\", I = 1", "did you mean 'inertia'?"},
    {"disc = \"r\"", "disc = \"r\", parent = \"floor\"", "did you mean 'on'?"},
    {"disc = \"r\"", "disc = \"r\", gravity = 9.81", "gravity belongs to [world]"},
    {"disc = \"r\"", "disc = \"r\", velocity = 1", "start and rate belong to the [[coordinate]]"},
    {"disc = \"r\"", "disc = \"r\", restitution = 1", "restitution belongs to the [[constraint]]"},
    {"disc = \"r\"", "rod = [[0, 0], [1, 0]], to = \"world.hook\"", "choose coordinates that close the loop"},
    {"at = [\"x\"", "pos = [\"x\"", "did you mean 'at'?"},
    {"angle = \"phi\"", "theta = \"phi\"", "did you mean 'angle'?"},
    {"world = {gravity = [0, \"-g\"], points", "gravity = [0, -9.81]\nworld = {points",
     "with bodies write world = {gravity = [0, -9.81]}"},
    {"gravity = [0, \"-g\"]", "g = [0, \"-g\"]", "did you mean 'gravity'?"},
    {"name = \"floor\"", "name = \"floor\", mass = 1", "a ground has no mass"},
    {"name = \"floor\"", "name = \"floor\", angle = 0.1", "turn the points of its line"},
    {"name = \"floor\", line", "name = \"floor\", from", "did you mean 'line'?"},
    {"stiffness = 3", "k = 3", "did you mean 'stiffness'?"},
    {"rest = 1", "length = 1", "did you mean 'rest'?"},
    {"rest = 1", "rest = 1, damping = 2", "write a [[damper]] with the same ends"},
    {"{between = [\"ball\"", "{bodies = [\"ball\"", "did you mean 'between'?"},
    {"restitution = 0.5", "restitution = 0.5, length = 2", "did you mean 'longest'?"},
    {"spring = [", "joint = [{name = \"hinge\"}]\nspring = [", "choose coordinates that close the loop"},
    {"spring = [", "floor = [{name = \"f\"}]\nspring = [", "did you mean 'ground'?"},
    {"spring = [", "force = [{at = \"ball\", F = [0, 1]}]\nspring = [", "did you mean 'value'?"},
    {"spring = [", "torque = [{body = \"ball\", value = 1}]\nspring = [", "did you mean 'on'?"},
    {"spring = [", "damper = [{between = [\"world\", \"ball\"], c = 1}]\nspring = [", "did you mean 'damping'?"},
    {"rest = 1}", "rest = 1}, {between = [[\"r/3\", \"y\"], \"ball\"], stiffness = 1, rest = 0.1}",
     "the ends of the spring meet at the start"},
    {"world.hook", "hook", "write \"world.hook\""},
    {"[2, 0]]", "[2, 0]], disc = 1", "write one [[ground]] for each"},
    {"[2, 0]]", "[2, 0]], over = [0, 1]", "'over' belongs to a curve"},
    {"gravity = [0, \"-g\"]", "gravity = -9.81", "write gravity = [0, -9.81]"},
    {"gravity = [0, \"-g\"]", "gravity = \"-g\"", "write gravity = [0, \"-g\"]"},
    {"disc = \"r\"", "rod = [\"world.hook\", [0, 1]]", "place its start with at"},
    {"spring = [", "force = [{at = \"world.hook\", value = [1, 0]}]\nspring = [",
     "'world.hook', where this force acts, moves with no coordinate"},
    {"body = [", "torque = [{on = \"stand\", value = 1}]\nbody = [{name = \"stand\"},",
     "'stand', on which this torque acts, turns with no coordinate"},
    {"between = [\"world.hook\", \"ball\"], stiffness", "angle = 1, stiffness",
     "the angle of this spring depends on no coordinate"},
    {"\"ball\"], stiffness", "[0, \"sin(t)\"]], stiffness", "the length of this spring depends on no coordinate"},
};
INSTANTIATE_TEST_SUITE_P(All, ForeignWords, testing::ValuesIn(foreign_words));

// The slip leaves out how the direction turns in the axes of the rod.
TEST(TouchedRods, MayNotTurnInTheirAxes) {
    const std::string message = test::told(test::changed(
        ball_over_floor, {{"body = [", "body = [{name = \"bar\", rod = [[-9, 0], [9, \"x\"]], at = [0, -3]},"},
                          {"\"ball\", \"floor\"", "\"ball\", \"bar\""}}));
    EXPECT_EQ(message.find("f.toml:9:36: the direction of the rod 'bar', which is touched, must not change"), 0U)
        << message;
}

// Keys of mechanisms in a file without bodies are not ignored.
TEST(MechanismKeys, AreReadWithoutBodies) {
    const auto edited = [](const std::string& from, const std::string& to) {
        return test::told(test::changed(test::good, {{from, to}}));
    };
    EXPECT_NE(
        edited("restitution", "normal = true\nrestitution").find("'normal' in [[constraint]] goes with 'between'"),
        std::string::npos);
    EXPECT_NE(edited("shape = \"curve\"", "shape = \"curve\"\non = \"thigh\"").find("unknown body or ground 'thigh'"),
              std::string::npos);
}

// Values of values, each used twice, grow without end as a text.
TEST(MechanismTexts, ThatGrowWithoutEndAreRefusedAtOnce) {
    std::string text = "coordinate = [{name = \"x\"}]\nbody = [{name = \"b0\", mass = 1, at = [\"x\", 0]},\n";
    for (int i = 1; i <= 60; ++i)
        text += fmt::format("{{name = \"b{0}\", at = [\"sin(b{1}.x) + cos(b{1}.x)\", 0]}},\n", i, i - 1);
    const std::clock_t begin = std::clock();
    const std::string message = test::told(text + "]\nconstraint = [{gap = \"x + 1\", restitution = 0}]\n");
    EXPECT_NE(message.find("is too large: it takes more than 200000 characters as a text"), message.npos) << message;
    EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5.0);
}

}  // namespace
}  // namespace achilles
