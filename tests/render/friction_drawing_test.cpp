// Dry friction in pictures: phases that stick and slip, heat in plots, and forces in their friction cones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "figure/mechanism_scene.hpp"
#include "figure/publication.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/event_descriptions.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

// A block thrown up a ramp of 25 degrees, which stops at 0.422 s. It sticks, as mu is above tan(25 deg).
const std::string ramp = R"-(
coordinate = [
    {name = "x", rate = -4.0, unit = "m", range = [-5.0, 5.0], rate_range = [-5.0, 5.0]},
    {name = "y", unit = "m", range = [0.0, 2.0], rate_range = [-2.0, 2.0]},
]
parameter = [
    {name = "m", value = 2.0, unit = "kg"}, {name = "alpha", value = "25 deg", unit = "rad"},
    {name = "mu", value = 0.6}, {name = "g", value = 9.81, unit = "m/s^2"},
]
world  = {gravity = [0, "-g"]}
body   = [
    {name = "ramp", angle = "-alpha"},
    {name = "b", mass = "m", inertia = 0, box = [0.5, 0.3], on = "ramp", at = ["x", "y + 0.15"], points.p = [0, -0.15]},
]
ground = [{name = "incline", line = [[-5, 0], [5, 0]], on = "ramp"}]
constraint = [{name = "incline", between = ["b.p", "incline"], friction = "mu", restitution = 0.3}]
run = {end_time = 3.0}
)-";
constexpr double slope = 0.4363323129985824, weight = 2.0 * 9.81, stop = 0.42192256;

// A disc with backspin: it skids until 1.699 s, then it rolls.
const std::string spinning_disc = R"-(
coordinate = [
    {name = "x", rate = 2.0, unit = "m", range = [-3.0, 3.0], rate_range = [-4.0, 4.0]},
    {name = "y", start = 0.2, unit = "m", range = [0.2, 1.5], rate_range = [-3.0, 3.0]},
    {name = "phi", rate = 40.0, unit = "rad", range = [-6.3, 6.3], rate_range = [-60.0, 60.0]},
]
world  = {gravity = [0, -9.81]}
body   = [{name = "disc", mass = 1, disc = 0.2, at = ["x", "y"], angle = "phi"}]
ground = [{name = "floor", line = [[-3, 0], [3, 0]]}]
constraint = [{name = "floor", between = ["disc", "floor"], friction = 0.2, restitution = 0.5}]
run = {end_time = 4.0}
)-";

// A block on a spring, carried by a belt, with a slightly rough guide: two joints and no contact.
const std::string belt = R"-(
coordinate = [{name = "x", start = 0.5, rate = 0.2, unit = "m", range = [-2.0, 2.0], rate_range = [-2.0, 2.0]}]
world  = {points = {wall = [-3, 0.25]}}
body   = [{name = "block", mass = 1, box = [0.8, 0.5], at = ["x", 0.25]}]
spring = [{between = ["world.wall", "block"], stiffness = 1, rest = 3}]
friction = [
    {name = "belt", slip = "x' - 0.2", level = "1/(1 + 3*slip)", static_level = 1},
    {name = "guide", slip = "x'", level = 0.001},
]
run = {end_time = 12.0}
)-";

const std::string bearing = R"-(
coordinate = [{name = "theta", start = 0.5, unit = "rad"}]
lagrangian.kinetic = "theta'^2/2"
lagrangian.potential = "-cos(theta)"
friction = [{name = "bearing", slip = "theta'", level = 0.1}]
drawing = [{shape = "disc", at = ["sin(theta)", "-cos(theta)"], radius = 0.1}]
run = {end_time = 5.0}
)-";

