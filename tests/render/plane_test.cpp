// Content of a plane of two quantities besides the run: surfaces, contours, arrows at impacts.
#include <gtest/gtest.h>

#include <cmath>

#include "figure/axes.hpp"
#include "figure/plane.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

std::shared_ptr<const Model> model_of(const std::string& system) {
    return std::make_shared<const Model>(read_system(ACHILLES_SOURCE_DIR "/assets/systems/" + system + ".toml"));
}

Drawing box(double x_low, double x_high, double y_low, double y_high) {
    Drawing limits;
    limits.x_low = x_low, limits.x_high = x_high, limits.y_low = y_low, limits.y_high = y_high;
    return limits;
}

State start_of(const Run& run) { return {run.q, run.v, run.options.start_time}; }

double area(const std::vector<std::vector<Point>>& parts) {
    double sum = 0.0;
    for (const std::vector<Point>& part : parts)
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Point &a = part[i], &b = part[(i + 1) % part.size()];
            sum += 0.5 * (a.x * b.y - b.x * a.y);
        }
    return sum;
}

TEST(Plane, OffersPairsOfCoordinatesAndPhasePlanes) {
    const auto names = [](const char* system) {
        std::string all;
        for (const auto& [x, y] : planes_of(model_of(system)->description())) all += x + "," + y + " ";
        return all;
    };
    EXPECT_EQ(names("impact_oscillator"), "x,x' gap,gap' ");
    EXPECT_EQ(names("double_pendulum_two_stops"),
              "theta1,theta2 theta1,theta1' theta2,theta2' gap_knee,gap_knee' gap_wall,gap_wall' ");
}

TEST(Plane, KnowsWhatItsAxesAre) {
    const auto model = model_of("double_pendulum");
    const Plane angles(*model, {"theta1", " theta2 "}), phase(*model, {"theta2", "theta2'"}), gap(*model, {"gap", "t"}),
        point(*model, {"L1*sin(theta1)", "theta2"}), line(*model, {"theta1", "theta1"});
    EXPECT_TRUE(angles.is_of_coordinates());
    EXPECT_TRUE(phase.is_of_states());
    EXPECT_FALSE(phase.is_of_coordinates());
    EXPECT_EQ(gap.x().gap, 0U);
    EXPECT_FALSE(gap.is_of_states());
    EXPECT_FALSE(point.is_of_states());
    EXPECT_FALSE(line.is_of_states());
    EXPECT_THROW(Plane(*model, {"theta1", "theta3"}), InputError);
    State state;
    state.q = Vector::Constant(2, 0.5), state.v = Vector::Constant(2, 0.1);
    EXPECT_NEAR(angles.at(state).y, 0.5 * 180.0 / M_PI, 1e-12);
    EXPECT_NEAR(phase.at(state).y, 0.1 * 180.0 / M_PI, 1e-12);
}

TEST(Plane, HasALineForEachGapAndShadesWhereAllAreOpen) {
    const auto model = model_of("double_pendulum_two_stops");
    const auto run = model->default_run();
    const Plane plane(*model, {"theta1", "theta2"});
    const Plane::Surfaces surfaces = plane.surfaces(run.parameters, start_of(run), box(-40.0, 40.0, -20.0, 60.0));
    ASSERT_EQ(surfaces.lines.size(), 2U);
    for (const Point& p : surfaces.lines[0].points)
        if (std::isfinite(p.x)) {
            EXPECT_NEAR(p.y, 0.0, 1e-9) << "the knee";
        }
    const double wall = surfaces.lines[1].points.at(0).x;
    EXPECT_NEAR(wall, 20.0535, 1e-3);
    for (const Point& p : surfaces.lines[1].points)
        if (std::isfinite(p.x)) {
            EXPECT_GE(p.y, -1e-9) << "not where the knee is overstretched";
        }
    EXPECT_NEAR(area(surfaces.open), (wall + 40.0) * 60.0, 1.0);
}

// The surface in a phase plane moves with time, and is recomputed only when it does.
TEST(Plane, HasTheSurfaceAsItIsNow) {
    const auto model = model_of("ball_on_vibrating_table");
    const auto run = model->default_run();
    const Plane plane(*model, {"y", "y'"});
    State state = start_of(run);
    for (const double t : {0.05, 0.3}) {
        state.t = t;
        const auto surfaces = plane.surfaces(run.parameters, state, box(-0.2, 0.3, -1.0, 1.0));
        ASSERT_EQ(surfaces.lines.size(), 1U);
        ASSERT_FALSE(surfaces.lines[0].points.empty());
        for (const Point& p : surfaces.lines[0].points)
            if (std::isfinite(p.x)) {
                EXPECT_NEAR(p.x, run.parameters[0] * std::sin(run.parameters[1] * t), 1e-6);
            }
    }
    EXPECT_EQ(plane.surfaces_key(state), std::vector<double>{0.3});
    const auto still = model_of("ball_on_floor");
    EXPECT_TRUE(Plane(*still, {"y", "y'"}).surfaces_key(start_of(still->default_run())).empty()) << "x does not matter";
    // If no gap depends on the axes, there are no surfaces.
    EXPECT_TRUE(Plane(*still, {"x", "x'"})
                    .surfaces(still->default_run().parameters, start_of(still->default_run()), box(0.0, 1.0, 0.0, 1.0))
                    .lines.empty());
}

