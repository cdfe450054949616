// The plots of the explorer: commands and zooming with the mouse.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/hands.hpp"
#include "image/comparison.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

void apply(Session& session, std::initializer_list<const char*> lines) {
    for (const char* line : lines) session.apply(parse_command(line));
}

const Framing& framing(const Session& session, std::size_t plot) { return session.plotted().list()[plot].framing; }

TEST(Plots, ShowTheViewsOfTheFileFirst) {
    const Session session = test::session("ball_on_sine");
    const auto& views = session.description().views;
    ASSERT_EQ(session.plotted().list().size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(session.plotted().list()[i].view.name, views[i].name);
    EXPECT_EQ(session.plots().size(), 4U);
}

// `gap` is valid for a single constraint. With several, the generic views refer to each contact, and every offered view
// can be shown.
TEST(Plots, FillEveryPlaceWithSeveralContacts) {
    Session session = test::session("../../tests/reference/gaps/pendulum_two_stops");
    std::string text = session.document().text;
    const std::size_t first = text.find("[[view]]");
    text.erase(std::min(first, text.size()));
    for (const char* y : {"t", "2*t", "3*t"})
        text += fmt::format("[[view]]\nname = \"{0}\"\nx = \"t\"\ny = [\"{0}\"]\n", y);
    session.apply(command::SetText{text});
    ASSERT_TRUE(session.document().problems.empty());
    ASSERT_EQ(session.plotted().list().size(), 4U);
    EXPECT_EQ(session.plotted().list()[3].view.name, "gap knee");
    apply(session, {"grid 4 4"});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.plotted().list().size(), 16U);
}

TEST(Plots, AnyExpressionAgainstAnyOther) {
    Session session = test::session("ball_on_sine");
    apply(session, {"plot 2 x y sin(x) gap'"});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.plots()[1].curves.size(), 6U);
    EXPECT_EQ(session.plotted().list()[1].view.name, "y, sin(x), gap' over x");
    Sample sample = session.at(1.0);
    const auto values = session.values(1, sample);
    EXPECT_NEAR(values[2], std::sin(values[0]), 1e-15);
}

TEST(Plots, AWrongExpressionChangesNothing) {
    Session session = test::session("ball_on_sine");
    const std::string before = to_text(session.plotted());
    session.apply(parse_command("plot 1 t yy"));
    EXPECT_NE(session.error().find("did you mean 'y'"), std::string::npos) << session.error();
    EXPECT_EQ(to_text(session.plotted()), before);
    for (const char* line : {"plot 9 t y", "zoom 1 2 1 0 1", "fit 0", "grid 0 1", "grid 9 9", "curve 1 2 off"}) {
        session.apply(parse_command(line));
        EXPECT_NE(session.error(), "") << line;
        EXPECT_EQ(to_text(session.plotted()), before);
    }
}

TEST(Plots, LinkedTimesMoveTogether) {
    Session session = test::session("ball_on_sine");
    apply(session, {"zoom 1 2 3 0 1"});
    for (std::size_t i = 0; i < 4; ++i) {
        const bool over_time = session.plotted().list()[i].over_time();
        EXPECT_EQ(framing(session, i).x.has_value(), over_time) << i;
        EXPECT_EQ(framing(session, i).y.has_value(), i == 0) << i;
        if (over_time) {
            EXPECT_EQ(session.plots()[i].x.low, 2.0);
        }
    }
    session.apply(parse_command("link off"));
    session.apply(parse_command("zoom 1 5 6 0 1"));
    EXPECT_EQ(session.plots()[0].x.low, 5.0);
    EXPECT_EQ(session.plots()[1].x.low, 2.0);
    session.apply(parse_command("fit 1"));
    EXPECT_EQ(session.plots()[0].x.low, 0.0);
    EXPECT_EQ(session.plots()[1].x.low, 2.0);
}

// At any zoom the curve is sampled densely and includes its impacts.
TEST(Plots, AZoomIsSampledAnew) {
    Session session = test::session("ball_on_sine");
    // Some of the last impacts before the cut: sampled as finely as the window shows them, and no finer outside.
    constexpr double low = 2.66, high = 2.72, top = 0.015;
    session.apply(parse_command(fmt::format("zoom 3 {} {} 0 {}", low, high, top)));
    const Panel& panel = session.plots()[2];
    Sampler sampler(session.trajectory());
    int chords = 0;
    for (const Curve& curve : panel.curves)
        for (std::size_t i = 1; i < curve.points.size(); ++i) {
            const Point &a = curve.points[i - 1], &b = curve.points[i];
            if (!std::isfinite(a.x) || !std::isfinite(b.x)) continue;
            EXPECT_GE(a.x, low - 1e-9);
            EXPECT_LE(b.x, high + 1e-9);
            const Sample middle = sampler.at(0.5 * (a.x + b.x));
            EXPECT_NEAR(0.5 * (a.y + b.y), middle.state.q[1] - std::sin(middle.state.q[0]), 1e-3 * top) << a.x;
            ++chords;
        }
    EXPECT_GT(chords, 30);
}

