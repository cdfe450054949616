// Figure 4 of the paper, and the comparison of its numbers with ours.
#include "pictures/paper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/systems.hpp"

namespace achilles {
namespace {

TEST(Paper, TheTableStandsOnTheRunsItIsGiven) {
    const auto ball = test::load("ball_on_sine"), pendulum = test::load("double_pendulum");
    const auto as_in_the_paper = [](const std::shared_ptr<const Model>& model) {
        auto run = model->default_run();
        run.options.truncation.conditions = Conditions::paper;
        return simulate(model, run);
    };
    const Trajectory a = as_in_the_paper(ball), b = as_in_the_paper(pendulum);
    EXPECT_NEAR(contact_time_with_velocity_threshold(a, 1.0), 10.93, 0.005);  // theory.md 8
    EXPECT_NEAR(contact_time_with_velocity_threshold(a, 1e-5), 12.4658, 1e-4);
    const std::string table = paper_table(a, b);
    for (const char* piece :
         {"ball, second Zeno time             about 11       12.465775      +1.47        see below\n",
          "ball, first Zeno time              about 3        2.72514217     -0.275       read off the plot\n",
          "ball, release                      about 4        3.73182155     -0.268       read off the plot\n", "10.93",
          "about -40 deg  -36.69", "pendulum, theta1 at release        0 deg          0 deg          +0 deg",
          "ball, Zeno time 2                  [12.4657", "pendulum, Zeno time 3              [18.6960"})
        EXPECT_NE(table.find(piece), std::string::npos) << piece << "\n" << table;
    const auto figures = paper_figures(a, b);
    ASSERT_EQ(figures.size(), 8u);
    EXPECT_EQ(figures[0].name, "fig4a");
    EXPECT_EQ(figures[6].name, "fig4");
    EXPECT_EQ(figures[6].figure.panels.size(), 6u);
    // The path is drawn once, together with the zero line of the gap, as in `figure`.
    const Panel& path = figures[3].figure.panels[0];
    EXPECT_EQ(path.curves.size(), 2u);
    EXPECT_TRUE(path.equal_axes);
    EXPECT_GT(path.boundary.points.size(), 300u);
    for (const Point& p : path.boundary.points)
        EXPECT_TRUE(std::isnan(p.x) || std::abs(p.y - std::sin(p.x)) < 2e-3) << p.x;
    for (const std::size_t i : {3u, 6u}) {
        const auto& keys = figures[i].figure.keys;
        EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [](const Key& key) { return key.label == "ℎ = 0"; })) << i;
    }
    // From the certified time at threshold 0 to about 11 at threshold 1.
    EXPECT_EQ(figures[7].name, "zeno");
    const std::vector<Point>& cut = figures[7].figure.panels[0].curves[0].points;
    EXPECT_EQ(cut.front().x, 0.0);
    EXPECT_NEAR(cut.front().y, 12.465774972, 1e-6);
    EXPECT_EQ(cut.back().x, 1.0);
    EXPECT_NEAR(cut.back().y, 10.93, 0.005);
    ASSERT_EQ(figures[7].figure.panels[1].curves.size(), 5u);
}

// Every interval contains the time of tests/reference, and the widths shrink with the square of the impact speed.
TEST(Paper, CertifiedIntervalsShrinkAroundTheZenoTimes) {
    const auto ball = test::load("ball_on_sine");
    auto run = ball->default_run();
    const auto widths = certified_widths(simulate(ball, run));
    ASSERT_EQ(widths.size(), 2u);
    const double truth[] = {2.725142172735049, 12.465774972267969};
    for (std::size_t n = 0; n < 2; ++n) {
        ASSERT_GE(widths[n].size(), 8u);
        for (const CertifiedWidth& cut : widths[n]) {
            // The certificate of the second Zeno point does not cover errors of the first cut, which are of its
            // tolerance.
            const double slack = n == 0 ? 1e-9 : 0.1 * cut.speed;
            EXPECT_LT(cut.low - slack, truth[n]) << cut.speed;
            EXPECT_GT(cut.high + slack, truth[n]) << cut.speed;
        }
        const CertifiedWidth &first = widths[n].front(), &last = widths[n].back();
        const double slope =
            std::log((first.high - first.low) / (last.high - last.low)) / std::log(first.speed / last.speed);
        EXPECT_NEAR(slope, 3.0, 0.25);
    }
}

}  // namespace
}  // namespace achilles
