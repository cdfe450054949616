#include "figure/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/systems.hpp"
#include "figure/axes.hpp"
#include "figure/grid.hpp"
#include "figure/palette.hpp"
#include "figure/publication.hpp"
#include "render/samples.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using samples::half;

// Paths with equal axes must not leave wide margins: in every figure of the gallery the panels fill their cells.
// Exceptions are single paths in a last row that would take more than its share of the height, and a round path beside
// which panels with bars would be too low.
TEST(Layout, PathsFillTheirPlace) {
    const std::set<std::string> is_less{"arm_at_wall", "ball_in_gusts", "cart_between_walls", "ball_round_post"};
    for (const std::string& name : test::all_systems()) {
        const auto system = test::load(name);
        auto views = system->description().views;
        std::stable_partition(views.begin(), views.end(), [](const ViewDescription& v) { return v.x.text == "t"; });
        const Figure figure = publication(simulate(system, system->default_run()), views, {});
        const auto plots = plot_areas(figure, half, {0, 0, 1200, 800}, publication_scale);
        const auto area = [](const Rectangle& r) { return double{r.width} * double{r.height}; };
        for (std::size_t i = 0; i < plots.size(); ++i) {
            const Rectangle& a = plots[i].plot;
            EXPECT_GT(area(a), (is_less.contains(name) ? 0.49 : 0.6) * area(plots[i].place))
                << name << " " << figure.panels[i].title;
            EXPECT_TRUE(a.x > 0 && a.y > 0 && a.x + a.width < 1200 && a.y + a.height < 800) << name;
            for (std::size_t j = 0; j < i; ++j) {
                const Rectangle& b = plots[j].plot;
                EXPECT_TRUE(a.x > b.x + b.width + 20 || b.x > a.x + a.width + 20 || a.y > b.y + b.height + 20 ||
                            b.y > a.y + a.height + 20)
                    << name << i << j;
            }
        }
    }
}

// The path comes first, beside two rows. The other panels keep their order and share their axis as usual.
TEST(Layout, ARoundPathStandsBesideTwoRows) {
    const auto system = test::load("bead_in_ring");
    const Trajectory run = simulate(system, system->default_run());
    auto views = system->description().views;
    std::rotate(views.begin(), views.begin() + 1, views.end());  // the path is the last one
    const Figure figure = publication(run, views, {});
    EXPECT_EQ(figure.panels[0].title, "(a)\u00A0\u00A0path");
    EXPECT_EQ(figure.panels[0].rows, 2);
    EXPECT_EQ(figure.panels[1].title, "(b)\u00A0\u00A0gap");
    const bool labeled[] = {true, false, false, true, true};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(figure.panels[i].x.labeled, labeled[i]) << i;
    const auto plots = plot_areas(figure, half, {0, 0, 1200, 800}, publication_scale);
    const Rectangle &path = plots[0].plot, &gap = plots[1].plot, &force = plots[3].plot;
    EXPECT_LE(path.y + path.height + 40, force.y);  // its own axis is above the next panel
    EXPECT_EQ(path.x, force.x);
    EXPECT_EQ(path.y, gap.y);
    EXPECT_EQ(force.y, plots[4].plot.y);
    EXPECT_EQ(gap.x, plots[2].plot.x);
    EXPECT_GT(path.height, 1.8F * gap.height);
    EXPECT_NEAR(path.width / path.height, shape_of(figure.panels[0]), 0.01);
    // With the order of the command line, or a given number of columns, the panels keep their places.
    PublicationStyle ordered, by_hand;
    ordered.ordered = true;
    by_hand.columns = 2;
    EXPECT_EQ(publication(run, views, ordered).panels[4].title, "(e)\u00A0\u00A0path");
    EXPECT_EQ(publication(run, views, by_hand).panels[4].rows, 1);
    // A long and low path keeps a row of its own, which is higher; a high and narrow one gets a column.
    const auto of_system = [](const std::string& name) {
        const auto other = test::load(name);
        return publication(simulate(other, other->default_run()), other->description().views, {});
    };
    EXPECT_EQ(of_system("falling_rod").panels[0].rows, 4);
    EXPECT_EQ(of_system("ball_on_sine").panels[3].rows, 1);
    EXPECT_EQ(of_system("ball_on_hills").panels[0].rows, 1);
}

// A marker at the very end of an axis is drawn entirely, for any width of the picture.
TEST(Layout, MarkersOnTheRimAreDrawn) {
    Figure figure;
    Panel& panel = figure.panels.emplace_back();
    panel.x.low = 0.1, panel.x.high = 20.3;
    panel.y.low = -0.3, panel.y.high = 0.7;
    panel.equal_axes = true;
    Markers& markers = panel.markers.emplace_back();
    markers.points = {{0.1, -0.3}, {20.3, -0.3}, {0.1, 0.7}, {20.3, 0.7}};
    for (float width = 300.0F; width < 400.0F; width += 1.0F) {
        int marks = 0;
        for (const auto& item : layout(figure, half, {0, 0, width, 300}, 1.0))
            marks += std::holds_alternative<Mark>(item) ? 1 : 0;
        EXPECT_EQ(marks, 4) << width;
    }
}