TEST(Plots, AHiddenCurveHasNoPointsAndNoLimits) {
    Session session = test::session("ball_on_sine");
    apply(session, {"plot 1 t x 100*y"});
    const double wide = session.plots()[0].y.high;
    session.apply(parse_command("curve 1 2 off"));
    EXPECT_LT(session.plots()[0].y.high, 0.2 * wide);
    EXPECT_TRUE(session.plots()[0].curves[2].points.empty());
    session.apply(parse_command("curve 1 2 on"));
    EXPECT_EQ(session.plots()[0].y.high, wide);
}

TEST(Plots, ALogarithmicAxisShowsWhatIsPositive) {
    Session session = test::session("ball_on_sine");
    apply(session, {"plot 1 t gap", "log 1 y on"});
    const Axis& y = session.plots()[0].y;
    EXPECT_TRUE(y.logarithmic);
    EXPECT_GT(y.low, 0.0);
    EXPECT_GT(y.high, 2.0);
}

TEST(Plots, ATextKeepsThemWhereItCan) {
    Session session = test::session("ball_on_sine");
    apply(session, {"grid 3 2", "plot 1 t y*g", "zoom 1 0 5 0 1"});
    const std::string before = to_text(session.plotted());
    std::string text = session.document().text;
    session.apply(command::SetText{text + "\n# a remark\n"});
    EXPECT_EQ(to_text(session.plotted()), before);
    session.apply(command::Open{"double_pendulum"});
    EXPECT_EQ(session.plotted().columns(), 2);
}

struct PlotHand : test::Hands {
    PlotHand() : Hands("ball_on_sine") {}
    const Axis& x(std::size_t plot = 1) const { return session.plots()[plot].x; }
    const Axis& y(std::size_t plot = 1) const { return session.plots()[plot].y; }
};

// In a small window names are shortened, not left out.
TEST(PlotInput, EveryCurveOfTwoIsNamedInASmallWindow) {
    test::Hands hands("ball_on_sine", test::surface(1000, 700));
    hands.session.apply(parse_command("plot 1 t energy*1.000001+y*0.0001 y*1.000001+x*0.0001"));
    ASSERT_EQ(hands.session.error(), "");
    hands.rest(3);
    EXPECT_TRUE(hands.state.places.contains("curve 1 1"));
    EXPECT_TRUE(hands.state.places.contains("curve 1 2"));
}

TEST(PlotInput, TheWheelZoomsAtThePointer) {
    PlotHand hand;
    hand.point("plot 1", 0.25);
    const double low = hand.x().low, high = hand.x().high, bottom = hand.y().low, top = hand.y().high;
    hand.hand.wheel = 1.0;
    hand.rest(1);
    hand.hand.wheel = 0.0;
    hand.rest(1);
    EXPECT_NEAR(hand.x().high - hand.x().low, 0.85 * (high - low), 1e-6);
    EXPECT_NEAR(hand.y().high - hand.y().low, 0.85 * (top - bottom), 1e-6);
    const double pointer = low + 0.25 * (high - low);
    EXPECT_NEAR((pointer - hand.x().low) / (hand.x().high - hand.x().low), 0.25, 0.005);
}

TEST(PlotInput, DraggingPansAndADoubleClickFits) {
    PlotHand hand;
    const double low = hand.x().low, width = hand.x().high - low;
    hand.point("plot 1", 0.5);
    hand.hand.left = true;
    hand.rest(1);
    for (int i = 0; i < 5; ++i) {
        hand.hand.mouse_x -= 8.0;
        hand.rest(1);
    }
    hand.hand.left = false;
    hand.rest(2);
    EXPECT_GT(hand.x().low, low + 0.02 * width);
    EXPECT_NEAR(hand.x().high - hand.x().low, width, 1e-9 * width);
    EXPECT_EQ(hand.session.time(), 0.0);  // a drag is not a click
    for (int i = 0; i < 2; ++i) {
        hand.hand.left = true;
        hand.rest(1);
        hand.hand.left = false;
        hand.rest(1);
    }
    EXPECT_EQ(hand.x().low, 0.0);
}

