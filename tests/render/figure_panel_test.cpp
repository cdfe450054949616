// Colors, texts, and panels of runs other than the paper's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism.hpp"
#include "model/read_system.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

// A ball above a floor; the gap and other entries can be changed.
std::string ball(const std::string& more, const std::string& y = "y", const std::string& gap = "y") {
    return "title = \"ball\"\n[[coordinate]]\nname = \"x\"\nrate = 0.5\n[[coordinate]]\nname = \"" + y +
           "\"\nstart = 1.0\n[lagrangian]\nkinetic = \"(x'^2 + " + y + "'^2)/2\"\npotential = \"10*" + y +
           "\"\n[[constraint]]\ngap = \"" + gap + "\"\nrestitution = \"0.5\"\n" + more;
}

struct Motion {
    explicit Motion(const std::string& text) : model(test::typed(text)), run(simulate(model, model->default_run())) {}
    Panel panel(std::size_t view = 0, const Theme& theme = light_theme()) const {
        return compose(run, plot_samples(run), PreparedView(*model, model->description().views.at(view)), theme);
    }
    std::shared_ptr<const Model> model;
    Trajectory run;
};

std::string a_view(const std::string& x, const std::string& y) {
    return "[[view]]\nname = \"v\"\nx = \"" + x + "\"\ny = [" + y + "]\n";
}

int distance(const Color& a, const Color& b) { return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b); }

TEST(Palette, TellsPhasesEventsAndCurvesApart) {
    for (const Theme& theme : {light_theme(), dark_theme()}) {
        std::vector<Color> hues;
        for (std::size_t i = 0; i < 8; ++i) {
            const Stroke flight = phase_stroke(theme, Phase::Kind::hybrid, i, 8);
            const Stroke contact = phase_stroke(theme, Phase::Kind::constrained, i, 8);
            EXPECT_EQ(flight.color, contact.color);
            EXPECT_FALSE(flight.dash.empty());
            EXPECT_TRUE(contact.dash.empty());
            EXPECT_GT(distance(flight.color, theme.background), 150);
            for (const Color& other : hues) EXPECT_GT(distance(flight.color, other), 100);
            hues.push_back(flight.color);
        }
        const Markers impact = event_markers(theme, Event::Kind::impact),
                      zeno = event_markers(theme, Event::Kind::zeno),
                      release = event_markers(theme, Event::Kind::release);
        EXPECT_EQ(impact.shape, Markers::MarkerShape::square);
        EXPECT_NE(zeno.shape, impact.shape);
        EXPECT_NE(release.shape, impact.shape);
        EXPECT_NE(release.shape, zeno.shape);
        EXPECT_GT(distance(theme.ink, theme.background), 400);
    }
}

TEST(FigureText, ShowsAtMostFortyPointsAndBothEnds) {
    for (const std::size_t count : {0u, 1u, 2u, 39u, 40u, 41u, 1000u}) {
        Figure figure;
        Curve& curve = figure.panels.emplace_back().curves.emplace_back();
        for (std::size_t i = 0; i < count; ++i) curve.points.push_back({static_cast<double>(i), -0.0});
        const std::string text = to_text(figure);
        EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '(')),
                  std::min<std::size_t>(40, count));
        EXPECT_EQ(text.find("-0"), std::string::npos);
        if (count == 0) continue;
        EXPECT_NE(text.find(": (0, 0)"), std::string::npos);
        EXPECT_NE(text.find("(" + std::to_string(count - 1) + ", 0)\n"), std::string::npos);
    }
}