struct RoughScene {
    explicit RoughScene(const std::string& text)
        : model(std::make_shared<const Model>(parse_system(text))),
          run(simulate(model, model->default_run())),
          samples(plot_samples(run)),
          mechanism(*model),
          stage(mechanism, run, samples),
          touch(mechanism, run, mechanism.limits(run, samples).size),
          marks(mechanism, run, touch, samples) {}
    Sample at(double t) { return Sampler(run).at(t); }
    Panel panel(const std::string& y, bool for_print = false) {
        ViewDescription view;
        view.x.text = "t";
        view.y.push_back({y, {}});
        Framing framing;
        framing.for_print = for_print;
        return compose(run, samples, PreparedView(*model, view), light_theme(), framing);
    }

    std::shared_ptr<const Model> model;
    Trajectory run;
    std::vector<Sample> samples;
    Mechanism mechanism;
    MechanismScene stage;
    ContactGeometry touch;
    FrictionMarks marks;
};

TEST(PhaseLooks, ComeFromTheMode) {
    RoughScene block(ramp), carried(belt);
    const auto look = [](const RoughScene& scene, const Sample& now) {
        return look_of(*scene.model, now.phase, now.mode);
    };
    EXPECT_EQ(look(block, block.at(0.2)), PhaseLook::slip);
    EXPECT_EQ(look(block, block.at(1.0)), PhaseLook::stick);
    EXPECT_EQ(phase_label(*block.model, block.at(0.2)).text, "sliding");
    EXPECT_EQ(phase_label(*block.model, block.at(1.0)).text, "sticking");
    // It is carried by the belt, and slides in its guide.
    EXPECT_EQ(look(carried, carried.at(1.0)), PhaseLook::slip);
    EXPECT_EQ(look_of(*carried.model, ContactSet::of(joint_number(0)), carried.at(1.0).mode), PhaseLook::stick);
    EXPECT_EQ(possible_looks(*block.model), (std::vector{PhaseLook::flight, PhaseLook::stick, PhaseLook::slip}));
    EXPECT_EQ(possible_looks(*carried.model), (std::vector{PhaseLook::stick, PhaseLook::slip}));
}

TEST(PhaseLooks, DifferInLightnessForAnyColorVision) {
    for (const Theme& theme : {light_theme(), dark_theme()}) {
        EXPECT_GE(contrast(phase_color(theme, PhaseLook::stick), phase_color(theme, PhaseLook::slip)), 2.0);
        for (const PhaseLook look : phase_looks) {
            EXPECT_GE(contrast(phase_color(theme, look), theme.background), 3.0);
            for (const PhaseLook other : phase_looks)
                EXPECT_EQ(phase_color(theme, look) == phase_color(theme, other), look == other);
        }
    }
    EXPECT_TRUE(phase_stroke(light_theme(), PhaseLook::stick, 1, 3).dash.empty());
    EXPECT_EQ(phase_stroke(light_theme(), PhaseLook::slip, 1, 3).dash.size(), 4u);
}

// The three events of friction differ in shape or filling, for print, and from those of contacts.
TEST(FrictionMarkers, DifferWithoutColor) {
    std::vector<std::pair<Markers::MarkerShape, bool>> signs;
    for (const EventNames& event : event_names) {
        const Markers markers = event_markers(light_theme(), event.kind);
        signs.emplace_back(markers.shape, markers.fill == light_theme().background);
    }
    for (std::size_t i = 0; i < signs.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) EXPECT_NE(signs[i], signs[k]) << i << " " << k;
}

TEST(FrictionPlots, NameTheirQuantities) {
    EXPECT_EQ(typeset("friction_force"), "friction force");
    EXPECT_EQ(typeset("friction_force_left"), "friction_{left}");
    EXPECT_EQ(typeset("2*slip_foot2"), "2\u00B7slip_{foot2}");
    EXPECT_EQ(typeset("slippery"), "slippery");
}

