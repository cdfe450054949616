// The cameras of the mechanism view: commands, menu, mouse, scale bar.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>

#include "app/hands.hpp"
#include "app/program.hpp"

namespace achilles {
namespace {

using test::Hands;

Scene after(const std::vector<const char*>& journal) {
    Session session = test::session("ball_on_sine");
    for (const char* line : journal) session.apply(parse_command(line));
    return session.scene();
}

TEST(CameraCommand, ChoosesACameraAndKeepsWhereOneLooked) {
    EXPECT_EQ(after({}).camera(), CameraMode::fit);
    EXPECT_EQ(after({"camera follow"}).camera(), CameraMode::follow);
    EXPECT_EQ(after({"look 1 2 3"}).camera(), CameraMode::fixed);
    EXPECT_EQ(after({"look 1 2 3", "look all"}).camera(), CameraMode::fit);
    EXPECT_EQ(after({"look 1 2 3", "camera fit"}).camera(), CameraMode::fit);
    // The user's view is remembered until the camera is fixed again.
    EXPECT_FALSE(after({"look 1 2 3", "camera zeno"}).look());
    ASSERT_TRUE(after({"look 1 2 3", "camera zeno", "camera fixed"}).look());
    EXPECT_EQ(after({"look 1 2 3", "camera zeno", "camera fixed"}).look()->width, 3.0);
    // Another system has another world: the view is not kept.
    EXPECT_EQ(after({"look 1 2 3", "open double_pendulum"}).camera(), CameraMode::fit);
    EXPECT_EQ(after({"camera zeno", "open double_pendulum"}).camera(), CameraMode::zeno);
    Session session = test::session("ball_on_sine");
    session.apply(parse_command("camera fixed"));
    EXPECT_NE(session.error().find("no view has been chosen yet"), std::string::npos) << session.error();
    EXPECT_THROW(parse_command("camera above"), InputError);
}

TEST(CameraCommand, IsInTheRecipeOfASession) {
    for (const std::vector<const char*>& journal : std::vector<std::vector<const char*>>{
             {"camera zeno"}, {"look 1 2 3", "camera follow"}, {"look 1 2 3"}, {"look 1 2 3", "camera fit"}}) {
        const Scene scene = after(journal);
        Scene again;
        for (const Command& command : steps_to(scene))
            std::visit(
                [&](const auto& what) {
                    if constexpr (requires { again.perform(what); }) again.perform(what);
                },
                static_cast<const AnyCommand&>(command));
        EXPECT_EQ(to_text(again), to_text(scene)) << journal[0];
        EXPECT_EQ(again.camera(), scene.camera());
    }
}

TEST(CameraMenu, ChoosesEachCamera) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Seek{2.0});
    hands.rest(2);
    const auto choose = [&](const std::string& item) {
        hands.click("camera");
        ASSERT_TRUE(hands.state.places.contains("menu " + item)) << item;
        hands.click("menu " + item);
    };
    choose("follow: move with the body");
    EXPECT_EQ(hands.session.scene().camera(), CameraMode::follow);
    const Rectangle before = hands.state.places.at("body");
    choose("fixed: the current view");
    ASSERT_TRUE(hands.session.scene().look());
    // The view stays as it was, and is then independent of the time.
    EXPECT_NEAR(hands.state.places.at("body").x, before.x, 0.5);
    EXPECT_NEAR(hands.state.places.at("body").y, before.y, 0.5);
    const command::LookAt look = *hands.session.scene().look();
    hands.session.apply(command::Seek{9.0});
    hands.rest(2);
    EXPECT_EQ(hands.session.scene().look()->x, look.x);
    choose("zeno: zoom in on the next Zeno point");
    EXPECT_EQ(hands.session.scene().camera(), CameraMode::zeno);
    choose("fit: the whole run");
    EXPECT_EQ(hands.session.scene().camera(), CameraMode::fit);
    EXPECT_TRUE(hands.state.places.contains("scale bar"));
}

