// The sweep panel: axes, pictures from coarse to fine, and mouse input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "app/hands.hpp"
#include "journal/journal.hpp"
#include "number/angle.hpp"
#include "panels/widgets.hpp"
#include "pictures/export.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::Hands;

std::string sweep_refusal(Session& session, const std::string& text) {
    session.apply(command::ShowSweep{text});
    return session.error();
}

Session swept(const std::string& system, const std::string& text) {
    Session session = test::session(system);
    session.apply(command::ShowSweep{text});
    EXPECT_EQ(session.error(), "");
    session.settle();
    return session;
}

TEST(SweepPanel, BeginsWithTheRestitutionAndTheFirstZenoTime) {
    Session session = test::session("ball_on_sine");
    EXPECT_EQ(session.sweep_job().data(), nullptr);
    session.apply(command::Show{"sweep", true});
    EXPECT_EQ(session.sweep_text(), "--over e=0:1:512 --print \"zeno_time(1)\"");
    session.settle();
    ASSERT_NE(session.sweep_job().data(), nullptr);
    EXPECT_EQ(session.sweep_job().data()->count(), 512U);
    EXPECT_EQ(session.sweep_job().share(), 1.0);
    session.apply(command::Show{"sweep", false});
    EXPECT_FALSE(session.sweep_job().is_busy());
}

TEST(SweepPanel, ShowsWhatSingleRunsSay) {
    Session session = swept("ball_on_sine", "--over x'=0:3:5 --over e=0.2:0.8:4 --print \"zeno_time(1)\" --print x");
    const SweepData& data = *session.sweep_job().data();
    ASSERT_EQ(data.count(), 20U);
    for (const std::size_t row : {0U, 7U, 19U}) {
        Session single = test::session("ball_on_sine");
        single.apply(command::SetStart{{{"x'", data.value(0, row)}, {"e", data.value(1, row)}}});
        const auto& events = single.trajectory().events;
        const auto zeno = std::find_if(events.begin(), events.end(),
                                       [](const Event& event) { return event.kind == Event::Kind::zeno; });
        if (zeno == events.end()) {
            EXPECT_TRUE(std::isnan(data.number(row, 0))) << row;
        } else {
            EXPECT_NEAR(data.number(row, 0), zeno->t, 1e-8) << row;
        }
    }
}

// Typed, or from the menu, which offers the derivative with respect to the x axis.
TEST(SweepPanel, ShowsDerivatives) {
    const Session session =
        swept("ball_on_sine", "--over e=0.2:0.5:31 --print \"d(zeno_time(1), e)\" --print \"zeno_time(1)\"");
    const SweepData& data = *session.sweep_job().data();
    ASSERT_EQ(data.count(), 31U);
    for (std::size_t row = 1; row < 30; ++row) {
        const double difference = (data.number(row + 1, 1) - data.number(row - 1, 1)) / 0.02;
        EXPECT_NEAR(data.number(row, 0), difference, 0.003 * std::abs(difference)) << row;
    }
    Hands hands("ball_on_sine");
    hands.session.apply(command::ShowSweep{"--over e=0.2:0.5:31 --print \"zeno_time(1)\""});
    hands.session.settle();
    hands.rest(3);
    hands.click("sweep print");
    hands.click("sweep print d(zeno_time(1), e)");
    hands.session.settle();
    EXPECT_EQ(hands.session.error(), "");
    EXPECT_EQ(hands.session.sweep_text(), "--over e=0.2:0.5:31 --print \"d(zeno_time(1), e)\"");
    ASSERT_NE(hands.session.sweep_job().data(), nullptr);
    EXPECT_EQ(hands.session.sweep_job().data()->number(3, 0), data.number(3, 0));
}

// More points, or rows, than a picture may have.
TEST(SweepPanel, RefusesMoreThanItDraws) {
    Session session = test::session("ball_on_sine");
    EXPECT_NE(
        sweep_refusal(session, "--over e=0:1:900000000 --print x").find("a sweep of 900000000 points cannot be drawn"),
        std::string::npos)
        << session.error();
}

TEST(SweepPanel, GoesFromCoarseToFine) {
    const Session session = test::session("ball_on_sine");
    const auto counts = [&](const std::string& text) {
        std::vector<std::uint64_t> all;
        SweepSpec sweep = read_sweep(text, session.description());
        for (const SweepSpec& level : coarse_to_fine(sweep)) all.push_back(level.count());
        return all;
    };
    using Counts = std::vector<std::uint64_t>;
    EXPECT_EQ(counts("--over e=0:0.9:512 --over x=0:1:512 --print x"), (Counts{256, 4096, 25600, 262144}));
    EXPECT_EQ(counts("--over e=0:0.9:512 --print x"), (Counts{32, 128, 512}));
    EXPECT_EQ(counts("--over e=0:0.9:128 --print x"), (Counts{32, 128}));
    EXPECT_EQ(counts("--over e=0:0.9:20 --print x"), (Counts{20}));
    // A section of a single run: with increasing length.
    std::vector<double> ends;
    for (const SweepSpec& level : coarse_to_fine(read_sweep("--at impact --print x", session.description())))
        ends.push_back(level.base.options.end_time);
    EXPECT_EQ(ends, (std::vector<double>{0.3125, 1.25, 5.0, 20.0}));
}

