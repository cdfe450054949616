// Figures of sweeps, as numbers and text: cells, contours, classes, dots, and sweeps without a figure.
#include "figure/sweep_figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "figure/label.hpp"
#include "figure/layout.hpp"
#include "figure/palette.hpp"
#include "figure/publication.hpp"
#include "figure/sweep_panels.hpp"
#include "number/angle.hpp"
#include "render/samples.hpp"
#include "render/sweep_tables.hpp"
#include "system/input_error.hpp"

namespace achilles {
namespace {

using sweeps::data_of, sweeps::grid, sweeps::nothing_there, sweeps::only;

// The first axis points to the right, the second upward. Half of each outer cell is outside the range of the axis.
TEST(SweepMap, HasACellForEveryPoint) {
    const SweepData data = grid({{"e", 0.0, 1.0, 2, false}, {"g", 2.0, 0.0, 3, false}}, {0, 1, 2, 3, 4, nothing_there},
                                {1, 1, 1, 1, 1, 2});
    const Panel panel = compose_sweep(data, only(0)).panels[0];
    ASSERT_NE(panel.raster.cells, nullptr);
    const Cells& cells = *panel.raster.cells;
    ASSERT_EQ(cells.columns, 2);
    ASSERT_EQ(cells.rows, 3);
    // The second axis runs downward, so that its first value, 2, is at the top.
    const std::vector<Color> table = number_colors(256);
    EXPECT_EQ(cells.colors[0], table.front());
    EXPECT_EQ(cells.colors[1], table[191]) << "three quarters of the way";
    EXPECT_EQ(cells.colors[3], table.back());
    EXPECT_EQ(cells.colors[2], table[64]);
    EXPECT_EQ(cells.colors[4], table[128]);
    EXPECT_EQ(cells.colors[5].a, 0) << "nothing is clear, and hatched";
    EXPECT_EQ(panel.hatch.label, "no value");
    EXPECT_EQ(panel.raster.left, -0.5);
    EXPECT_EQ(panel.raster.right, 1.5);
    EXPECT_EQ(panel.raster.bottom, -0.5);
    EXPECT_EQ(panel.raster.top, 2.5);
    EXPECT_EQ(panel.x.low, 0.0);
    EXPECT_EQ(panel.color_bar.axis.label, "Zeno time 2 (s)");
    EXPECT_EQ(panel.color_bar.axis.low, 0.0);
    EXPECT_EQ(panel.color_bar.axis.high, 4.0);
    // The line between the last cell and its two neighbors.
    ASSERT_EQ(panel.curves.size(), 2u);
    const std::vector<Point>& line = panel.curves[1].points;
    ASSERT_EQ(line.size(), 5u);
    EXPECT_EQ(line[0].x, 0.5);
    EXPECT_EQ(line[0].y, -0.5);
    EXPECT_EQ(line[1].y, 0.5);
    EXPECT_EQ(line[3].y, 0.5);
    EXPECT_EQ(line[4].x, 1.5);
}

// Lines between small cells would be gray noise: neither they nor their legend are drawn.
TEST(SweepMap, HasLinesOnlyBetweenLargeCells) {
    const auto width = [](const std::string&, float) { return 40.0F; };
    for (const auto& [side, is_drawn] : {std::pair{10, true}, {60, true}, {220, false}}) {
        const auto count = static_cast<std::size_t>(side);
        std::vector<double> numbers(count * count, 1.0);
        std::vector<std::uint64_t> signatures(count * count, 1);
        for (std::size_t i = 0; i < count * count / 2; ++i) signatures[i] = 2;
        const SweepData data =
            grid({{"e", 0.0, 1.0, count, false}, {"g", 0.0, 2.0, count, false}}, numbers, signatures);
        const Figure figure = compose_sweep(data, only(0));
        for (const double scale : {1.0, 2.0}) {
            const auto size = static_cast<float>(500.0 * scale);
            std::size_t lines = 0, words = 0;
            const Color rim = figure.panels.at(0).curves.at(0).stroke.color;
            for (const auto& item : layout(figure, width, {0, 0, size, size}, scale)) {
                const auto* path = std::get_if<Path>(&item);
                lines += path != nullptr && path->stroke.color == rim ? 1 : 0;
                const auto* text = std::get_if<TextRun>(&item);
                words += text != nullptr && text->label == sequence_changes ? 1 : 0;
            }
            EXPECT_EQ(lines > 0, is_drawn) << side << " " << scale;
            EXPECT_EQ(words > 0, is_drawn) << side << " " << scale;
        }
    }
}

// A low plot has low cells: wide ones alone are not enough.
TEST(SweepMap, HasNoLinesBetweenLowCells) {
    const auto width = [](const std::string&, float) { return 40.0F; };
    std::vector<double> numbers(64 * 64, 1.0);
    std::vector<std::uint64_t> signatures(64 * 64, 1);
    for (std::size_t i = 0; i < 64 * 32; ++i) signatures[i] = 2;
    const SweepData data = grid({{"e", 0.0, 1.0, 64, false}, {"g", 0.0, 2.0, 64, false}}, numbers, signatures);
    for (const auto& [height, is_drawn] : {std::pair{500.0F, true}, {180.0F, false}}) {
        std::size_t words = 0;
        for (const auto& item : layout(compose_sweep(data, only(0)), width, {0, 0, 700, height}, 1.0)) {
            const auto* text = std::get_if<TextRun>(&item);
            words += text != nullptr && text->label == sequence_changes ? 1 : 0;
        }
        EXPECT_EQ(words > 0, is_drawn) << height;
    }
}

TEST(SweepMap, SaysWhereLinesWouldBeTooMany) {
    const SweepData data = grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 2, false}}, {1, 2, 3, 4}, {1, 2, 3, 4});
    const Panel panel = compose_sweep(data, only(0)).panels[0];
    ASSERT_EQ(panel.curves.size(), 1u);
    EXPECT_TRUE(panel.curves[0].points.empty());
    EXPECT_EQ(panel.curves[0].label, changes_too_often);
    EXPECT_TRUE(panel.legend_above);
}