TEST(CameraMouse, MiddleDragMovesThePictureAlsoOverTheBody) {
    Hands hands("ball_on_sine");
    hands.point("body");
    const Rectangle body = hands.state.places.at("body");
    hands.hand.middle = true;
    hands.rest(1);
    for (int i = 0; i < 10; ++i) {
        hands.hand.mouse_x += 5.0;
        hands.hand.mouse_y += 3.0;
        hands.frame();
    }
    hands.hand.middle = false;
    hands.rest(2);
    ASSERT_TRUE(hands.session.scene().look());
    EXPECT_NEAR(hands.state.places.at("body").x - body.x, 50.0, 1.0);
    EXPECT_NEAR(hands.state.places.at("body").y - body.y, 30.0, 1.0);
    EXPECT_EQ(*hands.session.value("x"), 0.0) << "the body is not what moves";
}

TEST(CameraPicture, SaysItsScaleAtEveryZoom) {
    Hands hands("ball_on_sine");
    EXPECT_TRUE(hands.says("1 m"));
    hands.session.apply(command::LookAt{4.6, -0.99, 1e-6});
    hands.rest(2);
    EXPECT_TRUE(hands.says("5\u00b710\u22128 m")) << hands.letters();
    // The scale bar and the layers are below the picture, side by side; without room the layers are in the menu.
    for (const auto& [width, height] : {std::pair{640, 480}, {1000, 700}, {1366, 768}, {1600, 1000}}) {
        Hands other("ball_on_egg_crate", test::surface(width, height));
        const Rectangle bar = other.state.places.at("scale bar"), world = other.state.places.at("mechanism");
        EXPECT_GE(bar.y, world.y + world.height) << width;
        EXPECT_GT(bar.width, 30.0F) << width;
        const bool folds = !other.state.places.contains("show trail");
        EXPECT_EQ(folds, width <= 1000) << width;
        if (folds) other.click("camera");
        const Rectangle trail = other.state.places.at("show trail"), menu = other.state.places.at("camera");
        EXPECT_LT(bar.x + bar.width, menu.x) << width;
        EXPECT_TRUE(folds || bar.x + bar.width < trail.x) << width;
        other.click("show trail");
        EXPECT_FALSE(other.session.scene().shows("trail")) << width;
    }
}

// In words, since the picture of a bounce near a Zeno point is two lines.
TEST(CameraPicture, ExplainsTheZenoCamera) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::SetCamera{"zeno"});
    hands.rest(2);
    EXPECT_TRUE(hands.says("the whole run"));
    hands.session.apply(command::Seek{2.72});
    hands.rest(2);
    EXPECT_TRUE(hands.says("inside the body")) << hands.letters();
    EXPECT_TRUE(hands.says("times enlarged"));
    EXPECT_TRUE(hands.says("in a bounce"));
    hands.session.apply(command::Seek{2.725});
    hands.rest(2);
    EXPECT_TRUE(hands.says("the bounces are cut"));
}

TEST(SidesOfSpace, AreOfferedWhereThereIsSpace) {
    Hands ball("ball_on_sine"), crate("ball_on_egg_crate");
    EXPECT_FALSE(ball.state.places.contains("show sides"));
    if (!crate.state.places.contains("show sides")) crate.click("camera");  // no room beside the scale
    crate.click("show sides");
    EXPECT_TRUE(crate.session.scene().shows("sides"));
    EXPECT_TRUE(crate.says("across")) << crate.letters();
}

// Prints positions for the window's test.
TEST(CameraMenu, TellsWhereItIs) {
    Hands hands("ball_on_sine");
    const auto tell = [&](const char* name, const std::string& place) {
        std::cout << name << " " << std::lround(hands.middle(place).x) << " " << std::lround(hands.middle(place).y)
                  << "\n";
    };
    tell("menu", "camera");
    tell("picture", "mechanism");
    hands.click("camera");
    tell("zeno", "menu zeno: zoom in on the next Zeno point");
}

}  // namespace
}  // namespace achilles
