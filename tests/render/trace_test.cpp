// Figures show the whole motion, for runs of any length.
#include "figure/trace.hpp"

#include <gtest/gtest.h>

#include "figure/mechanism_scene.hpp"
#include "render/drawn.hpp"

namespace achilles {
namespace {

ViewDescription view(const std::string& x, const std::string& y) {
    ViewDescription result;
    result.x.text = x;
    result.y.push_back({y, {}});
    return result;
}

Trajectory run_until(const std::string& name, double end) {
    const auto model = test::load(name);
    Run run = model->default_run();
    run.options.end_time = end;
    return simulate(model, run);
}

TEST(Trace, FiguresOfRandomRunsShowTheirMotion) {
    drawn::RandomRuns runs(36, 2000.0);
    for (int i = 0; i < 40; ++i) {
        const drawn::RandomRun run = runs.next();
        const drawn::Picture picture(run.trajectory, run.view);
        EXPECT_FALSE(drawn::is_empty(picture)) << run.about;
        EXPECT_LE(drawn::worst(run.trajectory, picture), 0.7) << run.about;
    }
}

// The contact force jumps where contact begins, and is largest there: 0.84 pixels above the next sample. The measure
// accepts the true curve and detects that this point is missing.
TEST(Trace, ShowsAForceToItsHighestWhereItJumps) {
    const auto model = test::load("ball_in_bowl");
    auto start = model->default_run();
    start.v *= 0.573364;
    start.options.end_time = 30.0961;
    const Trajectory run = simulate(model, start);
    drawn::Picture picture(run, view("t", "lambda"));
    EXPECT_LE(drawn::worst_over_time(run, picture), 0.7);
    const auto jump =
        std::find_if(run.pieces.begin(), run.pieces.end(), [](auto& piece) { return !piece.mode.is_free(); });
    ASSERT_NE(jump, run.pieces.end());
    int changed = 0;
    for (Curve& curve : picture.figure.panels[0].curves)
        for (Point& point : curve.points)
            if (point.x == jump->start && point.y > 0.0) point.y = 0.0, ++changed;
    EXPECT_GT(changed, 0);
    EXPECT_GT(drawn::worst_over_time(run, picture), 0.7);
}

// Where the state jumps a path in a plane ends, also if the phase changes there.
TEST(Trace, PathsEndWhereTheStateJumps) {
    const Trajectory run = run_until("kneed_walker", 1.2);
    const drawn::Picture picture(run, view("q1", "q1'"));
    for (const Curve& curve : picture.figure.panels[0].curves)
        for (std::size_t i = 1; i < curve.points.size(); ++i) {
            const Point &a = curve.points[i - 1], &b = curve.points[i];
            if (std::isfinite(a.x) && std::isfinite(b.x)) {
                EXPECT_LT(b.x - a.x, 5.0) << a.x;  // degrees; q1 falls between the jumps
            }
        }
}

TEST(Trace, PhasePlaneOfALongRunIsNoPolygon) {
    for (const double end : {1.0, 100.0, 500.0}) {
        const Trajectory run = run_until("ball_on_vibrating_table", end);
        const drawn::Picture picture(run, view("sin(om*t)", "y'"));
        EXPECT_LE(drawn::worst_in_plane(run, picture, 24), 0.7) << end;
    }
}

TEST(Trace, NumberOfPointsDoesNotGrowWithTheRun) {
    const Trajectory run = run_until("ball_on_vibrating_table", 2000.0);
    for (const ViewDescription& shown : {view("t", "gap"), view("sin(om*t)", "y'")}) {
        const drawn::Picture picture(run, shown);
        std::size_t points = 0;
        for (const Curve& curve : picture.panel().curves) points += curve.points.size();
        EXPECT_LT(points, 40000U) << shown.x.text;
    }
}

// The rod rotates at 10 rad/s and its end is on the ring for most of the run, so that the drawn trail is a circle.
TEST(Trace, TrailIsSampledWhereItIsDrawn) {
    const auto model = test::typed(R"toml(
title = ""
[[coordinate]]
name = "r"
start = 0.3
[[coordinate]]
name = "phi"
rate = 10
[lagrangian]
kinetic = "0.5*r'^2 + 0.5*r^2*phi'^2 + 0.5*phi'^2"
potential = "0"
[[constraint]]
gap = "0.6 - r"
restitution = "0"
[[drawing]]
shape = "disc"
at = ["r*cos(phi)", "r*sin(phi)"]
radius = "0.04"
)toml");
    auto run = model->default_run();
    run.options.end_time = 300.0;
    const Trajectory trajectory = simulate(model, run);
    ASSERT_EQ(trajectory.end_phase, Phase::Kind::constrained);
    const Mechanism mechanism(*model);
    const std::vector<Sample> samples = plot_samples(trajectory);
    MechanismScene stage(mechanism, trajectory, samples);
    const Drawing& world = stage.limits();
    constexpr double pixels = 700.0;
    const double unit = (world.x_high - world.x_low) / pixels;
    int chords = 0;
    const auto& way = stage.trail().way;
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Point &a = way[i - 1].at, &b = way[i].at;
        if (way[i].look != PhaseLook::contact || !drawn::is_there(a) || !drawn::is_there(b)) continue;
        EXPECT_NEAR(std::hypot(0.5 * (a.x + b.x), 0.5 * (a.y + b.y)), 0.6, 0.3 * unit);
        ++chords;
    }
    EXPECT_GT(chords, 60);
    EXPECT_LT(way.size(), 30000U);
    // Near the present, in a small part of the world.
    const Sample now = Sampler(trajectory).at(200.0);
    const Point at{0.6 * std::cos(now.state.q[1]), 0.6 * std::sin(now.state.q[1])};
    Drawing seen = world;
    const double size = 0.02;
    seen.x_low = at.x - size, seen.x_high = at.x + size, seen.y_low = at.y - size, seen.y_high = at.y + size;
    int close = 0;
    for (const DrawnShape& shape : stage.draw(now, seen, light_theme(), {}).shapes) {
        if (shape.kind != DrawnShape::Kind::polyline || shape.moves) continue;
        for (std::size_t i = 1; i < shape.points.size(); ++i) {
            const Point middle{0.5 * (shape.points[i].x + shape.points[i - 1].x),
                               0.5 * (shape.points[i].y + shape.points[i - 1].y)};
            // The rest of the trail, drawn in other turns, has the resolution of the whole world.
            const bool is_of_now = std::hypot(shape.points[i].x - shape.points[i - 1].x,
                                              shape.points[i].y - shape.points[i - 1].y) < 0.3 * size;
            if (std::hypot(middle.x - at.x, middle.y - at.y) > size || !is_of_now) continue;
            EXPECT_NEAR(std::hypot(middle.x, middle.y), 0.6, 2.0 * size / pixels);
            ++close;
        }
    }
    EXPECT_GT(close, 4);
}

// A ramp of 40 m with waves of 1 m, 20 pixels each.
TEST(Boundaries, LineOfAWavyRampIsSmooth) {
    const auto model = test::typed(R"toml(
title = ""
[[coordinate]]
name = "x"
rate = 8
unit = "m"
[[coordinate]]
name = "y"
start = 1.5
unit = "m"
[lagrangian]
kinetic = "0.5*(x'^2 + y'^2)"
potential = "9.81*y"
[[constraint]]
gap = "y - (-0.3*x + 0.2*sin(6*x))"
restitution = "0.7"
)toml");
    auto run = model->default_run();
    run.options.end_time = 20.0;
    const Trajectory trajectory = simulate(model, run);
    for (const drawn::Size size : {drawn::Size{1000, 700}, drawn::Size{500, 350}}) {
        const drawn::Picture picture(trajectory, view("x", "y"), size);
        const std::vector<Point>& line = picture.panel().boundary.points;
        const PanelMap map = picture.map();
        const auto at = [](double x) { return -0.3 * x + 0.2 * std::sin(6.0 * x); };
        double longest = 0.0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (!drawn::is_there(line[i - 1]) || !drawn::is_there(line[i])) continue;
            const double x = 0.5 * (line[i - 1].x + line[i].x);
            EXPECT_NEAR(map.y(0.5 * (line[i - 1].y + line[i].y)), map.y(at(x)), 0.3);
            longest = std::max(longest, std::abs(line[i].x - line[i - 1].x));
        }
        // The whole line is drawn, from one side of the picture to the other.
        for (double x = picture.panel().x.low + 0.1; x < picture.panel().x.high - 0.1; x += 0.05) {
            double least = 1e9;
            for (const Point& p : line)
                if (drawn::is_there(p)) least = std::min(least, std::abs(p.x - x));
            EXPECT_LE(least, longest) << x;
        }
        EXPECT_LT(longest, 0.2);
    }
}