// Two outliers do not use up the color scale, and the figure mentions them.
TEST(SweepMap, LeavesTheFarthestBeyondItsColors) {
    std::vector<double> numbers;
    for (int i = 0; i < 2000; ++i) numbers.push_back(i % 100);
    numbers[17] = 5000.0;
    const SweepData data =
        grid({{"e", 0.0, 1.0, 40, false}, {"g", 0.0, 2.0, 50, false}}, numbers, std::vector<std::uint64_t>(2000, 1));
    Panel panel = compose_sweep(data, only(0)).panels[0];
    EXPECT_EQ(panel.color_bar.axis.low, 0.0);
    EXPECT_EQ(panel.color_bar.axis.high, 99.0);
    EXPECT_EQ(panel.color_bar.axis.label, "Zeno time 2 (s), max 5000");
    SweepLook look = only(0);
    look.range = std::array<double, 2>{0.0, 5000.0};
    panel = compose_sweep(data, look).panels[0];
    EXPECT_EQ(panel.color_bar.axis.high, 5000.0);
    EXPECT_EQ(panel.color_bar.axis.label, "Zeno time 2 (s)");
}

TEST(SweepMap, HasRoomLeftForRowsThatAreNotThereYet) {
    SweepData data =
        grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 3, false}}, {0, 1, 2, 3, 4, 5}, {1, 1, 1, 1, 1, 1});
    Rows rows = data.rows;
    data.rows = {};
    data.add(rows, 4);
    data.add(rows, 1);
    const Panel panel = compose_sweep(data, only(0)).panels[0];
    EXPECT_EQ(panel.raster.cells->colors[3], number_color(1.0));
    EXPECT_EQ(panel.raster.cells->colors[0], light_theme().background);
    EXPECT_TRUE(panel.hatch.label.empty());
}

TEST(SweepMap, OfClassesHasTheHuesOfPhasesAndNames) {
    const SweepData data =
        grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 2, false}}, {1, 2, 3, nothing_there}, {1, 1, 1, 1});
    const Panel panel = compose_sweep(data, only(1)).panels[0];
    const Theme theme = light_theme();
    EXPECT_EQ(panel.raster.cells->colors[0], phase_color(theme, Phase::Kind::hybrid));
    EXPECT_EQ(panel.raster.cells->colors[3], phase_color(theme, Phase::Kind::constrained));
    EXPECT_EQ(panel.markers[0].label, "no contact");
    EXPECT_EQ(panel.markers[1].label, "floor");
    EXPECT_TRUE(panel.color_bar.colors.empty());
}

TEST(SweepMap, OfSequencesCountsThem) {
    const SweepData data = grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 2, false}}, {1, 2, 3, 4}, {7, 9, 9, 9});
    const Panel panel = compose_sweep(data, only(sequence_column)).panels[0];
    EXPECT_EQ(panel.markers[0].label, "1. (75 %)");
    EXPECT_EQ(panel.markers[1].label, "2. (25 %)");
}