TEST(FrictionPlots, HaveACurveForEachLook) {
    RoughScene block(ramp);
    const Panel panel = block.panel("x");
    ASSERT_EQ(panel.courses, 4u);
    ASSERT_EQ(panel.curves.size(), 4u);
    EXPECT_TRUE(panel.curves[0].points.empty());
    EXPECT_TRUE(panel.curves[1].points.empty());
    const Curve &stick = panel.curves[2], &slip = panel.curves[3];
    ASSERT_FALSE(stick.points.empty());
    ASSERT_FALSE(slip.points.empty());
    EXPECT_EQ(slip.points.front().x, 0.0);
    EXPECT_NEAR(slip.points.back().x, stop, 1e-6);
    EXPECT_NEAR(stick.points.front().x, stop, 1e-6);
    EXPECT_EQ(stick.points.back().x, 3.0);
    EXPECT_EQ(stick.label, "sticking");
    EXPECT_EQ(slip.stroke.color, phase_color(light_theme(), PhaseLook::slip));
}

// The heat grows along a phase; it needs the integral up to each drawn instant.
TEST(FrictionPlots, HeatGrowsWhileItSlides) {
    RoughScene block(ramp);
    const Panel panel = block.panel("heat");
    const Curve& slip = panel.curves[3];
    ASSERT_GT(slip.points.size(), 2u);
    ASSERT_GT(block.run.heat, 1.0);
    const double force = 0.6 * weight * std::cos(slope);
    for (const Point& point : slip.points) EXPECT_NEAR(point.y, -force * block.at(point.x).state.q[0], 1e-6) << point.x;
    EXPECT_NEAR(panel.curves[2].points.back().y, block.run.heat, 1e-9);
    const Sample event = sample_at(block.run, block.run.events.at(0));
    EXPECT_EQ(event.heat, block.run.events[0].heat);
    EXPECT_NEAR(event.heat, block.run.heat, 1e-9);
}

TEST(FrictionPlots, BarsOfSeveralJointsTellStickFromSlip) {
    RoughScene carried(belt);
    const Panel panel = carried.panel("x");
    ASSERT_EQ(panel.time_bars.size(), 2u);
    const TimeBar &of_belt = panel.time_bars[0], &of_guide = panel.time_bars[1];
    EXPECT_EQ(of_belt.label, "belt");
    EXPECT_EQ(of_guide.label, "guide");
    ASSERT_GE(of_belt.marks.size(), 3u);
    EXPECT_EQ(of_belt.marks[0].color, phase_color(light_theme(), PhaseLook::stick));
    EXPECT_EQ(of_belt.marks[1].color, phase_color(light_theme(), PhaseLook::slip));
    EXPECT_EQ(of_belt.marks[0].high, of_belt.marks[1].low);
    EXPECT_EQ(of_guide.marks[0].color, phase_color(light_theme(), PhaseLook::slip));
}

TEST(FrictionPlots, TheLegendOfAFigureNamesWhatOccurs) {
    RoughScene block(ramp);
    ViewDescription view;
    view.x.text = "t";
    view.y.push_back({"x", {}});
    const Figure figure = publication(block.run, {&view, 1}, {}, nullptr, {});
    std::vector<std::string> labels;
    for (const Key& key : figure.keys) labels.push_back(key.label);
    EXPECT_EQ(labels, (std::vector<std::string>{"sticking", "sliding", "stick"}));
}

TEST(FrictionForce, IsPartOfTheContactForce) {
    RoughScene block(ramp);
    const double pressing = weight * std::cos(slope);
    const Vector sliding = contact_force(block.run, block.at(0.2)), resting = contact_force(block.run, block.at(1.0));
    EXPECT_NEAR(sliding[0], 0.6 * pressing, 1e-9);
    EXPECT_NEAR(sliding[1], pressing, 1e-9);
    EXPECT_NEAR(resting[0], -weight * std::sin(slope), 1e-9);
}

