// Keyboard focus: the player has the keys or, after Tab, a control.
#include <gtest/gtest.h>

#include <set>

#include "app/hands.hpp"

namespace achilles {
namespace {

FocusTarget stop(const char* name, float x, float y, unsigned window = 1) {
    return {name, {x, y, 10.0F, 10.0F}, 1, window};
}

TEST(Focus, AnArrowGoesToWhatLiesThere) {
    const std::vector<FocusTarget> stops{stop("here", 100, 100), stop("right", 150, 104), stop("far right", 400, 100),
                                         stop("below", 90, 160), stop("elsewhere", 120, 100, 2)};
    const auto name = [&](int at) { return at < 0 ? std::string() : stops[static_cast<std::size_t>(at)].name; };
    EXPECT_EQ(name(neighbor(stops, stops[0], 1, 0)), "right");
    EXPECT_EQ(name(neighbor(stops, stops[1], 1, 0)), "far right");
    EXPECT_EQ(name(neighbor(stops, stops[0], 0, 1)), "below");
    EXPECT_EQ(name(neighbor(stops, stops[3], 0, -1)), "here");
    EXPECT_EQ(name(neighbor(stops, stops[0], -1, 0)), "");
    EXPECT_EQ(name(neighbor(stops, stops[0], 0, -1)), "");
}

TEST(Focus, ThePlayerHasTheKeysUntilTabAndAgainAfterEscape) {
    test::Hands hands("ball_on_sine");
    hands.press(' ');
    EXPECT_TRUE(hands.session.playing());
    hands.press(' ');
    ASSERT_FALSE(hands.session.playing());
    hands.press(key::home);
    hands.press(key::right);
    const double first = hands.session.time();
    ASSERT_GT(first, 0.0);
    hands.press(key::tab);
    ASSERT_EQ(hands.state.focus.at, "bar File");
    hands.press(key::right);
    EXPECT_EQ(hands.state.focus.at, "bar Edit");
    EXPECT_EQ(hands.session.time(), first) << "the arrow moved the time as well";
    hands.press(key::escape);
    EXPECT_EQ(hands.state.focus.at, "");
    hands.press(key::right);
    EXPECT_GT(hands.session.time(), first);
    hands.press(' ');
    EXPECT_TRUE(hands.session.playing());
}

TEST(Focus, TheMouseGivesTheKeysBack) {
    test::Hands hands("ball_on_sine");
    hands.press(key::tab);
    ASSERT_NE(hands.state.focus.at, "");
    hands.click("play");
    EXPECT_EQ(hands.state.focus.at, "");
    EXPECT_TRUE(hands.session.playing());
}

// Tab visits every control of the window once; Shift+Tab goes back.
TEST(Focus, TabWalksEverythingAndComesBack) {
    test::Hands hands("ball_on_sine");
    std::set<std::string> met;
    hands.press(key::tab);
    const std::string first = hands.state.focus.at;
    while (met.insert(hands.state.focus.at).second) hands.press(key::tab);
    EXPECT_EQ(hands.state.focus.at, first);
    for (const char* name :
         {"bar Help", "switch theme", "systems", "editor", "set g", "play", "pin", "loop", "show trail"})
        EXPECT_TRUE(met.contains(name)) << name;
    EXPECT_FALSE(met.contains("mechanism"));
    hands.press(key::tab);
    hands.hand.keys = {key::left_shift, key::tab};
    hands.rest(2);
    hands.hand.keys.clear();
    hands.rest(2);
    EXPECT_EQ(hands.state.focus.at, first);
}

void go_to(test::Hands& hands, const std::string& name) {
    for (int i = 0; i < 100 && hands.state.focus.at != name; ++i) hands.press(key::tab);
    ASSERT_EQ(hands.state.focus.at, name);
}

TEST(Focus, ASliderGoesByArrowsIsTypedAndPutBack) {
    test::Hands hands("ball_on_sine");
    const double before = *hands.session.value("e");
    go_to(hands, "set e");
    hands.press(key::right);
    const double moved = *hands.session.value("e");
    EXPECT_GT(moved, before);
    EXPECT_EQ(hands.state.focus.at, "set e");
    hands.press(key::left);
    hands.press(key::left);
    EXPECT_LT(*hands.session.value("e"), before);
    hands.press(key::remove);
    EXPECT_EQ(*hands.session.value("e"), before);
    hands.press(key::enter);
    hands.rest(2);
    hands.type("0.25");
    hands.press(key::enter);
    hands.rest(2);
    EXPECT_EQ(*hands.session.value("e"), 0.25);
    EXPECT_FALSE(hands.session.playing());
}

TEST(Focus, EnterAndSpacePress) {
    test::Hands hands("ball_on_sine");
    go_to(hands, "show trail");
    ASSERT_TRUE(hands.session.scene().shows("trail"));
    hands.press(' ');
    EXPECT_FALSE(hands.session.scene().shows("trail"));
    EXPECT_FALSE(hands.session.playing());
    hands.press(key::enter);
    EXPECT_TRUE(hands.session.scene().shows("trail"));
    go_to(hands, "switch theme");
    hands.press(key::enter);
    EXPECT_TRUE(hands.session.theme().dark);
}

// Arrows walk a menu; Escape closes only the menu.
TEST(Focus, AMenuGoesByKeys) {
    test::Hands hands("ball_on_sine");
    go_to(hands, "bar View");
    hands.press(key::enter);
    hands.rest(2);
    for (const char* panel : {"controls", "plots", "events"}) ASSERT_TRUE(hands.session.scene().shows(panel));
    hands.press(key::down);
    hands.press(key::down);
    hands.press(key::enter);
    EXPECT_FALSE(hands.session.scene().shows("events")) << "the third line of the menu";
    hands.press(key::enter);
    hands.rest(2);
    hands.press(key::escape);
    EXPECT_EQ(hands.state.focus.at, "bar View");
    hands.press(key::escape);
    EXPECT_EQ(hands.state.focus.at, "");
}

// In a dialog Tab goes from the path to the next control and does not leave the dialog.
TEST(Focus, StaysInADialog) {
    test::Hands hands("ball_on_sine");
    hands.press_with_control('O');
    hands.rest(2);
    std::set<std::string> met;
    for (int i = 0; i < 4; ++i) {
        hands.press(key::tab);
        met.insert(hands.state.focus.at);
    }
    EXPECT_EQ(met, (std::set<std::string>{"dialog Cancel", "path"}));
    while (hands.state.focus.at != "dialog Cancel") hands.press(key::tab);
    hands.press(key::enter);
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::nothing);
}

}  // namespace
}  // namespace achilles
