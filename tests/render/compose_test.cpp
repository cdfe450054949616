// Content of figures as numbers: limits, ticks, labels, phases, markers.
#include "figure/compose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/multi_contact.hpp"
#include "figure/axes.hpp"
#include "figure/body.hpp"
#include "figure/label.hpp"
#include "figure/mechanism.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

TEST(Labels, NamesBecomeSymbols) {
    EXPECT_EQ(typeset_name("theta1"), "θ₁");
    EXPECT_EQ(typeset_name("theta1'"), "θ\u0307₁");
    EXPECT_EQ(typeset_name("x'"), "x\u0307");
    EXPECT_EQ(typeset_name("gap''"), "h\u0308");
    EXPECT_EQ(typeset_name("lambda"), "λ");
    EXPECT_EQ(typeset_name("L12"), "L₁₂");
    EXPECT_EQ(typeset_name("phi_2"), "φ₂");
    EXPECT_EQ(typeset_name("energy"), "energy");
    EXPECT_EQ(typeset("m*g*y - theta1'^2"), "𝑚·𝑔·𝑦 − 𝜃\u0307₁²");
    EXPECT_EQ(typeset("2.5*x1"), "2.5·𝑥₁");
    EXPECT_EQ(typeset("1e3*x - 2.5E-2*e1"), "1e3·𝑥 − 2.5E−2·𝑒₁");
    EXPECT_EQ(typeset("2*e"), "2·𝑒");
    EXPECT_EQ(typeset("sin(x_ball)^12/(2*pi) + (x')^2.5"), "sin(𝑥_{ball})¹²/(2·π) + (𝑥\u0307)^2.5");
    EXPECT_EQ(typeset("h + _1*v_max2 - mass"), "ℎ + _1·𝑣_{max2} − mass");
    // A subscript of letters needs a single letter before it; other words with an underscore stay words.
    EXPECT_EQ(typeset("lambda_knee + near_left"), "𝜆_{knee} + near_left");
    EXPECT_EQ(typeset_name("lambda_knee"), "λ_knee");
    EXPECT_EQ(typeset_name("near_left"), "near_left");
    EXPECT_EQ(typeset_unit("kg*m^2/s^2"), "kg·m²/s²");
    EXPECT_EQ(typeset_unit("m^0.5^"), "m^0.5^");
    EXPECT_EQ(with_unit("h", ""), "h");
    EXPECT_EQ(with_unit("h", "m"), "h (m)");
}

std::string labels(double low, double high, double margin = 0.0, int most = 6) {
    Axis axis;
    set_ticks(axis, low, high, margin, most);
    std::string text;
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) text += (text.empty() ? "" : " ") + tick.label;
    return text;
}

TEST(Label, IsShortenedByWordsThenLettersAndKeepsItsUnit) {
    const auto fitting = [](std::size_t room, EllipsisMode cut = EllipsisMode::words) {
        return [room, cut](const std::string& label) {
            return shortened(
                label, [room](const std::string& text) { return letters(text).size() <= room; }, cut);
        };
    };
    EXPECT_EQ(fitting(30)("moment of the stop (N)"), "moment of the stop (N)");
    EXPECT_EQ(fitting(18)("moment of the stop (N)"), "moment of the… (N)");
    EXPECT_EQ(fitting(18, EllipsisMode::letters)("moment of the stop (N)"), "moment of the… (N)");
    EXPECT_EQ(fitting(12)("displacement (m)"), "displac… (m)");
    EXPECT_EQ(fitting(8)("𝜆_{near_left} (N)"), "𝜆_{ne…} (N)");
    EXPECT_EQ(fitting(2)("𝜆_{near_left}"), "𝜆…");
    EXPECT_EQ(fitting(0)("θθ"), "θ…") << "not less than a letter";
    EXPECT_EQ(fitting(0)(""), "");
}

