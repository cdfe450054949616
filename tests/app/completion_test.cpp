// What the program makes from its own tables for the terminal: man pages and the completion of bash. Both are compared
// with --help.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "app/program.hpp"
#include "cli/assets.hpp"
#include "cli/manual.hpp"

namespace achilles::test {
namespace {

using WordSet = std::set<std::string>;

WordSet matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    WordSet names;
    for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it) names.insert((*it)[1]);
    return names;
}

WordSet commands_of_help() { return matches(Folder().run("--help").out, "\n  ([a-z]+) "); }
WordSet options_of_help(const std::string& command) {
    return matches(Folder().run(command + " --help").out, "[\n,](?:  -h,|  )(--[a-z0-9-]+)");
}

// Calls the function of the script as bash does at the end of this line, in a folder with some files.
class BashCompletion : public testing::Test {
 protected:
    BashCompletion() {
        folder_.put("mine.toml", drop_text);
        folder_.put("picture.png", "");
        folder_.put("data.csv", "");
        std::filesystem::create_directory(folder_.path() / "shots");
    }
    // One word a line; the options that the function sets come first.
    WordSet complete(const std::string& line, const std::string& word) const {
        folder_.put("ask.sh", "compopt() { echo \"compopt $*\"; }\nsource <('" + program + "' completion)\nCOMP_LINE=" +
                                  quoted(line) + "\nCOMP_POINT=" + std::to_string(line.size()) + "\n_achilles '" +
                                  program + "' " + quoted(word) +
                                  " before\n[ ${#COMPREPLY[@]} = 0 ] || printf '%s\\n' \"${COMPREPLY[@]}\"\n");
        const std::string call = "cd '" + folder_.path().string() + "' && bash ask.sh > answer 2>&1";
        EXPECT_EQ(std::system(call.c_str()), 0) << content(folder_.path() / "answer");
        std::istringstream lines(content(folder_.path() / "answer"));
        WordSet names;
        for (std::string one; std::getline(lines, one);) names.insert(one);
        return names;
    }
    static std::string quoted(const std::string& text) {
        std::string result = "'";
        for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
        return result + "'";
    }
    static constexpr const char* no_space = "compopt -o nospace";
    const std::string program = ACHILLES_BINARY_DIR "/achilles";
    Folder folder_;
};

TEST_F(BashCompletion, KnowsEveryCommandAndSystem) {
    WordSet expected = commands_of_help();
    EXPECT_GE(expected.size(), 15U);
    for (const std::string& system : system_names()) expected.insert(system);
    expected.insert({"compopt -o filenames", "mine.toml", "shots"});
    EXPECT_EQ(complete("achilles ", ""), expected);
    EXPECT_EQ(complete("achilles sim", "sim"), (WordSet{"compopt -o filenames", "simplest_walker", "simulate"}));
}

TEST_F(BashCompletion, KnowsEveryOption) {
    for (const std::string& command : commands_of_help()) {
        const WordSet expected = options_of_help(command);
        EXPECT_TRUE(expected.contains("--help")) << command;
        EXPECT_EQ(complete("achilles " + command + " --", "--"), expected) << command;
    }
    EXPECT_EQ(complete("achilles simulate ball_on_sine --to", "--to"), WordSet{"--tolerance"});
    // Without a command the explorer opens.
    EXPECT_EQ(complete("achilles ball_on_sine --rec", "--rec"), WordSet{"--record"});
    EXPECT_EQ(complete("achilles --ver", "--ver"), WordSet{"--version"});
}

TEST_F(BashCompletion, KnowsTheNamesOfTheSystemThatWasTyped) {
    EXPECT_EQ(complete("achilles simulate ball_on_sine --set ", ""),
              (WordSet{no_space, "e=", "g=", "m=", "x=", "y=", "x\\'=", "y\\'="}));
    EXPECT_EQ(complete("achilles sweep ./mine.toml --over y", "y"), (WordSet{no_space, "y=", "y\\'="}));
    EXPECT_EQ(complete("achilles simulate ./mine.toml --set \"y", "y"), (WordSet{no_space, "y=", "y'="}));
    EXPECT_EQ(complete("achilles simulate ./mine.toml --set 'y", "y"), (WordSet{no_space, "y="}))
        << "a rate cannot be typed within apostrophes";
    EXPECT_EQ(complete("achilles simulate ./mine.toml --set y\\'", "y\\'"), (WordSet{no_space, "y\\'="}));
    EXPECT_EQ(complete("achilles simulate ./mine.toml --set y=", ""), WordSet{});
    EXPECT_EQ(complete("achilles simulate --set ", ""), WordSet{});
    const WordSet views = complete("achilles figure ball_on_sine --view ", "");
    EXPECT_TRUE(views.contains("height") && views.contains("gap")) << views.size();
}

