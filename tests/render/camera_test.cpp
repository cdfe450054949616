// Visible part of the world, solid ground, and resting discs, numerically for the systems of the gallery.
#include "figure/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism.hpp"
#include "figure/mechanism_scene.hpp"

namespace achilles {
namespace {

struct SceneFixture {
    explicit SceneFixture(const std::string& name)
        : model(test::load(name)),
          run(simulate(model, model->default_run())),
          samples(plot_samples(run)),
          mechanism(*model),
          stage(mechanism, run, samples) {}
    Sample at(double t) { return Sampler(run).at(t); }
    const Event& first(Event::Kind kind) const {
        return *std::find_if(run.events.begin(), run.events.end(), [&](const Event& e) { return e.kind == kind; });
    }
    Drawing draw(double t, const Drawing& seen) { return stage.draw(at(t), seen, light_theme(), {}); }

    std::shared_ptr<const Model> model;
    Trajectory run;
    std::vector<Sample> samples;
    Mechanism mechanism;
    MechanismScene stage;
};

// The last moving disc.
DrawnShape ball_in(const Drawing& drawing) {
    DrawnShape found;
    for (const DrawnShape& shape : drawing.shapes)
        if (shape.kind == DrawnShape::Kind::disc && shape.moves) found = shape;
    return found;
}

bool is_inside(const std::vector<Point>& polygon, const Point& p) {
    bool left = false, right = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double turn = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        left = left || turn > 0.0, right = right || turn < 0.0;
    }
    return !polygon.empty() && !(left && right);
}

bool is_solid(const Drawing& drawing, const Point& p) {
    for (const DrawnShape& shape : drawing.shapes) {
        if (shape.kind != DrawnShape::Kind::area) continue;
        std::vector<Point> polygon;
        for (const Point& corner : shape.points) {
            if (std::isfinite(corner.x)) {
                polygon.push_back(corner);
                continue;
            }
            if (is_inside(polygon, p)) return true;
            polygon.clear();
        }
        if (is_inside(polygon, p)) return true;
    }
    return false;
}

Drawing around(const Point& p, double size) {
    Drawing drawing;
    drawing.x_low = p.x - 0.5 * size, drawing.x_high = p.x + 0.5 * size;
    drawing.y_low = p.y - 0.5 * size, drawing.y_high = p.y + 0.5 * size;
    return drawing;
}

// Gaps such as y - sin(x) refer to the center of a disc. While such a contact is held, the rim is on the line and no
// part of the disc below it. A gap that includes the radius leaves the disc where the file puts it.
TEST(Disc, RestsOnTheGroundItTouches) {
    for (const char* name : {"ball_on_sine", "ball_on_hills", "ball_in_bowl", "ball_in_gusts", "ball_on_cylinder",
                             "bead_in_ring", "ball_on_floor", "ball_on_incline", "ball_in_sloped_box", "ball_in_v"}) {
        SceneFixture staged(name);
        const double t = staged.first(Event::Kind::zeno).t;
        const Drawing drawing = staged.draw(t, staged.stage.limits());
        const DrawnShape ball = name == std::string("ball_in_gusts") ? [&] {
            for (const DrawnShape& shape : drawing.shapes)
                if (shape.kind == DrawnShape::Kind::disc && shape.moves) return shape;
            return DrawnShape();
        }() : ball_in(drawing);
        ASSERT_EQ(ball.points.size(), 1u) << name;
        // Slightly inside the rim nothing is solid; slightly outside, toward the ground, there is ground.
        int free = 0, touching = 0;
        for (int i = 0; i < 360; ++i) {
            const double angle = i * 3.14159265358979 / 180.0;
            const auto at = [&](double share) {
                return Point{ball.points[0].x + share * ball.radius * std::cos(angle),
                             ball.points[0].y + share * ball.radius * std::sin(angle)};
            };
            free += is_solid(drawing, at(0.93)) ? 0 : 1;
            touching += is_solid(drawing, at(1.07)) ? 1 : 0;
        }
        EXPECT_EQ(free, 360) << name;
        EXPECT_GE(touching, 3) << name;
        EXPECT_LE(touching, 150) << name;
    }
}

// A floor that is drawn only where the ball reaches it is solid everywhere, since its gap is that of a floor everywhere.
// A table is not: beside it, its contact does not count.
TEST(Ground, IsFoundWhereAContactFirstCloses) {
    SceneFixture ramp("wavy_ramp");
    const Drawing slope = ramp.draw(0.0, ramp.stage.limits());
    for (const double x : {0.2, 2.0, 4.0}) {
        EXPECT_TRUE(is_solid(slope, {x, -0.1})) << x;
        EXPECT_FALSE(is_solid(slope, {x, 1.2})) << x;
    }
    SceneFixture table("superball");
    const Drawing room = table.draw(0.0, table.stage.limits());
    EXPECT_TRUE(is_solid(room, {-0.5, -0.02})) << "the floor";
    for (double y = 0.1; y < room.y_high; y += 0.05) EXPECT_FALSE(is_solid(room, {-0.5, y})) << y;
}

TEST(Disc, IsWhereTheFileSaysFarFromTheGround) {
    SceneFixture staged("ball_on_sine");
    const DrawnShape ball = ball_in(staged.draw(0.0, staged.stage.limits()));
    EXPECT_NEAR(ball.points[0].x, 0.0, 1e-9);
    EXPECT_NEAR(ball.points[0].y, 2.0, 1e-9);
    SceneFixture floor("ball_on_floor");
    const double t = floor.first(Event::Kind::zeno).t;
    EXPECT_EQ(ball_in(floor.draw(t, floor.stage.limits())).points[0].y, floor.at(t).state.q[1]);
}

// Small heights over the ground are true, so that the scale bar is valid for a bounce.
TEST(Disc, KeepsSmallHeights) {
    SceneFixture staged("ball_on_sine");
    const double t = staged.first(Event::Kind::zeno).t;
    Sample sample = staged.at(t);
    const double x = sample.state.q[0], slope = std::sqrt(1.0 + std::cos(x) * std::cos(x));
    const auto height = [&](double h) {
        sample.state.q[1] = std::sin(x) + h;
        const DrawnShape ball = ball_in(staged.stage.draw(sample, staged.stage.limits(), light_theme(), {}));
        return ball.points[0].y;
    };
    for (const double h : {1e-9, 1e-6, 1e-3}) EXPECT_NEAR((height(h) - height(0.0)) / h, 1.0, 0.01 + 0.2 * h) << slope;
}

TEST(Ground, IsTheSideOfTheGapAndSmoothAtAnyZoom) {
    SceneFixture staged("ball_on_sine");
    for (const double x : {0.4, 4.0, 11.0})
        for (const double size : {10.0, 1.0, 1e-3, 1e-6, 1e-9}) {
            const Point on{x, std::sin(x)};
            const Drawing drawing = staged.draw(0.0, around({x + 0.013 * size, on.y}, size));
            EXPECT_TRUE(is_solid(drawing, {x, on.y - 0.01 * size})) << x << " " << size;
            EXPECT_FALSE(is_solid(drawing, {x, on.y + 0.01 * size})) << x << " " << size;
            // On the file's own line, the error of a visible chord is at most a tenth of a pixel of a thousand.
            const auto line = std::find_if(drawing.shapes.begin(), drawing.shapes.end(), [](const DrawnShape& shape) {
                return shape.kind == DrawnShape::Kind::polyline && !shape.moves && shape.item;
            });
            ASSERT_NE(line, drawing.shapes.end());
            double worst = 0.0;
            int seen = 0;
            for (std::size_t i = 1; i < line->points.size(); ++i) {
                const Point &a = line->points[i - 1], &b = line->points[i];
                const double middle = 0.5 * (a.x + b.x);
                if (std::abs(middle - x) > 0.5 * size) continue;
                ++seen;
                worst = std::max(worst, std::abs(0.5 * (a.y + b.y) - std::sin(middle)));
            }
            EXPECT_GE(seen, 5);
            EXPECT_LE(worst, 1e-4 * size) << x << " " << size;
            EXPECT_LT(line->points.size(), 3000u);
        }
    // A bead inside a ring: the outside is solid.
    SceneFixture ring("bead_in_ring");
    const Drawing drawing = ring.draw(0.0, ring.stage.limits());
    EXPECT_TRUE(is_solid(drawing, {0.51, 0.0}));
    EXPECT_FALSE(is_solid(drawing, {0.48, 0.0}));
}

TEST(Contact, IsLitWhileItIsHeldInEverySystemThatDraws) {
    for (const std::string& name : test::all_systems()) {
        SceneFixture staged(name);
        if (staged.mechanism.is_empty()) continue;
        const auto count = [&](const ContactSet& held, const Color& lit) {
            Sample sample = staged.at(staged.run.run.options.start_time);
            sample.mode = Mode::holding(held);
            const Drawing drawing = staged.stage.draw(sample, staged.stage.limits(), light_theme(), {false, false});
            return std::count_if(drawing.shapes.begin(), drawing.shapes.end(),
                                 [&](const DrawnShape& shape) { return shape.stroke.color == lit; });
        };
        for (std::size_t i = 0; i < staged.model->contacts(); ++i) {
            const ContactSet held = ContactSet::of(i);
            const Color lit = phase_color(light_theme(), look_of(*staged.model, held, Mode::holding(held)));
            EXPECT_EQ(count({}, lit), 0) << name;
            EXPECT_GE(count(held, lit), 1) << name << i;
        }
    }
}

// ---- cameras ----

bool holds(const Drawing& seen, const Point& p) {
    return p.x >= seen.x_low && p.x <= seen.x_high && p.y >= seen.y_low && p.y <= seen.y_high;
}

TEST(Camera, FitCutsNoArrow) {
    for (const char* name : {"ball_on_sine", "double_pendulum", "ball_in_v", "falling_rod", "cart_pendulum"})
        for (const auto& [width, height] : {std::pair{480.0, 310.0}, {600.0, 600.0}, {900.0, 500.0}}) {
            SceneFixture staged(name);
            const double longest = 0.16 * std::min(width, height);
            const Drawing seen =
                staged.stage.camera().at(CameraMode::fit, staged.at(0.0), {width, height, longest, longest});
            const double unit = std::min(width / (seen.x_high - seen.x_low), height / (seen.y_high - seen.y_low));
            const Drawing all = widened(seen, width, height);
            for (const Trail::Arrows& arrows : staged.stage.trail().arrows)
                for (const Point& share : {arrows.velocity, arrows.force})
                    EXPECT_TRUE(holds(all, {arrows.at.x + share.x * longest / unit * 0.99,
                                            arrows.at.y + share.y * longest / unit * 0.99}))
                        << name;
        }
}

TEST(Camera, FollowNeverLosesTheBodyAndItsArrow) {
    for (const char* name : {"ball_on_sine", "ball_on_hills", "double_pendulum", "falling_rod"}) {
        SceneFixture staged(name);
        auto grip = staged.mechanism.grip(staged.run.run.parameters);
        const double longest = 80.0;
        Point before;
        for (int i = 0; i <= 400; ++i) {
            const double start = staged.run.run.options.start_time;
            const Sample now = staged.at(start + (staged.run.end_time - start) * i / 400);
            const Drawing seen = staged.stage.camera().at(CameraMode::follow, now, {500.0, 500.0, longest, 0.0});
            const double size = seen.x_high - seen.x_low;
            const Point body = grip->at(now.t, now.state).at,
                        v = Body::of(*grip, now.t, now.state)->velocity(now.state.v);
            const double arrow = longest / 500.0 * size / staged.stage.trail().fastest;
            EXPECT_TRUE(holds(seen, body)) << name << " " << now.t;
            EXPECT_TRUE(holds(seen, {body.x + arrow * v.x, body.y + arrow * v.y})) << name << " " << now.t;
            // The view does not jump.
            const Point middle{0.5 * (seen.x_low + seen.x_high), 0.5 * (seen.y_low + seen.y_high)};
            if (i > 0) {
                EXPECT_LT(std::hypot(middle.x - before.x, middle.y - before.y), 0.2 * size) << name;
            }
            before = middle;
        }
    }
}

// The bounces look alike at every scale: the highest remaining bounce takes a quarter of the picture's height, until
// there are no more bounces.
TEST(Camera, ZenoKeepsTheBouncesVisibleUntilTheCut) {
    for (const char* name : {"ball_on_sine", "ball_on_floor", "falling_rod"}) {
        SceneFixture staged(name);
        const Camera& camera = staged.stage.camera();
        const double zeno = staged.first(Event::Kind::zeno).t;
        double before = std::numeric_limits<double>::infinity(), least = before;
        auto grips = staged.mechanism.grips(staged.run.run.parameters);
        AnchorPoint& grip = grips[staged.stage.touch().tip_of(0).value_or(0)];
        for (double left = 0.4; left > 1e-12; left *= 0.9) {
            const auto height = camera.height_left(zeno - left);
            if (!height) continue;
            const Sample now = staged.at(zeno - left);
            const Drawing seen = camera.at(CameraMode::zeno, now, {600.0, 400.0});
            const double size = seen.y_high - seen.y_low;
            EXPECT_LE(size, before * (1.0 + 1e-9)) << name << left;
            before = size;
            const double shown = *height / size;
            if (size < 1.0) {
                EXPECT_NEAR(shown, 0.25, 0.01) << name << " " << left;
                least = std::min(least, *height);
            }
            // The contact point on the ground and the points just above it are visible.
            const auto ground = staged.stage.touch().ground_below(grip, 0, now.t, now.state);
            ASSERT_TRUE(ground);
            EXPECT_TRUE(holds(seen, ground->foot)) << name << " " << left;
        }
        EXPECT_LT(least, 2e-4) << name;
        // From the last impact on the picture stays: it shows no height at which no bounce is computed.
        const auto& events = staged.run.events;
        const auto cut = std::find_if(events.begin(), events.end(), [](const Event& event) { return event.is_zeno(); });
        const double last = std::prev(cut)->t;
        const double at_cut = *camera.height_left(last), later = *camera.height_left(0.5 * (last + zeno));
        EXPECT_DOUBLE_EQ(at_cut, later) << name;
        EXPECT_DOUBLE_EQ(at_cut, least) << name;
        // After the Zeno point the view returns. It is a function of time only.
        const Drawing all = camera.at(CameraMode::fit, staged.at(0.0), {600.0, 400.0});
        const Drawing end = camera.at(CameraMode::zeno, staged.at(staged.run.end_time), {600.0, 400.0});
        EXPECT_GE(end.y_high - end.y_low, (all.y_high - all.y_low) * (1.0 - 1e-9)) << name;
        const Drawing once = camera.at(CameraMode::zeno, staged.at(zeno - 1e-3), {600.0, 400.0});
        const Drawing again = camera.at(CameraMode::zeno, staged.at(zeno - 1e-3), {600.0, 400.0});
        EXPECT_EQ(once.x_low, again.x_low);
        EXPECT_EQ(once.y_high, again.y_high);
    }
}

// Words for the Zeno camera: how much it enlarges, the gap and the height of the bounce.
TEST(Camera, ZenoTellsItsEnlargementGapAndBounce) {
    SceneFixture staged("ball_on_floor");
    const Camera& camera = staged.stage.camera();
    const CameraPicture picture{600.0, 400.0};
    std::vector<double> impacts;
    double zeno = 0.0;
    for (const Event& event : staged.run.events) {
        if (event.is_zeno()) {
            zeno = event.t;
            break;
        }
        impacts.push_back(event.t);
    }
    ASSERT_GT(impacts.size(), 4u);
    EXPECT_FALSE(camera.zeno_view(staged.at(0.5 * impacts.front()), picture)) << "before the first impact";
    EXPECT_FALSE(camera.zeno_view(staged.at(staged.run.end_time), picture));
    double enlargement = 1.0;
    std::size_t seen_bounces = 0;
    for (std::size_t i = 0; i + 1 < impacts.size(); ++i) {
        const double middle = 0.5 * (impacts[i] + impacts[i + 1]);
        const auto view = camera.zeno_view(staged.at(middle), picture);
        if (!view && enlargement == 1.0) continue;  // a bounce as high as the picture
        ASSERT_TRUE(view) << i;
        ++seen_bounces;
        EXPECT_FALSE(view->is_cut);
        EXPECT_NEAR(view->gap, view->bounce, 1e-6 * view->bounce) << "a bounce is highest in its middle, " << i;
        EXPECT_GT(view->enlargement, enlargement);
        enlargement = view->enlargement;
        // The gap of this bounce never shrinks below 5 pixels.
        const Drawing seen = camera.at(CameraMode::zeno, staged.at(middle), picture);
        EXPECT_GT(view->gap * picture.height / (seen.y_high - seen.y_low), 5.0) << i;
    }
    EXPECT_GT(seen_bounces, impacts.size() / 2);
    const auto cut = camera.zeno_view(staged.at(0.5 * (impacts.back() + zeno)), picture);
    ASSERT_TRUE(cut);
    EXPECT_TRUE(cut->is_cut);
    EXPECT_TRUE(cut->is_inside_body);
    EXPECT_GT(cut->bounce, 0.0);
}

TEST(Strobe, IsThinNearAZenoPoint) {
    SceneFixture staged("ball_on_sine");
    const std::vector<double> poses = staged.stage.poses();
    EXPECT_GE(poses.size(), 6u);
    EXPECT_LE(poses.size(), 40u);
    const double zeno = staged.first(Event::Kind::zeno).t;
    EXPECT_LE(std::count_if(poses.begin(), poses.end(), [&](double t) { return std::abs(t - zeno) < 0.1; }), 2);
    const Sample end = staged.at(staged.run.end_time);
    const auto shapes = [&](bool strobe) {
        return staged.stage.draw(end, staged.stage.limits(), light_theme(), {false, strobe}).shapes.size();
    };
    EXPECT_GE(shapes(true), shapes(false) + poses.size() - 1);
}

TEST(BodyTrail, IsFaintAhead) {
    SceneFixture staged("ball_on_sine");
    const Drawing drawing = staged.draw(5.0, staged.stage.limits());
    std::size_t ahead = 0, passed = 0;
    double last = 0.0;
    for (const DrawnShape& shape : drawing.shapes) {
        if (shape.item || shape.kind != DrawnShape::Kind::polyline || shape.points.empty()) continue;
        (shape.stroke.color.a < 100 ? ahead : passed) += shape.points.size();
        if (shape.stroke.color.a < 100) last = std::max(last, shape.points.back().x);
    }
    EXPECT_GT(ahead, 20u);
    EXPECT_GT(passed, 20u);
    EXPECT_GT(last, 11.0) << "to the end of the run";
}

TEST(ScaleBar, IsRoundAndInTheUnitOfTheFile) {
    EXPECT_EQ(round_length(0.7), 0.5);
    EXPECT_EQ(round_length(1.0), 1.0);
    EXPECT_DOUBLE_EQ(round_length(4.9e-9), 2e-9);
    EXPECT_EQ(length_label(0.5, "m"), "0.5 m");
    EXPECT_EQ(length_label(20.0, ""), "20");
    EXPECT_EQ(length_label(2e-9, "m"), "2\u00b710\u207b\u2079 m");
    EXPECT_EQ(length_label(1e-6, "m"), "10\u207b\u2076 m");
    for (const std::string& name : test::all_systems())
        EXPECT_EQ(length_unit(test::load(name)->description()), name == "simplest_walker" ? "" : "m") << name;
}

TEST(TwoViews, CutASystemInSpaceWhereItsPointIs) {
    SceneFixture staged("ball_on_egg_crate");
    const TwoViews sides(staged.run, staged.samples);
    ASSERT_TRUE(sides.exist());
    EXPECT_FALSE(TwoViews(SceneFixture("ball_on_sine").run, staged.samples).exist());
    const auto limits = sides.limits();
    for (std::size_t side = 0; side < 2; ++side) {
        const Sample now = staged.at(staged.run.end_time);
        const Drawing drawing = sides.draw(side, now, limits[side], light_theme(), true);
        const DrawnShape ball = ball_in(drawing);
        const double across = now.state.q[static_cast<Eigen::Index>(side)];
        EXPECT_NEAR(ball.points[0].x, across, 1.01 * ball.radius);
        EXPECT_TRUE(is_solid(drawing, {across, now.state.q[2] - 0.05}));
        EXPECT_FALSE(is_solid(drawing, {across, now.state.q[2] + 0.02}));
    }
}

}  // namespace
}  // namespace achilles