TEST(Plane, HasTheLineOfAGapThatIsAnAxis) {
    const auto model = model_of("double_pendulum");
    const auto run = model->default_run();
    const Plane plane(*model, {"gap", "gap'"});
    const auto surfaces = plane.surfaces(run.parameters, start_of(run), box(-5.0, 5.0, -5.0, 5.0));
    ASSERT_EQ(surfaces.lines.size(), 1U);
    for (const Point& p : surfaces.lines[0].points)
        if (std::isfinite(p.x)) {
            EXPECT_NEAR(p.x, 0.0, 1e-12);
        }
    EXPECT_NEAR(area(surfaces.open), 50.0, 1e-9);
}

// For a falling ball: V = m g y, so its level lines are horizontal; E = m y'^2/2 + m x'^2/2 + m g y has parabolas.
TEST(Plane, HasContoursAtRoundEnergies) {
    const auto model = model_of("ball_on_floor");
    const auto run = model->default_run();
    const auto parameter = [&](const char* name) {
        for (std::size_t i = 0; i < run.parameters.size(); ++i)
            if (model->description().parameters[i].name == name) return run.parameters[i];
        return 0.0;
    };
    const double m = parameter("m"), g = parameter("g"), r = parameter("r");
    State state = start_of(run);
    const auto value = [](const Plane::Level& level) {
        std::string text = level.label;
        if (const auto minus = text.find("\u2212"); minus != std::string::npos) text.replace(minus, 3, "-");
        return std::stod(text);
    };
    const auto levels = Plane(*model, {"x", "y"}).levels(run.parameters, state, box(0.0, 2.0, 0.0, 2.0));
    ASSERT_GE(levels.size(), 3U);
    ASSERT_LE(levels.size(), 12U);
    double datum = value(levels[0]) - m * g * levels[0].points[0].y;  // the file may measure heights from the ground
    EXPECT_TRUE(std::abs(datum) < 1e-9 || std::abs(datum + m * g * r) < 1e-9) << datum;
    for (const auto& level : levels)
        for (const Point& p : level.points)
            if (std::isfinite(p.x)) {
                EXPECT_NEAR(m * g * p.y + datum, value(level), 1e-9);
            }
    const Plane phase(*model, {"y", "y'"});
    state.v[0] = 2.0;
    const auto energies = phase.levels(run.parameters, state, box(0.0, 2.0, -4.0, 4.0));
    ASSERT_GE(energies.size(), 3U);
    for (const auto& level : energies)
        for (const Point& p : level.points)
            if (std::isfinite(p.x)) {
                EXPECT_NEAR(0.5 * m * (p.y * p.y + 4.0) + m * g * p.x + datum, value(level), 1e-2) << "between corners";
            }
    EXPECT_EQ(phase.levels_key(state), std::vector<double>{2.0}) << "x' alone";
    EXPECT_TRUE(Plane(*model, {"x*y", "y"}).levels(run.parameters, state, box(0.0, 2.0, 0.0, 2.0)).empty());
    // A constant has no level lines.
    EXPECT_TRUE(Plane(*model, {"x", "gap"}).levels(run.parameters, state, box(0.0, 2.0, 0.0, 2.0)).empty());
}

TEST(Plane, HasArrowsFromBeforeAnImpactToAfterIt) {
    const auto model = model_of("ball_on_floor");
    const auto run = model->default_run();
    const Trajectory trajectory = simulate(model, run);
    const std::vector<Sample> samples = plot_samples(trajectory);
    const Plane phase(*model, {"y", "y'"});
    const Panel panel = compose(trajectory, samples, phase.view(), light_theme());
    const auto all = impact_arrows(trajectory, phase.view(), panel, 1e9, 1e9, 1.0);
    const auto seen = impact_arrows(trajectory, phase.view(), panel, 400.0, 300.0, 7.0);
    std::size_t impacts = 0;
    for (const Event& event : trajectory.events)
        if (event.kind == Event::Kind::impact) ++impacts;
    EXPECT_EQ(all.size(), impacts);
    EXPECT_LT(seen.size(), impacts) << "near the Zeno point they are too short";
    ASSERT_GE(seen.size(), 4U);
    const double e = model->restitution(run.parameters, 0);
    for (const ImpactArrow& arrow : seen) {
        EXPECT_LT(arrow.from.y, 0.0);
        EXPECT_NEAR(arrow.to.y, -e * arrow.from.y, 1e-9);
        EXPECT_EQ(arrow.from.x, arrow.to.x);
        EXPECT_GT(arrow.coming.x, arrow.from.x) << "from above";
        EXPECT_GE((arrow.to.y - arrow.from.y) * 300.0 / (panel.y.high - panel.y.low), 7.0);
    }
    // In a plane of coordinates an impact causes no jump.
    const Plane path(*model, {"x", "y"});
    EXPECT_TRUE(impact_arrows(trajectory, path.view(), compose(trajectory, samples, path.view(), light_theme()), 400.0,
                              300.0, 1.0)
                    .empty());
}

TEST(Field, LeavesOutWhatIsFarAboveAllOthers) {
    const ScalarField plain(box(0.0, 1.0, 0.0, 1.0), [](const Point& p) { return p.x; });
    EXPECT_EQ(plain.range()[0], 0.0);
    EXPECT_EQ(plain.range()[1], 1.0);
    const ScalarField peak(box(-1.0, 1.0, -1.0, 1.0),
                           [](const Point& p) { return 1.0 / (1e-6 + p.x * p.x + p.y * p.y); });
    EXPECT_LT(peak.range()[1], 100.0);
    const ScalarField nothing(box(0.0, 1.0, 0.0, 1.0), [](const Point&) { return std::nan(""); });
    EXPECT_GT(nothing.range()[0], nothing.range()[1]);
}

}  // namespace
}  // namespace achilles
