// The table of actions: what menus, keys, the palette and the F1 card are made from.
#include "panels/actions.hpp"

#include <gtest/gtest.h>

#include <set>

#include "app/hands.hpp"

namespace achilles {
namespace {

using test::Hands;

TEST(Actions, HaveNamesAndKeysOfTheirOwnAndLinesThatAreCommands) {
    std::set<std::string_view> names, keys;
    for (const Action& one : actions()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name;
        if (!one.keys.empty()) {
            EXPECT_TRUE(keys.insert(one.keys).second) << one.name;
        }
        EXPECT_FALSE(one.menu.empty()) << one.name;
        if (!one.effect.run) {
            EXPECT_NO_THROW(parse_command(one.effect.command)) << one.name;
        }
    }
}

// Every key of the table does what the entry of the menu does.
TEST(Actions, DoTheSameByKeyAndByMenu) {
    for (const char* name : {"Dark theme", "Sweep", "Proof", "Equations", "Lecture", "Energy", "Next event"}) {
        const Action& one = action(name);
        Hands by_menu("ball_on_sine"), by_key("ball_on_sine");
        by_menu.click("bar " + std::string(one.menu));
        by_menu.click("menu " + std::string(name));
        if (one.keys.empty()) continue;
        const std::string key(one.keys);
        if (key.starts_with("Ctrl+"))
            by_key.press_with_control(key.back());
        else
            by_key.press(key == "F11" ? key::f11 : key::right);
        ASSERT_FALSE(by_menu.all.empty()) << name;
        EXPECT_EQ(by_key.all, by_menu.all) << name;
    }
}

TEST(Actions, TurnOffWhatIsOn) {
    Hands hands("ball_on_sine");
    const auto done = [&](const char* name) {
        Commands commands;
        perform(action(name), hands.session, hands.state, commands);
        for (const Command& command : commands) hands.session.apply(command);
        return is_on(action(name), hands.session);
    };
    for (const char* name : {"Dark theme", "Sweep", "Lecture", "Loop playback", "Energy"}) {
        EXPECT_TRUE(done(name)) << name;
        EXPECT_FALSE(done(name)) << name;
    }
    for (const char* name : {"Plots", "Events", "Link time", "Trail"}) {
        EXPECT_FALSE(done(name)) << name;
        EXPECT_TRUE(done(name)) << name;
    }
    // A study in front of the events is put away, and the events are seen.
    hands.session.apply(command::Show{"sweep", true});
    EXPECT_FALSE(is_on(action("Events"), hands.session));
    EXPECT_TRUE(done("Events"));
    EXPECT_EQ(hands.session.scene().below(), "events");
}

// Back and Forward go through zooms and choices; turns of the wheel in quick succession are one.
TEST(Views, GoBackAndForward) {
    Hands hands("ball_on_sine");
    const std::string first = to_text(hands.session.plotted());
    hands.session.apply(parse_command("zoom 1 0 5 -1 1"));
    hands.rest(60);
    const std::string zoomed = to_text(hands.session.plotted());
    hands.session.apply(parse_command("plot 2 t energy"));
    hands.rest(60);
    const std::string chosen = to_text(hands.session.plotted());
    const auto go = [&](int code) {
        hands.hand.keys = {key::left_alt};
        hands.rest(1);
        hands.hand.keys.push_back(code);
        hands.rest(2);
        hands.hand.keys.clear();
        hands.rest(3);
        return to_text(hands.session.plotted());
    };
    EXPECT_EQ(go(key::left), zoomed);
    EXPECT_EQ(go(key::left), first);
    EXPECT_EQ(go(key::left), first) << "there is nothing before";
    EXPECT_EQ(hands.session.time(), 0.0) << "the player does not hear these arrows";
    EXPECT_EQ(go(key::right), zoomed);
    EXPECT_EQ(go(key::right), chosen);
    go(key::left);
    hands.point("plot 0");
    for (int i = 0; i < 3; ++i) {
        hands.hand.wheel = 1.0;
        hands.rest(1);
        hands.hand.wheel = 0.0;
        hands.rest(2);
    }
    EXPECT_NE(to_text(hands.session.plotted()), zoomed);
    EXPECT_EQ(go(key::left), zoomed) << "the turns are one step";
}

TEST(Copy, PutsTablesOnTheClipboard) {
    Hands hands("ball_on_sine");
    const auto copied = [&](const std::string& line) {
        hands.session.apply(parse_command(line));
        EXPECT_EQ(hands.session.error(), "") << line;
        return hands.session.copied();
    };
    EXPECT_EQ(copied("copy data").rfind("t,", 0), 0U);
    const std::string plots = copied("copy plots"), second = copied("copy plots 2");
    EXPECT_NE(plots.find(second), std::string::npos) << "one of them is the second plot's";
    EXPECT_GT(plots.size(), 2 * second.size());
    EXPECT_EQ(second.substr(0, second.find('\n')), "t [s]\ty [m]");
    EXPECT_EQ(hands.session.notice(), "copied plot 2 as a table");
    copied("select 3");
    const std::string event = copied("copy events");
    EXPECT_EQ(std::count(event.begin(), event.end(), '\n'), 2) << event;
    for (const char* wrong : {"copy plots 9", "copy data 2", "copy run 1"}) {
        hands.session.apply(parse_command(wrong));
        EXPECT_NE(hands.session.error(), "") << wrong;
    }
}

TEST(Copy, HandsOverAPicture) {
    SystemSource library = test::library();
    std::string png;
    library.copy_picture = [&](const std::string& bytes) { png = bytes; };
    Session session("ball_on_sine", test::system("ball_on_sine"), library);
    session.apply(parse_command("copy picture 1"));
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(session.notice(), "copied plot 1 as a picture");
}

}  // namespace
}  // namespace achilles
