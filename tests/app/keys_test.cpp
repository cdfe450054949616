// Keyboard ownership: the part in front receives all keys, parts behind it none.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/hands.hpp"
#include "app/program.hpp"

namespace achilles {
namespace {

using test::Hands;

void press_together(Hands& hands, const std::vector<int>& codes) {
    for (const int code : codes) {
        hands.hand.keys.push_back(code);
        hands.rest(1);
    }
    hands.rest(1);
    hands.hand.keys.clear();
    hands.rest(2);
}

// Every key that the panels use, alone and with Ctrl. A menu uses some itself to close or to go to the next one.
void press_all(Hands& hands, bool is_menu) {
    std::vector<int> codes{key::home, key::end, key::f11, key::f1};
    if (!is_menu) codes.insert(codes.end(), {' ', key::left, key::right});
    for (const int code : codes) hands.press(code);
    for (const char code : std::string("1234560D=-SONEGZYC")) hands.press_with_control(code);
    press_together(hands, {key::left_control, key::left_shift, 'Z'});
    press_together(hands, {key::left_control, key::left_shift, 'P'});
}

// The visible state of the session and of the dialogs.
std::string seen(const Hands& hands) {
    return to_text(hands.session) + (hands.session.playing() ? "playing" : "") +
           std::to_string(static_cast<int>(hands.state.editor.asking));
}

TEST(Keys, ReachNothingBehindAMenuOrADialog) {
    for (const std::string front : {"systems", "bar View", "dialog", "manual"}) {
        Hands hands("ball_on_sine");
        hands.session.apply(command::Set{"e", 0.7});
        hands.session.apply(command::Seek{1.0});
        hands.rest(2);
        if (front == "dialog") {
            hands.press_with_control('O');
            hands.click("dialog Cancel", -0.5);  // beside the button: no text field is active
        } else if (front == "manual") {
            hands.state.manual_text = "A page.";
            hands.state.opens_manual = true;
        } else {
            hands.click(front);
        }
        hands.rest(3);
        const std::string before = seen(hands);
        hands.all.clear();
        press_all(hands, front == "systems" || front == "bar View");
        EXPECT_EQ(seen(hands), before) << front;
        for (const Command& command : hands.all) ADD_FAILURE() << front << " lets through: " << to_text(command);
    }
}

// (Except the palette's own shortcut on other cards, which it replaces.)
TEST(Keys, ReachNothingBehindThePalette) {
    for (const char* front : {"palette", "gallery", "help"}) {
        Hands hands("ball_on_sine");
        hands.session.apply(command::Show{front, true});
        hands.rest(3);
        const std::string before = seen(hands);
        hands.all.clear();
        hands.press(key::f11);
        for (const char code : std::string("1234560D=-SONEZY")) hands.press_with_control(code);
        if (std::string(front) != "help") hands.press(key::f1);
        if (std::string(front) != "gallery") hands.press_with_control('G');
        EXPECT_EQ(seen(hands), before) << front;
        for (const Command& command : hands.all) ADD_FAILURE() << front << " lets through: " << to_text(command);
    }
}

// The same shortcuts show and hide them.
TEST(Keys, ShowAndHideWhatStandsInFront) {
    Hands hands("ball_on_sine");
    const auto toggle = [&](const std::string& what) {
        if (what == "help") hands.press(key::f1);
        if (what == "gallery") hands.press_with_control('G');
        if (what == "palette") press_together(hands, {key::left_control, key::left_shift, 'P'});
        hands.rest(2);
    };
    for (const char* what : {"help", "gallery", "palette"}) {
        toggle(what);
        EXPECT_TRUE(hands.session.scene().shows(what)) << what;
        toggle(what);
        EXPECT_FALSE(hands.session.scene().shows(what)) << what;
    }
    hands.press(key::right);
    EXPECT_GT(hands.session.time(), 0.0) << "the player has them again";
}

struct ExportDialog : test::Folder {
    ExportDialog() : hands("ball_on_sine") {
        put("foreign.svg", "of somebody else");
        hands.session.apply(command::Show{"export", true});
        hands.rest(3);
        hands.press_with_control('A');
        hands.type((path() / "").string());
        hands.rest(2);
        EXPECT_EQ(hands.state.browser.rows.size(), 1U);
    }
    // The selected row of the file list after Down.
    int row_after_down() {
        hands.press(key::down);
        return hands.state.browser.chosen;
    }
    Hands hands;
};

TEST(Keys, OfADropDownChooseNoFileBehindIt) {
    ExportDialog dialog;
    Hands& hands = dialog.hands;
    hands.click("take page");
    EXPECT_EQ(dialog.row_after_down(), -1);
    // Escape closes only the list of widths.
    hands.press(key::escape);
    EXPECT_TRUE(hands.session.scene().shows("export"));
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::export_run);
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("export"));
}

TEST(Keys, OfANumberChooseNoFileBelowIt) {
    ExportDialog dialog;
    Hands& hands = dialog.hands;
    hands.click("take page");
    hands.click("take one of two columns (85 mm)");
    hands.click("take field width");
    EXPECT_EQ(dialog.row_after_down(), -1);
    hands.press(key::enter);
    EXPECT_EQ(test::content(dialog.path() / "foreign.svg"), "of somebody else");
}

TEST(Keys, OfARingChooseNoFile) {
    ExportDialog dialog;
    for (int i = 0; i < 40 && dialog.hands.state.focus.at != "dialog Cancel"; ++i) dialog.hands.press(key::tab);
    ASSERT_EQ(dialog.hands.state.focus.at, "dialog Cancel");
    EXPECT_EQ(dialog.row_after_down(), -1);
    const std::string path = dialog.hands.state.editor.path;
    dialog.hands.type("z");
    EXPECT_EQ(dialog.hands.state.editor.path, path) << "letters go to the field while the ring is elsewhere";
}

// If no control of the dialog has the keys, arrows walk the file list and Enter chooses a row.
TEST(Keys, OfADialogWithoutALettersFieldAreTheFileLists) {
    ExportDialog dialog;
    Hands& hands = dialog.hands;
    hands.click("take dark");
    EXPECT_EQ(dialog.row_after_down(), 0);
    hands.press(key::enter);
    hands.rest(2);
    EXPECT_EQ(hands.state.editor.path, (dialog.path() / "foreign.svg").string());
    EXPECT_EQ(test::content(dialog.path() / "foreign.svg"), "of somebody else");
}

// A row selected in one dialog is not chosen by Enter in the next.
TEST(Keys, ForgetTheRowOfAnotherDialog) {
    ExportDialog dialog;
    Hands& hands = dialog.hands;
    EXPECT_EQ(dialog.row_after_down(), 0);
    hands.press(key::escape);
    hands.session.apply(command::Show{"export", true});
    hands.rest(4);
    EXPECT_EQ(hands.state.browser.chosen, -1);
}

// A dialog that opens ignores keys that were pressed before it was visible.
TEST(Keys, PressedEarlierDoNotAnswerANewDialog) {
    Hands hands("ball_on_sine");
    hands.state.recovery_question = RecoveryQuestion{"mine.toml", "today"};
    hands.hand.keys = {key::enter};
    hands.rest(2);
    ASSERT_TRUE(hands.state.recovery_question);
    EXPECT_EQ(hands.state.recovery_question->answer, RecoveryQuestion::RecoveryChoice::none);
    hands.hand.keys.clear();
    hands.rest(2);
    hands.press(key::enter);
    EXPECT_EQ(hands.state.recovery_question->answer, RecoveryQuestion::RecoveryChoice::recover);
}

}  // namespace
}  // namespace achilles
