// Sweeps over one axis, numerically: gaps, breaks, steps and classes.
#include <gtest/gtest.h>

#include <cmath>

#include "figure/sweep_panels.hpp"
#include "render/sweep_tables.hpp"

namespace achilles {
namespace {

using sweeps::grid, sweeps::nothing_there, sweeps::only;

// The pieces of a curve, as the x of their points.
std::vector<std::vector<double>> pieces(const Curve& curve) {
    std::vector<std::vector<double>> all(1);
    for (const Point& p : curve.points) {
        if (std::isnan(p.x))
            all.emplace_back();
        else
            all.back().push_back(p.x);
    }
    std::erase_if(all, [](const auto& piece) { return piece.empty(); });
    return all;
}

TEST(SweepCurve, BreaksWhereNothingIsAndWhereTheSequenceChanges) {
    const SweepData data =
        grid({{"e", 0.0, 0.7, 8, false}}, {1, 2, 3, nothing_there, 5, 6, 9, 10}, {1, 1, 1, 1, 1, 1, 2, 2});
    const Figure figure = compose_sweep(data, only(0));
    ASSERT_EQ(figure.panels.size(), 1u);
    const Panel& panel = figure.panels[0];
    ASSERT_EQ(panel.curves.size(), 1u);
    const auto found = pieces(panel.curves[0]);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].size(), 3u);
    EXPECT_EQ(found[1].size(), 2u);
    EXPECT_EQ(found[2].size(), 2u);
    EXPECT_DOUBLE_EQ(found[2][0], 0.6);
    EXPECT_EQ(panel.x.label, "\U0001D452");
    EXPECT_EQ(panel.y.label, "Zeno time 2 (s)");
    EXPECT_EQ(panel.x.low, 0.0);
    EXPECT_EQ(panel.x.high, 0.7);
    // One bar, midway between the two points.
    ASSERT_EQ(panel.markers.size(), 1u);
    EXPECT_EQ(panel.markers[0].label, sequence_changes);
    ASSERT_EQ(panel.markers[0].points.size(), 1u);
    EXPECT_NEAR(panel.markers[0].points[0].x, 0.55, 1e-12);
}

TEST(SweepCurve, SaysWhyItIsBrokenWhereLinesWouldBeTooMany) {
    std::vector<double> numbers(64, 1.0);
    std::vector<std::uint64_t> sequences;
    for (std::uint64_t i = 0; i < 64; ++i) sequences.push_back(i / 2);
    const auto panel = [&] {
        return compose_sweep(grid({{"e", 0.0, 1.0, 64, false}}, numbers, sequences), only(0)).panels[0];
    };
    const Panel too_many = panel();
    EXPECT_EQ(pieces(too_many.curves[0]).size(), 32u);
    EXPECT_TRUE(too_many.markers.empty());
    ASSERT_EQ(too_many.curves.size(), 2u);
    EXPECT_EQ(too_many.curves[1].label, broken_at_changes);
    EXPECT_TRUE(too_many.legend_above);
    for (std::uint64_t& one : sequences) one = std::min<std::uint64_t>(one, 30);
    EXPECT_EQ(panel().markers.at(0).label, sequence_changes);
    EXPECT_EQ(panel().curves.size(), 1u);
}

// A count has no values between integers.
TEST(SweepCurve, OfACountIsNotJoinedWhereItSteps) {
    SweepData data = grid({{"e", 0.0, 0.5, 6, false}}, {1, 1, 2, 2, 2, 4}, {1, 1, 1, 1, 1, 1});
    EXPECT_EQ(pieces(compose_sweep(data, only(0)).panels[0].curves[0]).size(), 1u);
    for (const char* count : {"impacts", "zeno_points", "releases"}) {
        data.columns[0] = {RunMeasures::Column::Kind::number, count, ""};
        const Panel panel = compose_sweep(data, only(0)).panels[0];
        EXPECT_EQ(pieces(panel.curves[0]).size(), 3u) << count;
        EXPECT_EQ(panel.markers.at(0).points.size(), 1u) << "the last stands alone";
    }
}

TEST(SweepCurve, WithoutAValueIsNamedBesideOthers) {
    const Figure figure = compose_sweep(
        sweeps::data_of("ball_on_floor", "--over e=0:0.5:3 --print \"zeno_time(1)\" --print \"zeno_time(2)\""));
    ASSERT_EQ(figure.panels.size(), 1u);
    EXPECT_EQ(figure.panels[0].curves[0].label, "Zeno time 1");
    EXPECT_EQ(figure.panels[0].curves[1].label, "Zeno time 2: no value");
    EXPECT_TRUE(figure.panels[0].hatch.label.empty());
}

TEST(SweepCurve, ShowsAPointThatStandsAlone) {
    const SweepData data = grid({{"e", 0.0, 0.4, 5, false}}, {1, nothing_there, 3, nothing_there, 5}, {1, 1, 1, 1, 1});
    const Panel panel = compose_sweep(data, only(0)).panels[0];
    ASSERT_EQ(panel.markers.size(), 1u);
    EXPECT_EQ(panel.markers[0].points.size(), 3u);
}

TEST(SweepCurve, HasALogarithmicAxisWhereTheSweepHas) {
    const Panel panel = compose_sweep(grid({{"g", 1e-3, 1.0, 4, true}}, {1, 2, 3, 4}, {1, 1, 1, 1}), only(0)).panels[0];
    EXPECT_TRUE(panel.x.logarithmic);
    EXPECT_EQ(panel.x.label, "\U0001D454 (m/s\u00B2)");
    EXPECT_NEAR(panel.curves[0].points[1].x, 1e-2, 1e-12);
}

TEST(SweepCurve, OfAClassIsABarForEach) {
    const Panel panel = compose_sweep(grid({{"e", 0.0, 0.3, 4, false}}, {1, 2, 3, 4}, {1, 1, 1, 1}), only(1)).panels[0];
    ASSERT_EQ(panel.curves.size(), 2u);
    EXPECT_EQ(panel.y.ticks[0].label, "no contact");
    EXPECT_EQ(panel.y.ticks[1].label, "floor");
    EXPECT_NEAR(panel.curves[0].points[1].x, 0.15, 1e-12);
    EXPECT_NEAR(panel.curves[1].points[0].x, 0.15, 1e-12);
}

}  // namespace
}  // namespace achilles
