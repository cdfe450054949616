// The gallery and its thumbnails.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/hands.hpp"
#include "pictures/thumbnails.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

TEST(Thumbnails, ComeOneByOneAndAreTheSameAgain) {
    const auto find = [](const std::string& name) -> fs::path {
        return ACHILLES_SOURCE_DIR "/assets/systems/" + name + ".toml";
    };
    Thumbnails lazy(find, false), eager(find, true);
    EXPECT_EQ(lazy.find("ball_on_floor"), nullptr);
    EXPECT_EQ(lazy.find("double_pendulum"), nullptr);
    for (int i = 0; i < 2000 && lazy.find("double_pendulum") == nullptr; ++i) {
        lazy.find("ball_on_floor");
        lazy.update();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    for (const char* name : {"ball_on_floor", "double_pendulum"}) {
        ASSERT_NE(lazy.find(name), nullptr);
        const auto &a = lazy.find(name)->light.shapes, &b = eager.find(name)->light.shapes;
        ASSERT_FALSE(a.empty());
        ASSERT_EQ(a.size(), b.size());
        EXPECT_EQ(a.back().points.back().x, b.back().points.back().x);
    }
    lazy.update();
    EXPECT_FALSE(lazy.is_busy());
    // A missing system has an empty picture and does not block the others.
    EXPECT_TRUE(eager.find("none")->light.shapes.empty());
}

TEST(Gallery, IsWalkedByArrowsAndOpens) {
    test::Hands hands("ball_on_sine");
    hands.press_with_control('G');
    hands.rest(3);
    ASSERT_TRUE(hands.session.scene().shows("gallery"));
    EXPECT_EQ(hands.state.focus.at, "gallery ball_on_sine");
    hands.press(key::right);
    EXPECT_EQ(hands.state.focus.at, "gallery double_pendulum");
    hands.press(key::enter);
    hands.rest(2);
    EXPECT_EQ(hands.session.system(), "double_pendulum");
    EXPECT_FALSE(hands.session.scene().shows("gallery"));
    hands.press_with_control('G');
    hands.press(key::escape);
    hands.rest(2);
    EXPECT_FALSE(hands.session.scene().shows("gallery"));
}

}  // namespace
}  // namespace achilles