TEST(FigureText, SaysEverythingThatIsDecided) {
    Figure figure;
    Panel& panel = figure.panels.emplace_back();
    panel.title = "(a)";
    panel.y.logarithmic = true;
    panel.y.ticks = {{1.0, "1"}, {2.0, ""}};
    Curve& curve = panel.curves.emplace_back();
    curve.label = "c";
    curve.stroke.color = {1, 2, 3, 255};
    curve.stroke.width = 2.0;
    curve.stroke.dash = {6.0, 3.5};
    curve.points.push_back({1.0 / 3.0, -std::nan("")});
    panel.markers.push_back(event_markers(light_theme(), Event::Kind::zeno));
    const std::string text = to_text(figure);
    for (const char* piece : {"panel \"(a)\"", "[0, 1] log: 1\n", "curve \"c\" #010203ff width 2 dashed points 1",
                              "(0.333333333, nan)", "markers \"Zeno point\" diamond"})
        EXPECT_NE(text.find(piece), std::string::npos) << piece << "\n" << text;
}

TEST(Panels, OfSeveralCurvesHaveALegendAndHues) {
    const Panel panel = Motion(ball(a_view("t", "\"x\", \" y \", \"y'\""))).panel();
    ASSERT_EQ(panel.curves.size(), 6u);
    EXPECT_TRUE(panel.legend);
    EXPECT_EQ(panel.curves[0].label, "𝑥");
    EXPECT_EQ(panel.curves[1].label, "");  // the same quantity in contact
    EXPECT_EQ(panel.curves[2].label, "𝑦");
    EXPECT_EQ(panel.curves[4].label, "𝑦\u0307");
    EXPECT_EQ(panel.curves[0].stroke.color, panel.curves[1].stroke.color);
    EXPECT_NE(panel.curves[0].stroke.color, panel.curves[2].stroke.color);
}

TEST(Panels, LeaveOutWhatIsNoNumber) {
    const Motion motion(ball(a_view("t", "\"log(x - 1)\", \"1/gap\"")));
    const Panel panel = motion.panel();
    EXPECT_TRUE(std::isfinite(panel.y.low) && std::isfinite(panel.y.high));
    for (const Curve& curve : panel.curves)
        for (const Point& p : curve.points) EXPECT_TRUE(std::isnan(p.x) || (std::isfinite(p.x) && std::isfinite(p.y)));
    for (const Markers& markers : panel.markers)
        for (const Point& p : markers.points) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
}

TEST(Panels, AreBoundedForManyImpacts) {
    SystemDescription description =
        parse_system(ball("[run]\nend_time = 1500\n" + a_view("t", "\"y\", \"y'\"")), "typed.toml");
    description.constraints[0].restitution.text = "1";
    const auto model = std::make_shared<const Model>(description);
    achilles::Run bouncing = model->default_run();
    bouncing.q[1] = 0.01;
    const Trajectory trajectory = simulate(model, bouncing);
    ASSERT_GT(trajectory.statistics.impacts, 15000);
    const std::vector<Sample> samples = plot_samples(trajectory);
    const Panel panel = compose(trajectory, samples, PreparedView(*model, description.views[0]), light_theme());
    double highest = 0.0;
    for (const Curve& curve : panel.curves) {
        EXPECT_LE(curve.points.size(), 4u * 4u * 1600u) << "four points in a quarter of a pixel's column";
        for (const Point& p : curve.points) highest = std::max(highest, std::isnan(p.y) ? 0.0 : p.y);
    }
    for (const Markers& markers : panel.markers) EXPECT_LE(markers.points.size(), 8000u);
    EXPECT_NEAR(highest, std::sqrt(0.2), 1e-3);  // thinning keeps the extremes
}

