// Simulated input in the explorer: mechanism, timeline, undo, pin, lens, export.
#include "app/hands.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "app/program.hpp"
#include "output/output.hpp"

namespace achilles {
namespace {

using test::Hands;

// Presses at a place and drags by some pixels, in steps.
void drag(Hands& hands, const std::string& place, double right, double down, int steps = 8) {
    hands.point(place);
    hands.hand.left = true;
    hands.rest(2);
    for (int i = 0; i < steps; ++i) {
        hands.hand.mouse_x += right / steps;
        hands.hand.mouse_y += down / steps;
        hands.frame();
    }
    hands.hand.left = false;
    hands.rest(2);
}

// Pixels per world unit.
double unit_of(Hands& hands) {
    const Rectangle before = hands.state.places.at("body");
    const double x = *hands.session.value("x");
    hands.session.apply(command::Set{"x", x + 1.0});
    hands.session.apply(command::LookAt{0.0, 0.0, 20.0});
    hands.rest(2);
    const Rectangle there = hands.state.places.at("body");
    hands.session.apply(command::Set{"x", x});
    hands.rest(2);
    const double unit = there.x - hands.state.places.at("body").x;
    EXPECT_GT(unit, 1.0) << before.x;
    return unit;
}

TEST(MechanismInput, DragsTheBodyToWhereTheRunStarts) {
    Hands hands("ball_on_sine");
    const double unit = unit_of(hands);
    const double x = *hands.session.value("x"), y = *hands.session.value("y");
    hands.session.apply(command::Seek{5.0});  // the drag changes the start, so the time goes there
    hands.rest(2);
    const std::string before = to_text(hands.session.trajectory());
    drag(hands, "body", 0.0, 0.0, 1);
    EXPECT_EQ(hands.session.time(), 5.0) << "not before it moves";
    hands.session.apply(command::Seek{0.0});
    hands.rest(2);
    drag(hands, "body", 30.0, -16.0);
    EXPECT_NEAR(*hands.session.value("x"), x + 30.0 / unit, 1.5 / unit);
    EXPECT_NEAR(*hands.session.value("y"), y + 16.0 / unit, 1.5 / unit);
    EXPECT_NE(to_text(hands.session.trajectory()), before);
    EXPECT_EQ(hands.session.error(), "");
    // The drag is one undo step.
    hands.press_with_control('Z');
    EXPECT_EQ(*hands.session.value("x"), x);
    EXPECT_EQ(*hands.session.value("y"), y);
}

TEST(MechanismInput, DragsTheArrowToHowFastItStarts) {
    Hands hands("ball_on_sine");
    const Rectangle body = hands.state.places.at("body"), tip = hands.state.places.at("velocity");
    const double scale = (tip.x - body.x) / *hands.session.value("x'");
    drag(hands, "velocity", 20.0, -12.0, 1);
    EXPECT_NEAR(*hands.session.value("x'"), 1.5 + 20.0 / scale, 0.1);
    EXPECT_NEAR(*hands.session.value("y'"), 12.0 / scale, 0.1);
    EXPECT_EQ(*hands.session.value("x"), 0.0);
}

TEST(MechanismInput, DragsAPendulumByItsKnee) {
    Hands hands("double_pendulum");
    const double before = *hands.session.value("theta1");
    drag(hands, "body", 12.0, 0.0);
    EXPECT_NE(*hands.session.value("theta1"), before);
    EXPECT_EQ(hands.session.error(), "");
}

TEST(MechanismInput, ZoomsAtThePointerPansAndShowsAll) {
    Hands hands("ball_on_sine");
    hands.point("mechanism", 0.25);
    hands.hand.wheel = 1.0;
    hands.frame();
    hands.hand.wheel = 0.0;
    hands.rest(2);
    ASSERT_TRUE(hands.session.scene().look());
    const command::LookAt closer = *hands.session.scene().look();
    // The world point under the mouse is fixed.
    const Rectangle mechanism = hands.state.places.at("mechanism");
    drag(hands, "mechanism", -40.0, 0.0);
    const command::LookAt moved = *hands.session.scene().look();
    EXPECT_NEAR(moved.width, closer.width, 1e-12 * closer.width);
    EXPECT_NEAR(moved.x - closer.x, 40.0 * closer.width / mechanism.width, 8.0 * closer.width / mechanism.width);
    EXPECT_NEAR(moved.y, closer.y, 1e-9);
    hands.point("mechanism", 0.9);
    for (int i = 0; i < 2; ++i) {
        hands.hand.left = true;
        hands.rest(1);
        hands.hand.left = false;
        hands.rest(1);
    }
    EXPECT_FALSE(hands.session.scene().look());
}

TEST(TimelineInput, StepsFromEventToEventAndToTheEnds) {
    Hands hands("ball_on_sine");
    const auto& events = hands.session.trajectory().events;
    hands.press(key::right);
    EXPECT_EQ(hands.session.time(), events[0].t);
    hands.click("step on");
    EXPECT_EQ(hands.session.time(), events[1].t);
    hands.press(key::left);
    EXPECT_EQ(hands.session.time(), events[0].t);
    hands.click("step back");
    EXPECT_EQ(hands.session.time(), 0.0);
    hands.press(key::end);
    EXPECT_EQ(hands.session.time(), hands.session.trajectory().end_time);
    hands.press(key::left);
    EXPECT_EQ(hands.session.time(), events.back().t);
    hands.press(key::home);
    EXPECT_EQ(hands.session.time(), 0.0);
}

TEST(TimelineInput, PlaysAtTheChosenSpeedAndBeginsAgain) {
    Hands hands("ball_on_sine");
    hands.click("speed", 0.01);
    EXPECT_EQ(hands.session.scene().speed(), command::slowest);
    hands.click("speed", 0.99);
    EXPECT_EQ(hands.session.scene().speed(), command::fastest);
    hands.press(' ');
    ASSERT_TRUE(hands.session.playing());
    play_on(hands.session, 0.5);
    EXPECT_DOUBLE_EQ(hands.session.time(), 5.0);
    hands.click("loop", 0.2);
    play_on(hands.session, 1.6);
    EXPECT_TRUE(hands.session.playing());
    EXPECT_LT(hands.session.time(), 5.0);
    hands.click("loop", 0.2);
    play_on(hands.session, 100.0);
    EXPECT_FALSE(hands.session.playing());
    EXPECT_EQ(hands.session.time(), hands.session.trajectory().end_time);
    // A right click restores the default.
    hands.point("speed");
    hands.hand.right = true;
    hands.rest(2);
    hands.hand.right = false;
    hands.rest(2);
    EXPECT_EQ(hands.session.scene().speed(), 1.0);
}

TEST(ExplorerInput, UndoesAndDoesAgain) {
    Hands hands("ball_on_sine");
    hands.click("set g", 0.8);
    const double g = *hands.session.value("g");
    ASSERT_NE(g, 1.0);
    hands.press_with_control('Z');
    EXPECT_EQ(*hands.session.value("g"), 1.0);
    hands.press_with_control('Y');
    EXPECT_EQ(*hands.session.value("g"), g);
}

TEST(ExplorerInput, PinsComparesAndUnpins) {
    Hands hands("ball_on_sine");
    hands.click("pin");
    ASSERT_EQ(hands.session.pinned().size(), 1U);
    hands.click("set e", 0.2);
    const PinnedRun& pinned = hands.session.pinned()[0];
    EXPECT_EQ(pinned.trajectory->run.parameters[2], 0.5);
    EXPECT_EQ(pinned.plots.size(), hands.session.plots().size());
    hands.session.apply(command::Seek{8.0});
    EXPECT_NE(hands.session.now_of(pinned).state.q, hands.session.now().state.q);
    const Image with_ghost = hands.picture();
    hands.click("unpin 1");
    EXPECT_TRUE(hands.session.pinned().empty());
    EXPECT_NE(hands.picture(), with_ghost);
    hands.click("compare");
    ASSERT_EQ(hands.session.pinned().size(), 1U);
    const Truncation& truncation = hands.session.pinned()[0].trajectory->run.options.truncation;
    EXPECT_EQ(truncation.conditions, Conditions::paper);
    EXPECT_EQ(truncation.reinitialization, Reinitialization::euclidean);
    EXPECT_EQ(hands.session.run().options.truncation.conditions, Conditions::sharp);
    EXPECT_EQ(hands.session.run().options.truncation.reinitialization, Reinitialization::kinetic);
    EXPECT_EQ(hands.session.error(), "");
}

TEST(ExplorerInput, OpensTheLensAndScrollsItForEver) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Select{10});
    hands.rest(2);
    hands.click("open lens");
    ASSERT_TRUE(hands.session.scene().shows("lens"));
    hands.rest(1);
    hands.click("lens cut");
    const double cut = hands.session.scene().lens().value_or(-1e9);
    hands.point("lens");
    for (int i = 0; i < 200; ++i) {
        hands.hand.wheel = -1.0;
        hands.frame();
    }
    hands.hand.wheel = 0.0;
    EXPECT_NEAR(*hands.session.scene().lens(), cut + 50.0, 1e-9);
    hands.frame();
    drag(hands, "lens", 100.0, 0.0);
    EXPECT_LT(*hands.session.scene().lens(), cut + 50.0);
    hands.click("lens certified interval");
    EXPECT_GT(*hands.session.scene().lens(), cut);
    hands.click("lens first impact");
    EXPECT_LT(*hands.session.scene().lens(), cut);
    hands.click("open lens");
    EXPECT_FALSE(hands.session.scene().shows("lens"));
    EXPECT_EQ(hands.session.error(), "");
}

