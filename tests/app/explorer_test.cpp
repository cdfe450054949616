#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "app/hands.hpp"
#include "output/output.hpp"
#include "surface/window.hpp"

namespace achilles {
namespace {

using test::Hands;

TEST(Explorer, DoesNothingByItself) {
    Hands hands("ball_on_sine");
    EXPECT_TRUE(hands.all.empty());
}

TEST(Explorer, ADraggedSliderChangesTheTrajectoryAndDerivesNothing) {
    Hands hands("ball_on_sine");
    const auto model = hands.session.model();
    const std::string before = to_text(hands.session.trajectory());
    hands.point("set g", 0.3);
    hands.hand.left = true;
    for (int i = 0; i < 10; ++i) {
        hands.hand.mouse_x += 4.0;
        hands.frame();
    }
    hands.hand.left = false;
    hands.rest(2);
    EXPECT_GE(hands.all.size(), 5U);
    for (const Command& command : hands.all) {
        ASSERT_TRUE(std::holds_alternative<command::Set>(command)) << to_text(command);
        EXPECT_EQ(std::get<command::Set>(command).name, "g");
    }
    EXPECT_NE(hands.session.run().parameters[1], 1.0);
    EXPECT_NE(to_text(hands.session.trajectory()), before);
    EXPECT_EQ(hands.session.model(), model);
    EXPECT_EQ(hands.session.error(), "");
}

TEST(Explorer, EveryValueHasASliderThatWorks) {
    for (const char* system : {"ball_on_sine", "double_pendulum"}) {
        Hands hands(system);
        hands.click("accuracy");
        EXPECT_EQ(hands.all, std::vector<Command>{(command::Show{"accuracy", true})});
        std::vector<std::string> names;
        for (const auto& p : hands.session.description().parameters) names.push_back("set " + p.name);
        for (const auto& c : hands.session.description().coordinates)
            names.insert(names.end(), {"set " + c.name, "set " + c.name + "'"});
        names.insert(names.end(), {"tolerance", "end", "eps", "eps q", "eps v", "eps t"});
        for (const std::string& name : names) {
            hands.all.clear();
            // Beside the grab, since a click on the grab does not move it.
            hands.click(name, name == "eps" || name == "end" ? 0.6 : 0.8);
            std::erase(hands.all, Command(command::EndEdit{}));  // ends the change of the previous slider
            ASSERT_FALSE(hands.all.empty()) << system << ": " << name;
            EXPECT_EQ(to_text(hands.all[0]).rfind(name.substr(0, name.rfind("eps ", 0) == 0 ? 3 : name.size()), 0), 0U)
                << system << ": " << name << ": " << to_text(hands.all[0]);
        }
    }
}

TEST(Explorer, ATypedValueIsKeptExactly) {
    Hands hands("ball_on_sine");
    hands.point("set g");
    hands.hand.keys = {key::left_control};
    hands.rest(1);
    hands.hand.left = true;
    hands.rest(1);
    hands.hand.left = false;
    hands.hand.keys.clear();
    hands.rest(2);
    hands.hand.text = "9.806650001";
    hands.rest(1);
    hands.hand.text.clear();
    hands.press(key::enter);
    EXPECT_EQ(hands.session.run().parameters[1], 9.806650001);
}

TEST(Explorer, PlaysSeeksSelectsAndOpens) {
    Hands hands("ball_on_sine");
    hands.click("play");
    EXPECT_TRUE(hands.session.playing());
    hands.press(' ');
    EXPECT_FALSE(hands.session.playing());
    hands.click("timeline", 0.5);
    EXPECT_NEAR(hands.session.time(), 10.0, 0.1);
    hands.click("plot 1", 0.25);
    EXPECT_NEAR(hands.session.time(), 5.0, 0.1);
    hands.session.apply(command::Seek{0.0});
    hands.rest(2);
    hands.click("impacts 1");
    hands.click("event 2");
    EXPECT_EQ(hands.session.selected(), 2);
    EXPECT_EQ(hands.session.time(), hands.session.trajectory().events[1].t);
    hands.click("accuracy");
    hands.click("reinitialization euclidean");
    EXPECT_EQ(hands.session.run().options.truncation.reinitialization, Reinitialization::euclidean);
    for (const Conditions conditions : {Conditions::paper, Conditions::sharp}) {
        hands.click("conditions " + std::string(to_text(conditions)));
        EXPECT_EQ(hands.session.run().options.truncation.conditions, conditions);
        hands.all.clear();
        hands.click("conditions " + std::string(to_text(conditions)));
        EXPECT_TRUE(hands.all.empty()) << "what is so already needs no command";
    }
    EXPECT_FALSE(hands.session.scene().loops());
    hands.click("loop", 0.2);
    EXPECT_TRUE(hands.session.scene().loops());
    EXPECT_EQ(hands.all, std::vector<Command>{command::Loop{true}});
    hands.click("systems");
    hands.click("open double_pendulum");
    EXPECT_EQ(hands.session.system(), "double_pendulum");
}

TEST(Explorer, DrawsTheSameBytesEveryTime) {
    for (const double scale : {1.0, 2.0}) {
        const SurfaceOptions options =
            test::surface(static_cast<int>(1280 * scale), static_cast<int>(800 * scale), scale);
        Hands a("double_pendulum", options), b("double_pendulum", options);
        EXPECT_EQ(a.picture(), b.picture());
    }
}

TEST(Explorer, FitsAnyWindowAndShowsMessages) {
    for (const auto& [width, height] :
         {std::pair{1, 1}, std::pair{60, 900}, std::pair{1200, 40}, std::pair{300, 200}}) {
        Hands hands("ball_on_sine", test::surface(width, height));
        hands.session.apply(command::Set{"e", 7.0});
        EXPECT_NE(hands.session.error(), "");
        EXPECT_EQ(hands.picture().width, width);
    }
}

// tests/app/window_test.sh reads from this test where to drag the mouse in a window of this size: it presses at a third
// of the slider and moves right by tenths of the width. This test does the same with the printed numbers: g follows the
// mouse, and nothing else changes.
TEST(Explorer, TellsWhereTheSliderOfGIs) {
    Hands hands("ball_on_sine", test::surface(1280, 800));
    ASSERT_TRUE(hands.state.places.contains("set g"));
    const Rectangle r = hands.state.places.at("set g");
    const int x = static_cast<int>(r.x), y = static_cast<int>(r.y + 0.5F * r.height), width = static_cast<int>(r.width);
    std::printf("slider %d %d %d\n", x, y, width);
    const Point tab = hands.middle("tab equations");
    std::printf("tab %d %d\n", static_cast<int>(tab.x), static_cast<int>(tab.y));
    ASSERT_GE(x, 0);
    ASSERT_LE(x + width, 1280);
    ASSERT_GE(width, 50);  // a tenth of it exceeds the click tolerance

    hands.hand.mouse_x = x + width / 3.0;
    hands.hand.mouse_y = y;
    hands.rest(2);
    hands.hand.left = true;
    hands.rest(2);
    std::vector<double> followed;
    for (int step = 0; step <= 4; ++step) {
        if (step == 0) hands.hand.mouse_x += 4.0;  // a press without motion may start a double click
        if (step > 0) hands.hand.mouse_x = x + width / 3.0 + step * width / 10.0;
        hands.rest(2);
        followed.push_back(hands.session.run().parameters[1]);
    }
    hands.hand.left = false;
    hands.rest(2);
    for (std::size_t i = 1; i < followed.size(); ++i) EXPECT_GT(followed[i], followed[i - 1]);
    for (const Command& command : hands.all) EXPECT_EQ(to_text(command).rfind("set g ", 0), 0U) << to_text(command);

    // The printed width is that of the slider: over it g goes through its logarithmic range. The grab takes part of the
    // width, so g changes a little faster.
    const auto& range = hands.session.description().parameters[1].range;
    const double share = std::log(followed[4] / followed[1]) / std::log(range[1] / range[0]);
    EXPECT_GE(share, 0.27);
    EXPECT_LE(share, 0.45);
}

TEST(ExplorerOnDisplay, TheWindowShowsTheBytesOfThePicture) {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no DISPLAY";
    const Session session = test::session("ball_on_sine");
    PanelState offscreen_state = test::panels(), window_state = test::panels();
    Offscreen surface(test::surface());
    const Image expected = surface.frame([&] { explorer(session, offscreen_state); }, 3);
    Window window(test::surface(), "Achilles");
    int frames = 0;
    window.run([&] {
        ImGui::GetIO().MousePos = {-1e6F, -1e6F};  // away from all controls, wherever the display's pointer is
        explorer(session, window_state);
        if (++frames == 3) window.close();
    });
    EXPECT_EQ(window.picture(), expected);
}

}  // namespace
}  // namespace achilles