// The drawing depends on t, and on a parameter computed from others.
TEST(Mechanism, MovesWithTime) {
    const auto model = test::typed(
        "title = \"\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n[[parameter]]\nname = \"double\"\nvalue = \"2*om\"\n"
        "[[parameter]]\nname = \"om\"\nvalue = 3\n[lagrangian]\nkinetic = \"x'^2\"\npotential = \"x\"\n"
        "[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n[run]\nend_time = 2\n"
        "[[drawing]]\nshape = \"segment\"\nfrom = [\"4*cos(t)\", 0]\nto = [1, \"double + t\"]\n"
        "[[drawing]]\nshape = \"curve\"\nover = [\"s\", 0, \"1 + t\"]\nat = [\"s\", \"s*t\"]\n"
        "[[drawing]]\nshape = \"disc\"\nat = [0, \"om\"]\nradius = 1\n");
    const Trajectory trajectory = simulate(model, model->default_run());
    const Mechanism mechanism(*model);
    const Drawing limits = mechanism.limits(trajectory, plot_samples(trajectory));
    EXPECT_GE(limits.y_high, 8.0) << "it is seen until the end";
    for (const double t : {0.0, 1.5}) {
        const Drawing drawing =
            mechanism.draw(t, {trajectory.run.q, trajectory.run.v}, trajectory.run.parameters, limits, light_theme());
        ASSERT_EQ(drawing.shapes.size(), 3u);
        EXPECT_NEAR(drawing.shapes[0].points[0].x, 4.0 * std::cos(t), 1e-14);
        EXPECT_NEAR(drawing.shapes[0].points[1].y, 6.0 + t, 1e-14);
        EXPECT_NEAR(drawing.shapes[1].points.back().x, 1.0 + t, 1e-14);
        EXPECT_NEAR(drawing.shapes[1].points.back().y, (1.0 + t) * t, 1e-14);
        EXPECT_TRUE(drawing.shapes[0].moves);
        EXPECT_FALSE(drawing.shapes[2].moves);
    }
    auto grip = mechanism.grip(trajectory.run.parameters);
    ASSERT_TRUE(grip);
    EXPECT_NEAR(grip->at(1.5, {trajectory.run.q, trajectory.run.v}).at.y, 7.5, 1e-14);
}

// Drawings of constraints are among the other drawings.
TEST(Mechanism, DrawsWhatIsTouched) {
    const auto model = test::typed(
        "title = \"\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n[lagrangian]\nkinetic = \"x'^2\"\npotential = \"x\"\n"
        "[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n"
        "[[constraint.drawing]]\nshape = \"segment\"\nfrom = [-1, 0]\nto = [1, 0]\n"
        "[[drawing]]\nshape = \"disc\"\nat = [0, \"x\"]\nradius = 1\n[run]\nend_time = 1\n");
    const Trajectory trajectory = simulate(model, model->default_run());
    const Mechanism mechanism(*model);
    const Drawing drawing = mechanism.draw(0.0, {trajectory.run.q, trajectory.run.v}, trajectory.run.parameters,
                                           mechanism.limits(trajectory, plot_samples(trajectory)), light_theme());
    ASSERT_EQ(drawing.shapes.size(), 2u);
    EXPECT_EQ(drawing.shapes[0].kind, DrawnShape::Kind::polyline);
    EXPECT_EQ(drawing.shapes[1].kind, DrawnShape::Kind::disc);
}

TEST(Mechanism, ACircleIsTheOutlineOfADisc) {
    const std::string system =
        "title = \"\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n[lagrangian]\nkinetic = \"x'^2\"\n"
        "potential = \"x\"\n[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n";
    const auto shape = [&](const std::string& drawing) {
        const auto model = test::typed(system + "[[drawing]]\nat = [\"x\", 2]\nradius = \"3*x\"\n" + drawing);
        const Trajectory trajectory = simulate(model, model->default_run());
        const Mechanism mechanism(*model);
        return mechanism
            .draw(0.0, {trajectory.run.q, trajectory.run.v}, trajectory.run.parameters,
                  mechanism.limits(trajectory, plot_samples(trajectory)), light_theme())
            .shapes.at(0);
    };
    const DrawnShape disc = shape("shape = \"disc\"\n"), circle = shape("shape = \"circle\"\n"),
                     outline = shape("shape = \"disc\"\nfill = false\n");
    EXPECT_TRUE(disc.fill);
    for (const DrawnShape& open : {circle, outline}) {
        EXPECT_EQ(open.kind, DrawnShape::Kind::disc);
        EXPECT_FALSE(open.fill);
        EXPECT_EQ(open.radius, 3.0);
        EXPECT_GT(open.stroke.width, 0.0);
        EXPECT_TRUE(open.moves);
    }
    EXPECT_TRUE(shape("shape = \"circle\"\nfill = true\n").fill);
}

