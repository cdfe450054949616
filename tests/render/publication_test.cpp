#include "figure/publication.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/systems.hpp"
#include "figure/layout.hpp"
#include "render/samples.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using samples::half;

ViewDescription view(const std::string& name, const std::string& x, const std::vector<std::string>& ys) {
    ViewDescription result;
    result.name = name;
    result.x.text = x;
    for (const std::string& y : ys) result.y.emplace_back().text = y;
    return result;
}

class Publication : public testing::Test {
 protected:
    Publication() : model(test::load("ball_on_sine")), trajectory(simulate(model, model->default_run())) {}
    Figure of(const std::vector<ViewDescription>& views, int columns = 0) const {
        return publication(trajectory, views, {columns, false});
    }
    std::shared_ptr<const Model> model;
    Trajectory trajectory;
};

TEST_F(Publication, StackedPanelsShowASharedAxisOnce) {
    const ViewDescription x = view("x", "t", {"x"}), y = view("y", "t", {"y"}), path = view("path", "x", {"y"});
    const Figure stack = of({x, y, x});
    EXPECT_EQ(stack.columns, 1);
    EXPECT_FALSE(stack.panels[0].x.labeled);
    EXPECT_FALSE(stack.panels[1].x.labeled);
    EXPECT_TRUE(stack.panels[2].x.labeled);
    for (const Panel& panel : stack.panels) {
        EXPECT_EQ(panel.x.low, 0.0);
        EXPECT_EQ(panel.x.high, 20.0);
    }
    const Figure grid = of({x, y, x, path});
    EXPECT_EQ(grid.columns, 2);
    for (const Panel& panel : grid.panels) EXPECT_TRUE(panel.x.labeled);
    const Figure even = of({x, y, y, x});
    EXPECT_FALSE(even.panels[0].x.labeled || even.panels[1].x.labeled);
    EXPECT_TRUE(even.panels[2].x.labeled && even.panels[3].x.labeled);
}

TEST_F(Publication, PanelsHaveLettersAndALoneOneHasNone) {
    const ViewDescription y = view("height", "t", {"y"});
    EXPECT_EQ(of({y}).panels[0].title, "");
    std::vector<ViewDescription> many(28, y);
    const Figure figure = of(many);
    EXPECT_EQ(figure.panels[0].title, "(a)\u00A0\u00A0height");
    EXPECT_EQ(figure.panels[25].title, "(z)\u00A0\u00A0height");
    EXPECT_EQ(figure.panels[26].title, "(aa)\u00A0\u00A0height");
    EXPECT_EQ(figure.columns, 3);
    EXPECT_EQ(of(many, 4).columns, 4);
}

// The square of a collapse is hollow, and that of an impact has no edge in print. Both are seen on paper.
TEST_F(Publication, TheSquaresOfImpactsAndCollapsesAreSeen) {
    const auto balls = test::load("three_balls");
    const Trajectory collapse = simulate(balls, balls->default_run());
    const Figure figure = publication(collapse, std::vector{view("balls", "t", {"x1"})}, {});
    int impacts = 0, collapses = 0;
    const auto look = [&](const Markers& markers) {
        if (markers.shape != Markers::MarkerShape::square) return;
        const bool is_hollow = markers.fill == figure.background;
        ++(is_hollow ? collapses : impacts);
        EXPECT_EQ(markers.edge.a, is_hollow ? 255 : 0);
        EXPECT_TRUE(!is_hollow || !(markers.edge == figure.background));
    };
    for (const Markers& markers : figure.panels[0].markers) look(markers);
    EXPECT_EQ(impacts, 1);
    EXPECT_EQ(collapses, 1);
    for (const Key& key : figure.keys)
        if (const auto* const markers = std::get_if<Markers>(&key.sign)) look(*markers);
    EXPECT_EQ(impacts, 2);
    EXPECT_EQ(collapses, 2);
}

TEST_F(Publication, TheLegendTellsWhatOccursAndNothingElse) {
    const ViewDescription y = view("height", "t", {"y"});
    std::string labels;
    for (const Key& key : of({y}).keys) labels += key.label + "|";
    EXPECT_EQ(labels, "in flight|in contact|impact|Zeno point, 𝜏_{∞}|release|");
    achilles::Run before = model->default_run();
    before.options.end_time = 1.0;
    trajectory = simulate(model, before);
    ASSERT_EQ(of({y}).keys.size(), 1u);
    EXPECT_EQ(of({y}).keys[0].label, "in flight");
}

