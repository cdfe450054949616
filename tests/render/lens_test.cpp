// The Zeno lens: evenly spaced, equal arcs.
#include "figure/lens.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/systems.hpp"
#include "figure/figure.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

std::size_t first_zeno(const Trajectory& trajectory) {
    const auto is_zeno = [](const Event& e) { return e.kind == Event::Kind::zeno; };
    return static_cast<std::size_t>(std::find_if(trajectory.events.begin(), trajectory.events.end(), is_zeno) -
                                    trajectory.events.begin());
}

Trajectory run_of(const std::string& system, double eps, double e = 0.5) {
    const auto model = test::load(system);
    auto run = model->default_run();
    for (std::size_t i = 0; i < run.parameters.size(); ++i)
        if (model->description().parameters[i].name == "e") run.parameters[i] = e;
    run.options.truncation = {eps, eps, eps, Conditions::paper, Reinitialization::kinetic};
    return simulate(model, run);
}

TEST(ZenoLens, TheRowIsEvenAndTheArcsAreEqual) {
    for (const std::string system : {"ball_on_sine", "double_pendulum"}) {
        const Trajectory trajectory = run_of(system, 1e-9);
        const auto lens = Lens::at(trajectory, first_zeno(trajectory));
        ASSERT_TRUE(lens);
        EXPECT_DOUBLE_EQ(lens->spacing(), std::log10(2.0));
        const Panel panel = lens->panel(lens->cut() - 1.0, lens->cut() + 1.0, light_theme());
        const auto& impacts = panel.markers[0].points;
        ASSERT_GE(impacts.size(), 6u);
        for (std::size_t i = 1; i < impacts.size(); ++i)
            EXPECT_NEAR(impacts[i].x - impacts[i - 1].x, lens->spacing(), 1e-5) << system << " impact " << i;
        // Maxima of the run's own arcs and of those after the cut.
        double own = 0.0, limit = 0.0;
        for (const Point& point : panel.curves[0].points) own = std::max(own, point.y);
        for (const Point& point : panel.curves[1].points) limit = std::max(limit, point.y);
        EXPECT_NEAR(own, limit, 1e-4 * limit) << system;
    }
}

// Flights longer than a millisecond show the gap of the run, which must join its cubic interpolation.
TEST(ZenoLens, ShowsTheGapOfTheRun) {
    const Trajectory trajectory = run_of("ball_on_sine", 1e-9);
    const auto lens = Lens::at(trajectory, first_zeno(trajectory));
    const Panel panel = lens->panel(lens->first(), lens->first() + 0.4, light_theme());
    const Event& impact = trajectory.events[0];
    Sampler sampler(trajectory);
    const double t = 0.5 * (impact.t + trajectory.events[1].t);
    const State state = sampler.at(t).state;
    const double h = (state.q[1] - std::sin(state.q[0])) / std::pow(impact.impact_speed, 2);
    EXPECT_NEAR(panel.curves[0].points[24].y, h, 1e-9 * h);
}

TEST(ZenoLens, GoesOnForEver) {
    const Trajectory trajectory = run_of("ball_on_sine", 1e-6);
    const auto lens = Lens::at(trajectory, first_zeno(trajectory));
    ASSERT_TRUE(lens);
    for (const double x : {50.0, 1e3, 1e6}) {
        const Panel panel = lens->panel(x, x + 3.0, light_theme());
        EXPECT_TRUE(panel.curves[0].points.empty());
        EXPECT_NEAR(static_cast<double>(panel.markers[0].points.size()), 3.0 / lens->spacing(), 2.0);
        for (const Point& point : panel.curves[1].points) {
            EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y));
            EXPECT_GE(point.y, 0.0);
        }
    }
}

TEST(ZenoLens, HasNothingToShowWithoutARow) {
    const Trajectory trajectory = run_of("ball_on_sine", 1e-6);
    EXPECT_FALSE(Lens::at(trajectory, 0));       // an impact
    EXPECT_FALSE(Lens::at(trajectory, 100000));  // not an event
    const Trajectory plastic = run_of("ball_on_sine", 1e-6, 0.0);
    EXPECT_FALSE(Lens::at(plastic, first_zeno(plastic)));
}

// The interval starts at the value of the certificate.
TEST(ZenoLens, MarksTheCutAndTheCertifiedInterval) {
    const Trajectory trajectory = run_of("double_pendulum", 1e-6);
    const std::size_t event = first_zeno(trajectory);
    const auto lens = Lens::at(trajectory, event);
    ASSERT_TRUE(lens && lens->interval());
    const Event& zeno = trajectory.events[event];
    EXPECT_DOUBLE_EQ(*lens->interval(), -std::log10(zeno.t - zeno.certificate->zeno_low));
    EXPECT_DOUBLE_EQ(lens->cut(), -std::log10(zeno.t - zeno.truncation->t));
    EXPECT_GT(*lens->interval(), lens->cut());
}

// The initial view contains the cut and the start of the interval, which has no end. The arcs have the same height in
// any view.
TEST(ZenoLens, ShowsTheIntervalAsABandWithoutEnd) {
    for (const std::string system : {"ball_on_sine", "double_pendulum"}) {
        const Trajectory trajectory = run_of(system, 1e-6);
        const auto lens = Lens::at(trajectory, first_zeno(trajectory));
        ASSERT_TRUE(lens && lens->interval());
        const Lens::LensPart part = lens->overview();
        EXPECT_LT(part.low, lens->cut());
        EXPECT_LT(*lens->interval(), part.high);
        const Panel panel = lens->panel(part.low, part.high, light_theme());
        ASSERT_EQ(panel.bands.size(), 1u);
        EXPECT_EQ(panel.bands[0].low, *lens->interval());
        Figure figure;
        figure.panels = {panel};
        EXPECT_NE(to_text(figure).find("band \"certified\""), std::string::npos);
        for (const double x : {lens->first(), 20.0, 1e6}) {
            const Panel there = lens->panel(x, x + 4.0, light_theme());
            EXPECT_EQ(there.y.low, panel.y.low);
            EXPECT_EQ(there.y.high, panel.y.high);
            double top = 0.0;
            for (const Point& point : there.curves[1].points) top = std::max(top, point.y);
            EXPECT_LT(top, there.y.high);
        }
    }
}

}  // namespace
}  // namespace achilles
