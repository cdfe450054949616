#include "figure/publication.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "figure/layout.hpp"
#include "render/samples.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

// Every letter as wide as half its size.
float half(const std::string& label, float size) { return 0.5F * size * static_cast<float>(label.size()); }

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

TEST_F(Publication, stacked_panels_show_a_shared_axis_once) {
    const ViewDescription x = view("x", "t", {"x"}), y = view("y", "t", {"y"}), path = view("path", "x", {"y"});
    const Figure stack = of({x, y, x});
    EXPECT_EQ(stack.columns, 1);
    EXPECT_FALSE(stack.panels[0].x.labelled);
    EXPECT_FALSE(stack.panels[1].x.labelled);
    EXPECT_TRUE(stack.panels[2].x.labelled);
    for (const Panel& panel : stack.panels) {
        EXPECT_EQ(panel.x.low, 0.0);
        EXPECT_EQ(panel.x.high, 20.0);
    }
    const Figure grid = of({x, y, x, path});
    EXPECT_EQ(grid.columns, 2);
    for (const Panel& panel : grid.panels) EXPECT_TRUE(panel.x.labelled);
    const Figure even = of({x, y, y, x});
    EXPECT_FALSE(even.panels[0].x.labelled || even.panels[1].x.labelled);
    EXPECT_TRUE(even.panels[2].x.labelled && even.panels[3].x.labelled);
}

TEST_F(Publication, panels_have_letters_and_a_lone_one_has_none) {
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

TEST_F(Publication, the_legend_tells_what_occurs_and_nothing_else) {
    const ViewDescription y = view("height", "t", {"y"});
    std::string labels;
    for (const Key& key : of({y}).keys) labels += key.label + "|";
    EXPECT_EQ(labels, "hybrid|constrained|impact|Zeno point, 𝜏_{∞}|release|");
    achilles::Run before = model->default_run();
    before.options.end_time = 1.0;
    trajectory = simulate(model, before);
    ASSERT_EQ(of({y}).keys.size(), 1u);
    EXPECT_EQ(of({y}).keys[0].label, "hybrid");
}

// The sheet is checked, not a picture: no sign or label of a legend inside a plot area.
TEST_F(Publication, no_legend_covers_data) {
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
        labels += words->label == "𝑥\u0307" || words->label == "𝑦\u0307" || words->label == "hybrid" ? 1 : 0;
    }
    EXPECT_EQ(labels, 3);
}

// Limits are those of the data: a legend above the panel needs no room in it.
TEST_F(Publication, several_curves_fill_their_panel) {
    const Panel panel = of({view("all", "t", {"x", "y", "x'", "y'", "gap"})}).panels[0];
    EXPECT_TRUE(panel.legend);
    double most = 0.0;
    for (const Curve& curve : panel.curves)
        for (const Point& p : curve.points) most = std::max(most, std::isnan(p.y) ? 0.0 : p.y);
    EXPECT_GT(panel.y.high, most);
    EXPECT_LT(panel.y.high, 1.15 * most);
}

// A long title stands above a legend that leaves no room beside it, a short one in its line.
TEST_F(Publication, titles_and_legends_do_not_overlap) {
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

TEST_F(Publication, a_transparent_figure_has_no_background) {
    const std::vector<ViewDescription> views{view("height", "t", {"y"})};
    const Figure figure = publication(trajectory, views, {0, true});
    EXPECT_EQ(figure.background.a, 0);
    for (const auto& item : layout(figure, half, {0, 0, 900, 700}, 1.0)) {
        const auto* fill = std::get_if<Fill>(&item);
        EXPECT_LT(fill == nullptr ? 0.0F : fill->area.width * fill->area.height, 2000.0F);
    }
}

TEST_F(Publication, as_text_tells_its_keys_and_shared_axes) {
    const ViewDescription y = view("height", "t", {"y"});
    const std::string text = to_text(of({y, view("rates", "t", {"x'", "y'"})}));
    EXPECT_NE(text.find("key \"release\"\n"), std::string::npos) << text;
    EXPECT_NE(text.find("x \"𝑡 (s)\" [0, 20] labelled below: 0 5"), std::string::npos) << text;
    EXPECT_NE(text.find("panel \"(b)\u00A0\u00A0rates\" legend above\n"), std::string::npos) << text;
}

TEST_F(Publication, a_small_one_shows_its_data_rather_than_its_legend) {
    const Figure figure = of({view("height", "t", {"y"})});
    const auto holds = [&](float width, float height, const std::string& label) {
        bool found = false;
        for (const auto& item : layout(figure, half, {0, 0, width, height}, 1.0))
            if (const auto* words = std::get_if<TextRun>(&item)) found = found || words->label == label;
        return found;
    };
    EXPECT_TRUE(holds(600, 400, "constrained"));
    EXPECT_FALSE(holds(200, 150, "constrained"));
    EXPECT_TRUE(holds(200, 150, "2"));
}

// Full size, the size of indices, and only then any other: letters that are stretched look pale in pixels.
TEST(Layout, labels_are_of_sizes_that_have_letters) {
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

TEST(Layout, ticks_without_labels_go_before_they_are_a_comb) {
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
    EXPECT_EQ(ticks_in(600), 9);  // 0, 5, ... 20 and what is between
    EXPECT_EQ(ticks_in(90), 5);
}

}  // namespace
}  // namespace achilles