// At restitution 0 there are no bounces: no legend mentions a Zeno point.
TEST_F(Publication, APlasticLandingIsCalledALanding) {
    const ViewDescription y = view("height", "t", {"y", "x"});
    achilles::Run plastic = model->default_run();
    assign(plastic, model->description(), "e=0");
    const Trajectory bouncing = trajectory;
    trajectory = simulate(model, plastic);
    const auto has = [](const Figure& figure, const std::string& label) {
        return std::any_of(figure.keys.begin(), figure.keys.end(), [&](const Key& key) { return key.label == label; });
    };
    EXPECT_TRUE(has(of({y}), "landing"));
    EXPECT_EQ(to_text(of({y})).find("Zeno"), std::string::npos);
    const auto samples = plot_samples(trajectory);
    const Panel on_screen = compose(trajectory, samples, PreparedView(*model, y), light_theme());
    EXPECT_EQ(on_screen.markers[1].label, "landing");
    Figure both;
    const Trajectory* const runs[] = {&bouncing, &trajectory};
    apply_print_style(both, runs);
    EXPECT_TRUE(has(both, "Zeno point, 𝜏_{∞}, landing"));
}

// Checked in the sheet instead of a picture: no symbol or label of a legend is inside a plot area.
TEST_F(Publication, NoLegendCoversData) {
    const Figure figure = of({view("rates", "t", {"x'", "y'"}), view("height", "t", {"y"})});
    EXPECT_TRUE(figure.panels[0].legend && figure.panels[0].legend_above);
    const Sheet sheet = layout(figure, half, {0, 0, 900, 700}, 1.0);
    std::vector<Rectangle> plots;
    for (const auto& item : sheet)
        if (const auto* path = std::get_if<Path>(&item); path != nullptr && path->points.size() > 2)
            plots.push_back(path->clip);
    ASSERT_GE(plots.size(), 4u);
    int labels = 0;
    for (const auto& item : sheet) {
        const auto* words = std::get_if<TextRun>(&item);
        if (words == nullptr || words->upwards) continue;
        for (const Rectangle& plot : plots)
            EXPECT_FALSE(words->x > plot.x && words->x < plot.x + plot.width && words->y + words->size > plot.y &&
                         words->y < plot.y + plot.height)
                << words->label;
        labels += words->label == "𝑥\u0307" || words->label == "𝑦\u0307" || words->label == "in flight" ? 1 : 0;
    }
    EXPECT_EQ(labels, 3);
}

// Limits follow the data, because a legend above the panel needs no space in it.
TEST_F(Publication, SeveralCurvesFillTheirPanel) {
    const Panel panel = of({view("all", "t", {"x", "y", "x'", "y'", "gap"})}).panels[0];
    EXPECT_TRUE(panel.legend);
    double most = 0.0;
    for (const Curve& curve : panel.curves)
        for (const Point& p : curve.points) most = std::max(most, std::isnan(p.y) ? 0.0 : p.y);
    EXPECT_GT(panel.y.high, most);
    EXPECT_LT(panel.y.high, 1.15 * most);
}

// Circles are round: units have equal length on both axes, in the drawn sheet.
TEST_F(Publication, AxesOfOneUnitAreEquallyLong) {
    const auto lengths = [](const Figure& figure) {
        const Panel& panel = figure.panels[0];
        Rectangle clip;
        for (const auto& item : layout(figure, half, {0, 0, 900, 700}, 1.0))
            if (const auto* path = std::get_if<Path>(&item); path != nullptr && path->points.size() > 100)
                clip = path->clip;
        return std::array{clip.width / (panel.x.high - panel.x.low), clip.height / (panel.y.high - panel.y.low)};
    };
    for (const char* name : {"bead_in_ring", "ball_on_cylinder", "cart_pendulum", "ball_on_sine"}) {
        const auto system = test::load(name);
        const auto& views = system->description().views;
        const auto path = std::find_if(views.begin(), views.end(), [](const auto& v) { return v.x.text != "t"; });
        const auto [x, y] = lengths(publication(simulate(system, system->default_run()), {{*path}}, {}));
        EXPECT_NEAR(x / y, 1.0, 0.02) << name;
    }
    EXPECT_TRUE(of({view("path", "x", {"y"})}).panels[0].equal_axes);
    EXPECT_FALSE(of({view("phase plane", "x", {"x'"})}).panels[0].equal_axes);
    EXPECT_FALSE(of({view("height", "t", {"y"})}).panels[0].equal_axes);
    // The whole length is shown, and the height is readable: the limits are widened.
    const Panel panel = of({view("path", "x", {"y"})}).panels[0];
    EXPECT_GE(panel.y.high - panel.y.low, 0.29 * (panel.x.high - panel.x.low));
}