// In a picture of any size, the line is at least one pixel wide.
TEST(Boundaries, LineIsSeenInASmallPicture) {
    const Trajectory run = run_until("ball_on_sine", 5.0);
    const drawn::Picture picture(run, view("x", "y"), {300, 200});
    const auto measure = [](const std::string& label, float size) {
        return 0.5F * size * static_cast<float>(label.size());
    };
    const Sheet sheet = layout(picture.figure, measure, {0, 0, 300, 200}, 0.5);
    const Color line = picture.panel().boundary.stroke.color;
    const bool is_seen = std::any_of(sheet.begin(), sheet.end(), [&](const auto& item) {
        const auto* path = std::get_if<Path>(&item);
        return path != nullptr && path->stroke.color == line && path->points.size() > 20 && path->stroke.width >= 1.0;
    });
    EXPECT_TRUE(is_seen);
}

// Thousands of events hide no curve: a few markers have edges, more are thinned and without edges, and very many are a
// band.
TEST(Markers, AreThinnedBeforeTheyHideTheCurve) {
    const auto measure = [](const std::string& label, float size) {
        return 0.5F * size * static_cast<float>(label.size());
    };
    const auto laid = [&](int count) {
        Figure figure;
        Panel& panel = figure.panels.emplace_back();
        panel.x.high = panel.y.high = 1.0;
        Markers& markers = panel.markers.emplace_back(event_markers(light_theme(), Event::Kind::impact));
        for (int i = 0; i < count; ++i) markers.points.push_back({(i + 0.5) / count, 0.5});
        return layout(figure, measure, {0, 0, 600, 400}, 1.0);
    };
    const auto marks = [](const Sheet& sheet, bool with_edges) {
        return std::count_if(sheet.begin(), sheet.end(), [&](const auto& item) {
            const auto* mark = std::get_if<Mark>(&item);
            return mark != nullptr && (mark->edge.a > 0) == with_edges;
        });
    };
    EXPECT_EQ(marks(laid(80), true), 80);
    EXPECT_LE(marks(laid(100), true), 600 / 6);  // no nearer than 6 pixels
    EXPECT_GE(marks(laid(100), true), 40);
    const Sheet many = laid(300), most = laid(30000);
    EXPECT_EQ(marks(many, true), 0);
    EXPECT_GT(marks(many, false), 40);
    EXPECT_LT(marks(many, false), 250);
    EXPECT_EQ(marks(most, true) + marks(most, false), 0);
    const auto band =
        std::find_if(most.begin(), most.end(), [](const auto& item) { return std::holds_alternative<Tiles>(item); });
    ASSERT_NE(band, most.end());
    EXPECT_LT(std::get<Tiles>(*band).area.height, 12.0F);
    EXPECT_GT(std::get<Tiles>(*band).area.width, 400.0F);
}

