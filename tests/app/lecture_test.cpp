// The lecture (F11), and a value that moves by itself.
#include <gtest/gtest.h>

#include "app/hands.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::Hands;

TEST(Lecture, ShowsTheTitleTheMechanismOnePlotSlidersAndThePlayer) {
    for (const auto& [width, height] : {std::pair{1280, 800}, {1024, 700}, {1920, 1080}}) {
        Hands hands("ball_on_sine", test::surface(width, height));
        hands.press(key::f11);
        hands.state.places.clear();
        hands.rest(2);
        for (const char* seen : {"mechanism", "plot 0", "set e", "animate e", "play", "timeline"})
            EXPECT_TRUE(hands.state.places.contains(seen)) << seen << " at " << width;
        for (const char* hidden : {"plot 1", "set g", "event 1", "result 10", "bar File", "tab events"})
            EXPECT_FALSE(hands.state.places.contains(hidden)) << hidden << " at " << width;
        EXPECT_TRUE(hands.says("Ball bouncing on a sinusoidal surface")) << width;
        hands.press(key::escape);
        EXPECT_FALSE(hands.session.scene().presents());
    }
}

TEST(Lecture, HasTheSlidersThatDifferOrAreChosen) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Present{true});
    EXPECT_EQ(lecture_sliders(hands.session), std::vector<std::string>{"e"}) << "without a difference: the restitution";
    for (const char* line : {"set g 2", "set x' 1", "set m 2", "set y 3"}) hands.session.apply(parse_command(line));
    EXPECT_EQ(lecture_sliders(hands.session).size(), 3U);
    hands.session.apply(parse_command("present on x' e"));
    EXPECT_EQ(lecture_sliders(hands.session), (std::vector<std::string>{"x'", "e"}));
    hands.rest(3);
    hands.click("set x'", 0.9);
    EXPECT_GT(*hands.session.value("x'"), 2.0);
    Session again = test::session("ball_on_sine");
    for (const Command& command : recipe(hands.session)) again.apply(command);
    EXPECT_EQ(lecture_sliders(again), lecture_sliders(hands.session));
    for (const auto& [line, says] :
         {std::pair{"present on ee", "ee"}, {"present on e x x' y", "at most three sliders"}}) {
        hands.session.apply(parse_command(line));
        EXPECT_NE(hands.session.error().find(says), std::string::npos) << hands.session.error();
    }
}

// Up and Down go through the systems, in a lecture alone.
TEST(Lecture, GoesToTheNextAndThePreviousSystem) {
    Hands hands("ball_on_sine");
    hands.press(key::down);
    EXPECT_EQ(hands.session.system(), "ball_on_sine");
    hands.session.apply(command::Present{true});
    hands.rest(2);
    hands.press(key::down);
    EXPECT_EQ(hands.session.system(), "double_pendulum");
    EXPECT_TRUE(hands.session.scene().presents());
    hands.press(key::up);
    EXPECT_EQ(hands.session.system(), "ball_on_sine");
    hands.press(key::up);
    EXPECT_EQ(hands.session.system(), "double_pendulum") << "before the first comes the last";
}

TEST(Animation, MovesAValueWhileTimePasses) {
    Session session = test::session("ball_on_sine");
    session.apply(parse_command("animate e 0.2 0.8 over 4"));
    ASSERT_EQ(session.error(), "");
    EXPECT_EQ(session.value("e"), 0.2);
    play_on(session, 1.0);
    EXPECT_NEAR(*session.value("e"), 0.35, 1e-12);
    EXPECT_EQ(session.trajectory().run.parameters[2], *session.value("e")) << "every picture is of a finished run";
    session.apply(command::Wait{2.0});
    EXPECT_NEAR(*session.value("e"), 0.65, 1e-12);
    session.apply(command::Wait{9.0});
    EXPECT_EQ(session.value("e"), 0.8);
    EXPECT_EQ(session.animation(), nullptr);
    EXPECT_FALSE(session.is_moving());
    // All of its values are undone together with the first.
    session.apply(command::Undo{});
    EXPECT_EQ(session.value("e"), 0.5) << "one step back";
    session.apply(command::Redo{});
    EXPECT_EQ(session.value("e"), 0.8);
}

TEST(Animation, StopsAndRefuses) {
    Session session = test::session("ball_on_sine");
    session.apply(parse_command("animate e 0.2 1.4"));
    play_on(session, 4.9);
    EXPECT_NE(session.error(), "") << "e may not be above 1";
    EXPECT_EQ(session.animation(), nullptr);
    for (const auto& [line, says] : {std::pair{"animate ee 0 1", "ee"}, {"animate e 0 30 deg", "deg"}}) {
        session.apply(parse_command(line));
        EXPECT_NE(session.error().find(says), std::string::npos) << line << ": " << session.error();
        EXPECT_EQ(session.animation(), nullptr);
    }
    session.apply(parse_command("animate e 0.2 0.4"));
    session.apply(parse_command("animate off"));
    play_on(session, 3.0);
    EXPECT_EQ(session.value("e"), 0.2);
    session.apply(parse_command("animate e 0.2 0.4"));
    session.apply(command::Open{"double_pendulum"});
    EXPECT_EQ(session.animation(), nullptr);
}

TEST(Animation, IsStartedBySayingIt) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Find{"play e from 0.2 to 0.9"});
    hands.rest(3);
    hands.press(key::enter);
    hands.rest(2);
    EXPECT_EQ(hands.session.error(), "");
    ASSERT_NE(hands.session.animation(), nullptr);
    EXPECT_EQ(hands.session.animation()->to, 0.9);
}

}  // namespace
}  // namespace achilles