// While it slides the force is on the side of the cone, and while it sticks inside.
TEST(FrictionCone, HasTheForceInIt) {
    RoughScene block(ramp);
    const auto sliding = block.marks.at(block.at(0.2)), resting = block.marks.at(block.at(1.0));
    ASSERT_EQ(sliding.size(), 1u);
    ASSERT_EQ(resting.size(), 1u);
    const double pressing = weight * std::cos(slope);
    for (const FrictionMarks::Mark& mark : {sliding[0], resting[0]}) {
        EXPECT_NEAR(mark.pressing, pressing, 1e-9);
        ASSERT_TRUE(mark.limit);
        EXPECT_NEAR(*mark.limit, 0.6 * pressing, 1e-9);
        EXPECT_NEAR(mark.normal.x, std::sin(slope), 1e-9);
        EXPECT_NEAR(mark.normal.y, std::cos(slope), 1e-9);
        // A positive slip is down the ramp, to the right.
        EXPECT_NEAR(mark.tangent.x, std::cos(slope), 1e-9);
        EXPECT_NEAR(mark.tangent.y, -std::sin(slope), 1e-9);
    }
    EXPECT_EQ(sliding[0].look, PhaseLook::slip);
    EXPECT_NEAR(sliding[0].friction, *sliding[0].limit, 1e-9);  // it slides up
    EXPECT_EQ(resting[0].look, PhaseLook::stick);
    EXPECT_NEAR(resting[0].friction, -weight * std::sin(slope), 1e-9);
    const double x = block.at(1.0).state.q[0];
    EXPECT_NEAR(resting[0].at.x, x * std::cos(slope), 1e-9);
    EXPECT_NEAR(resting[0].at.y, -x * std::sin(slope), 1e-9);
    EXPECT_EQ(EventDescriptions(block.run).state_at_start(), "in contact and sliding to the left");
}

TEST(FrictionCone, IsDrawnAtTheContact) {
    RoughScene block(ramp);
    const Theme theme = light_theme();
    const Drawing seen = block.stage.limits();
    const double side = std::min(seen.x_high - seen.x_low, seen.y_high - seen.y_low);
    for (const double t : {0.2, 1.0}) {
        const auto mark = block.marks.at(block.at(t)).at(0);
        const Drawing bare = block.stage.draw(block.at(t), seen, theme, {true, false, false}),
                      drawn = block.stage.draw(block.at(t), seen, theme, {true, false, true});
        // The cone, the force and the friction force, each arrow a line and a head with their edges.
        ASSERT_EQ(drawn.shapes.size(), bare.shapes.size() + 9);
        const DrawnShape &cone = drawn.shapes[bare.shapes.size()], &head = drawn.shapes[bare.shapes.size() + 4];
        EXPECT_EQ(cone.stroke.color, phase_color(theme, mark.look));
        EXPECT_EQ(head.fill_color, phase_color(theme, mark.look));
        ASSERT_EQ(cone.points.size(), 3u);
        EXPECT_NEAR(cone.points[2].x, mark.at.x, 1e-12);
        const double scale = FrictionMarks::longest * side / block.marks.strongest();
        EXPECT_NEAR(std::hypot(cone.points[0].x - cone.points[1].x, cone.points[0].y - cone.points[1].y),
                    2.0 * scale * *mark.limit, 1e-9);
        const Point tip = mark.tip(scale);
        EXPECT_NEAR(head.points[0].x, tip.x, 1e-12);
        EXPECT_NEAR(head.points[0].y, tip.y, 1e-12);
        // It ends at a corner of the base only while the contact slides.
        double nearest = 1e9;
        for (int i : {0, 1}) {
            const Point& corner = cone.points[static_cast<std::size_t>(i)];
            nearest = std::min(nearest, std::hypot(corner.x - tip.x, corner.y - tip.y));
        }
        EXPECT_EQ(nearest < 1e-9, mark.look == PhaseLook::slip) << t;
    }
}

// The center of a disc cannot carry the torque of friction; the contact is at the rim.
TEST(FrictionCone, OfADiscIsAtItsRim) {
    RoughScene spinning(spinning_disc);
    const Sample now = spinning.at(0.5);
    const auto marks = spinning.marks.at(now);
    ASSERT_EQ(marks.size(), 1u);
    EXPECT_NEAR(marks[0].at.x, now.state.q[0], 1e-9);
    EXPECT_NEAR(marks[0].at.y, 0.0, 1e-9);
    EXPECT_NEAR(marks[0].pressing, 9.81, 1e-9);
    EXPECT_NEAR(marks[0].tangent.x * marks[0].friction, -0.2 * 9.81, 1e-9);  // against the slip, to the left
    const auto rolling = spinning.marks.at(spinning.at(3.0));
    ASSERT_EQ(rolling.size(), 1u);
    EXPECT_EQ(rolling[0].look, PhaseLook::stick);
    EXPECT_NEAR(rolling[0].friction, 0.0, 1e-9);
}