TEST(ExplorerInput, TakesAFigureAwayAndIsToldWhatCannotBeWritten) {
    const test::Folder folder;
    Hands hands("ball_on_sine");
    const std::string file = (folder.path() / "ball.svg").string();
    const auto ask = [&](const char* item, const std::string& path) {
        hands.click("bar File");
        hands.click(item);
        hands.rest(2);
        hands.hand.keys = {key::left_control};
        hands.rest(1);
        hands.hand.keys.push_back('A');
        hands.rest(1);
        hands.hand.keys.clear();
        hands.rest(1);
        hands.type(path);
        hands.rest(2);
    };
    ask("menu Export figure\u2026", file);
    hands.press(key::enter);
    EXPECT_EQ(hands.session.error(), "");
    EXPECT_EQ(hands.session.notice(), "wrote " + file);
    EXPECT_EQ(test::content(file).rfind("<?xml", 0), 0U);
    // The file exists already: Enter alone does not overwrite it.
    ask("menu Export figure\u2026", file);
    hands.all.clear();
    hands.press(key::enter);
    EXPECT_TRUE(hands.all.empty());
    hands.click("dialog Overwrite");
    EXPECT_EQ(hands.all, std::vector<Command>{(command::Export{file, true})});
    EXPECT_EQ(hands.session.error(), "");
    std::filesystem::permissions(folder.path() / "ball.svg", std::filesystem::perms::none);
    ask("menu Export data\u2026", "/proc/run.json");
    hands.press(key::enter);
    EXPECT_NE(hands.session.error().find("/proc/run.json"), std::string::npos) << hands.session.error();
    EXPECT_EQ(folder.files().size(), 1U);
    hands.rest(2);
}

TEST(ExplorerInput, CopiesTheCommandLine) {
    Hands hands("ball_on_sine");
    hands.click("set e", 0.3);
    hands.click("bar File");
    hands.click("menu Copy command");
    hands.click("menu copy run");
    hands.rest(2);
    EXPECT_EQ(hands.session.copies(), 1);
    EXPECT_EQ(hands.state.copies, 1);
    EXPECT_EQ(hands.session.copied().rfind("achilles simulate ball_on_sine --set e=", 0), 0U);
}

}  // namespace
}  // namespace achilles
