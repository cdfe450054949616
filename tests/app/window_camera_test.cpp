// The cameras of the mechanism view: commands, menu, mouse, scale bar.
#include <gtest/gtest.h>

#include <algorithm>
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

// Drags with a button from an empty place of the picture.
void drag_beside(Hands& hands, bool Input::*button, double across, double down) {
    const Rectangle world = hands.state.places.at("mechanism");
    hands.hand.mouse_x = world.x + 0.9 * world.width, hands.hand.mouse_y = world.y + 0.1 * world.height;
    hands.rest(2);
    hands.hand.*button = true;
    hands.rest(1);
    for (int i = 0; i < 10; ++i) {
        hands.hand.mouse_x -= 0.1 * across;
        hands.hand.mouse_y += 0.1 * down;
        hands.frame();
    }
    hands.hand.*button = false;
    hands.rest(2);
}

TEST(CameraMouse, TurnsASystemInSpace) {
    Hands hands("ball_on_egg_crate");
    const ViewAngles drawn = hands.session.direction();
    EXPECT_FALSE(hands.session.scene().direction());
    drag_beside(hands, &Input::left, 60.0, 20.0);
    ASSERT_TRUE(hands.session.scene().direction());
    EXPECT_EQ(*hands.session.scene().direction(), (ViewAngles{drawn.about - 30.0, drawn.tilt + 10.0}));
    EXPECT_FALSE(hands.session.scene().look()) << "the camera still shows the whole run";
    // A second drag goes on from there; the right button moves the picture.
    drag_beside(hands, &Input::left, 20.0, 0.0);
    EXPECT_EQ(hands.session.direction().about, drawn.about - 40.0);
    const Rectangle body = hands.state.places.at("body");
    drag_beside(hands, &Input::right, 40.0, 0.0);
    EXPECT_EQ(hands.session.direction().about, drawn.about - 40.0);
    EXPECT_NEAR(hands.state.places.at("body").x, body.x - 40.0, 1.0);
    // Zoomed in, what is in the middle stays there.
    const command::LookAt before = *hands.session.scene().look();
    drag_beside(hands, &Input::left, 20.0, 0.0);
    EXPECT_EQ(hands.session.scene().look()->width, before.width);
    EXPECT_NE(hands.session.scene().look()->x, before.x);
    const Rectangle world = hands.state.places.at("mechanism");
    hands.state.places["corner"] = {world.x + 0.95F * world.width, world.y + 0.05F * world.height, 0.0F, 0.0F};
    hands.double_click("corner");
    EXPECT_FALSE(hands.session.scene().direction()) << "as the file draws it";
    EXPECT_FALSE(hands.session.scene().look());
    // In a plane there is nothing to turn: the picture moves.
    Hands flat("ball_on_sine");
    drag_beside(flat, &Input::left, 40.0, 0.0);
    EXPECT_FALSE(flat.session.scene().direction());
    EXPECT_TRUE(flat.session.scene().look());
}

TEST(TurnCommand, BelongsToTheSessionAndItsSystem) {
    Session session = test::session("ball_on_egg_crate");
    EXPECT_TRUE(session.apply(parse_command("turn 10 20")));
    EXPECT_NE(to_text(session).find("turn 10 20\n"), std::string::npos) << to_text(session);
    const std::vector<Command> steps = steps_to(session.scene());
    EXPECT_TRUE(
        std::any_of(steps.begin(), steps.end(), [](const Command& step) { return to_text(step) == "turn 10 20"; }));
    ASSERT_NE(session.mechanism().space(), nullptr);
    EXPECT_TRUE(session.apply(parse_command("set e 0.4")));
    EXPECT_NE(session.mechanism().space(), nullptr) << "the next run is seen from there, too";
    EXPECT_FALSE(session.apply(parse_command("turn 10 91")));
    EXPECT_NE(session.error().find("from -90 to 90"), std::string::npos) << session.error();
    EXPECT_TRUE(session.apply(parse_command("turn default")));
    EXPECT_EQ(session.mechanism().space(), nullptr);
    EXPECT_TRUE(session.apply(parse_command("turn 10 20")));
    for (const char* other : {"open ball_round_post", "open ball_on_sine"}) {
        EXPECT_TRUE(session.apply(parse_command(other)));
        EXPECT_EQ(session.mechanism().space(), nullptr) << other;
    }
    EXPECT_FALSE(session.apply(parse_command("turn 10 20")));
    EXPECT_NE(session.error().find("lies in a plane and cannot be turned"), std::string::npos) << session.error();
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
