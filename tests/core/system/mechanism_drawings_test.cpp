// The drawings that a mechanism brings: what is drawn, in which order, and that the expanded file draws the same.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/systems.hpp"
#include "expression/parse.hpp"

namespace achilles {
namespace {

using Shape = DrawingDescription::Shape;

std::vector<DrawingDescription> drawings_in(const std::string& text) {
    return drawings_of(parse_system(text, "f.toml"));
}

std::string mechanism_of(const std::string& name) {
    const std::string gallery = test::source_file("assets/systems/" + name + ".toml");
    return read_text(std::filesystem::exists(gallery)
                         ? std::filesystem::path(gallery)
                         : test::source_file("tests/reference/mechanisms/" + name + ".toml"));
}

std::vector<DrawingDescription> of_shape(const std::vector<DrawingDescription>& all, Shape shape) {
    std::vector<DrawingDescription> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found), [&](const auto& d) { return d.shape == shape; });
    return found;
}

// The value of an expression of numbers and these names.
double value_in(const std::string& text, const std::map<std::string, double>& values) {
    Graph graph;
    Scope scope;
    std::vector<double> inputs;
    for (const auto& [name, value] : values) {
        scope.allowed.emplace(name, graph.symbol(static_cast<std::uint32_t>(inputs.size())));
        inputs.push_back(value);
    }
    return value_of(parse(text, scope, graph), inputs);
}

// What is drawn, without the order: the shape, the contact that lights it, and the expressions.
std::multiset<std::string> contents(const std::vector<DrawingDescription>& all) {
    std::multiset<std::string> found;
    for (const DrawingDescription& drawing : all) {
        std::string text = fmt::format("{} {} {}", static_cast<int>(drawing.shape),
                                       drawing.contact ? static_cast<int>(*drawing.contact) : -1, drawing.color);
        for (const Text& each : texts_of(drawing)) text += " " + each.text;
        found.insert(text);
    }
    return found;
}

TEST(MechanismDrawings, AreThoseOfTheExpandedFile) {
    for (const char* name :
         {"kneed_leg", "newtons_cradle", "slider_crank", "ball_on_string", "falling_rod", "seesaw"}) {
        const std::string text = mechanism_of(name);
        EXPECT_EQ(contents(drawings_in(text)), contents(drawings_in(expand_system(text, "f.toml")))) << name;
    }
}

constexpr const char* plane_head = R"toml(coordinate = [{name = "x"}, {name = "y", start = 2}, {name = "phi"}]
world = {gravity = [0, -9.81], points = {hook = [0, 5]}}
)toml";

// In the expanded file, too.
TEST(MechanismDrawings, PutGroundsBehindSpringsBehindBodies) {
    const std::string text = std::string(plane_head) + R"toml(
body = [{name = "block", mass = 1, inertia = 1, box = [1, 1], at = ["x", "y"], angle = "phi"}]
ground = [{name = "floor", line = [[-1, 0], [1, 0]]}, {name = "wall", line = [[5, 0], [5, 1]]}]
spring = [{between = ["block", "world.hook"], stiffness = 1, rest = 1}]
constraint = [
    {name = "one", between = ["block.lower_left", "floor"], restitution = 0.5},
    {name = "two", between = ["block.lower_right", "floor"], restitution = 0.5},
]
)toml";
    for (const std::string& file : {text, expand_system(text, "f.toml")}) {
        std::vector<Shape> shapes;
        for (const DrawingDescription& drawing : drawings_in(file)) shapes.push_back(drawing.shape);
        // The first disc is the mount of the spring, the others are the corners that touch.
        EXPECT_EQ(shapes, (std::vector{Shape::ground, Shape::ground, Shape::disc, Shape::spring, Shape::box,
                                       Shape::disc, Shape::disc}))
            << file;
    }
}

// A pin for each joint; none for a body that moves freely, slides, or is fixed to another one.
TEST(MechanismDrawings, ShowJoints) {
    const auto pins = [](const std::string& bodies) {
        return of_shape(drawings_in(std::string(plane_head) + "body = [" + bodies +
                                    "]\nconstraint = [{gap = \"y\", restitution = 0}]\n"),
                        Shape::disc)
            .size();
    };
    const std::string cart = R"toml({name = "cart", mass = 1, box = [1, 1], at = ["x", "y"]}, )toml";
    EXPECT_EQ(pins(cart + R"toml({name = "a", mass = 1, rod = [[0, 0], [1, 0]], on = "cart", angle = "phi"})toml"), 1U);
    EXPECT_EQ(
        pins(cart + R"toml({name = "a", mass = 1, rod = [[0, 0], [1, 0]], at = "cart.upper_left", angle = "phi"})toml"),
        1U);
    EXPECT_EQ(
        pins(cart + R"toml({name = "a", mass = 1, rod = [[0, 0], [1, 0]], at = ["sin(t)", 0], angle = "phi"})toml"),
        1U);
    EXPECT_EQ(pins(R"toml({name = "a", mass = 1, rod = [[0, 0], [1, 0]], at = ["x", "y"], angle = "phi"})toml"), 0U);
    const std::string with_arm =
        cart + R"toml({name = "a", mass = 1, rod = [[0, 0], [1, 0]], on = "cart", angle = "phi", hidden = true})toml";
    EXPECT_EQ(pins(with_arm), 0U);
    EXPECT_EQ(pins(with_arm +
                   R"toml(, {name = "b", mass = 1, rod = [[0, 0], [1, 0]], at = "a.end", angle = "phi + pi/2"})toml"),
              0U);
    EXPECT_EQ(pins(with_arm +
                   R"toml(, {name = "b", mass = 1, rod = [[0, 0], [1, 0]], on = "a", at = ["y", 0], angle = "x"})toml"),
              0U);
}

