// The export dialog: its messages and the files it writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/inputs.hpp"
#include "journal/journal.hpp"

namespace achilles {
namespace {

TEST(ExportDialog, TheDialogSaysTheSizeAndWritesIt) {
    const test::Folder folder;
    test::Hands hands("ball_on_sine");
    hands.session.apply(parse_command("show export"));
    hands.rest(3);
    EXPECT_TRUE(hands.says("1200 \u00d7 800 px"));
    hands.click("take page");
    hands.click("take one of two columns (85 mm)");
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

TEST(ExportDialog, ASizeThatIsNoneIsToldAndNothingIsWritten) {
    const test::Folder folder;
    test::Hands hands("ball_on_sine");
    hands.session.apply(parse_command("show export"));
    hands.rest(3);
    hands.state.export_form.on_paper = true;
    hands.state.export_form.width = 5.0;
    hands.state.editor.path = (folder.path() / "a.svg").string();
    hands.rest(2);
    EXPECT_TRUE(hands.says("the width of a picture cannot be 5 mm: use 20 to 1200 mm"));
    hands.click("dialog Export");
    EXPECT_TRUE(hands.session.scene().shows("export"));
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("export"));
    EXPECT_TRUE(folder.files().empty());
}

// Whether a button of the dialog is enabled.
bool can_press(const test::Hands& hands, const std::string& name) {
    const auto& stops = hands.state.focus.stops;
    return std::any_of(stops.begin(), stops.end(), [&](const FocusTarget& stop) { return stop.name == name; });
}

// A folder that replaces PATH while this object lives.
class ProgramFolder : public test::Folder {
 public:
    ProgramFolder() { ::setenv("PATH", path().c_str(), 1); }
    ~ProgramFolder() { ::setenv("PATH", before_.c_str(), 1); }
    // Adds a program that does nothing.
    void add(const std::string& name) const {
        put(name, "#!/bin/sh\n");
        std::filesystem::permissions(path() / name, std::filesystem::perms::owner_all);
    }

 private:
    std::string before_ = std::getenv("PATH") == nullptr ? "" : std::getenv("PATH");
};

// Every menu entry opens a complete dialog: Enter alone writes the file it shows.
TEST(ExportDialog, EntryOfTheMenuIsReady) {
    const ProgramFolder programs;
    programs.add("ffmpeg");
    const std::pair<const char*, const char*> entries[] = {{"Export film\u2026", "mp4"},
                                                           {"Export figure\u2026", "svg"},
                                                           {"Export data\u2026", "csv"},
                                                           {"Save session\u2026", "journal"}};
    for (const auto& [entry, ending] : entries) {
        test::Hands hands("ball_on_sine");
        hands.click("bar File");
        hands.click(std::string("menu ") + entry);
        hands.rest(3);
        EXPECT_EQ(hands.state.editor.path, std::string("ball_on_sine.") + ending);
        EXPECT_TRUE(can_press(hands, "dialog Export")) << entry;
        EXPECT_TRUE(hands.says(std::string("ball_on_sine.") + ending)) << entry;
        const bool is_film = std::string(ending) == "mp4";
        EXPECT_EQ(hands.state.export_form.what == ExportForm::ExportSubject::film, is_film);
        EXPECT_EQ(hands.says("1280 \u00d7 800 px"), is_film) << entry;
    }
}

// The dialog says what is missing before a name is typed, and Enter draws no frames.
TEST(ExportDialog, FilmNeedsFfmpeg) {
    const ProgramFolder programs;  // no programs
    const test::Folder folder;
    test::Hands hands("ball_on_sine");
    hands.click("bar File");
    hands.click("menu Export film\u2026");
    hands.rest(3);
    EXPECT_EQ(hands.state.editor.path, "ball_on_sine.mp4");
    EXPECT_FALSE(can_press(hands, "dialog Export"));
    EXPECT_TRUE(hands.says("a film needs ffmpeg, which is not installed"));
    hands.type((folder.path() / "short").string());
    hands.press(key::enter);
    hands.rest(2);
    EXPECT_TRUE(hands.says("a film needs ffmpeg, which is not installed")) << "the dialog is closed";
    EXPECT_TRUE(folder.files().empty());
    EXPECT_EQ(hands.session.error(), "");
    // After ffmpeg is added, the same dialog exports.
    programs.add("ffmpeg");
    hands.rest(2);
    EXPECT_TRUE(can_press(hands, "dialog Export"));
    EXPECT_TRUE(hands.says((folder.path() / "short.mp4").string()));
}

// Typing replaces the whole name; a name without an extension gets that of the format.
TEST(ExportDialog, NameIsTypedOverAndEndsAsTheKindSays) {
    const test::Folder folder;
    test::Hands hands("ball_on_sine");
    hands.click("bar File");
    hands.click("menu Export figure\u2026");
    hands.rest(3);
    hands.click("take png");
    hands.click("path");
    hands.press_with_control('A');
    hands.type((folder.path() / "short").string());
    hands.rest(2);
    EXPECT_EQ(hands.state.editor.path, (folder.path() / "short").string()) << "the rest of the proposed name stays";
    EXPECT_TRUE(can_press(hands, "dialog Export"));
    EXPECT_TRUE(hands.says("1200 \u00d7 800 px"));
    EXPECT_TRUE(hands.says((folder.path() / "short.png").string()));
    // An unknown extension is refused, without a message about the size.
    hands.type(".pn");
    hands.rest(2);
    EXPECT_FALSE(can_press(hands, "dialog Export"));
    EXPECT_TRUE(hands.says("1200 \u00d7 800 px"));
    EXPECT_FALSE(hands.says("above 0"));
    hands.type("g");
    hands.press(key::enter);
    hands.rest(2);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"short.png"}) << hands.session.error();
}