TEST_F(BashCompletion, KnowsValuesAndFiles) {
    EXPECT_EQ(complete("achilles simulate ball_on_sine --method ", ""), (WordSet{"dopri5", "taylor"}));
    EXPECT_EQ(complete("achilles simulate ball_on_sine --method=t", "t"), WordSet{"taylor"});
    EXPECT_EQ(complete("achilles figure ball_on_sine --format p", "p"), (WordSet{"pdf", "png"}));
    EXPECT_EQ(complete("achilles screenshot --journal the_e", "the_e"),
              (WordSet{"compopt -o filenames", "the_explorer"}));
    EXPECT_EQ(complete("achilles figure ball_on_sine --out ", ""),
              (WordSet{"compopt -o filenames", "picture.png", "shots"}));
    EXPECT_EQ(complete("achilles compare ", ""), (WordSet{"compopt -o filenames", "picture.png", "shots"}));
    EXPECT_EQ(complete("achilles compare picture.png sh", "sh"), (WordSet{"compopt -o filenames", "shots"}));
    EXPECT_EQ(complete("achilles compare picture.png shots ", ""), WordSet{});
    EXPECT_EQ(complete("achilles simulate ball_on_sine --csv d", "d"), (WordSet{"compopt -o filenames", "data.csv"}));
    EXPECT_EQ(complete("achilles simulate m", "m"), (WordSet{"compopt -o filenames", "mine.toml"}));
    EXPECT_EQ(complete("achilles simulate --end 5 m", "m"), (WordSet{"compopt -o filenames", "mine.toml"}))
        << "the value of an option is no argument";
    WordSet topics = commands_of_help();
    for (const ManualTopic& topic : manual_topics()) topics.insert(topic.name);
    EXPECT_EQ(complete("achilles help ", ""), topics);
}

TEST_F(BashCompletion, SaysNothingOfWhatCannotBeRead) {
    folder_.put("broken.toml", "title = ");
    EXPECT_EQ(complete("achilles simulate ./broken.toml --set ", ""), WordSet{});
    EXPECT_EQ(complete("achilles nonsense more ", ""), WordSet{});
}

class ManPages : public testing::Test {
 protected:
    ManPages() { EXPECT_EQ(folder_.run("help --man .").status, 0); }
    std::string page(const std::string& name) const {
        std::string text = content(folder_.path() / name);
        for (std::size_t at = 0; (at = text.find("\\-", at)) != text.npos;) text.erase(at, 1);
        return text;
    }
    Folder folder_;
};

TEST_F(ManPages, ListEveryCommandAndOption) {
    WordSet files{"achilles.1"};
    const std::string main = page("achilles.1");
    for (const std::string& command : commands_of_help()) {
        files.insert("achilles-" + command + ".1");
        const std::string text = page("achilles-" + command + ".1");
        EXPECT_EQ(matches(text, "\n\\.TP\n\\\\fB(?:-h,)?(--[a-z0-9-]+)"), options_of_help(command)) << text;
        EXPECT_NE(main.find("\n.TP\n\\fB" + command + "\\fR\n"), std::string::npos) << main;
        EXPECT_EQ(text.find(".TH ACHILLES-"), 0U);
        EXPECT_NE(text.find("\n\\fB2\\fR\nthe command or a file is wrong; nothing was written\n"), std::string::npos);
    }
    const std::vector<std::string> written = folder_.files();
    EXPECT_EQ(WordSet(written.begin(), written.end()), files);
    for (const ManualTopic& topic : manual_topics())
        EXPECT_NE(main.find("\n\\fB" + topic.name + "\\fR\n"), std::string::npos) << topic.name;
}

TEST_F(ManPages, AreShownWithoutAWarning) {
    if (std::system("command -v man groff >/dev/null") != 0) GTEST_SKIP() << "man-db or groff is missing";
    const std::string call =
        "cd '" + folder_.path().string() +
        "' && for page in *.1; do LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l "
        "-Tutf8 $page; done >shown 2>warnings";
    EXPECT_EQ(std::system(call.c_str()), 0);
    EXPECT_EQ(content(folder_.path() / "warnings"), "");
    const std::string shown = content(folder_.path() / "shown");
    EXPECT_NE(shown.find("x'=1.5"), std::string::npos) << "an apostrophe can be copied to a shell";
    EXPECT_NE(shown.find("achilles-sweep - simulates many runs"), std::string::npos);
}

}  // namespace
}  // namespace achilles::test