TEST(SweepPanel, IsMadeAnewWhereSomethingElseChanges) {
    Session session = swept("ball_on_sine", "--over e=0:0.9:16 --print \"zeno_time(1)\"");
    const auto before = session.sweep_job().data();
    session.apply(command::Set{"e", 0.7});  // the cross hair moves, the picture stays
    session.settle();
    EXPECT_EQ(session.sweep_job().data(), before);
    session.apply(command::Set{"g", 5.0});
    session.settle();
    EXPECT_NE(session.sweep_job().data(), before);
    EXPECT_NE(session.sweep_job().data()->number(8, 0), before->number(8, 0));
}

TEST(SweepPanel, RefusesWhatCannotBeShownAndKeepsWhatThereIs) {
    Session session = swept("ball_on_sine", "--over e=0:0.9:8 --print x");
    EXPECT_NE(sweep_refusal(session, "--over f=0:1:8 --print x").find("'f'"), std::string::npos) << session.error();
    EXPECT_NE(sweep_refusal(session, "--over e=0:0.9:8").find("name at least one quantity to print"), std::string::npos)
        << session.error();
    EXPECT_NE(sweep_refusal(session, "--over e=0:0.9:8 --print nonsense").find("nonsense"), std::string::npos);
    EXPECT_NE(sweep_refusal(session, "--over e=0:0.9:8 --print x --set g=3").find("sliders"), std::string::npos);
    EXPECT_NE(sweep_refusal(session, "--over e=0:0.9:8 --over x=0:1:8 --over y=0:1:8 --print x").find("two axes"),
              std::string::npos);
    EXPECT_EQ(session.sweep_text(), "--over e=0:0.9:8 --print x");
    // Another system has no x: it gets its default sweep.
    session.apply(command::Open{"double_pendulum"});
    session.settle();
    EXPECT_EQ(session.sweep_text(), default_sweep(session.description()));
    EXPECT_EQ(session.sweep_job().problem(), "");
}

TEST(SweepPanel, IsInTheRecipeAndOnTheCommandLine) {
    Session session = swept("ball_on_sine", "--over e=0:0.9:8 --print \"zeno_time(1)\"");
    session.apply(command::Set{"g", 5.0});
    Session again = test::session("ball_on_sine");
    for (const Command& command : recipe(session)) again.apply(command);
    EXPECT_EQ(to_text(again), to_text(session));
    EXPECT_EQ(command_for(session, "sweep"),
              "achilles sweep ball_on_sine --over e=0:0.9:8 --print 'zeno_time(1)' --set g=5 --out "
              "ball_on_sine-sweep.svg");
    // Accepted here, but needs quotes in a shell.
    session.apply(command::ShowSweep{"--over x'=0:3:8 --print zeno_time(1)"});
    EXPECT_EQ(command_for(session, "sweep"),
              "achilles sweep ball_on_sine --over 'x'\\''=0:3:8' --print 'zeno_time(1)' --set g=5 --out "
              "ball_on_sine-sweep.svg");
}

TEST(SweepPanel, AsksForSectionsOfRunsThatAreLongerThanTheFileSays) {
    Session session = test::session("ball_on_vibrating_table");  // takes 10 s
    const std::string late = "--over om=5:15:8 --at impact --after 50 --print y'";
    EXPECT_NE(sweep_refusal(session, late).find("--after 50: the runs end at 10"), std::string::npos);
    session.apply(command::SetEndTime{60.0});
    EXPECT_EQ(sweep_refusal(session, late), "");
    session.settle();
    EXPECT_EQ(session.sweep_job().problem(), "");
    session.apply(command::SetEndTime{40.0});
    session.settle();
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.sweep_job().problem(), "--after 50: the runs end at 40");
}

TEST(SweepPanel, TakesTheHandToAnotherRun) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::ShowSweep{"--over e=0.1:0.9:9 --over x'=0:2:9 --print \"zeno_time(1)\""});
    hands.session.settle();
    hands.rest(3);
    hands.point("sweep picture", 0.25);
    EXPECT_TRUE(hands.says("Zeno point at"));
    hands.click("sweep picture", 0.25);
    EXPECT_NEAR(*hands.session.value("e"), 0.3, 0.005);  // at a quarter of the x axis, in the middle of the y axis
    EXPECT_NEAR(*hands.session.value("x'"), 1.0, 0.02);
}

