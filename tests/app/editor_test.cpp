// The text editor: when changes take effect, error messages, and saving.
#include <gtest/gtest.h>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "journal/journal.hpp"
#include "output/output.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::content;
using test::Folder;
using test::Hands;

constexpr int frames_of_a_pause = 26;  // 0.4 s at 60 frames per second, and one to apply the text

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error("not in the text: " + from);
    return text.replace(at, from.size(), to);
}

std::string ball() { return test::system("ball_on_sine").source_text; }

// An explorer with its editor open.
struct Writer : Hands {
    explicit Writer(const std::string& system = "ball_on_sine", const SurfaceOptions& options = test::surface())
        : Hands(system, options) {
        session.apply(command::Show{"editor", true});
        rest(2);
    }
    void write(const std::string& text) {
        click("text");
        press_with_control('A');
        type(text);
    }
    // Types a path into a dialog, replacing its content.
    void write_path(const std::string& path) {
        press_with_control('A');
        type(path);
        rest(2);
        ASSERT_EQ(state.editor.path, path);
    }
    // Number of pixels in the error color within the text.
    int marked() {
        const Image image = picture();
        const Rectangle r = state.places.at("text");
        int count = 0;
        for (int y = static_cast<int>(r.y); y < static_cast<int>(r.y + r.height); ++y)
            for (int x = static_cast<int>(r.x); x < static_cast<int>(r.x + r.width); ++x) {
                const auto* pixel =
                    &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(x))];
                if (pixel[0] > pixel[1] + 12 && pixel[1] < pixel[2] + 3) ++count;
            }
        return count;
    }
    std::vector<std::string> told() const {
        std::vector<std::string> lines;
        for (const Command& command : all) lines.push_back(to_text(command).substr(0, 60));
        return lines;
    }
};

TEST(Editor, ShowsAndHidesAndDoesNothingByItself) {
    Hands hands("ball_on_sine");
    hands.click("editor");
    EXPECT_TRUE(hands.session.shows_editor());
    hands.rest(60);
    EXPECT_EQ(hands.state.editor.text, ball());
    hands.press_with_control('E');
    EXPECT_FALSE(hands.session.shows_editor());
    EXPECT_EQ(journal_text(hands.all), "show editor\nhide editor\n");
}

TEST(Editor, ATextTakesEffectWhenTheHandRests) {
    Writer hands;
    const std::string text = replaced(ball(), "value = 1.0, unit = \"m/s^2\"", "value = 2.5, unit = \"m/s^2\"");
    hands.write(text);
    hands.rest(frames_of_a_pause - 6);
    EXPECT_TRUE(hands.all.empty()) << "the hand has not rested yet";
    EXPECT_TRUE(is_typing(hands.state));
    hands.type("#");  // on the last line, which is empty
    hands.rest(frames_of_a_pause - 6);
    EXPECT_TRUE(hands.all.empty()) << "every letter begins the pause anew";
    hands.rest(10);
    ASSERT_EQ(hands.all, std::vector<Command>{command::SetText{text + "#"}});
    EXPECT_EQ(hands.session.run().parameters[1], 2.5);
    EXPECT_EQ(hands.session.trajectory().run.parameters[1], 2.5);
    EXPECT_TRUE(hands.session.document().problems.empty());
    hands.rest(60);
    EXPECT_EQ(hands.all.size(), 1U) << "once";
}

TEST(Editor, WhatCannotBeReadLeavesTheRunAndIsToldAsTheCommandLineTellsIt) {
    Writer hands;
    const std::string before = to_text(hands.session.trajectory());
    const std::string bad = replaced(ball(), "x'^2 + y'^2", "x'^2 + yy'^2");
    hands.write(bad);
    hands.rest(frames_of_a_pause);
    EXPECT_EQ(to_text(hands.session.trajectory()), before);
    ASSERT_EQ(hands.session.document().problems.size(), 1U);
    const InputError& problem = hands.session.document().problems[0];
    EXPECT_EQ(problem.at.line, 20);
    EXPECT_EQ(problem.at.column, 37);
    EXPECT_EQ(hands.session.error(), "") << "told under the text, not over the picture too";
    const Folder folder;
    folder.put("bad.toml", bad);
    Session other = test::session("ball_on_sine");
    other.apply(command::Open{(folder.path() / "bad.toml").string()});
    ASSERT_EQ(other.document().problems.size(), 1U);
    EXPECT_EQ(std::string(other.document().problems[0].what()) + "\n",
              folder.run("simulate " + (folder.path() / "bad.toml").string()).err);

    hands.write(ball());
    hands.rest(frames_of_a_pause);
    EXPECT_TRUE(hands.session.document().problems.empty());
    EXPECT_EQ(to_text(hands.session.trajectory()), before);
}