TEST(PlotInput, TheRightButtonDrawsABoxToZoomTo) {
    PlotHand hand;
    hand.point("plot 1", 0.25);
    hand.hand.right = true;
    hand.rest(1);
    const Rectangle place = hand.state.places.at("plot 1");
    hand.hand.mouse_x = place.x + 0.5 * place.width;
    hand.hand.mouse_y = place.y + 0.75 * place.height;
    hand.rest(2);
    hand.hand.right = false;
    hand.rest(2);
    EXPECT_NEAR(hand.x().low, 5.0, 0.1);
    EXPECT_NEAR(hand.x().high, 10.0, 0.1);
}

// The same for a hand without a right button; the plots say what the mouse does while it is over them.
TEST(PlotInput, ShiftDrawsABoxAndAHintSaysSo) {
    PlotHand hand;
    EXPECT_FALSE(hand.says("zoom box"));
    hand.point("plot 1", 0.25);
    EXPECT_TRUE(hand.says("right drag: zoom box"));
    const double time = hand.session.time();
    hand.hand.keys = {key::left_shift};
    hand.rest(1);
    hand.hand.left = true;
    hand.rest(1);
    const Rectangle place = hand.state.places.at("plot 1");
    hand.hand.mouse_x = place.x + 0.5 * place.width;
    hand.hand.mouse_y = place.y + 0.75 * place.height;
    hand.rest(2);
    hand.hand.left = false;
    hand.rest(1);
    hand.hand.keys.clear();
    hand.rest(2);
    hand.settle();
    EXPECT_NEAR(hand.x().low, 5.0, 0.1);
    EXPECT_NEAR(hand.x().high, 10.0, 0.1);
    EXPECT_EQ(hand.session.time(), time);
}

// A double click fits the plot and does nothing else: neither the time nor the chosen event changes.
TEST(PlotInput, ADoubleClickKeepsTimeAndEvent) {
    PlotHand hand;
    hand.session.apply(command::Select{10});
    hand.rest(2);
    const double time = hand.session.time();
    hand.all.clear();
    hand.double_click("plot 1", 0.7);
    hand.settle();
    hand.rest(30);
    EXPECT_EQ(hand.all, std::vector<Command>{command::Fit{2}});
    EXPECT_EQ(hand.session.time(), time);
    EXPECT_EQ(hand.session.selected(), 10);
    // The same with some frames between its clicks, as a window that draws fast has.
    hand.all.clear();
    for (int i = 0; i < 2; ++i) {
        hand.hand.left = true;
        hand.rest(2);
        hand.hand.left = false;
        hand.rest(6);
    }
    hand.settle();
    hand.rest(30);
    EXPECT_EQ(hand.all, std::vector<Command>{command::Fit{2}});
    EXPECT_EQ(hand.session.time(), time);
    EXPECT_EQ(hand.session.selected(), 10);
    hand.click("plot 1", 0.7);
    EXPECT_NE(hand.session.time(), time);
}

TEST(PlotInput, ThePointersInstantIsInEveryPlotOverTime) {
    PlotHand hand;
    const Image before = hand.picture();
    hand.point("plot 1", 0.4);
    ASSERT_TRUE(hand.state.pointed_before);
    EXPECT_NEAR(*hand.state.pointed_before, 8.0, 0.1);
    EXPECT_GT(worst_tile(before, hand.surface.frame([&] { explorer(hand.session, hand.state); }, 3, hand.hand)), 0.02);
}

TEST(PlotInput, ChoosesTypesAndHides) {
    PlotHand hand;
    hand.click("grid 2 3");
    EXPECT_EQ(hand.session.plots().size(), 6U);
    hand.click("menu of plot 2");
    hand.click("expression y");
    hand.press_with_control('A');
    hand.type("y, max_y");
    hand.press(key::enter);
    EXPECT_NE(hand.session.error(), "");
    hand.press_with_control('A');  // the menu stays open and its field active
    hand.type("y, gap");
    hand.press(key::enter);
    EXPECT_EQ(hand.session.error(), "");
    EXPECT_EQ(hand.session.plotted().list()[1].view.y.size(), 2U);
    hand.click("curve 2 1");
    EXPECT_EQ(framing(hand.session, 1).hidden, std::set<std::size_t>{0});
    hand.click("link");
    EXPECT_FALSE(hand.session.plotted().linked());
}

}  // namespace
}  // namespace achilles