TEST(SweepSection, IsADiagramOfDotsWherePointsAreMany) {
    const SweepData data = data_of("ball_on_vibrating_table", "--over a=0.07:0.1:60 --print y --at impact --end 30");
    const Panel panel = compose_sweep(data).panels[0];
    ASSERT_GT(data.count(), 3000u);
    EXPECT_EQ(panel.dots.points.size(), data.count());
    EXPECT_EQ(panel.dots.columns, 60);
    EXPECT_EQ(panel.markers[0].label, "at every impact; color strength: number of points (log scale)");
}

TEST(SweepSection, WithoutAnAxisIsOnePrintOverTheOther) {
    const SweepData data = data_of("ball_on_sine", "--print x --print \"x'\" --at impact --end 6");
    ASSERT_GT(data.count(), 3u);
    const Panel panel = compose_sweep(data).panels[0];
    EXPECT_EQ(panel.x.label, "\U0001D465 (m)");
    ASSERT_EQ(panel.markers.size(), 1u);
    EXPECT_EQ(panel.markers[0].points.size(), data.count());
    EXPECT_EQ(panel.markers[0].points[1].y, data.number(1, 1));
}

// An axis without numbers has no labels.
TEST(SweepFigure, SaysThatThereIsNoValue) {
    const std::vector<double> none(4, nothing_there);
    const std::vector<std::uint64_t> same(4, 1);
    const auto is_empty = [](const Panel& panel) {
        Figure figure;
        figure.panels = {panel};
        const Sheet sheet = layout(figure, samples::half, {0, 0, 600, 400}, 1.0);
        return std::any_of(sheet.begin(), sheet.end(), [](const auto& item) {
            const auto* text = std::get_if<TextRun>(&item);
            return text != nullptr && text->label == no_value && std::abs(text->y - 200.0F) < 50.0F;
        });
    };
    const Panel curve = compose_sweep(grid({{"e", 0.0, 1.0, 4, false}}, none, same), only(0)).panels[0];
    EXPECT_TRUE(is_empty(curve));
    EXPECT_TRUE(curve.y.ticks.empty());
    EXPECT_FALSE(curve.x.ticks.empty());
    const Panel bars = compose_sweep(grid({{"e", 0.0, 1.0, 4, false}}, none, same), only(1)).panels[0];
    EXPECT_TRUE(is_empty(bars));
    const Panel map =
        compose_sweep(grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 1.0, 2, false}}, none, same), only(0)).panels[0];
    EXPECT_EQ(map.hatch.label, no_value);
    EXPECT_TRUE(map.legend_above) << "as where there is something, too";
    EXPECT_TRUE(map.color_bar.colors.empty());
    EXPECT_EQ(map.title, "Zeno time 2 (s)");
    const Panel diagram = compose_sweep(data_of("ball_on_floor", "--over e=0:0.5:3 --at release --print y")).panels[0];
    EXPECT_TRUE(is_empty(diagram));
    EXPECT_TRUE(diagram.y.ticks.empty());
    const Panel section = compose_sweep(data_of("ball_on_floor", "--at release --print y --print gap")).panels[0];
    EXPECT_TRUE(is_empty(section));
    EXPECT_TRUE(section.x.ticks.empty());
    EXPECT_FALSE(is_empty(compose_sweep(grid({{"e", 0.0, 1.0, 4, false}}, {}, {}), only(0)).panels[0]))
        << "it is not there yet";
}

TEST(SweepSection, OfZerosSaysWhichWayTheyArePassed) {
    const SweepData data = data_of("ball_on_sine", "--over e=0:0.5:3 --at \"x - 1\" --print y --end 3");
    EXPECT_EQ(compose_sweep(data).panels[0].markers[0].label, "at every upward zero of " + typeset("x - 1"));
}