// Within the distance of event markers one is drawn: the largest.
TEST(Layout, CrowdedEventsShareAMarker) {
    Figure figure;
    Panel& panel = figure.panels.emplace_back();
    panel.x.low = 0.0, panel.x.high = 1.0, panel.y.low = -1.0, panel.y.high = 1.0;
    for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release})
        panel.markers.push_back(event_markers(light_theme(), kind));
    for (int i = 0; i < 60; ++i) panel.markers[0].points.push_back({0.5 - 0.4 * std::pow(0.8, i), 0.0});
    panel.markers[1].points = {{0.5, 0.0}};
    panel.markers[2].points = {{0.502, 0.0}, {0.9, 0.0}};
    for (const double scale : {1.0, 2.0}) {
        std::vector<Mark> marks;
        for (const auto& item : layout(figure, half, {0, 0, 600, 400}, scale))
            if (const auto* mark = std::get_if<Mark>(&item)) marks.push_back(*mark);
        double nearest = 1e9;
        int diamonds = 0, triangles = 0;
        for (std::size_t i = 0; i < marks.size(); ++i) {
            diamonds += marks[i].shape == Markers::MarkerShape::diamond ? 1 : 0;
            triangles += marks[i].shape == Markers::MarkerShape::triangle ? 1 : 0;
            for (std::size_t j = 0; j < i; ++j)
                nearest = std::min(nearest, std::hypot(marks[i].at.x - marks[j].at.x, marks[i].at.y - marks[j].at.y));
        }
        EXPECT_GE(nearest, event_marker_distance * scale);
        EXPECT_LT(nearest, 3.0 * event_marker_distance * scale) << "more are drawn where there is room";
        EXPECT_EQ(diamonds, 1) << "the Zeno point, not its release";
        EXPECT_EQ(triangles, 1);
        EXPECT_GT(marks.size(), 8u);
    }
}

// Full size, then the size of subscripts, and only then any other size: scaled glyphs look pale.
TEST(Layout, LabelsAreOfSizesThatHaveLetters) {
    const auto size_of = [](const std::string& label) {
        Figure figure;
        figure.panels.push_back(samples::corners(""));
        figure.panels[0].x.label = label;
        for (const auto& item : layout(figure, half, {0, 0, 400, 400}, 1.0))
            if (const auto* words = std::get_if<TextRun>(&item); words != nullptr && words->label == label)
                return words->size;
        return 0.0F;
    };
    EXPECT_EQ(size_of(std::string(50, 'x')), 14.0F);  // 350 px
    EXPECT_EQ(size_of(std::string(60, 'x')), 10.0F);
    EXPECT_EQ(size_of(std::string(75, 'x')), 10.0F);
    const float least = size_of(std::string(90, 'x'));
    EXPECT_LT(least, 10.0F);
    EXPECT_GE(least, 7.0F);
}

// A word longer than the plot is shortened if it cannot be smaller, and stays on the page.
TEST(Layout, LabelsOfOneLongWordStayOnThePage) {
    Figure figure;
    figure.smallest_text = 0.9;
    figure.panels.push_back(samples::corners(""));
    figure.panels[0].y.label = std::string(90, 'x') + " (m)";
    int labels = 0;
    for (const auto& item : layout(figure, half, {0, 0, 400, 400}, 1.0)) {
        const auto* words = std::get_if<TextRun>(&item);
        if (words == nullptr || !words->upwards) continue;
        ++labels;
        EXPECT_TRUE(words->label.ends_with("x\u2026 (m)")) << words->label;
        EXPECT_GE(words->y - 0.5F * half(words->label, words->size), 0.0F);
    }
    EXPECT_EQ(labels, 1);
}

// The labels on an axis of `height` pixels.
std::vector<std::string> numbers_at(float height, bool bars = false) {
    Figure figure;
    Panel& panel = figure.panels.emplace_back();
    set_ticks(panel.y, -0.4, 0.4, 0.0);
    if (bars) panel.time_bars = {{"knee", {}}, {"foot", {}}};
    const Sheet sheet = layout(figure, half, {0, 0, 400, height}, 1.0);
    std::vector<std::string> numbers;
    for (const auto& item : sheet)
        if (const auto* words = std::get_if<TextRun>(&item); words != nullptr && words->anchor == 1.0F)
            numbers.push_back(words->label);
    return numbers;
}

// A single label does not define a scale.
TEST(Layout, AnAxisHasTwoNumbersWhereThereIsRoomForTwo) {
    for (float height = 80.0F; height < 200.0F; height += 1.0F) EXPECT_GE(numbers_at(height).size(), 2U) << height;
}

// The lowest label on the axis does not touch the first name below it.
TEST(Layout, NumbersStandAboveTheNamesOfTimeBars) {
    for (float height = 120.0F; height < 300.0F; height += 1.0F) {
        const std::vector<std::string> numbers = numbers_at(height, true);
        EXPECT_EQ(std::count(numbers.begin(), numbers.end(), "\u22120.4"), 0) << height;
        EXPECT_EQ(std::count(numbers.begin(), numbers.end(), "knee"), 1) << height;
    }
}

TEST(Layout, LongNamesOfTimeBarsLeaveThePlotItsRoom) {
    Figure figure;
    Panel& panel = figure.panels.emplace_back();
    panel.time_bars = {{std::string(40, 'x'), {}}, {"foot", {}}};
    EXPECT_GT(plot_areas(figure, half, {0, 0, 400, 300}, 1.0)[0].plot.width, 250.0F);
}

TEST(Layout, TicksWithoutLabelsGoBeforeTheyAreAComb) {
    const auto ticks_in = [](float width) {
        Figure figure;
        figure.panels.push_back(samples::corners(""));
        figure.panels[0].y.ticks.clear();
        int ticks = 0;
        for (const auto& item : layout(figure, half, {0, 0, width, 400}, 1.0)) {
            const auto* fill = std::get_if<Fill>(&item);
            ticks += fill != nullptr && (fill->area.height == 3.0F || fill->area.height == 5.0F) ? 1 : 0;
        }
        return ticks;
    };
    EXPECT_EQ(ticks_in(600), 9);  // 0, 5, ... 20, and minor ticks
    EXPECT_EQ(ticks_in(90), 5);
}

}  // namespace
}  // namespace achilles