// The wavy underline and the tinted line change the picture; without the problem the picture is as before.
TEST(Editor, AProblemIsMarkedInTheText) {
    Writer hands;
    EXPECT_EQ(hands.marked(), 0);
    hands.session.apply(command::SetText{replaced(ball(), "y = [\"lambda\"]", "y = [\"lamda\"]")});
    hands.rest(3);
    EXPECT_GT(hands.marked(), 300 * 10) << "the line is on the last page: the text scrolls there";
    hands.session.apply(command::SetText{ball()});
    hands.rest(3);
    EXPECT_EQ(hands.marked(), 0);
}

// A mistake in a body, spring or contact between shapes stands in one line of a long table: it is marked there.
TEST(Editor, AMistakeInABodyIsMarkedWhereItWasTyped) {
    const std::string leg = test::system(test::mechanism("kneed_leg")).source_text;
    for (const auto& [typed, mistaken, name] : {std::tuple{"[0, \"-Ls\"]", "[0, \"-Lz\"]", "Lz"},
                                                {"\"world.below\", \"hip\"", "\"world.below\", \"hap\"", "hap"},
                                                {"\"shank.end\", \"floor\"", "\"shank.end\", \"flor\"", "flor"},
                                                {"rest = \"z0", "rest = \"zz", "zz"}}) {
        const std::string text = replaced(leg, typed, mistaken);
        Writer hands(test::mechanism("kneed_leg"));
        hands.session.apply(command::SetText{text});
        hands.rest(3);
        ASSERT_EQ(hands.session.document().problems.size(), 1U) << name;
        const InputError& problem = hands.session.document().problems[0];
        const std::size_t place = text.find(name);
        const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n') + 1;
        EXPECT_EQ(problem.at.line, line) << problem.what();
        const auto column = static_cast<int>(place - text.rfind('\n', place));
        EXPECT_TRUE(problem.at.column == column || problem.at.column == column - 1) << problem.what();
        EXPECT_NE(std::string(problem.what()).find(std::string("'") + name + "'"), std::string::npos) << problem.what();
        EXPECT_GT(hands.marked(), 300 * 10) << name;
    }
}

TEST(Editor, AMessageDoesNotHideTheLineUnderTheHand) {
    Writer hands;
    hands.write(ball() + "y = [\"x\"]");  // duplicate key: an error in the last line
    hands.rest(frames_of_a_pause + 5);
    ASSERT_FALSE(hands.session.document().problems.empty());
    EXPECT_GT(hands.marked(), 300 * 10);
}

TEST(Editor, EscapeTakesNothingBack) {
    Writer hands;
    hands.write(ball() + "# more");
    hands.press(key::escape);
    hands.rest(frames_of_a_pause);
    EXPECT_EQ(hands.session.document().text, ball() + "# more");
}

TEST(Editor, WhatWasTypedCountsWhenTheHandLeaves) {
    Writer hands;
    hands.write(ball() + "# more");
    EXPECT_TRUE(hands.all.empty());
    hands.click("plot 1");
    ASSERT_FALSE(hands.all.empty());
    EXPECT_EQ(hands.all[0], Command(command::SetText{ball() + "# more"}));
    hands.write(ball() + "# and more");
    hands.press_with_control('E');
    EXPECT_EQ(hands.session.document().text, ball() + "# and more");
    EXPECT_FALSE(is_typing(hands.state));
}

