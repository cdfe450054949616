// The groups of the gallery, and the preferences kept between windows.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <utility>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/assets.hpp"
#include "cli/explore.hpp"
#include "image/image.hpp"
#include "journal/preferences.hpp"
#include "session/glossary.hpp"

namespace achilles {
namespace {

using test::Hands;

TEST(Gallery, HasEverySystemInOneGroup) {
    std::multiset<std::string> grouped, there;
    for (const GalleryGroup& group : gallery())
        for (const std::string_view name : group.systems) grouped.emplace(name);
    for (const auto& file : system_files()) there.insert(file.stem().string());
    EXPECT_EQ(grouped, there);
    EXPECT_EQ(group_of("ball_on_sine"), "the paper");
    EXPECT_EQ(group_of("mine"), "others");
    const auto known = known_systems();
    ASSERT_EQ(known.size(), there.size());
    EXPECT_EQ(known[0].name, "ball_on_sine");
    std::set<std::string> begun;
    std::string last;
    for (const SystemEntry& entry : known)
        if (entry.group != std::exchange(last, entry.group)) {
            EXPECT_TRUE(begun.insert(entry.group).second) << entry.group << " begins twice";
        }
    EXPECT_EQ(begun.size(), gallery().size());
}

TEST(Gallery, ShowsItsGroups) {
    Hands hands("ball_on_sine");
    hands.state.systems = known_systems();
    hands.click("systems");
    EXPECT_TRUE(hands.says("the paper"));
    EXPECT_TRUE(hands.says("robots"));
    hands.click("open double_pendulum");
    EXPECT_EQ(hands.session.system(), "double_pendulum");
}

// A temporary home folder for a test.
struct Home {
    Home() { setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1); }
    ~Home() { unsetenv("XDG_CONFIG_HOME"); }
    std::string text() const { return test::content(folder.path() / "achilles/preferences.journal"); }
    test::Folder folder;
};

TEST(Preferences, AreTheLooksAndTheFilesThatWereOpen) {
    const Home home;
    test::Folder systems;
    const std::string text = read_text(find_system("ball_on_floor"));
    for (const char* name : {"a.toml", "b c.toml"}) systems.put(name, text);
    const std::string a = (systems.path() / "a.toml").string(), b = (systems.path() / "b c.toml").string();
    {
        Preferences none;
        EXPECT_TRUE(none.appearance().empty());
        Session session = test::session("ball_on_sine");
        none.keep(session);
        EXPECT_FALSE(std::filesystem::exists(home.folder.path() / "achilles")) << "there is nothing to remember";
        for (const std::string& line :
             {std::string("theme dark"), std::string("enlarge 1.5"), "open " + a, "open \"" + b + "\"",
              std::string("size plots 0.4"), "open " + a, std::string("present on"), std::string("set g 3")}) {
            session.apply(parse_command(line));
            EXPECT_EQ(session.error(), "") << line;
            none.keep(session);
        }
        session.apply(parse_command("open double_pendulum"));  // from the gallery: not a recent file
        none.keep(session);
    }
    EXPECT_EQ(home.text(), "theme dark\nsize plots 0.4\nenlarge 1.5\nopen " + a + "\nopen \"" + b + "\"\n");
    const Preferences again;
    EXPECT_EQ(again.recent(), (std::vector<std::string>{a, b}));
    Session next = test::session("ball_on_sine");
    for (const Command& command : again.appearance()) next.apply(command);
    EXPECT_TRUE(next.theme().dark);
    EXPECT_EQ(next.scene().enlarged(), 1.5);
    EXPECT_EQ(next.scene().share("plots"), 0.4);
    EXPECT_FALSE(next.scene().presents());
}

// Whatever the file contains, a window opens, and only its appearance is affected.
TEST(Preferences, TakesNothingElseFromTheFile) {
    const Home home;
    std::filesystem::create_directories(home.folder.path() / "achilles");
    std::ofstream(home.folder.path() / "achilles/preferences.journal")
        << "theme blue\nsave stolen.toml overwrite\nnonsense\n\ntheme dark\nreplay evil\n\"\n\x01\xff\n";
    const Preferences read;
    EXPECT_EQ(read.appearance(), std::vector<Command>{command::SetTheme{true}});
    EXPECT_TRUE(read.recent().empty());
}

TEST(Preferences, FilesStandInTheMenu) {
    Hands hands("ball_on_sine");
    const std::string path = find_system("double_pendulum").string();
    hands.state.recent = {path};
    hands.click("bar File");
    hands.click("menu Open recent");
    EXPECT_TRUE(hands.says("double_pendulum.toml"));
    hands.click("menu " + path);
    EXPECT_EQ(hands.all, std::vector<Command>{command::Open{path}});
    EXPECT_EQ(hands.session.error(), "");
}

// A picture must not depend on preferences.
TEST(Preferences, IsNothingToAPicture) {
    const Home home;
    std::filesystem::create_directories(home.folder.path() / "achilles");
    std::ofstream(home.folder.path() / "achilles/preferences.journal") << "theme dark\nenlarge 2\n";
    const test::Folder folder;
    const auto picture = [&](const std::string& environment) {
        EXPECT_EQ(folder.run("screenshot ball_on_floor --size 640x480 --out a.png", environment).status, 0);
        return read_png(folder.path() / "a.png").rgb;
    };
    EXPECT_EQ(picture("XDG_CONFIG_HOME=" + home.folder.path().string()), picture("XDG_CONFIG_HOME=/nowhere"));
}

}  // namespace
}  // namespace achilles
