// Frames of animations: positions of their areas, and plots that fill as time passes.
#include "figure/animation.hpp"

#include <gtest/gtest.h>

#include "core/systems.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

TEST(Animation, PutsThePlotsWhereTheWorldIsLarger) {
    const Rectangle screen{0, 0, 1600, 950};
    const StillAreas wide = still_areas(4.0, 3, screen), tall = still_areas(0.8, 3, screen);
    EXPECT_EQ(wide.columns, 3);
    EXPECT_EQ(wide.world.width, 1600.0F);
    EXPECT_EQ(wide.plots.y, wide.world.y + wide.world.height);
    EXPECT_EQ(tall.columns, 1);
    EXPECT_EQ(tall.world.height, 950.0F);
    EXPECT_EQ(tall.plots.x, tall.world.width);
    EXPECT_EQ(still_areas(1.0, 0, screen).world.width, 1600.0F);
    // A portrait area, and many plots.
    EXPECT_EQ(still_areas(4.0, 2, {0, 0, 1080, 1850}).columns, 1);
    EXPECT_EQ(still_areas(0.8, 5, screen).columns, 2);
    EXPECT_EQ(still_areas(4.0, 6, screen).columns, 3);
}

TEST(Animation, IsTheSameSmallerAsLongAsItCanBeRead) {
    EXPECT_DOUBLE_EQ(still_scale({1600, 1000, 1.0}), 1.3);
    EXPECT_DOUBLE_EQ(still_scale({3200, 2000, 1.0}), 2.6);
    EXPECT_DOUBLE_EQ(still_scale({3200, 1000, 2.0}), 2.6);
    EXPECT_DOUBLE_EQ(still_scale({320, 200, 1.0}), 0.5);
    EXPECT_DOUBLE_EQ(still_scale({16384, 16384, 8.0}), 11.0);
}

// Without a [[drawing]], a frame shows the plane of two coordinates with h = 0, or the phase plane of a single one.
TEST(Animation, ShowsAPlaneWhereNothingIsDrawn) {
    const std::string rest = "[[constraint]]\ngap = \"a\"\nrestitution = 0.5\n";
    const std::string one = "title = \"\"\n[[coordinate]]\nname = \"a\"\nstart = 1\nunit = \"m\"\n";
    const auto plane = test::typed(one + "[[coordinate]]\nname = \"b\"\nrate = 1\n[lagrangian]\n" +
                                   "kinetic = \"(a'^2 + b'^2)/2\"\npotential = \"a\"\n" + rest);
    const auto line = test::typed(one + "[lagrangian]\nkinetic = \"a'^2/2\"\npotential = \"a\"\n" + rest);
    for (const auto& model : {plane, line}) {
        const Trajectory trajectory = simulate(model, model->default_run());
        Animation animation(trajectory, {}, {1600, 1000, 1.0}, 1.0 / 30.0);
        const AnimationFrame still = animation.at(1.0);
        ASSERT_EQ(still.plane.panels.size(), 1u);
        const Panel& panel = still.plane.panels[0];
        EXPECT_EQ(panel.x.label, "𝑎 (m)");
        EXPECT_EQ(panel.y.label, model == plane ? "𝑏" : "𝑎\u0307 (m/s)");
        EXPECT_EQ(panel.boundary.points.empty(), model == line);
        EXPECT_NEAR(panel.markers.back().points.at(0).x, 0.5, 1e-9);  // the present state
        EXPECT_EQ(to_text(still).find("[[drawing]]"), std::string::npos);
    }
}

TEST(Animation, ShowsThePresentAndFillsThePlots) {
    const auto model = test::load("ball_on_sine");
    const Trajectory trajectory = simulate(model, model->default_run());
    const std::vector<ViewDescription> views{model->description().views[1]};  // the height
    Animation animation(trajectory, views, {1600, 1000, 1.0}, 1.0 / 30.0);
    const AnimationFrame before = animation.at(1.0), after = animation.at(3.2);
    EXPECT_EQ(to_text(before).substr(0, to_text(before).find("shape")),
              "Ball bouncing on a sinusoidal surface\n𝑡 = 1.00 s\nin flight\n");
    EXPECT_NE(to_text(after).find("𝑡 = 3.20 s\nin contact\n"), std::string::npos);

    const Panel &first = before.plots.panels[0], &second = after.plots.panels[0];
    EXPECT_EQ(first.y.low, second.y.low);
    EXPECT_EQ(first.y.high, second.y.high);
    // Pale curves of the whole run, then the curves up to the present.
    ASSERT_EQ(first.curves.size(), 4u);
    EXPECT_EQ(first.curves[0].points.size(), second.curves[0].points.size());
    EXPECT_LT(first.curves[0].stroke.color.a, 100);
    EXPECT_EQ(first.curves[2].points.back().x, 1.0);
    EXPECT_TRUE(first.curves[3].points.empty());
    EXPECT_EQ(second.curves[3].points.back().x, 3.2);
    // Events up to the present, then the cursor and the dot.
    ASSERT_EQ(second.markers.size(), 5u);
    EXPECT_TRUE(first.markers[0].points.empty());
    EXPECT_GT(second.markers[0].points.size(), 3u);
    for (const Point& p : second.markers[0].points) EXPECT_LE(p.x, 3.2);
    EXPECT_EQ(second.markers[1].points.size(), 1u);  // one Zeno point
    EXPECT_TRUE(second.markers[2].points.empty());   // no release yet
    EXPECT_EQ(second.markers[3].points[0].x, 3.2);
    EXPECT_EQ(second.markers[4].points[0].x, 3.2);
    EXPECT_NEAR(second.markers[4].points[0].y, Sampler(trajectory).at(3.2).state.q[1], 1e-15);
    // The solid; the surface, highlighted because it is touched; the future and the past trail of the ball, in flight
    // and in contact. In front of them the ball, whose rim is at the position that the file gives for its center.
    const std::vector<DrawnShape>& shapes = after.world.shapes;
    ASSERT_EQ(shapes.size(), 9u);
    const Color lit = phase_color(light_theme(), Phase::Kind::constrained);
    EXPECT_EQ(shapes[0].kind, DrawnShape::Kind::area);
    EXPECT_EQ(shapes[1].stroke.color, light_theme().surface);
    EXPECT_EQ(shapes[2].stroke.color, lit);
    for (std::size_t i = 3; i < 6; ++i) EXPECT_LT(shapes[i].stroke.color.a, 100);
    EXPECT_FALSE(shapes[6].stroke.dash.empty());
    EXPECT_TRUE(shapes[7].stroke.dash.empty());
    EXPECT_EQ(shapes[7].stroke.color, lit);
    const DrawnShape& disc = shapes[8];
    EXPECT_EQ(disc.kind, DrawnShape::Kind::disc);
    const Vector q = Sampler(trajectory).at(3.2).state.q;
    EXPECT_NEAR(std::hypot(disc.points[0].x - q[0], disc.points[0].y - q[1]), disc.radius, 1e-9);
}

}  // namespace
}  // namespace achilles