TEST(Editor, AJournalOfWhatWasTypedLeadsToTheSameSession) {
    Writer hands;
    hands.write(replaced(ball(), "y - sin(x)", "y - 1.5*sin(x)"));
    hands.rest(frames_of_a_pause);
    hands.session.apply(command::Set{"g", 2.0});
    hands.all.emplace_back(command::Set{"g", 2.0});
    hands.write(replaced(ball(), "y - sin(x)", "y - 1.6*sin(x)"));
    hands.rest(frames_of_a_pause);
    Session again = test::session("ball_on_sine");
    again.apply(parse_command("show editor"));
    for (const Command& command : parse_journal(journal_text(hands.all))) again.apply(command);
    EXPECT_EQ(to_text(again), to_text(hands.session));
    EXPECT_EQ(again.run().parameters[1], 2.0);
    EXPECT_NE(to_text(again.trajectory()), to_text(test::session("ball_on_sine").trajectory()));
}

TEST(Editor, SavesAsAndAsksBeforeItWritesOverAFile) {
    const Folder folder;
    folder.put("there.toml", "something else");
    const std::string there = (folder.path() / "there.toml").string(), mine = (folder.path() / "mine.toml").string();
    Writer hands;
    hands.write(ball() + "# mine");
    hands.click("Save");  // opened from the list, so it has no file yet
    EXPECT_EQ(hands.told(), std::vector<std::string>{to_text(Command(command::SetText{ball()})).substr(0, 60)});
    hands.write_path((folder.path() / "nowhere" / "mine.toml").string());
    hands.press(key::enter);
    EXPECT_EQ(hands.session.document().file, "") << "there is no such folder";
    hands.write_path(there);
    hands.press(key::enter);
    EXPECT_EQ(content(there), "something else") << "Enter alone writes over nothing";
    hands.click("dialog Cancel");
    hands.click("Save as\u2026");
    hands.write_path(mine);
    hands.press(key::enter);
    EXPECT_EQ(content(mine), ball() + "# mine");
    EXPECT_EQ(hands.session.system(), mine);
    EXPECT_FALSE(hands.session.document().is_changed());

    hands.write(ball() + "# more");
    hands.press_with_control('S');  // its own file
    EXPECT_EQ(content(mine), ball() + "# more");
    hands.click("Save as\u2026");
    hands.write_path(there);
    hands.click("dialog Overwrite");
    EXPECT_EQ(content(there), ball() + "# more");
    EXPECT_EQ(hands.told().back(), to_text(Command(command::Save{there, true})).substr(0, 60));
    EXPECT_EQ(hands.session.error(), "");
    EXPECT_EQ(folder.files().size(), 2U) << "nothing else was written";
}

TEST(Editor, OpensAPathThatIsTyped) {
    const Folder folder;
    folder.put("mine.toml", replaced(ball(), "Ball bouncing", "My ball bouncing"));
    Writer hands;
    hands.press_with_control('O');
    hands.write_path((folder.path() / "min.toml").string());
    hands.press(key::enter);
    EXPECT_TRUE(hands.all.empty()) << "there is no such file";
    hands.write_path((folder.path() / "mine.toml").string());
    hands.press(key::enter);
    ASSERT_EQ(hands.all.size(), 1U);
    EXPECT_EQ(hands.session.description().title, "My ball bouncing on a sinusoidal surface");
    EXPECT_EQ(hands.state.editor.text, content(folder.path() / "mine.toml"));
}

TEST(Editor, AsksWhatToDoWithChangesThatAreNotSaved) {
    const Folder folder;
    const std::string mine = (folder.path() / "mine.toml").string();
    Writer hands;
    const auto choose_pendulum = [&] {
        hands.click("systems");
        hands.click("open double_pendulum");
    };
    hands.write(ball() + "# 1");
    choose_pendulum();
    EXPECT_EQ(hands.session.system(), "ball_on_sine");
    hands.click("dialog Cancel");
    EXPECT_EQ(hands.session.document().text, ball() + "# 1");
    choose_pendulum();
    hands.click("dialog Save");  // without a file: asks for one, then continues
    hands.write_path(mine);
    hands.press(key::enter);
    EXPECT_EQ(content(mine), ball() + "# 1");
    EXPECT_EQ(hands.session.system(), "double_pendulum");
    hands.write("no system at all");
    hands.rest(frames_of_a_pause);
    EXPECT_FALSE(hands.session.document().problems.empty());
    hands.click("New");
    hands.click("dialog Discard");
    EXPECT_EQ(hands.session.system(), "untitled");
    EXPECT_TRUE(hands.session.document().problems.empty());
    EXPECT_EQ(folder.files().size(), 1U);
}