// Angles are displayed in degrees; the slider's command uses the file's unit.
TEST(SweepPanel, TakesTheHandToAnAngle) {
    Hands hands("double_pendulum");
    hands.session.apply(command::ShowSweep{"--over theta1=-0.5:0.5:9 --print theta2"});
    hands.session.settle();
    hands.rest(3);
    hands.point("sweep picture", 0.25);
    EXPECT_TRUE(hands.says("theta1(0) = \u221214.3239\u00B0"));
    const double angle = degrees(hands.session.sweep_job().data()->number(2, 0));
    EXPECT_TRUE(hands.says("theta2 = " + number(angle) + "\u00B0"));
    hands.click("sweep picture", 0.25);
    EXPECT_NEAR(*hands.session.value("theta1"), -0.25, 0.005);
    hands.session.settle();
    hands.rest(2);
    ASSERT_TRUE(hands.state.sweep.measure);
    EXPECT_NEAR(*hands.state.sweep.measure, degrees(hands.session.samples().back().state.q[1]), 1e-6);
}

TEST(SweepPanel, ShowsThePresentRunOnItsCurve) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::ShowSweep{"--over e=0.1:0.9:9 --print \"zeno_time(1)\""});
    hands.session.settle();
    hands.rest(3);
    ASSERT_TRUE(hands.state.sweep.measure);
    const auto& events = hands.session.trajectory().events;
    const auto zeno =
        std::find_if(events.begin(), events.end(), [](const Event& event) { return event.kind == Event::Kind::zeno; });
    ASSERT_NE(zeno, events.end());
    EXPECT_EQ(*hands.state.sweep.measure, zeno->t);
}

TEST(SweepPanel, IsChosenFromMenus) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"sweep", true});
    hands.rest(2);
    hands.click("sweep y");
    hands.click("sweep y x'");
    EXPECT_EQ(hands.session.sweep().axes.size(), 2U);
    EXPECT_EQ(hands.session.sweep().axes[1].name, "x'");
    hands.click("sweep print");
    hands.click("sweep print outcome");
    EXPECT_EQ(hands.session.sweep().prints, std::vector<std::string>{"outcome"});
    // A section must be over x alone: with two axes it could not be drawn.
    hands.click("sweep print");
    hands.click("sweep at every impact");
    EXPECT_EQ(hands.session.error(), "");
    EXPECT_EQ(hands.session.sweep().axes.size(), 1U);
    EXPECT_TRUE(hands.session.sweep().at);
    hands.press(key::escape);
    hands.click("tab events");
    EXPECT_FALSE(hands.session.scene().shows("sweep"));
}

// In degrees by default, as for the slider.
TEST(SweepPanel, TakesLimitsInDegrees) {
    Hands hands("double_pendulum");
    hands.session.apply(command::ShowSweep{"--over theta1=-0.5:0.5:9 --print theta2"});
    hands.session.settle();
    hands.rest(3);
    hands.click("sweep x");
    EXPECT_EQ(hands.state.sweep.menus[0].low, "-28.6478897565");
    const auto limited_to = [&](const std::string& typed) {
        hands.click("sweep x from");
        hands.press_with_control('A');
        hands.type(typed);
        hands.press(key::enter);
        hands.rest(2);
        return hands.session.sweep().axes[0].low;
    };
    EXPECT_NEAR(limited_to("-45"), -std::numbers::pi / 4.0, 1e-12);
    EXPECT_EQ(hands.session.sweep().axes[0].high, 0.5);
    EXPECT_NEAR(limited_to("-1 rad"), -1.0, 1e-12);
    EXPECT_NEAR(limited_to("-pi/3"), -std::numbers::pi / 3.0, 1e-12);
}

// Prints positions for sweep_window_test.sh.
TEST(SweepPanel, TellsWhereItIs) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"sweep", true});
    hands.session.settle();
    hands.rest(3);
    const auto tell = [&](const char* name, const std::string& place) {
        std::cout << name << " " << std::lround(hands.middle(place).x) << " " << std::lround(hands.middle(place).y)
                  << "\n";
    };
    tell("menu", "sweep y");
    tell("picture", "sweep picture");
    hands.click("sweep y");
    tell("rate", "sweep y x'");
}

TEST(SweepPanel, TakesTheNameOfASliderOntoAnAxis) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"sweep", true});
    hands.session.settle();
    hands.rest(3);
    const Rectangle slider = hands.state.places.at("set g"), picture = hands.state.places.at("sweep picture");
    hands.hand.mouse_x = slider.x - 30.0;  // its name is to its left
    hands.hand.mouse_y = slider.y + 0.5 * slider.height;
    hands.rest(2);
    hands.hand.left = true;
    hands.rest(2);
    hands.hand.mouse_x = picture.x + 0.5 * picture.width;
    hands.hand.mouse_y = picture.y + picture.height + 8.0;
    hands.rest(3);
    hands.hand.left = false;
    hands.rest(2);
    EXPECT_EQ(hands.session.sweep().axes[0].name, "g");
}

}  // namespace
}  // namespace achilles