// A path shows h = 0: in the plane of coordinates, and for the path of a mechanism's point.
TEST_F(Publication, APathShowsTheBoundary) {
    const auto of_path = [](const std::string& name) {
        const auto system = test::load(name);
        const auto& views = system->description().views;
        const auto path = std::find_if(views.begin(), views.end(), [](const auto& v) { return v.x.text != "t"; });
        return publication(simulate(system, system->default_run()), {{*path}}, {}).panels[0];
    };
    const Panel ball = of_path("ball_on_sine"), bead = of_path("bead_in_ring");
    EXPECT_GT(ball.boundary.points.size(), 300u);
    for (const Point& p : ball.boundary.points)
        EXPECT_TRUE(std::isnan(p.x) || std::abs(p.y - std::sin(p.x)) < 2e-3) << p.x;
    double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
    for (const Point& p : bead.boundary.points) {
        if (!std::isfinite(p.x)) continue;
        EXPECT_NEAR(std::hypot(p.x, p.y), 0.5, 1e-9);
        left = std::min(left, p.x), right = std::max(right, p.x);
        bottom = std::min(bottom, p.y), top = std::max(top, p.y);
    }
    EXPECT_TRUE(left < -0.49 && right > 0.49 && bottom < -0.49 && top > 0.49);
    // The whole ring is visible; of a longer line, only what the path needs.
    EXPECT_TRUE(bead.x.low < left && bead.x.high > right && bead.y.low < bottom && bead.y.high > top);
    EXPECT_LT(of_path("ball_on_cylinder").x.high, 1.5);
    EXPECT_TRUE(of_path("ball_on_egg_crate").boundary.points.empty());  // h also depends on the height
    EXPECT_TRUE(of_path("double_pendulum").boundary.points.empty());    // a phase plane
    EXPECT_TRUE(of({view("x", "t", {"x"})}).panels[0].boundary.points.empty());
    const auto keys = of({view("path", "x", {"y"})}).keys;
    EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [](const Key& key) { return key.label == "ℎ = 0"; }));
}

TEST_F(Publication, AxesSayTheirUnits) {
    const auto label = [&](const std::vector<std::string>& ys) { return of({view("", "t", ys)}).panels[0].y.label; };
    EXPECT_EQ(label({"gap"}), "ℎ (m)");
    EXPECT_EQ(label({"gap'"}), "ℎ\u0307 (m/s)");
    EXPECT_EQ(label({"lambda"}), "𝜆 (N)");
    EXPECT_EQ(label({"energy"}), "energy (J)");
    EXPECT_EQ(label({"sqrt(x'^2 + y'^2)"}), "sqrt(𝑥\u0307² + 𝑦\u0307²) (m/s)");
    EXPECT_EQ(label({"x", "y"}), "𝑥, 𝑦 (m)");
    EXPECT_EQ(label({"x", "y'"}), "𝑥, 𝑦\u0307");
    EXPECT_EQ(of({view("", "t", {"x", "y'"})}).panels[0].curves[2].label, "𝑦\u0307 (m/s)");
    EXPECT_EQ(label({"x", "y", "gap", "sin(x)*y"}), "m");
    ViewDescription own = view("speed", "t", {"sqrt(x'^2 + y'^2)"});
    own.label = "speed";
    EXPECT_EQ(of({own}).panels[0].y.label, "speed (m/s)");
    own.unit = "km/s";
    EXPECT_EQ(of({own}).panels[0].y.label, "speed (km/s)");
    own.y = {own.y[0], own.y[0]};
    own.unit = "";
    EXPECT_EQ(of({own}).panels[0].y.label, "speed (m/s)");
}