// The surface of a body that is drawn is a line, that of a frame is hatched.
TEST(MechanismDrawings, HatchGroundsThatNobodyCarries) {
    const auto drawn = [](const std::string& table) {
        return drawings_in(std::string(plane_head) +
                           "body = [{name = \"ball\", mass = 1, inertia = 1, at = [\"x\", \"y\"], angle = \"phi\"}, "
                           "{name = \"table\"" +
                           table + ", at = [0, \"-1 + 0.1*sin(t)\"]}]\n" + R"toml(
ground = [{name = "top", on = "table", line = [[-1, 0.1], [1, 0.1]]}]
constraint = [{between = ["ball", "top"], restitution = 0.5}]
)toml");
    };
    EXPECT_EQ(of_shape(drawn(""), Shape::ground).size(), 1U);
    EXPECT_EQ(of_shape(drawn(", box = [2, 0.2]"), Shape::ground).size(), 0U);
    EXPECT_EQ(of_shape(drawn(", box = [2, 0.2]"), Shape::segment).size(), 1U);
    EXPECT_EQ(of_shape(drawn(", box = [2, 0.2], hidden = true"), Shape::ground).size(), 1U);
}

// Springs with the same ends lie side by side, at equal distances from the line between them, and keep their direction.
TEST(MechanismDrawings, PutSpringsWithTheSameEndsSideBySide) {
    for (const char* place : {R"(["x", "y"])", R"([0, "x + 2*y + phi"])", R"(["x + 2*y + phi", 5])"}) {
        const auto all =
            drawings_in(std::string(plane_head) + "body = [{name = \"ball\", mass = 1, at = " + place + "}, " + R"toml(
  {name = "rest", mass = 1, inertia = 1, at = ["x", "y"], angle = "phi"}]
spring = [{between = ["ball", "world.hook"], stiffness = 1, rest = 1}]
damper = [{between = ["ball", "world.hook"], damping = 1}]
constraint = [{gap = "y", restitution = 0.5}]
)toml");
        const auto springs = of_shape(all, Shape::spring), dampers = of_shape(all, Shape::damper);
        ASSERT_EQ(springs.size(), 1U);
        ASSERT_EQ(dampers.size(), 1U);
        const std::map<std::string, double> state{{"x", 0.7}, {"y", 1.9}, {"phi", 0.3}};
        const auto at = [&](const DrawingDescription& d, std::size_t i) {
            return std::array{value_in(d.points[i][0].text, state), value_in(d.points[i][1].text, state)};
        };
        const auto a = at(springs[0], 0), b = at(springs[0], 1), c = at(dampers[0], 0), d = at(dampers[0], 1);
        EXPECT_NEAR(b[0] - a[0], d[0] - c[0], 1e-12) << place;
        EXPECT_NEAR(b[1] - a[1], d[1] - c[1], 1e-12) << place;
        const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
        const double aside = (dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / length;
        EXPECT_NEAR((dx * (c[0] - a[0]) + dy * (c[1] - a[1])) / length, 0.0, 1e-12) << place;
        EXPECT_GT(std::abs(aside), 0.1) << place;
        // The middle of the four ends lies on the line from the ball to the hook.
        EXPECT_NEAR(0.5 * (b[0] + d[0]), 0.0, 1e-12) << place;
        EXPECT_NEAR(0.5 * (b[1] + d[1]), 5.0, 1e-12) << place;
    }
}

