// The file browser of the dialogs: its entries and its keys.
#include "session/folder_entries.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/hands.hpp"
#include "app/program.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names(const std::vector<FolderEntry>& entries) {
    std::vector<std::string> result;
    for (const FolderEntry& entry : entries) result.push_back(entry.name + (entry.is_folder ? "/" : ""));
    return result;
}

using Names = std::vector<std::string>;

struct Tree : test::Folder {
    Tree() {
        fs::create_directories(path() / "systems/old");
        fs::create_directories(path() / "pictures");
        for (const char* file : {"ball.toml", "bowl.toml", "notes.txt", ".hidden.toml", "systems/mine.toml"})
            put(file, test::drop_text);
    }
    std::string at(const std::string& name) const { return (path() / name).string(); }
};

TEST(Browser, ListsFoldersAndWhatCanBeOpened) {
    const Tree tree;
    const auto all = entries_of(tree.at(""), {".toml"}, false);
    EXPECT_EQ(names(all), (Names{"pictures/", "systems/", "ball.toml", "bowl.toml"}));
    EXPECT_EQ(names(entries_of(tree.at(""), {".toml"}, true)).size(), 5U);
    EXPECT_EQ(names(filtered(all, "B")), (Names{"ball.toml", "bowl.toml"}));
    EXPECT_EQ(names(filtered(all, "ow")), (Names{"bowl.toml"}));
    EXPECT_TRUE(entries_of(tree.at("none"), {".toml"}, false).empty());
}

TEST(Browser, CompletesAsAShellAndGoesUp) {
    const std::vector<FolderEntry> all{{"systems", true}, {"ball.toml", false}, {"balcony.toml", false}};
    EXPECT_EQ(completed("a/b", all), "a/bal");
    EXPECT_EQ(completed("a/ball", all), "a/ball.toml");
    EXPECT_EQ(completed("s", all), "systems/");
    EXPECT_EQ(completed("q", all), "q");
    EXPECT_EQ(one_up("a/b/"), "a/");
    EXPECT_EQ(one_up("a/"), "");
    EXPECT_EQ(one_up(""), "../");
    EXPECT_EQ(one_up("../"), "../../");
    EXPECT_EQ(one_up("/"), "/");
    EXPECT_EQ(one_up("/a/"), "/");
}

struct BrowserFixture : Tree {
    BrowserFixture() : hands("ball_on_sine") {
        hands.press_with_control('O');
        hands.rest(2);
        hands.type(at(""));
        hands.rest(2);
    }
    test::Hands hands;
    std::string line() const { return hands.state.editor.path.substr(path().string().size()); }
    Names rows() const { return names(hands.state.browser.rows); }
};

TEST(Browser, LettersFilterAndEnterOpens) {
    BrowserFixture o;
    EXPECT_EQ(o.rows(), (Names{"pictures/", "systems/", "ball.toml", "bowl.toml"}));
    o.hands.type("bo");
    EXPECT_EQ(o.rows(), Names{"bowl.toml"});
    o.hands.press(key::down);
    o.hands.press(key::enter);
    EXPECT_EQ(o.hands.session.system(), o.at("bowl.toml")) << o.hands.session.error();
}

TEST(Browser, ArrowsAndBackspaceWalkFolders) {
    BrowserFixture o;
    o.hands.press(key::down);
    o.hands.press(key::down);
    o.hands.press(key::enter);
    o.hands.rest(3);
    EXPECT_EQ(o.line(), "/systems/");
    EXPECT_EQ(o.rows(), (Names{"old/", "mine.toml"}));
    ASSERT_EQ(o.hands.state.editor.asking, EditorState::OpenDialog::open);
    o.hands.press(key::backspace);
    o.hands.rest(3);
    EXPECT_EQ(o.line(), "/");
    EXPECT_EQ(o.rows().size(), 4U);
    o.hands.type("sy");
    o.hands.press(key::tab);
    o.hands.rest(3);
    EXPECT_EQ(o.line(), "/systems/");
    o.hands.press(key::down);
    o.hands.press(key::down);
    o.hands.press(key::enter);
    EXPECT_EQ(o.hands.session.system(), o.at("systems/mine.toml"));
}

TEST(Browser, AClickGoesThere) {
    BrowserFixture o;
    o.hands.click("file systems");
    o.hands.rest(3);
    EXPECT_EQ(o.line(), "/systems/");
    o.hands.click("file mine.toml");
    o.hands.rest(3);
    EXPECT_EQ(o.line(), "/systems/mine.toml");
    EXPECT_EQ(o.hands.session.system(), "ball_on_sine");
    o.hands.press(key::enter);
    EXPECT_EQ(o.hands.session.system(), o.at("systems/mine.toml"));
}

// The dialog shows where the file is written; Enter does not overwrite an existing file.
TEST(Browser, OfSavingShowsTheFolderThatIsWrittenTo) {
    Tree tree;
    test::Hands hands("ball_on_sine");
    hands.press_with_control('S');
    hands.rest(2);
    hands.press_with_control('A');
    hands.type(tree.at("systems/new"));
    hands.rest(2);
    EXPECT_TRUE(hands.says("writes to"));
    EXPECT_EQ(names(hands.state.browser.all), (Names{"old/", "mine.toml"}));
    hands.press(key::enter);
    EXPECT_TRUE(fs::exists(tree.path() / "systems/new.toml")) << hands.session.error();
}

}  // namespace
}  // namespace achilles