// Also for plots arranged by the user.
TEST_F(Publication, ALegendAboveNeedsNoRoomInThePanel) {
    const PreparedView rates(*model, view("rates", "t", {"x'", "y'"}));
    Framing screen, print;
    screen.legend = false;
    print.for_print = true;
    const auto samples = plot_samples(trajectory);
    const Panel a = compose(trajectory, samples, rates, light_theme(), screen);
    const Panel b = compose(trajectory, samples, rates, light_theme(), print);
    EXPECT_TRUE(b.legend && b.legend_above && !a.legend);
    EXPECT_EQ(a.y.high, b.y.high);
}

// A last row that is not full has no gap: its panels are wider and end where the others do.
TEST_F(Publication, ALastRowFillsItsWidth) {
    const ViewDescription y = view("height", "t", {"y"}), x = view("x", "t", {"x"});
    const auto clips = [&](std::size_t panels, int columns) {
        std::vector<Rectangle> found;
        for (const auto& item :
             layout(of(std::vector<ViewDescription>(panels, y), columns), half, {0, 0, 1200, 900}, 1.0)) {
            const auto* path = std::get_if<Path>(&item);
            if (path == nullptr || path->points.size() < 100) continue;
            if (found.empty() || found.back().x != path->clip.x || found.back().y != path->clip.y)
                found.push_back(path->clip);
        }
        return found;
    };
    for (const auto& [panels, columns] : {std::pair{5, 2}, {3, 2}, {7, 3}, {8, 3}}) {
        const auto all = clips(static_cast<std::size_t>(panels), columns);
        ASSERT_EQ(all.size(), static_cast<std::size_t>(panels));
        const Rectangle &first = all.front(), &last = all.back(), &corner = all[static_cast<std::size_t>(columns) - 1];
        EXPECT_NEAR(last.x + last.width, corner.x + corner.width, 1.5) << panels << " " << columns;
        EXPECT_EQ(all[static_cast<std::size_t>(panels - panels % columns)].x, first.x);
        EXPECT_GT(last.width, first.width);
        for (std::size_t i = 1; i < all.size(); ++i)
            EXPECT_TRUE(all[i].y != all[i - 1].y || all[i].x > all[i - 1].x + all[i - 1].width + 20.0F);
    }
}

// Impacts before a Zeno point are drawn individually while they are far enough apart, on each of several curves.
TEST_F(Publication, ImpactsThatCrowdThinOut) {
    for (const auto& ys : {std::vector<std::string>{"y"}, {"y", "x'"}}) {
        const Figure figure = of({view("", "t", ys)});
        const Color fill = figure.panels[0].markers[0].fill;
        std::vector<Point> squares;
        for (const auto& item : layout(figure, half, {0, 0, 1200, 800}, 1.4))
            if (const auto* mark = std::get_if<Mark>(&item); mark != nullptr &&
                                                             mark->shape == Markers::MarkerShape::square &&
                                                             mark->fill == fill && mark->at.y > 60.0)
                squares.push_back(mark->at);
        EXPECT_GT(squares.size(), 5u * ys.size());
        EXPECT_LT(squares.size(), figure.panels[0].markers[0].points.size());
        double nearest = 1e9;
        for (std::size_t i = 0; i < squares.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                nearest = std::min(nearest, std::hypot(squares[i].x - squares[j].x, squares[i].y - squares[j].y));
        EXPECT_GT(nearest, 5.5 * 1.4);  // minimum distance: the width of a marker, pixels
    }
}

// A second lap of dashes over the first would look solid.
TEST_F(Publication, WhatIsRetracedIsDrawnOnce) {
    const auto system = test::typed(
        "title = \"lap\"\n[[coordinate]]\nname = \"x\"\nstart = 1\n[[coordinate]]\nname = \"y\"\nrate = 1\n"
        "[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"(x^2 + y^2)/2\"\n"
        "[[constraint]]\ngap = \"x + 9\"\nrestitution = 0.5\n[run]\nend_time = 62.0\n");
    const Figure figure = publication(simulate(system, system->default_run()), {{view("", "x", {"y"})}}, {});
    double length = 0.0;
    const auto& points = figure.panels[0].curves[0].points;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step = std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
        length += std::isfinite(step) ? step : 0.0;
    }
    EXPECT_NEAR(length, 2.0 * 3.14159265, 0.1);
}