// A spiral or a vane at the joint that turns by the angle, against the other body or the world.
TEST(MechanismDrawings, PutTorsionSpringsAndDampersAtTheirJoints) {
    const auto drawn = [](const std::string& angle, const std::string& more = "") {
        return drawings_in(std::string(plane_head) + R"toml(body = [
  {name = "a", mass = 1, rod = [[0, 0], [0, -1]], angle = "x"},
  {name = "b", mass = 1, rod = [[0, 0], [0, -1]], on = "a", at = "end", angle = "-y"},
  {name = "slider", mass = 1, at = ["phi", 0]}]
constraint = [{gap = "phi + 1", restitution = 0}]
spring = [{angle = ")toml" +
                           angle + "\", stiffness = 1" + more + "}]\ndamper = [{angle = \"" + angle +
                           "\", damping = 1}]\n");
    };
    const std::map<std::string, double> start{{"x", 0.3}, {"y", 0.9}, {"phi", 0.0}};
    const auto end_of = [&](const DrawingDescription& spiral, double s, double y) {
        std::map<std::string, double> values = start;
        values["y"] = y;
        values[spiral.over] = s;
        return std::array{value_in(spiral.points[0][0].text, values), value_in(spiral.points[0][1].text, values)};
    };
    for (const auto& [angle, axes] : {std::pair{"y", 0.3}, {"b.angle", 0.0}, {"2 - y", 0.3}}) {
        const auto all = drawn(angle);
        const auto curves = of_shape(all, Shape::curve);
        ASSERT_EQ(curves.size(), 3U) << angle;
        const DrawingDescription &spiral = curves[0], &housing = curves[1], &vane = curves[2];
        const double joint[] = {std::sin(0.3), -std::cos(0.3)};
        const auto outer = end_of(spiral, 0.0, 0.9), inner = end_of(spiral, 1.0, 0.9),
                   turned = end_of(spiral, 1.0, 1.1);
        // The outer end is held by the other body, the inner one turns with its own.
        EXPECT_NEAR(std::atan2(outer[1] - joint[1], outer[0] - joint[0]), axes, 1e-12) << angle;
        EXPECT_EQ(end_of(spiral, 0.0, 1.1), outer) << angle;
        EXPECT_NEAR(std::atan2(inner[1] - joint[1], inner[0] - joint[0]), 0.3 - 0.9, 1e-12) << angle;
        EXPECT_NEAR(std::atan2(turned[1] - joint[1], turned[0] - joint[0]), 0.3 - 1.1, 1e-12) << angle;
        EXPECT_LT(std::hypot(inner[0] - joint[0], inner[1] - joint[1]),
                  0.8 * std::hypot(outer[0] - joint[0], outer[1] - joint[1]));
        // The vane is a diameter of the housing and turns with the body.
        const auto rim = end_of(housing, 0.4, 0.9), tip = end_of(vane, 1.0, 0.9), other = end_of(vane, 0.0, 0.9);
        const double radius = std::hypot(rim[0] - joint[0], rim[1] - joint[1]);
        EXPECT_NEAR(std::hypot(tip[0] - joint[0], tip[1] - joint[1]), radius, 1e-12) << angle;
        EXPECT_NEAR(std::hypot(tip[0] - other[0], tip[1] - other[1]), 2.0 * radius, 1e-12) << angle;
        const auto later = end_of(vane, 1.0, 1.1);
        EXPECT_NEAR(
            std::atan2(tip[1] - joint[1], tip[0] - joint[0]) - std::atan2(later[1] - joint[1], later[0] - joint[0]),
            0.2, 1e-12)
            << angle;
        EXPECT_EQ(spiral.color, "") << "like other springs";
    }
    EXPECT_EQ(of_shape(drawn("phi"), Shape::curve).size(), 0U) << "no joint turns by it";
    EXPECT_EQ(of_shape(drawn("x + 2*y"), Shape::curve).size(), 0U);
    EXPECT_EQ(of_shape(drawn("x"), Shape::curve).size(), 3U);
    EXPECT_EQ(of_shape(drawn("y", ", hidden = true"), Shape::curve).size(), 2U) << "the damper";
}

// A string hangs down where it is slack, and is as long as it says while it sags little.
TEST(MechanismDrawings, LetAStringSag) {
    const auto all = drawings_in(R"toml(coordinate = [{name = "x", start = 0.9}]
world = {gravity = [0, -9.81], points = {hook = [0, 0]}}
body = [{name = "ball", mass = 1, at = ["x", 0]}]
constraint = [{between = ["world.hook", "ball"], longest = 1, restitution = 0}]
)toml");
    const auto strings = of_shape(all, Shape::curve);
    ASSERT_EQ(strings.size(), 1U);
    for (const double x : {0.9, 0.97, 1.0, 1.0 + 1e-13}) {
        double length = 0.0, lowest = 0.0, before[2] = {0.0, 0.0};
        for (int i = 0; i <= 1000; ++i) {
            const std::map<std::string, double> values{{"x", x}, {strings[0].over, i / 1000.0}};
            const double here[] = {value_in(strings[0].points[0][0].text, values),
                                   value_in(strings[0].points[0][1].text, values)};
            ASSERT_TRUE(std::isfinite(here[1])) << x;
            length += std::hypot(here[0] - before[0], here[1] - before[1]);
            lowest = std::min(lowest, here[1]);
            std::copy(here, here + 2, before);
        }
        EXPECT_NEAR(length, 1.0, 0.01) << x;
        EXPECT_NEAR(before[0], x, 1e-12);
        EXPECT_EQ(lowest < -0.05, x < 0.99) << lowest;
    }
}

}  // namespace
}  // namespace achilles