// As in the figure of a run; the frequency of a drive is not converted to degrees.
TEST(SweepFigure, ShowsAnglesInDegrees) {
    const SweepData data =
        data_of("driven_double_pendulum",
                "--over theta1=0.1:0.3:3 --over om=1:2:2 --print theta1 --print \"theta1'\" --end 0.5");
    const Figure figure = compose_sweep(data);
    const Panel& panel = figure.panels[0];
    EXPECT_EQ(panel.x.label, "\U0001D703\u2081(0) (\u00B0)");
    EXPECT_NEAR(panel.x.low, degrees(0.1), 1e-12);
    EXPECT_NEAR(panel.raster.right, degrees(0.35), 1e-12);
    EXPECT_TRUE(panel.y.label.ends_with(" (rad/s)")) << panel.y.label;
    EXPECT_EQ(panel.y.high, 2.0);
    EXPECT_TRUE(panel.color_bar.axis.label.ends_with(" (\u00B0)")) << panel.color_bar.axis.label;
    EXPECT_NEAR(ColumnView(data, 0).number(3), degrees(data.number(3, 0)), 1e-9);
    EXPECT_TRUE(figure.panels[1].color_bar.axis.label.ends_with(" (\u00B0/s)"));
    const SweepData rates = data_of("double_pendulum", "--over theta1'=1:2:3 --print theta2 --end 0.5");
    const Panel curve = compose_sweep(rates).panels[0];
    EXPECT_NEAR(curve.curves[0].points[0].x, degrees(1.0), 1e-12);
    EXPECT_NEAR(curve.curves[0].points[0].y, degrees(rates.number(0, 0)), 1e-12);
    EXPECT_TRUE(curve.x.label.ends_with(" (\u00B0/s)")) << curve.x.label;
}

TEST(SweepSamples, StandWhereTheyAre) {
    const SweepData data =
        data_of("ball_on_sine", "--over x=-3:3 --over y=-1:2 --random 40 --print x --print held --end 3");
    const Figure figure = compose_sweep(data);
    ASSERT_EQ(figure.panels.size(), 2u);
    std::size_t points = 0;
    std::set<std::string> labels;
    for (const Markers& markers : figure.panels[0].markers)
        points += markers.points.size(), labels.insert(markers.label);
    EXPECT_EQ(points, 40u);
    EXPECT_EQ(figure.panels[0].x.label, "\U0001D465(0) (m)");
    EXPECT_FALSE(figure.panels[0].color_bar.colors.empty());
    EXPECT_TRUE(figure.panels[1].color_bar.colors.empty());
}

// A dot darkens with the logarithm of its number of points.
TEST(SweepDots, AreShadedByTheLogarithmOfTheirNumber) {
    Panel panel;
    panel.x.high = panel.y.high = 10.0;
    panel.dots.ink = {0, 0, 0, 255};
    panel.dots.points.push_back({1.0, 1.0});
    panel.dots.points.insert(panel.dots.points.end(), 10, {5.0, 5.0});
    panel.dots.points.insert(panel.dots.points.end(), 100, {9.0, 9.0});
    panel.dots.points.push_back({nothing_there, 3.0});
    panel.dots.points.push_back({11.0, 3.0});
    Sheet sheet;
    layout(
        panel, Figure(), [](const std::string&, float) { return 10.0F; }, {0, 0, 300, 200}, 1.0, sheet);
    std::multiset<int> alphas;
    for (const auto& item : sheet)
        if (const auto* tiles = std::get_if<Tiles>(&item))
            for (const Color& c : tiles->cells->colors)
                if (c.a > 0) alphas.insert(c.a);
    EXPECT_EQ(alphas, (std::multiset<int>{128, 191, 255}));
}

TEST(SweepFigure, HasItsBarInsideThePicture) {
    const SweepData data = grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 2, false}}, {1, 2, 3, 4}, {1, 1, 1, 1});
    const auto width = [](const std::string& label, float size) {
        return 0.6F * size * static_cast<float>(label.size());
    };
    for (const Rectangle area : {Rectangle{0, 0, 1200, 800}, Rectangle{0, 0, 400, 300}}) {
        float right = 0;
        for (const auto& item : layout(compose_sweep(data, only(0)), width, area, 1.0))
            if (const auto* tiles = std::get_if<Tiles>(&item))
                right = std::max(right, tiles->clip.x + tiles->clip.width);
        EXPECT_GT(right, 0.7F * area.width);
        EXPECT_LT(right, area.width - 14.0F);
    }
}

// Also below a panel without a color scale.
TEST(SweepFigure, HasItsBarInsideThePictureInARowThatIsNotFull) {
    const SweepData data = grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 2, false}}, {1, 2, 3, 4}, {1, 1, 1, 1});
    SweepLook look;
    look.columns = {1, 1, 0};
    const Rectangle area{0, 0, 1200, 800};
    const auto width = [](const std::string&, float) { return 40.0F; };
    for (const auto& item : layout(compose_sweep(data, look), width, area, 1.0)) {
        const auto* text = std::get_if<TextRun>(&item);
        EXPECT_LT(text != nullptr ? text->x : 0.0F, area.width - 14.0F);
        const auto* tiles = std::get_if<Tiles>(&item);
        const bool is_bar = tiles != nullptr && tiles->clip.width < 40.0F;
        EXPECT_LT(is_bar ? tiles->clip.x + tiles->clip.width : 0.0F, area.width - 70.0F);
    }
}

