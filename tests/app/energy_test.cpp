// The energy panel.
#include <gtest/gtest.h>

#include "app/hands.hpp"

namespace achilles {
namespace {

using test::Hands;

TEST(EnergyBar, IsShownByACommandAndFromTheMenu) {
    Hands hands("ball_on_sine");
    EXPECT_FALSE(hands.state.places.contains("energy bar"));
    hands.click("bar View");
    hands.click("menu Energy");
    EXPECT_EQ(hands.all, (std::vector<Command>{command::Show{"energy", true}}));
    hands.rest(2);
    EXPECT_TRUE(hands.says("impact loss"));
    EXPECT_FALSE(hands.says("work done")) << "only gravity acts";
    EXPECT_TRUE(hands.state.places.contains("energy course"));
}

// It shares the player's time axis: a click goes to the time at that place.
TEST(EnergyBar, GoesWhereItIsPressed) {
    Hands hands("driven_double_pendulum", test::surface(1280, 900));
    hands.session.apply(parse_command("show energy"));
    hands.rest(2);
    EXPECT_TRUE(hands.says("work done"));
    const Rectangle course = hands.state.places.at("energy course"), player = hands.state.places.at("timeline");
    EXPECT_NEAR(course.x + 0.5 * course.width, player.x + 0.5 * player.width, 1.0);
    hands.click("energy course", 0.5);
    EXPECT_NEAR(hands.session.time(), 0.5 * hands.session.trajectory().run.options.end_time, 0.02 * 20);
}

// In a low panel the time plot is dropped but the bar stays; the mechanism has precedence over both.
TEST(EnergyBar, GivesPlaceToTheMechanism) {
    for (const int height : {480, 620, 760, 1000}) {
        Hands hands("ball_on_sine", test::surface(1100, height));
        hands.session.apply(parse_command("show energy"));
        hands.rest(2);
        ASSERT_TRUE(hands.state.places.contains("mechanism"));
        EXPECT_GE(hands.state.places.at("mechanism").height, 60.0F) << height;
        EXPECT_EQ(hands.state.places.contains("energy course"), height > 700) << height;
    }
}

}  // namespace
}  // namespace achilles
