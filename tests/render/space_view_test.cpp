// Systems in space, seen from any direction.
#include "figure/space_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism_scene.hpp"

namespace achilles {
namespace {

struct TurnedScene {
    TurnedScene(const std::string& name, const std::optional<ViewAngles>& direction)
        : model(test::load(name)),
          run(simulate(model, model->default_run())),
          samples(plot_samples(run)),
          mechanism(*model, direction),
          scene(mechanism, run, samples) {}
    Sample at(double t) { return Sampler(run).at(t); }
    Drawing draw(double t) { return scene.draw(at(t), scene.limits(), light_theme(), {true, false, false}); }

    std::shared_ptr<const Model> model;
    Trajectory run;
    std::vector<Sample> samples;
    Mechanism mechanism;
    MechanismScene scene;
};

DrawnShape ball_of(const Drawing& drawing) {
    return *std::find_if(drawing.shapes.begin(), drawing.shapes.end(),
                         [](const DrawnShape& shape) { return shape.kind == DrawnShape::Kind::disc && shape.moves; });
}

TEST(SpaceView, ShowsPointsInSpaceAndNothingElse) {
    for (const std::string& name : test::all_systems())
        EXPECT_EQ(SpaceView::shows(*test::load(name)), name == "ball_on_egg_crate" || name == "ball_round_post")
            << name;
}

TEST(SpaceView, LooksAlongTheAxes) {
    const auto model = test::load("ball_on_egg_crate");
    const SpaceView::Place p(1.0, 2.0, 3.0);
    const auto sees = [&](double about, double tilt, const SpaceView::Place& wanted) {
        const SpaceView view(*model, {about, tilt});
        EXPECT_LT((view.seen(p) - wanted).norm(), 1e-15) << about << " " << tilt;
        EXPECT_LT((view.unseen(view.seen(p)) - p).norm(), 1e-15);
    };
    sees(0.0, 0.0, {1.0, 3.0, -2.0});  // x to the right, z up, from the front
    sees(0.0, 90.0, {1.0, 2.0, 3.0});  // from above
    sees(0.0, -90.0, {1.0, -2.0, -3.0});
    sees(90.0, 0.0, {-2.0, 3.0, -1.0});  // y to the left
    const ViewAngles by_hand = rounded({200.4, 95.0});
    EXPECT_EQ(by_hand.about, -160.0);
    EXPECT_EQ(by_hand.tilt, 90.0);
}

// A drag goes on from the direction in which the file draws its system.
TEST(SpaceView, FindsTheDirectionOfADrawing) {
    const auto direction = [](const char* name) {
        const auto model = test::load(name);
        return drawn_angles(Mechanism(*model), *model);
    };
    EXPECT_EQ(direction("ball_on_egg_crate"), (ViewAngles{30.0, 46.0}));
    EXPECT_EQ(direction("ball_round_post"), (ViewAngles{0.0, 90.0}));
}

TEST(SpaceView, HasThePointWhereItIsAndKeepsItsSize) {
    const double across = TurnedScene("ball_round_post", ViewAngles{0.0, 0.0}).scene.limits().x_high -
                          TurnedScene("ball_round_post", ViewAngles{0.0, 0.0}).scene.limits().x_low;
    for (const ViewAngles& direction :
         {ViewAngles{0.0, 0.0}, ViewAngles{0.0, 90.0}, ViewAngles{-50.0, 20.0}, ViewAngles{120.0, -70.0}}) {
        TurnedScene turned("ball_round_post", direction);
        const Drawing& limits = turned.scene.limits();
        EXPECT_NEAR(limits.x_high - limits.x_low, across, 1e-12) << "the scale must not change while it is turned";
        const SpaceView view(*turned.model, direction);
        for (const double t : {0.0, 0.4, 3.0}) {
            const State state = turned.at(t).state;
            const SpaceView::Place seen =
                view.seen({state.q[0] * std::cos(state.q[1]), state.q[0] * std::sin(state.q[1]), state.q[2]});
            const DrawnShape ball = ball_of(turned.draw(t));
            EXPECT_GT(ball.radius, 0.0);
            EXPECT_LE(std::hypot(ball.points[0].x - seen.x(), ball.points[0].y - seen.y()), 3.0 * ball.radius)
                << "between two surfaces that meet at a sharp angle it is farther from the point" << t;
            EXPECT_GT(seen.x(), limits.x_low);
            EXPECT_LT(seen.x(), limits.x_high);
            EXPECT_GT(seen.y(), limits.y_low);
            EXPECT_LT(seen.y(), limits.y_high);
        }
    }
}

// Seen from above, the lines of the post are its section; from the side, those of the crate are at most its height.
TEST(SpaceView, DrawsTheSurfacesOfTheGaps) {
    TurnedScene post("ball_round_post", ViewAngles{0.0, 90.0});
    const double p = post.run.run.parameters[2];
    std::size_t on_post = 0, lines = 0;
    for (const DrawnShape& shape : post.draw(0.0).shapes) {
        if (shape.moves || shape.points.size() < 3) continue;
        ++lines;
        on_post += std::all_of(shape.points.begin(), shape.points.end(), [&](const Point& at) {
            const double r = std::hypot(at.x, at.y), phi = std::atan2(at.y, at.x);
            return !std::isfinite(at.x) || std::abs(r - 1.0 - p * std::cos(phi)) < 1e-6;
        });
    }
    EXPECT_GE(on_post, 5U);
    EXPECT_GT(lines, on_post + 5) << "and the bowl";
    TurnedScene crate("ball_on_egg_crate", ViewAngles{0.0, 0.0});
    std::size_t seen = 0;
    for (const DrawnShape& shape : crate.draw(0.0).shapes) {
        if (shape.moves || shape.stroke.width != 1.0) continue;
        for (const Point& at : shape.points) {
            if (!std::isfinite(at.y)) continue;
            EXPECT_LE(std::abs(at.y), 0.2 + 1e-9);
            ++seen;
        }
    }
    EXPECT_GT(seen, 200U);
}

// In space every contact force is a force at the point, which a drawing in the plane cannot say.
TEST(SpaceView, ShowsTheForceOfTheContact) {
    TurnedScene crate("ball_on_egg_crate", ViewAngles{0.0, 0.0});
    const Sample now = crate.at(crate.run.end_time);
    ASSERT_TRUE(now.contact);
    auto grip = crate.mechanism.grip(crate.run.run.parameters);
    const auto body = Body::of(*grip, now.t, now.state);
    const Vector Q = contact_force(crate.run, now);
    const auto force = body->force(Q);
    ASSERT_TRUE(force);
    EXPECT_NEAR(force->x, Q[0], 1e-6);
    EXPECT_NEAR(force->y, Q[2], 1e-6);
    EXPECT_GT(crate.scene.trail().strongest, 0.0);
}

TEST(SpaceView, LeavesTheDrawingOfTheFileAlone) {
    TurnedScene drawn("ball_on_egg_crate", std::nullopt), plane("ball_on_sine", ViewAngles{10.0, 10.0});
    EXPECT_EQ(drawn.mechanism.space(), nullptr);
    EXPECT_EQ(plane.mechanism.space(), nullptr) << "a system in a plane is not turned";
}

}  // namespace
}  // namespace achilles