// Half a second of 500 s.
TEST(Trace, ComposesAZoomAsFinelyAsTheWhole) {
    const Trajectory run = run_until("ball_on_vibrating_table", 500.0);
    const PreparedView gap(*run.model, view("t", "gap"));
    const std::vector<Sample> samples = plot_samples(run);
    Framing framing;
    framing.x = {400.0, 400.5};
    const Panel panel = compose(run, samples, gap, light_theme(), framing);
    std::size_t points = 0;
    for (const Curve& curve : panel.curves)
        for (const Point& p : curve.points) {
            if (std::isnan(p.x)) continue;
            EXPECT_TRUE(p.x >= 400.0 && p.x <= 400.5);
            ++points;
        }
    EXPECT_GT(points, 50U);
    EXPECT_LT(panel.y.high, 0.05) << "the axis holds what is seen";
}

// In contact the gap, typed as an expression, is its rounding error. On a logarithmic axis it has no place, like 0.
TEST(Trace, LogarithmicAxesShowNoRoundingErrors) {
    const Trajectory run = run_until("ball_on_sine", 20.0);
    const std::vector<Sample> samples = plot_samples(run);
    Framing framing;
    framing.log_y = true;
    for (const char* x : {"t", "x"}) {
        const Panel panel =
            compose(run, samples, PreparedView(*run.model, view(x, "y - sin(x)")), light_theme(), framing);
        EXPECT_GT(panel.y.low, 1e-14) << x;
        EXPECT_GT(panel.y.high, 1.0) << x;
        std::size_t count = 0;
        for (const Curve& curve : panel.curves) count += curve.points.size();
        EXPECT_TRUE(count > 100 && count < 5000) << x << " " << count;
        EXPECT_TRUE(panel.curves.at(static_cast<std::size_t>(PhaseLook::contact)).points.empty()) << x;
        for (const Markers& markers : panel.markers)
            for (const Point& point : markers.points) EXPECT_TRUE(point.y == 0.0 || point.y > 1e-14) << point.y;
    }
    // What is small beside its largest value is no rounding error.
    const Panel many = compose(run, samples, PreparedView(*run.model, view("t", "exp(20*x)")), light_theme(), framing);
    EXPECT_LT(many.y.low, 2.0);
    EXPECT_GT(many.y.high, 1e90);
}

}  // namespace
}  // namespace achilles