// A width in mm with a format that has no size on paper: the message is not about the width.
TEST(ExportDialog, WidthIsWrongOnlyWhereItIs) {
    test::Hands hands("ball_on_sine");
    hands.session.apply(parse_command("show export"));
    hands.rest(3);
    hands.click("take page");
    hands.click("take one of two columns (85 mm)");
    hands.click("path");
    hands.press_with_control('A');
    for (const char* path : {"a", "a.s", "a.csv", "a.5", "a.svg"}) {
        hands.press_with_control('A');
        hands.type(path);
        hands.rest(2);
        EXPECT_FALSE(hands.says("above 0")) << path;
    }
    hands.state.export_form.width = 0.0;
    hands.rest(2);
    EXPECT_TRUE(hands.says("width must be above 0, not 0"));
    EXPECT_FALSE(can_press(hands, "dialog Export"));
    EXPECT_TRUE(hands.state.places.contains("take field width")) << "its field is there to be mended";
}

// All numbers of the size and their units are within the dialog, and the height is the drawn one.
TEST(ExportDialog, SizeIsReadWhole) {
    for (const double scale : {1.0, 1.5}) {
        test::Hands hands("ball_on_sine",
                          test::surface(static_cast<int>(1280 * scale), static_cast<int>(800 * scale), scale));
        hands.click("bar File");
        hands.click("menu Export figure\u2026");
        hands.rest(3);
        hands.click("take png");
        hands.click("take page");
        hands.click("take one of two columns (85 mm)");
        hands.rest(3);
        const double right = scale * (640.0 + 280.0 - 16.0), unit = scale * 32.0;
        for (const char* field : {"width", "height", "font", "dpi"}) {
            const Rectangle& area = hands.state.places.at(std::string("take field ") + field);
            EXPECT_LT(area.x + area.width + unit, right) << field;
        }
        EXPECT_TRUE(hands.says("300dpi")) << hands.letters();
        EXPECT_TRUE(hands.says("56.67mm")) << "the height of the field: " << hands.letters();
        // After typing another height, "fits" restores the automatic one.
        hands.click("take field height");
        hands.press_with_control('A');
        hands.type("40");
        hands.press(key::enter);
        EXPECT_EQ(hands.state.export_form.height, 40.0);
        EXPECT_TRUE(hands.says("85 \u00d7 40 mm"));
        hands.click("take fits");
        EXPECT_EQ(hands.state.export_form.height, 0.0);
        EXPECT_TRUE(hands.says("85 \u00d7 56.67 mm"));
    }
}

TEST(ExportDialog, FilmNeedsANumberOfPicturesASecond) {
    test::Hands hands("ball_on_sine");
    hands.click("bar File");
    hands.click("menu Export film\u2026");
    hands.rest(3);
    hands.click("take field fps");
    hands.press_with_control('A');
    hands.type("-5");
    hands.press(key::enter);
    EXPECT_FALSE(can_press(hands, "dialog Export"));
    EXPECT_TRUE(hands.says("the frames per second must be above 0, not -5"));
}

// The dialog grows downward: its fields stay where they are while one types, and with other contents.
TEST(ExportDialog, KeepsItsPlace) {
    test::Hands hands("ball_on_sine");
    hands.session.apply(command::Show{"export", true});
    hands.rest(3);
    const Rectangle before = hands.state.places.at("take what");
    hands.state.editor.path = "/no/such/folder/a.svg";
    hands.state.export_form.on_paper = true;
    hands.rest(3);
    const Rectangle after = hands.state.places.at("take what");
    EXPECT_EQ(before.x, after.x);
    EXPECT_EQ(before.y, after.y);
}

}  // namespace
}  // namespace achilles