TEST(MechanismLimits, StayAtTheMotion) {
    const std::string disc = "[[drawing]]\nshape = \"disc\"\nat = [\"x\", \"y\"]\nradius = 0.3\n";
    const auto limits = [](const std::string& text) {
        const Motion motion(text);
        return Mechanism(*motion.model).limits(motion.run, plot_samples(motion.run));
    };
    const Drawing alone = limits(ball("[run]\nend_time = 2\n" + disc));
    EXPECT_LT(alone.x_low, -0.3);
    EXPECT_GT(alone.x_high, 1.3);
    EXPECT_LT(alone.x_high, 1.6);
    // A long floor slightly below is shown, and only around the ball; a distant floor is not shown.
    const auto floor = [&](const std::string& y) {
        return disc + "[[drawing]]\nshape = \"segment\"\nfrom = [\"-500\", \"" + y + "\"]\nto = [\"500\", \"" + y +
               "\"]\n";
    };
    const Drawing near = limits(ball("[run]\nend_time = 2\n" + floor("-1")));
    EXPECT_LT(near.y_low, -1.0);
    EXPECT_LT(near.x_high - near.x_low, 12.0);
    const Drawing far = limits(ball("[run]\nend_time = 2\n" + floor("-400")));
    EXPECT_GT(far.y_low, -2.0);
    // A bowl not much larger than the motion is shown entirely, a long valley is not.
    const auto valley = [&](const std::string& half) {
        return disc + "[[drawing]]\nshape = \"curve\"\nover = [\"s\", -" + half + ", " + half +
               "]\nat = [\"s\", \"0.3*s^2\"]\n";
    };
    EXPECT_LT(limits(ball("[run]\nend_time = 2\n" + valley("1.4"))).x_low, -1.4);
    EXPECT_GT(limits(ball("[run]\nend_time = 2\n" + valley("20"))).x_low, -1.0);
    // A curve that depends on a coordinate moves with it.
    const std::string rope =
        "[[drawing]]\nshape = \"curve\"\nover = [\"s\", 0, 1]\nat = [\"s*x\", \"5 + s*(y - 5)\"]\n";
    EXPECT_GT(limits(ball("[run]\nend_time = 2\n" + rope)).y_high, 5.0);
}

TEST(MechanismWithoutDrawing, ShowsTheSurfaceOrSaysSo) {
    const Motion motion(ball("[run]\nend_time = 2\n", "y", "y - 0.2*sin(3*x)"));
    const Mechanism mechanism(*motion.model);
    const Drawing limits = mechanism.limits(motion.run, plot_samples(motion.run));
    const Drawing drawing =
        mechanism.draw(motion.run.end_time, motion.run.end, motion.run.run.parameters, limits, light_theme());
    ASSERT_EQ(drawing.shapes.size(), 2u);
    EXPECT_GT(drawing.shapes[0].points.size(), 300u);
    for (const Point& p : drawing.shapes[0].points) {
        if (std::isnan(p.x)) continue;
        EXPECT_NEAR(p.y, 0.2 * std::sin(3.0 * p.x), 1e-3);
    }
    EXPECT_EQ(drawing.shapes[1].kind, DrawnShape::Kind::disc);

    const Motion other(ball("[run]\nend_time = 2\n", "z", "z"));
    const Mechanism note(*other.model);
    const Drawing text = note.draw(other.run.end_time, other.run.end, other.run.run.parameters,
                                   note.limits(other.run, plot_samples(other.run)), dark_theme());
    ASSERT_EQ(text.shapes.size(), 1u);
    EXPECT_EQ(text.shapes[0].kind, DrawnShape::Kind::text);
}

}  // namespace
}  // namespace achilles