TEST(FrictionCone, OfAJointIsABar) {
    RoughScene carried(belt);
    const auto marks = carried.marks.at(carried.at(1.0));
    ASSERT_EQ(marks.size(), 2u);
    EXPECT_EQ(marks[0].look, PhaseLook::stick);
    EXPECT_EQ(marks[0].pressing, 0.0);
    EXPECT_NEAR(marks[0].at.x, 0.7, 1e-9);
    EXPECT_NEAR(marks[0].at.y, 0.0, 1e-9);  // under the block
    EXPECT_NEAR(marks[0].limit.value_or(0.0), 1.0, 1e-9);
    // It balances the spring, at 0.5 + 0.2 m, and the guide.
    EXPECT_NEAR(marks[0].tangent.x * marks[0].friction, 0.7 + 0.001, 1e-9);
    EXPECT_NEAR(marks[1].limit.value_or(0.0), 0.001, 1e-9);
    // It slides back: friction falls with the sliding speed.
    const Sample later = carried.at(4.0);
    const FrictionMarks::Mark sliding = carried.marks.at(later).at(0);
    ASSERT_EQ(sliding.look, PhaseLook::slip);
    const double speed = 0.2 - later.state.v[0];
    ASSERT_GT(speed, 0.1);
    EXPECT_NEAR(sliding.limit.value_or(0.0), 1.0 / (1.0 + 3.0 * speed), 1e-9);
    EXPECT_NEAR(sliding.tangent.x * sliding.friction, *sliding.limit, 1e-9);
}

// A slip that is typed with the other sign: friction still acts against the motion, here to the left.
TEST(FrictionCone, FollowsTheSignOfTheSlip) {
    RoughScene block(R"-(
coordinate = [{name = "x", rate = 1, range = [-2, 2]}, {name = "y", range = [0, 1]}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{gap = "y", slip = "-x'", friction = 0.25, restitution = 0.5}]
drawing = [
    {shape = "segment", from = [-2, 0], to = [5, 0]},
    {shape = "segment", from = ["x", "y"], to = ["x", "y + 1"]},
]
run = {end_time = 2.0}
)-");
    const auto marks = block.marks.at(block.at(1.0));
    ASSERT_EQ(marks.size(), 1u);
    EXPECT_NEAR(marks[0].at.x, block.at(1.0).state.q[0], 1e-9);
    EXPECT_NEAR(marks[0].at.y, 0.0, 1e-9);
    EXPECT_NEAR(marks[0].tangent.x, -1.0, 1e-9);
    EXPECT_NEAR(marks[0].tangent.x * marks[0].friction, -0.25, 1e-9);
}

TEST(FrictionCone, OfATorqueIsNotDrawn) {
    RoughScene pendulum(bearing);
    EXPECT_TRUE(pendulum.marks.at(pendulum.at(1.0)).empty());
    EXPECT_FALSE(pendulum.stage.has_friction_marks());
}

TEST(FrictionMechanism, LightsTheSurfaceInTheColorOfThePhase) {
    RoughScene block(ramp);
    for (const auto& [t, look] : {std::pair{0.2, PhaseLook::slip}, std::pair{1.0, PhaseLook::stick}}) {
        const Drawing drawing =
            block.stage.draw(block.at(t), block.stage.limits(), light_theme(), {false, false, false});
        EXPECT_TRUE(std::any_of(drawing.shapes.begin(), drawing.shapes.end(),
                                [&, color = look](const DrawnShape& shape) {
                                    return shape.stroke.color == phase_color(light_theme(), color);
                                }))
            << t;
    }
}

}  // namespace
}  // namespace achilles