// A path continues where it crosses itself.
TEST_F(Publication, CrossingsAreNotRetraced) {
    const auto system = test::typed(
        "title = \"eight\"\n[[coordinate]]\nname = \"x\"\nrate = 1\n[[coordinate]]\nname = \"y\"\nrate = 2\n"
        "[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"(x^2 + 4*y^2)/2\"\n"
        "[[constraint]]\ngap = \"x + 9\"\nrestitution = 0.5\n[run]\nend_time = 6.28\n");
    const Figure figure = publication(simulate(system, system->default_run()), {{view("", "x", {"y"})}}, {});
    for (const Point& p : figure.panels[0].curves[0].points) EXPECT_TRUE(std::isfinite(p.x));
}

// A long title is above the legend if there is no space beside it; a short one is on the same line.
TEST_F(Publication, TitlesAndLegendsDoNotOverlap) {
    for (const char* name : {"rates", "the rates of both coordinates of the ball, each in a colour of its own"}) {
        const Sheet sheet =
            layout(of({view(name, "t", {"x'", "y'"}), view("b", "t", {"y"})}), half, {0, 0, 700, 700}, 1.0);
        const auto find = [&](const std::string& label) {
            for (const auto& item : sheet)
                if (const auto* words = std::get_if<TextRun>(&item); words != nullptr && words->label == label)
                    return *words;
            ADD_FAILURE() << label;
            return TextRun{};
        };
        const TextRun title = find("(a)\u00A0\u00A0" + std::string(name)), key = find("𝑥\u0307");
        const bool apart = title.x + half(title.label, title.size) <= key.x || title.y + title.size <= key.y;
        EXPECT_TRUE(apart) << name;
        EXPECT_GE(title.y, 0.0F);
    }
}

TEST_F(Publication, ATransparentFigureHasNoBackground) {
    const std::vector<ViewDescription> views{view("height", "t", {"y"})};
    const Figure figure = publication(trajectory, views, {0, true});
    EXPECT_EQ(figure.background.a, 0);
    for (const auto& item : layout(figure, half, {0, 0, 900, 700}, 1.0)) {
        const auto* fill = std::get_if<Fill>(&item);
        EXPECT_LT(fill == nullptr ? 0.0F : fill->area.width * fill->area.height, 2000.0F);
    }
}

TEST_F(Publication, AsTextTellsItsKeysAndSharedAxes) {
    const ViewDescription y = view("height", "t", {"y"});
    const std::string text = to_text(of({y, view("rates", "t", {"x'", "y'"})}));
    EXPECT_NE(text.find("key \"release\"\n"), std::string::npos) << text;
    EXPECT_NE(text.find("x \"𝑡 (s)\" [0, 20] labelled below: 0 5"), std::string::npos) << text;
    EXPECT_NE(text.find("panel \"(b)\u00A0\u00A0rates\" legend above\n"), std::string::npos) << text;
}

TEST_F(Publication, ASmallOneShowsItsDataRatherThanItsLegend) {
    const Figure figure = of({view("height", "t", {"y"})});
    const auto holds = [&](float width, float height, const std::string& label) {
        bool found = false;
        for (const auto& item : layout(figure, half, {0, 0, width, height}, 1.0))
            if (const auto* words = std::get_if<TextRun>(&item)) found = found || words->label == label;
        return found;
    };
    EXPECT_TRUE(holds(600, 400, "in contact"));
    EXPECT_FALSE(holds(200, 150, "in contact"));
    EXPECT_TRUE(holds(200, 150, "2"));
}

// On a page, 1200 pixels are 170 mm: all text at --scale 1 has at least 7 points, except subscripts.
TEST_F(Publication, TextIsNeverTooSmallToBePrinted) {
    ViewDescription long_one = view("a view whose name is much longer than the panel that it stands above, twice", "t",
                                    {"sqrt(x'^2 + y'^2)*sqrt(x'^2 + y'^2) + x'*y' + x'*x' + y'*y'"});
    const ViewDescription two = view("rates", "t", {"x'", "y'"});
    std::string words;
    for (const int columns : {1, 2, 3}) {
        const Figure figure = of({long_one, two, long_one, two, long_one, long_one, two}, columns);
        for (const auto& item : layout(figure, half, {0, 0, 1200, 800}, publication_scale)) {
            const auto* run = std::get_if<TextRun>(&item);
            if (run == nullptr) continue;
            EXPECT_GE(run->size * 170.0 / 25.4 * 72.0 / 1200.0, 7.0) << run->label;
            words += run->label + "|";
        }
    }
    EXPECT_NE(words.find("\u2026 (m²/s²)|"), std::string::npos) << words;  // shortened, with its unit
}

}  // namespace
}  // namespace achilles
