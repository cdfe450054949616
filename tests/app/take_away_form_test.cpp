// The dialog that takes things away: it says what comes of it, and writes that.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/dropped.hpp"
#include "journal/journal.hpp"

namespace achilles {
namespace {

TEST(TakeAway, the_dialog_says_the_size_and_writes_it) {
    const test::Folder folder;
    test::Hands hands("ball_on_sine");
    hands.session.apply(parse_command("show export"));
    hands.rest(3);
    EXPECT_TRUE(hands.says("1200 \u00d7 800 px"));
    hands.click("take page");
    hands.click("take a column of two (85 mm)");
    hands.rest(2);
    EXPECT_TRUE(hands.says("85 \u00d7 56.67 mm, text of 8 pt")) << hands.letters();
    hands.click("take png");
    hands.rest(3);
    EXPECT_EQ(hands.state.editor.path, "ball_on_sine.png");
    EXPECT_TRUE(hands.says("85 \u00d7 56.67 mm, 1004 \u00d7 669 px at 300 dpi"));
    hands.click("take what");
    hands.click("take plot 2: height");
    hands.click("take dark");
    hands.click("path");
    hands.press_with_control('A');
    hands.type((folder.path() / "a.png").string());
    hands.press(key::enter);
    hands.rest(2);
    ASSERT_EQ(hands.session.error(), "");
    EXPECT_FALSE(hands.session.scene().shows("export"));
    const auto is_export = [](const Command& c) { return std::holds_alternative<command::Export>(c); };
    const auto given = std::find_if(hands.all.begin(), hands.all.end(), is_export);
    ASSERT_NE(given, hands.all.end());
    EXPECT_EQ(to_text(*given), "export " + (folder.path() / "a.png").string() + " plot 2 width 85 dark");
    Session again = test::session("double_pendulum");
    for (const Command& c : session_in((folder.path() / "a.png").string(), trust_of(true, {}))) again.apply(c);
    EXPECT_EQ(again.system(), "ball_on_sine");
    EXPECT_EQ(again.plotted().list().size(), 1U);
}

TEST(TakeAway, a_size_that_is_none_is_told_and_nothing_is_written) {
    const test::Folder folder;
    test::Hands hands("ball_on_sine");
    hands.session.apply(parse_command("show export"));
    hands.rest(3);
    hands.state.take_away.width = 5.0;
    hands.state.editor.path = (folder.path() / "a.svg").string();
    hands.rest(2);
    EXPECT_TRUE(hands.says("a width of 5 mm is none"));
    hands.click("dialog Export");
    EXPECT_TRUE(hands.session.scene().shows("export"));
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("export"));
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace achilles