TEST(Label, IsTakenApartIntoLetters) {
    const auto one = [](const char* label) { return letters(label).at(0); };
    EXPECT_EQ(one("𝜃\u0308"), (Letter{U'θ', true, 0, 2}));
    EXPECT_EQ(one("ℎ"), (Letter{'h', true, 0, 0}));
    EXPECT_EQ(one("𝑧"), (Letter{'z', true, 0, 0}));
    EXPECT_EQ(one("𝛺"), (Letter{U'Ω', true, 0, 0}));
    EXPECT_EQ(one("₇"), (Letter{'7', false, -1, 0}));
    EXPECT_EQ(one("⁻"), (Letter{U'−', false, 1, 0}));
    EXPECT_EQ(letters("τ_{∞}b"), (std::vector<Letter>{{U'τ', false, 0, 0}, {U'∞', false, -1, 0}, {'b', false, 0, 0}}));
    EXPECT_EQ(letters("a_{b").size(), 4u);  // no closing brace: kept as it is
    EXPECT_EQ(letters("\xff\xce").size(), 2u);
    EXPECT_TRUE(letters("\u0307").empty());
}

TEST(Ticks, AreRoundAndHaveTheFewestDigits) {
    EXPECT_EQ(labels(0, 20), "0 5 10 15 20");
    EXPECT_EQ(labels(-1, 1), "−1.0 −0.5 0.0 0.5 1.0");
    EXPECT_EQ(labels(0, 0.3), "0.0 0.1 0.2 0.3");
    EXPECT_EQ(labels(-0.02, 0.02), "−0.02 −0.01 0.00 0.01 0.02");
    EXPECT_EQ(labels(2.7251, 2.7252), "2.72510 2.72512 2.72514 2.72516 2.72518 2.72520");
    EXPECT_EQ(labels(0, 4e-7), "0 1×10⁻⁷ 2×10⁻⁷ 3×10⁻⁷ 4×10⁻⁷");
    EXPECT_EQ(labels(0, 3e6), "0 1×10⁶ 2×10⁶ 3×10⁶");
    EXPECT_EQ(labels(3, 3), "2.8 3.0 3.2");
    EXPECT_EQ(labels(0, 0), "−1.0 −0.5 0.0 0.5 1.0");
    EXPECT_EQ(labels(std::nan(""), 1), "0.0 0.2 0.4 0.6 0.8 1.0");
}

TEST(Ticks, AreExactMultiplesWithinTheLimitsAndNotTooMany) {
    for (double high = 1e-6; high < 1e6; high *= 1.37) {
        Axis axis;
        set_ticks(axis, -0.3 * high, high, 0.05);
        int count = 0;
        for (const Tick& tick : axis.ticks) {
            EXPECT_GE(tick.value, axis.low - 1e-9 * high);
            EXPECT_LE(tick.value, axis.high + 1e-9 * high);
            if (!tick.label.empty()) ++count;
        }
        EXPECT_GE(count, 2) << high;
        EXPECT_LE(count, 8) << high;
    }
    Axis axis;
    set_ticks(axis, 0.0, 1.0, 0.0, 11);
    std::vector<double> values;
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) values.push_back(tick.value);
    EXPECT_EQ(values, (std::vector<double>{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}));
}

class ComposedFigure : public testing::TestWithParam<std::string> {
 protected:
    ComposedFigure() : model(test::load(GetParam())), trajectory(simulate(model, model->default_run())) {}
    std::shared_ptr<const Model> model;
    Trajectory trajectory;
};