TEST(Editor, AsksBeforeTheWindowIsClosedOverChanges) {
    const Folder folder;
    Writer hands;
    EXPECT_TRUE(request_close(hands.session, hands.state));
    hands.write(ball() + "# 1");
    EXPECT_FALSE(request_close(hands.session, hands.state));
    hands.rest(3);
    hands.click("dialog Cancel");
    EXPECT_FALSE(hands.state.editor.may_close);
    EXPECT_FALSE(request_close(hands.session, hands.state));
    hands.rest(3);
    hands.click("dialog Save");
    hands.write_path((folder.path() / "mine.toml").string());
    hands.press(key::enter);
    EXPECT_TRUE(hands.state.editor.may_close);
    EXPECT_EQ(content(folder.path() / "mine.toml"), ball() + "# 1");
    EXPECT_TRUE(request_close(hands.session, hands.state));

    Writer other;
    other.write("nothing of value");
    EXPECT_FALSE(request_close(other.session, other.state));
    other.rest(3);
    other.click("dialog Discard");
    EXPECT_TRUE(other.state.editor.may_close);
}

TEST(Editor, AnotherTextTakesThePlaceOfTheOneUnderTheHand) {
    Writer hands;
    hands.write(ball() + "# more");
    hands.rest(frames_of_a_pause);
    hands.session.apply(command::Open{"double_pendulum"});  // e.g. a file dropped on the window
    hands.rest(2);
    EXPECT_EQ(hands.state.editor.text, test::system("double_pendulum").source_text);
    hands.type("#");
    hands.rest(frames_of_a_pause);
    EXPECT_EQ(hands.session.document().text, test::system("double_pendulum").source_text)
        << "letters for the old text do not go into the new one";
    EXPECT_EQ(hands.session.system(), "double_pendulum");
}

TEST(Editor, ShowsButDoesNotChangeWhatItCannotKeep) {
    Writer hands;
    hands.session.apply(command::SetText{"# \U0001F600\n" + ball()});
    hands.rest(2);
    hands.write("gone");
    hands.rest(frames_of_a_pause);
    EXPECT_EQ(hands.session.document().text, "# \U0001F600\n" + ball());
}

TEST(Editor, DrawsTheSameBytesEveryTimeInAnySize) {
    for (const auto& [width, height, scale] :
         {std::tuple{1280, 800, 1.0}, {2560, 1600, 2.0}, {1, 1, 1.0}, {60, 900, 1.0}, {300, 200, 1.0}}) {
        Writer a("double_pendulum", test::surface(width, height, scale));
        Writer b("double_pendulum", test::surface(width, height, scale));
        for (Writer* hands : {&a, &b}) {
            hands->session.apply(command::SetText{"title ="});
            hands->rest(2);
        }
        EXPECT_EQ(a.picture(), b.picture());
    }
}

// Scroll position of the text, pixels.
float scroll_of(Writer& hands) {
    float scroll = -1.0F;
    hands.surface.step(
        [&] {
            for (const Command& command : explorer(hands.session, hands.state)) hands.session.apply(command);
            for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
                if (window->Active && std::string_view(window->Name).find("##text") != std::string_view::npos)
                    scroll = window->Scroll.y;
        },
        hands.hand);
    return scroll;
}

