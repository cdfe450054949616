// Springs, dampers, grounds and boxes, numerically.
#include "figure/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

double apart(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(Parts, ASpringStretchesBetweenStraightEndsAndKeepsItsBreadth) {
    const PartSize size{2.0, 0.3};
    for (const double length : {0.7, 2.0, 9.0}) {
        const std::vector<Point> line = spring_line({1.0, 1.0}, {1.0, 1.0 + length}, 5, size);
        ASSERT_EQ(line.size(), 14u);  // two ends with two points each, five coils with two points each
        EXPECT_EQ(line.front().y, 1.0);
        EXPECT_NEAR(line.back().y, 1.0 + length, 1e-15);
        const double end = std::min(0.15, 0.15 * length);
        EXPECT_NEAR(line[1].y, 1.0 + end, 1e-14);
        EXPECT_NEAR(line[1].x, 1.0, 1e-15);
        for (std::size_t i = 2; i < 12; ++i) {
            EXPECT_NEAR(std::abs(line[i].x - 1.0), 0.15, 1e-15);
            EXPECT_NEAR(line[i].y, 1.0 + end + (length - 2.0 * end) * (static_cast<double>(i) - 1.5) / 10.0, 1e-14);
            if (i > 2) {
                EXPECT_LT((line[i].x - 1.0) * (line[i - 1].x - 1.0), 0.0);
            }
        }
    }
}

// Cup: points 3 to 6; piston: 8 and 9; its rod: 11 and 12.
TEST(Parts, ThePistonOfADamperStaysInItsCup) {
    const PartSize size{1.0, 0.2};
    double before = 0.0;
    for (const double length : {0.05, 0.3, 0.9, 1.0, 1.1, 3.0, 40.0}) {
        const std::vector<Point> line = damper_line({0.0, 0.0}, {length, 0.0}, size);
        ASSERT_EQ(line.size(), 13u);
        const double bottom = line[4].x, mouth = line[3].x, piston = line[8].x;
        EXPECT_EQ(line[1].x, bottom);
        EXPECT_GT(bottom, 0.0);
        EXPECT_LT(bottom, piston);
        EXPECT_LT(piston, mouth);
        EXPECT_LT(mouth, length);
        EXPECT_LT(std::abs(line[8].y), std::abs(line[4].y));
        EXPECT_EQ(line[11].x, piston);
        EXPECT_EQ(line[12].x, length);
        EXPECT_GT(piston, before);
        before = piston;
        if (length == 1.0) {
            EXPECT_NEAR(piston, 0.5 * (bottom + mouth), 1e-15);
        }
        // Under extension the rod becomes longer, not the cup.
        if (length >= 1.0) {
            EXPECT_NEAR(mouth - bottom, 0.4, 1e-15);
        }
        EXPECT_NEAR(apart(line[4], line[5]), 0.2, 1e-15);
    }
}

TEST(Parts, AGroundIsHatchedOnTheRight) {
    const std::vector<Point> strokes = hatching({0.0, 0.0}, {2.0, 0.0}, 0.1);
    ASSERT_EQ(strokes.size(), 60u);  // two ends and a break each
    for (std::size_t i = 0; i < strokes.size(); i += 3) {
        EXPECT_NEAR(strokes[i].y, 0.0, 1e-15);
        EXPECT_NEAR(strokes[i + 1].y, -0.08, 1e-15);
        EXPECT_NEAR(strokes[i].x - strokes[i + 1].x, 0.08, 1e-14);
        EXPECT_GE(strokes[i + 1].x, 0.0);
        EXPECT_LE(strokes[i].x, 2.0 + 1e-14);
        EXPECT_TRUE(std::isnan(strokes[i + 2].x));
    }
    for (const Point& p : hatching({0.0, 2.0}, {0.0, 0.0}, 0.1))
        EXPECT_FALSE(p.x > 1e-15);                                    // downward: its right is
                                                                      // -x
    EXPECT_EQ(hatching({0.0, 0.0}, {1e9, 0.0}, 1e-3).size(), 3000u);  // not more, for any length
    EXPECT_EQ(hatching({0.0, 0.0}, {0.05, 0.0}, 0.1).size(), 3u);
}

TEST(Parts, WithoutADirectionDrawNothingWild) {
    const PartSize size{1.0, 0.1};
    const Point here{3.0, 4.0};
    EXPECT_EQ(spring_line(here, here, 5, size).size(), 2u);
    EXPECT_EQ(damper_line(here, here, size).size(), 2u);
    EXPECT_TRUE(hatching(here, here, 0.1).empty());
    EXPECT_TRUE(hatching(here, {std::nan(""), 0.0}, 0.1).empty());
    for (const double rest : {0.0, std::nan(""), double{INFINITY}}) {
        EXPECT_GT(fitting_across(rest, 10.0), 0.0);
        EXPECT_GE(fitting_coils({rest, fitting_across(rest, 10.0)}), 4);
        for (const Point& p : {damper_line({0.0, 0.0}, {1.0, 0.0}, {rest, 0.1})[8]})
            EXPECT_TRUE(p.x > 0.2 && p.x < 0.8);
    }
}

TEST(Parts, ABoxTurnsAboutItsMiddle) {
    const std::vector<Point> corners = box_corners({1.0, 2.0}, 4.0, 2.0, std::numbers::pi / 2.0);
    ASSERT_EQ(corners.size(), 4u);
    EXPECT_NEAR(corners[0].x, 2.0, 1e-15);
    EXPECT_NEAR(corners[0].y, 0.0, 1e-15);
    EXPECT_NEAR(corners[2].x, 0.0, 1e-15);
    EXPECT_NEAR(corners[2].y, 4.0, 1e-15);
}

// ---- parts in a system ----

// A mass on a spring and a damper that comes to rest on a table; the table sinks at a given speed.
struct Machine {
    explicit Machine(const std::string& more = "")
        : model(test::typed(
              "title = \"\"\n[[coordinate]]\nname = \"x\"\nstart = 2\n[[parameter]]\nname = \"w\"\nvalue = 0.4\n"
              "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x\"\n"
              "[[constraint]]\nname = \"table\"\ngap = \"x - 1\"\nrestitution = 0\n"
              "[[constraint.drawing]]\nshape = \"ground\"\nfrom = [-1, 1]\nto = [1, 1]\n"
              "[[drawing]]\nshape = \"spring\"\nfrom = [0, 0]\nto = [0, \"x - w/2\"]\n"
              "[[drawing]]\nshape = \"damper\"\nfrom = [1, 0]\nto = [1, \"x\"]\nacross = \"w/2\"\n"
              "[[drawing]]\nshape = \"box\"\nat = [0, \"x\"]\nsize = [\"2*w\", \"w\"]\nangle = \"t\"\n" +
              more + "[run]\nend_time = 3\n")),
          run(simulate(model, model->default_run())),
          mechanism(*model),
          limits(mechanism.limits(run, plot_samples(run))) {}
    Drawing at(double t) const {
        const Sample sample = Sampler(run).at(t);
        return mechanism.draw(sample.t, sample.state, run.run.parameters, limits, light_theme(), sample.mode);
    }
    std::shared_ptr<const Model> model;
    Trajectory run;
    Mechanism mechanism;
    Drawing limits;
};

TEST(Mechanism, DrawsPartsBetweenThingsThatMove) {
    const Machine machine;
    const Drawing start = machine.at(0.0), later = machine.at(1.0);
    ASSERT_EQ(start.shapes.size(), 6u);  // solid, hatches, their line, spring, damper, box
    const auto breadth = [](const DrawnShape& shape) {
        const auto [least, most] = std::minmax_element(shape.points.begin(), shape.points.end(),
                                                       [](const Point& a, const Point& b) { return a.x < b.x; });
        return most->x - least->x;
    };
    const DrawnShape &spring = start.shapes[3], &stretched = later.shapes[3];
    EXPECT_EQ(spring.points.size(), stretched.points.size());
    EXPECT_NEAR(spring.points.back().y, 1.8, 1e-12);
    EXPECT_NEAR(stretched.points.back().y, 1.3, 1e-8);  // x = 2 - t^2/2
    EXPECT_NEAR(breadth(spring), breadth(stretched), 1e-15);
    EXPECT_GT(breadth(spring), 0.02);
    EXPECT_TRUE(spring.moves);
    EXPECT_NEAR(start.shapes[4].points[4].x - start.shapes[4].points[5].x, -0.2, 1e-15);  // the cup, whose width is w/2
    const DrawnShape& box = later.shapes[5];
    ASSERT_EQ(box.points.size(), 4u);
    EXPECT_TRUE(box.closed && box.fill);
    EXPECT_NEAR(apart(box.points[0], box.points[1]), 0.8, 1e-12);
    EXPECT_NEAR(std::atan2(box.points[1].y - box.points[0].y, box.points[1].x - box.points[0].x), 1.0, 1e-12);
    auto grip = machine.mechanism.grip(machine.run.run.parameters);
    ASSERT_TRUE(grip);
    EXPECT_EQ(grip->at(0.0, {machine.run.run.q, machine.run.run.v}).at.y, 2.0);
    EXPECT_EQ(grip->at(0.0, {machine.run.run.q, machine.run.run.v}).radius, 0.2);
    // The table is not long, so it is shown entirely.
    EXPECT_LT(machine.limits.x_low, -1.0);
    EXPECT_GT(machine.limits.x_high, 1.0);
}

TEST(Mechanism, LightsWhatIsTouchedWhileItIsHeld) {
    const Machine machine("[[drawing]]\nshape = \"segment\"\nfrom = [0, 0]\nto = [1, 0]\n");
    const Color lit = phase_color(light_theme(), Phase::Kind::constrained);
    const Drawing falling = machine.at(1.0), resting = machine.at(2.5);
    for (std::size_t i = 0; i < falling.shapes.size(); ++i) {
        const bool is_table = i == 1 || i == 2;
        EXPECT_FALSE(falling.shapes[i].stroke.color == lit);
        EXPECT_EQ(resting.shapes[i].stroke.color == lit, is_table) << i;
        EXPECT_EQ(resting.shapes[i].stroke.width > falling.shapes[i].stroke.width, is_table) << i;
    }
}

}  // namespace
}  // namespace achilles