TEST_P(ComposedFigure, EveryViewShowsThePhasesAndEveryEvent) {
    const Figure figure = compose(trajectory, model->description().views, light_theme(), 2);
    ASSERT_EQ(figure.panels.size(), model->description().views.size());
    for (const Panel& panel : figure.panels) {
        SCOPED_TRACE(panel.title);
        ASSERT_EQ(panel.curves.size(), 2u);
        EXPECT_FALSE(panel.curves[0].stroke.dash.empty());  // hybrid
        EXPECT_TRUE(panel.curves[1].stroke.dash.empty());   // constrained
        EXPECT_NE(panel.curves[0].stroke.color, panel.curves[1].stroke.color);
        EXPECT_GE(panel.curves[0].points.size(), 2u);  // how many are needed: trace_test.cpp
        EXPECT_GE(panel.curves[1].points.size(), 2u);
        ASSERT_EQ(panel.markers.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) {
            const Event::Kind kinds[] = {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release};
            EXPECT_EQ(panel.markers[k].points.size(), test::events_of(trajectory, kinds[k]).size());
        }
        for (const Curve& curve : panel.curves) {
            for (const Point& point : curve.points) {
                if (std::isnan(point.x)) continue;
                EXPECT_GE(point.x, panel.x.low);
                EXPECT_LE(point.x, panel.x.high);
                EXPECT_GE(point.y, panel.y.low);
                EXPECT_LE(point.y, panel.y.high);
            }
        }
    }
    EXPECT_EQ(figure.panels[0].x.low, 0.0);
    EXPECT_EQ(figure.panels[0].x.high, 20.0);
    EXPECT_EQ(figure.panels[0].x.label, "𝑡 (s)");
    EXPECT_EQ(to_text(figure), to_text(compose(trajectory, model->description().views, light_theme(), 2)));
}