TEST(SweepFigure, SaysOnceWhatSeveralPanelsShow) {
    SweepData data =
        grid({{"e", 0.0, 1.0, 3, false}, {"g", 0.0, 2.0, 3, false}},
             {1, 2, 3, 4, nothing_there, 6, nothing_there, nothing_there, nothing_there}, {1, 1, 1, 1, 1, 1, 1, 1, 2});
    data.columns.push_back({RunMeasures::Column::Kind::outcome, "outcome", ""});
    const Figure figure = compose_sweep(data);
    ASSERT_EQ(figure.panels.size(), 3u);
    ASSERT_EQ(figure.keys.size(), 1u);
    EXPECT_EQ(figure.keys[0].label, no_value);
    std::size_t named = 0;
    for (const Panel& panel : figure.panels) {
        EXPECT_TRUE(panel.hatch.label.empty());
        for (const Curve& curve : panel.curves) named += curve.label == sequence_changes ? 1 : 0;
    }
    EXPECT_EQ(named, 1u);
    EXPECT_EQ(figure.panels[2].markers[0].label, "end time") << "before what is as frequent";
    EXPECT_EQ(figure.panels[2].markers[1].label, "cannot start");
    EXPECT_EQ(figure.panels[2].title, "(c)\u00A0\u00A0outcome");
    EXPECT_EQ(figure.columns, 2);
}

// The widths are in points: 1200 pixels, or 170 mm, and half of it. With a given height, the maps stay side by side if
// they are larger so.
TEST(SweepFigure, HasNarrowMapsBelowOneAnother) {
    const SweepData data = grid({{"e", 0.0, 1.0, 2, false}, {"g", 0.0, 2.0, 2, false}}, {1, 2, 3, 4}, {1, 1, 1, 1});
    const auto columns = [&](double width, double height) {
        SweepLook look;
        look.columns = {0, 0};
        look.width = width, look.height = height;
        return compose_sweep(data, look).columns;
    };
    EXPECT_EQ(columns(0.0, 0.0), 2);
    EXPECT_EQ(columns(1200.0 / publication_scale, 0.0), 2);
    EXPECT_EQ(columns(600.0 / publication_scale, 0.0), 1);
    EXPECT_EQ(columns(600.0 / publication_scale, 800.0 / publication_scale), 1);
    EXPECT_EQ(columns(600.0 / publication_scale, 200.0 / publication_scale), 2);
}

TEST(SweepFigure, IsAsHighAsItsPanelsNeed) {
    SweepData data = grid({{"e", 0.0, 1.0, 2, false}}, {1, 2}, {1, 1});
    data.columns[0].unit = "";
    SweepLook look;
    for (const std::size_t count : {1u, 3u, 12u}) {
        look.columns.assign(count, 0);
        const Figure figure = compose_sweep(data, look);
        const int height = readable_height(figure, 1200, 800, publication_scale);
        EXPECT_EQ(height > 800, count == 12) << height;
        const Rectangle page{0, 0, 1200, static_cast<float>(height)};
        for (const PlotArea& at : plot_areas(figure, samples::half, page, publication_scale)) {
            EXPECT_GE(at.plot.height, 109.0F) << count;
            EXPECT_LT(at.plot.height, height > 800 ? 125.0F : 800.0F) << count;
        }
    }
}

TEST(SweepFigure, SaysWhatHasNone) {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            check_drawn(data_of("ball_on_sine", text, false), {});
        } catch (const InputError& error) {
            return error.message;
        }
        return "";
    };
    EXPECT_EQ(refusal("--over e=0:1:3 --over x=0:1:3 --over y=1:2:3 --print t"), "a sweep over 3 axes cannot be drawn");
    EXPECT_EQ(refusal("--over e=0:1:3 --over x=0:1:3 --print t --at impact"), "a section over 2 axes cannot be drawn");
    EXPECT_EQ(refusal("--over e=0:1:3 --print held --at impact"), "the diagram of a section needs a numeric quantity");
    EXPECT_EQ(refusal("--print t --at impact"),
              "the figure of a section without an axis needs exactly two numeric quantities");
    EXPECT_EQ(refusal("--over e=0:1:5000 --over x=0:1:3 --print t"),
              "5000 values of e are too many for one side of a map");
    EXPECT_EQ(refusal("--over e=0:1:5000 --print t"), "");
    EXPECT_EQ(refusal("--over e=0:1 --over x=0:1 --random 9 --print t"), "");
}

}  // namespace
}  // namespace achilles