// Undo of a visible change does not scroll the text in any frame; undo of a hidden one scrolls to it.
TEST(Editor, UndoScrollsNoFurtherThanToWhatItChanges) {
    Writer hands("ball_on_egg_crate");  // a long text
    hands.click("text");
    hands.press_with_control(key::end);
    for (const char* letters : {"# one", "\n[[", "\n"}) {
        hands.type(letters);
        hands.rest(frames_of_a_pause + 2);
    }
    ASSERT_FALSE(hands.session.document().problems.empty());
    hands.rest(3);
    const float before = scroll_of(hands);
    ASSERT_GT(before, 300.0F) << "the end of the text";
    hands.hand.keys = {key::left_control, 'Z'};
    std::vector<float> after;
    for (int i = 0; i < 6; ++i) after.push_back(scroll_of(hands));
    hands.hand.keys.clear();
    for (int i = 0; i < 3; ++i) after.push_back(scroll_of(hands));
    EXPECT_TRUE(hands.session.document().problems.empty());
    ASSERT_EQ(hands.session.document().text, test::system("ball_on_egg_crate").source_text + "# one");
    // Without its message the text shows more lines, and it has two lines less.
    for (const float scroll : after) EXPECT_NEAR(scroll, before, 12.0F * 14.0F);
    EXPECT_GT(after.back(), 300.0F);
    hands.session.apply(command::SetText{replaced(hands.session.document().text, "title = \"", "title = \"My ")});
    hands.rest(3);
    EXPECT_LT(scroll_of(hands), 100.0F) << "line 7 is in sight";
}

// Another document starts at its top.
TEST(Editor, AnotherTextBeginsAtItsTop) {
    Writer hands("ball_on_egg_crate");  // a long text
    hands.click("text");
    hands.press_with_control(key::end);
    hands.rest(3);
    ASSERT_GT(scroll_of(hands), 300.0F);
    hands.session.apply(command::Open{"double_pendulum"});
    hands.rest(3);
    EXPECT_EQ(scroll_of(hands), 0.0F);
}

// A value changed by a slider is listed beside the text and can be restored there.
TEST(Editor, TellsWhatTheRunHasOtherwiseThanTheText) {
    Writer hands;
    EXPECT_FALSE(hands.says("Differs from the text"));
    hands.session.apply(command::Set{"e", 0.7});
    hands.rest(2);
    EXPECT_TRUE(hands.says("Differs from the text"));
    EXPECT_TRUE(hands.says("e = 0.7")) << hands.letters();
    EXPECT_TRUE(hands.says("text: 0.5"));
    const auto all = differences(hands.session.description(), hands.session.run(), hands.session.file_run());
    ASSERT_EQ(all.size(), 1U);
    hands.click("put back " + all[0].name);
    EXPECT_EQ(*hands.session.value("e"), 0.5);
    EXPECT_FALSE(hands.says("Differs from the text"));
    for (const auto& [name, value] : {std::pair{"m", 2.0}, {"g", 2.0}, {"e", 0.6}, {"x", 1.0}, {"y", 3.0}, {"x'", 1.0}})
        hands.session.apply(command::Set{name, value});
    hands.rest(2);
    EXPECT_TRUE(hands.says("and 2 more: reset all")) << hands.letters();
    hands.click("reset all");
    EXPECT_EQ(hands.session.run(), hands.session.file_run());
}

// A message starts with the file name, without the folder, for lack of room.
TEST(Editor, MessagesBeginWithTheNameOfTheFile) {
    const Folder folder;
    folder.put("mine.toml", replaced(ball(), "x'^2 + y'^2", "x'^2 + yy'^2"));
    const std::string path = (folder.path() / "mine.toml").string();
    Writer hands;
    hands.session.apply(command::Open{path});
    hands.rest(3);
    EXPECT_EQ(std::string(hands.session.document().problems.at(0).what()).find(path + ":20:37: "), 0U);
    EXPECT_TRUE(hands.says("mine.toml:20:37: "));
    EXPECT_FALSE(hands.says(path + ":20")) << hands.letters();
    hands.session.apply(command::Show{"editor", false});
    hands.rest(3);
    EXPECT_TRUE(hands.says("mine.toml:20:37: ")) << "on the card above the picture";
    EXPECT_FALSE(hands.says(path + ":20")) << hands.letters();
}

}  // namespace
}  // namespace achilles