TEST_P(ComposedFigure, TheMechanismStaysInsideItsLimits) {
    const Mechanism mechanism(*model);
    const std::vector<Sample> samples = plot_samples(trajectory);
    const Drawing limits = mechanism.limits(trajectory, samples);
    EXPECT_LT(limits.x_low, limits.x_high);
    for (const Sample& sample : samples) {
        const Drawing drawing =
            mechanism.draw(sample.t, sample.state, trajectory.run.parameters, limits, light_theme());
        EXPECT_EQ(drawing.shapes.size(), model->description().drawings.size());
        for (const DrawnShape& shape : drawing.shapes) {
            if (shape.points.size() > 100) continue;  // the surface extends beyond the picture
            for (const Point& p : shape.points) {
                EXPECT_TRUE(p.x >= limits.x_low && p.x <= limits.x_high && p.y >= limits.y_low && p.y <= limits.y_high);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Systems, ComposedFigure, testing::Values("ball_on_sine", "double_pendulum"),
                         [](const auto& test) { return test.param; });

TEST(FigureComposition, AnglesAreShownInDegrees) {
    const auto model = test::load("double_pendulum");
    const Trajectory trajectory = simulate(model, model->default_run());
    const std::vector<Sample> samples = plot_samples(trajectory);
    const Panel panel =
        compose(trajectory, samples, PreparedView(*model, model->description().views[0]), light_theme());
    EXPECT_EQ(panel.y.label, "𝜃₁ (°)");
    EXPECT_NEAR(panel.curves[0].points[0].y, 30.0, 1e-12);
    const Event zeno = test::events_of(trajectory, Event::Kind::zeno).at(0);
    EXPECT_NEAR(panel.markers[1].points[0].y, zeno.q[0] * 180.0 / std::numbers::pi, 1e-12);
}

// Expressions that are angles are shown in degrees, not only coordinates.
TEST(FigureComposition, AnglesThatAreComputedAreShownInDegrees) {
    const auto model = test::load("double_pendulum");
    ViewDescription view;
    view.x.text = "t";
    for (const auto& [text, label, factor] :
         {std::tuple{"gap", "ℎ (°)", 180.0 / std::numbers::pi},
          {"theta1 + theta2", "𝜃₁ + 𝜃₂ (°)", 180.0 / std::numbers::pi},
          {"theta1' - theta2'", "𝜃\u0307₁ − 𝜃\u0307₂ (°/s)", 180.0 / std::numbers::pi},
          {"lambda", "𝜆 (N·m)", 1.0}}) {
        view.y = {{text, {}}};
        const PreparedView prepared(*model, view);
        EXPECT_EQ(with_unit(prepared.label(), prepared.unit()), label);
        EXPECT_EQ(prepared.quantities()[1].factor, factor) << text;
    }
}

// A point of a body is called as typed, in the unit of its value.
TEST(FigureComposition, PointsOfBodiesKeepTheirNames) {
    const auto model = std::make_shared<const Model>(parse_system(R"(coordinate = [{name = "theta", unit = "rad"}]
parameter = [{name = "L", value = 2, unit = "m"}]
body = [{name = "arm", mass = 1, rod = [[0, 0], [0, "-L"]], angle = "theta"}]
constraint = [{gap = "theta + 1", restitution = 0}]
view = [{x = "t", y = "arm.end.x"}, {x = "arm.angle", y = "arm.end.y'"}]
)"));
    const auto& views = model->description().views;
    const PreparedView place(*model, views[0]), rate(*model, views[1]);
    EXPECT_EQ(with_unit(place.label(), place.unit()), "arm.end.𝑥 (m)");
    EXPECT_EQ(with_unit(rate.label(), rate.unit()), "arm.end.𝑦\u0307 (m/s)");
    EXPECT_EQ(name_of(views[0]), "arm.end.x");
    EXPECT_EQ(rate.quantities()[0].unit, "°");
}

// With thousands of steps, no flight may lose its height.
TEST(FigureComposition, EveryOneOfVeryManyFlightsHasItsHeight) {
    const auto model = test::load("ball_on_floor");
    auto run = model->default_run();
    run.parameters[3] = 1.0;  // e
    run.options.end_time = 5000.0;
    const Trajectory trajectory = simulate(model, run);
    ASSERT_GT(trajectory.events.size(), 5000u);
    const std::vector<Sample> samples = plot_samples(trajectory);
    const auto height = [](const Sample& sample) { return sample.state.q[1]; };
    for (std::size_t i = 0; i + 1 < trajectory.events.size(); i += 100) {
        double highest = 0.0;
        for (const Sample& sample : samples)
            if (sample.t > trajectory.events[i].t && sample.t < trajectory.events[i + 1].t)
                highest = std::max(highest, height(sample));
        EXPECT_NEAR(highest, 1.0, 1e-3) << "flight " << i;
    }
}

TEST(FigureComposition, ALegendHidesNoCurve) {
    const auto model = test::load("double_pendulum");
    const Trajectory trajectory = simulate(model, model->default_run());
    for (const ViewDescription& view : model->description().views) {
        Panel panel = compose(trajectory, plot_samples(trajectory), PreparedView(*model, view), light_theme());
        place_legend(panel);
        for (const Curve& curve : panel.curves) {
            for (const Point& p : curve.points) {
                const double x = (p.x - panel.x.low) / (panel.x.high - panel.x.low);
                const double y = (p.y - panel.y.low) / (panel.y.high - panel.y.low);
                EXPECT_FALSE(std::abs(x - panel.legend_at[0]) < 0.29 && std::abs(y - panel.legend_at[1]) < 0.29);
            }
        }
    }
}

// A quantity at rest is drawn as constant: the axis is not magnified until rounding errors fill it, whatever the scale
// of the system.
TEST(FigureComposition, RoundingErrorsAreNoMotion) {
    const auto drawn = [](const std::string& name, const std::string& y, const std::string& x = "t") {
        const auto system = test::load(name);
        ViewDescription view;
        view.x.text = x;
        view.y.emplace_back().text = y;
        const Trajectory run = simulate(system, system->default_run());
        return compose(run, plot_samples(run), PreparedView(*system, view), light_theme());
    };
    for (const char* y : {"phi", "gap_near_left", "phi - psi"}) {
        const Panel panel = drawn("table_on_legs", y);
        EXPECT_EQ(panel.y.low, -1.0) << y;
        EXPECT_EQ(panel.y.high, 1.0) << y;
    }
    EXPECT_EQ(drawn("box_dropped_flat", "phi").y.high, 1.0);
    EXPECT_LT(drawn("ball_on_sine", "1e-9*y").y.high, 3e-9) << "small is not nothing";
    EXPECT_LT(drawn("ball_on_sine", "1e-30*energy + 1e-30*y").y.high, 3e-30 * 2);
    const Panel plane = drawn("table_on_legs", "psi'", "z");
    EXPECT_EQ(plane.x.low, -1.0);
    EXPECT_EQ(plane.x.high, 1.0);
    EXPECT_LT(plane.curves[1].points.size(), 10U);
    EXPECT_LT(drawn("ball_on_sine", "y'", "1e-9*y").x.high, 3e-9);
}

// The label of a curve is at the part that is drawn.
TEST(FigureComposition, ALegendShowsTheCurveAsItIs) {
    const auto system = test::load("table_on_legs");
    ViewDescription view;
    view.x.text = "t";
    view.y.emplace_back().text = "energy";
    view.y.emplace_back().text = "loss";
    const Trajectory run = simulate(system, system->default_run());
    const Panel panel = compose(run, plot_samples(run), PreparedView(*system, view), light_theme());
    for (const Curve& curve : panel.curves) EXPECT_EQ(curve.label.empty(), curve.points.empty());
}

TEST(FigureComposition, ContactForceIsZeroInFlightAndPositiveInContact) {
    const auto model = test::load("ball_on_sine");
    const Trajectory trajectory = simulate(model, model->default_run());
    const Panel panel = compose(trajectory, plot_samples(trajectory),
                                PreparedView(*model, model->description().views[5]), light_theme());
    for (const Point& p : panel.curves[1].points) EXPECT_TRUE(std::isnan(p.x) || p.y >= -1e-9) << p.y;
    double most = 0.0;
    for (const Point& p : panel.curves[1].points)
        if (!std::isnan(p.y)) most = std::max(most, p.y);
    EXPECT_GT(most, 1.0);
}

// At 10 s the ball rests in the bowl and at the post: g_bowl = (-r, 0, 1), g_post = (1, 0.3 sin(phi), 0).
TEST(FigureComposition, EveryContactShowsItsForce) {
    const Trajectory trajectory = test::run_gaps("bowl_and_post");
    ViewDescription view;
    view.x.text = "t";
    for (const char* y : {"lambda_bowl", "lambda_post", "gap_bowl''", "gap_post''", "work", "loss"})
        view.y.emplace_back().text = y;
    const Sample sample = Sampler(trajectory).at(10.0);
    const std::vector<double> values = values_at(trajectory, sample, PreparedView(*trajectory.model, view));
    const Vector force = contact_force(trajectory, sample);
    EXPECT_GT(values[1], 0.0);
    EXPECT_GT(values[2], 0.0);
    EXPECT_EQ(values[3], 0.0);
    EXPECT_EQ(values[4], 0.0);
    EXPECT_EQ(values[5], sample.work);
    EXPECT_EQ(values[6], sample.loss);
    EXPECT_NEAR(force[0], values[2] - sample.state.q[0] * values[1], 1e-12);
    EXPECT_NEAR(force[1], 0.3 * std::sin(sample.state.q[1]) * values[2], 1e-12);
    EXPECT_NEAR(force[2], values[1], 1e-12);
    // At an event, the forces are those after it.
    const Event& release = trajectory.events[test::event_near(trajectory, 13.775854797030098)];
    const std::vector<double> after =
        values_at(trajectory, sample_at(trajectory, release), PreparedView(*trajectory.model, view));
    EXPECT_GT(after[1], 0.0);
    EXPECT_EQ(after[2], 0.0);
}

TEST(FigureComposition, VeryManyStepsAreThinned) {
    const auto model = test::load("ball_in_bowl");
    auto run = model->default_run();
    run.options.end_time = 1e8;
    run.options.max_steps = 300000;
    const Trajectory trajectory = simulate(model, run);
    ASSERT_EQ(trajectory.pieces.size(), 300000U);
    const std::vector<Sample> samples = plot_samples(trajectory);
    EXPECT_LT(samples.size(), 200000U);
    double highest = 0.0, highest_of_all = 0.0;
    for (const Sample& sample : samples) highest = std::max(highest, sample.state.q[1]);
    for (const Sample& sample : Sampler(trajectory).all(1))
        highest_of_all = std::max(highest_of_all, sample.state.q[1]);
    EXPECT_GT(highest, 0.999 * highest_of_all);
    EXPECT_LT(samples.front().t, 0.01 * trajectory.end_time);
    EXPECT_GT(samples.back().t, 0.99 * trajectory.end_time);
    EXPECT_TRUE(
        std::is_sorted(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.t < b.t; }));
}

}  // namespace
}  // namespace achilles
