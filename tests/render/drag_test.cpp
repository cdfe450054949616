// Dragging of bodies: any point of a drawn body follows the hand as its coordinates and the gaps allow.
#include "figure/drag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/systems.hpp"
#include "figure/palette.hpp"

namespace achilles {
namespace {

struct Draggable {
    explicit Draggable(const std::string& text)
        : model(test::typed(text)), run(model->default_run()), mechanism(*model) {}

    AnchorPoint material(const Point& at, double reach = 1e-6) {
        const auto point = mechanism.material_point(at, reach, 0.0, run.start(), run.parameters);
        EXPECT_TRUE(point.has_value()) << at.x << ", " << at.y;
        return mechanism.grip(point.value(), run.parameters).value();
    }
    Point at(AnchorPoint& point, const Vector& q) { return point.at(run.options.start_time, {q, run.v}).at; }
    // Drags the point to a place and returns where it is then. The run can start there.
    Point drag(AnchorPoint& point, const Point& place) {
        run.q = dragged_start(*model, run, point, place);
        EXPECT_NO_THROW(model->check(run));
        return at(point, run.q);
    }

    std::shared_ptr<const Model> model;
    Run run;
    Mechanism mechanism;
};

double span_of(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

std::string reference_mechanism(const std::string& name) {
    return read_text(test::source_file("tests/reference/mechanisms/" + name + ".toml"));
}

class DraggedMechanisms : public testing::TestWithParam<const char*> {};

// The middle of every edge of every body, dragged to where a start near by has it.
TEST_P(DraggedMechanisms, HavePointsThatReachTheHand) {
    Draggable all(reference_mechanism(GetParam()));
    const achilles::Run start = all.run;
    Drawing limits;
    limits.x_low = limits.y_low = -1.0, limits.x_high = limits.y_high = limits.size = 1.0;
    const Drawing drawing = all.mechanism.draw(0.0, start.start(), start.parameters, limits, light_theme());
    std::mt19937 random(41);
    std::uniform_real_distribution<double> part(-0.1, 0.1);
    std::size_t points = 0;
    for (const DrawnShape& shape : drawing.shapes) {
        if (!shape.moves || shape.kind != DrawnShape::Kind::polyline || shape.points.size() > 5) continue;
        for (std::size_t i = 0; i + 1 < shape.points.size(); ++i) {
            const Point &a = shape.points[i], &b = shape.points[i + 1];
            const auto found = all.mechanism.material_point({0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}, 1e-9, 0.0,
                                                            start.start(), start.parameters);
            if (!found) continue;  // a spring
            AnchorPoint point = *all.mechanism.grip(*found, start.parameters);
            ++points;
            achilles::Run wanted = start;
            const auto can_start = [&] {
                for (double& q : wanted.q) q += part(random);
                try {
                    return all.model->check(wanted), true;
                } catch (const InputError&) {
                    return wanted.q = start.q, false;
                }
            };
            while (!can_start()) {
            }
            all.run = start;
            const Point place = all.at(point, wanted.q);
            EXPECT_LT(span_of(all.drag(point, place), place), 1e-6) << "edge " << i << " of drawing " << found->drawing;
        }
    }
    EXPECT_GT(points, 0U);
}

INSTANTIATE_TEST_SUITE_P(OfTheReference, DraggedMechanisms,
                         testing::Values("box_dropped_flat", "double_pendulum", "driven_pivot", "falling_rod",
                                         "kneed_leg", "newtons_cradle", "triple_pendulum"),
                         [](const auto& one) { return std::string(one.param); });

constexpr const char* arm = R"toml(coordinate = [{name = "a", start = 0.3, unit = "rad"}]
body = [{name = "arm", mass = 1, rod = [[0, 0], [0, -1]], angle = "a"}]
constraint = [{gap = "3 - a", restitution = 0.5}]
)toml";

// Far away the linearization overshoots: without a check of each step the arm would jump to and fro.
TEST(DraggedStart, PointsAtAHandThatIsOutOfReach) {
    for (const double far : {1.5, 3.0, 40.0})
        for (const double length : {0.5, 1.0}) {
            Draggable all(arm);
            AnchorPoint point = all.material({length * std::sin(0.3), -length * std::cos(0.3)});
            const Point there = all.drag(point, {far, 0.0});
            EXPECT_NEAR(all.run.q[0], 0.5 * std::numbers::pi, 1e-4) << far << ", " << length;
            EXPECT_NEAR(there.x, length, 1e-6);
        }
}

TEST(DraggedStart, StopsAtAGapOfTheCoordinatesAlone) {
    Draggable all(arm);
    AnchorPoint end = all.material({std::sin(0.3), -std::cos(0.3)});
    for (const double angle : {1.0, 2.0, 2.9, 3.1}) all.drag(end, {std::sin(angle), -std::cos(angle)});
    EXPECT_LE(all.run.q[0], 3.0);
    EXPECT_NEAR(all.run.q[0], 3.0, 1e-6);
}

// A rod's end below the floor: it lies on the floor, below the hand.
TEST(DraggedStart, SlidesAlongWhatItIsPushedInto) {
    Draggable all(reference_mechanism("falling_rod"));
    AnchorPoint end = all.material({-0.5 * std::sin(0.15), 0.53 - 0.5 * std::cos(0.15)});
    const Point before = all.at(end, all.run.q);
    for (const double x : {0.1, 0.2, 0.35}) {
        const Point there = all.drag(end, {before.x + x, -0.3});
        EXPECT_NEAR(there.x, before.x + x, 1e-6);
        EXPECT_GE(there.y, 0.0);
        EXPECT_LT(there.y, 1e-6);
    }
    const Point above = all.drag(end, {before.x, 0.4});
    EXPECT_LT(span_of(above, {before.x, 0.4}), 1e-6) << "it leaves the floor with the hand";
}

// A disc in the corner between two slopes touches both.
TEST(DraggedStart, KeepsTwoGaps) {
    Draggable all(R"toml(coordinate = [{name = "x", start = 0.2}, {name = "y", start = 3}]
body = [{name = "ball", mass = 1, disc = 0.5, at = ["x", "y"]}]
ground = [{name = "right", line = [[0, 0], [4, 4]]}, {name = "left", line = [[-4, 4], [0, 0]]}]
constraint = [
  {name = "r", between = ["ball", "right"], restitution = 0.5},
  {name = "l", between = ["ball", "left"], restitution = 0.5},
]
)toml");
    AnchorPoint ball = *all.mechanism.grip(all.run.parameters);
    const Point corner = all.drag(ball, {0.1, -3.0});
    EXPECT_NEAR(corner.x, 0.0, 1e-6);
    EXPECT_NEAR(corner.y, 0.5 * std::numbers::sqrt2, 1e-6);
    // On the right slope below a hand inside it.
    const Point slope = all.drag(ball, {2.0, 1.0});
    EXPECT_NEAR(slope.x, 1.5 - 0.25 * std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(slope.y - slope.x, 0.5 * std::numbers::sqrt2, 1e-6);
}

// A seesaw cannot be moved at its center, but at any other point.
TEST(DraggedStart, TurnsABoxAboutItsCenter) {
    Draggable all(R"toml(coordinate = [{name = "a", unit = "rad"}]
body = [{name = "plank", mass = 1, box = [4, 0.2], angle = "a"}]
constraint = [{gap = "1 - a", restitution = 0.5}]
)toml");
    AnchorPoint end = all.material({1.5, 0.05});
    const Point there = all.drag(end, {1.4, 0.6});
    EXPECT_NEAR(std::atan2(there.y, there.x), std::atan2(0.6, 1.4), 1e-4);
    EXPECT_NEAR(all.run.q[0], std::atan2(0.6, 1.4) - std::atan2(0.05, 1.5), 1e-4);
}

// In every state the point has the same place in the axes of its body.
TEST(MaterialPoints, BelongToTheirBodies) {
    for (const char* shape : {"box = [0.6, 0.4]", "polygon = [[-0.3, -0.2], [0.4, -0.2], [0.1, 0.3]]",
                              "rod = [[-0.3, -0.1], [0.5, 0.2]]"}) {
        Draggable all(
            std::string("coordinate = [{name = \"x\"}, {name = \"y\", start = 1}, {name = \"a\", start = 0.2}]\n"
                        "body = [{name = \"b\", mass = 1, ") +
            shape + ", at = [\"x\", \"y\"], angle = \"a\"}]\n" +
            "constraint = [{gap = \"y + 9\", restitution = 0.5}]\n");
        const auto in_body = [](const Point& p, const Vector& q) {
            const double x = p.x - q[0], y = p.y - q[1], c = std::cos(q[2]), s = std::sin(q[2]);
            return Point{c * x + s * y, -s * x + c * y};
        };
        // (0.1, 0.05) in the axes of the body: on the rod, and inside the others.
        const double c = std::cos(0.2), s = std::sin(0.2);
        AnchorPoint point = all.material({0.1 * c - 0.05 * s, 1.0 + 0.1 * s + 0.05 * c});
        for (const double turn : {0.2, -1.0, 2.5}) {
            Vector q(3);
            q << 0.7 * turn, 1.3, turn;
            EXPECT_LT(span_of(in_body(all.at(point, q), q), {0.1, 0.05}), 1e-9) << shape << " at " << turn;
        }
        EXPECT_FALSE(all.mechanism.material_point({2.0, 1.0}, 0.5, 0.0, all.run.start(), all.run.parameters));
    }
}

}  // namespace
}  // namespace achilles
