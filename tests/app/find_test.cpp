// The card of keys and terms, the command palette, the interface scale and presentation mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/manual.hpp"
#include "image/image.hpp"
#include "panels/actions.hpp"
#include "session/command_search.hpp"
#include "session/glossary.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::Hands;

// ---- card of keys and terms ----

TEST(Help, ComesAndGoesWithItsKeyAndByACommand) {
    Hands hands("ball_on_sine");
    EXPECT_FALSE(hands.says("certificate theory"));
    hands.press(key::f1);
    EXPECT_EQ(hands.all, std::vector<Command>{(command::Show{"help", true})});
    hands.rest(2);
    EXPECT_TRUE(hands.says("Zeno point"));
    hands.press(key::escape);
    hands.press(key::f1);
    hands.press(key::f1);
    hands.click("bar Help");
    hands.click("menu Keys and words");
    hands.click("Close the help");
    std::string record;
    for (const Command& command : hands.all) record += to_text(command) + "; ";
    EXPECT_EQ(record, "show help; hide help; show help; hide help; show help; hide help; ");
    EXPECT_FALSE(hands.says("Zeno point theory"));
}

// Escape closes only the card, nothing behind it.
TEST(Help, TakesEscapeForItself) {
    Hands hands("ball_on_sine");
    hands.session.apply(parse_command("select 3"));
    hands.session.apply(parse_command("show help"));
    hands.rest(3);
    hands.press(key::escape);
    EXPECT_EQ(hands.session.selected(), 3);
    EXPECT_FALSE(hands.session.scene().shows("help"));
}

TEST(Help, HasEveryWordAndKeyOnTheCard) {
    const SurfaceOptions tall = test::surface(1600, 1600);
    Hands hands("ball_on_sine", tall);
    hands.session.apply(parse_command("show help"));
    hands.rest(3);
    for (const GlossaryTerm& term : glossary()) {
        EXPECT_TRUE(hands.says(std::string(term.word))) << term.word;
        EXPECT_TRUE(hands.says(std::string(term.meaning))) << term.meaning;
    }
    for (const Shortcut& shortcut : shortcuts())
        EXPECT_TRUE(hands.says(std::string(shortcut.keys) + std::string(shortcut.does))) << shortcut.keys;
}

// The manual shows the same tables in a monospace font, which requires ASCII.
TEST(Help, IsTheManualsTable) {
    const std::string page = manual_page("words");
    const auto is_ascii = [](std::string_view text) {
        return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
    };
    std::set<std::string_view> words;
    for (const GlossaryTerm& term : glossary()) {
        EXPECT_TRUE(words.insert(term.word).second) << term.word;
        for (const std::string_view text : {term.word, term.formula, term.meaning, term.source}) {
            EXPECT_TRUE(is_ascii(text)) << text;
            EXPECT_NE(page.find(text), std::string::npos) << text;
        }
    }
    for (const char* word : {"gap", "restitution", "impact", "Zeno point", "truncation", "certificate", "release",
                             "constrained phase", "contact force"})
        EXPECT_TRUE(words.contains(word)) << word;
    for (const Shortcut& shortcut : shortcuts()) EXPECT_NE(page.find(shortcut.does), std::string::npos);
}

// Every action of the table is in its menu.
TEST(Help, TellsKeysOfLinesThatMenusHave) {
    Hands hands("ball_on_sine");
    for (const char* menu : {"bar File", "bar Edit", "bar View", "bar Time", "bar Plots", "bar Help"}) {
        hands.click(menu);
        hands.rest(2);
        hands.press(key::escape);
    }
    for (const Action& one : actions())
        EXPECT_TRUE(hands.state.places.contains("menu " + std::string(one.name))) << one.name;
    EXPECT_EQ(action("Undo").keys, "Ctrl+Z");
    EXPECT_EQ(action("Reset all values").keys, "");
}

// ---- command palette ----

std::vector<std::string> lines_for(const std::string& typed, const std::vector<Completions>& completions = {}) {
    std::vector<std::string> lines;
    for (const CommandMatch& found : find_commands(typed, completions)) lines.push_back(found.line);
    return lines;
}

TEST(Finder, OrdersByHowWellLettersFit) {
    EXPECT_EQ(match_rank("grid", "grid"), 0);
    EXPECT_EQ(match_rank("GR", "grid"), 1);
    EXPECT_EQ(match_rank("imp", "max-impacts"), 2);
    EXPECT_EQ(match_rank("id", "grid"), 3);
    EXPECT_EQ(match_rank("gd", "grid"), 6);
    EXPECT_EQ(match_rank("dg", "grid"), -1);
    EXPECT_EQ(match_rank("gridd", "grid"), -1);
}

TEST(Finder, FindsCommandsByNameThenByUsage) {
    EXPECT_EQ(lines_for("").size(), command_usages().size());
    ASSERT_FALSE(lines_for("grid").empty());
    EXPECT_EQ(lines_for("grid")[0], "grid ");
    EXPECT_EQ(lines_for("pl")[0], "play") << "what stands alone runs";
    EXPECT_EQ(lines_for("tol")[0], "tolerance ");
    const auto by_usage = lines_for("journal");
    EXPECT_NE(std::find(by_usage.begin(), by_usage.end(), "replay "), by_usage.end());
    EXPECT_TRUE(lines_for("qqq").empty());
    EXPECT_TRUE(lines_for("grid 2 ").empty());
    EXPECT_EQ(usage_of("grid 2 2"), "grid COLUMNS ROWS");
    EXPECT_EQ(usage_of("gird 2 2"), "");
}

TEST(Finder, CompletesValuesByNameOrByWhatTheyAre) {
    const std::vector<Completions> some{{"open", {{"ball_on_sine", "A ball"}, {"two words", "Kneed leg"}}, true},
                                        {"set", {{"g", "gravity"}, {"e", ""}}, false}};
    EXPECT_EQ(lines_for("open ball", some), std::vector<std::string>{"open ball_on_sine"});
    EXPECT_EQ(lines_for("open knee", some), std::vector<std::string>{"open \"two words\""});
    EXPECT_EQ(lines_for("set grav", some), std::vector<std::string>{"set g "});
    EXPECT_TRUE(find_commands("open ball", some)[0].runs);
    EXPECT_FALSE(find_commands("set g", some)[0].runs);
    EXPECT_TRUE(lines_for("set g 3", some).empty());
}

// Opens it by its shortcut.
void open_palette(Hands& hands) {
    hands.hand.keys = {key::left_control, key::left_shift};
    hands.rest(1);
    hands.hand.keys.push_back('P');
    hands.rest(2);
    hands.hand.keys.clear();
    hands.rest(3);
}

TEST(Palette, CompletesAndRunsByEnter) {
    Hands hands("ball_on_sine");
    open_palette(hands);
    EXPECT_EQ(hands.all, std::vector<Command>{(command::Show{"palette", true})});
    hands.all.clear();
    hands.type("gri");
    EXPECT_TRUE(hands.says("grid COLUMNS ROWS"));
    hands.press(key::enter);
    EXPECT_EQ(hands.state.palette.text, "grid ");
    hands.type("3 2");
    EXPECT_EQ(hands.state.palette.text, "grid 3 2") << "letters go behind what was completed";
    hands.press(key::enter);
    EXPECT_EQ(hands.all, (std::vector<Command>{command::SetGrid{3, 2}, command::Show{"palette", false}}));
    hands.rest(2);
    EXPECT_FALSE(hands.says("COLUMNS"));
    EXPECT_EQ(hands.session.plotted().columns(), 3);
}

TEST(Palette, IsWalkedByArrowsAndClicked) {
    Hands hands("ball_on_sine");
    hands.session.apply(parse_command("find \"pi\""));
    hands.rest(3);
    hands.press(key::down);
    EXPECT_EQ(hands.state.palette.chosen, 1);
    hands.press(key::up);
    EXPECT_EQ(hands.state.palette.chosen, 0);
    hands.press(key::up);
    EXPECT_GT(hands.state.palette.chosen, 2);
    EXPECT_EQ(hands.all, std::vector<Command>{}) << "neither the time nor a plot hears the arrows";
    hands.press(key::down);
    hands.press(key::down);
    while (!hands.state.places.contains("command pin")) hands.press(key::down);
    hands.press(key::up);
    hands.press(key::up);
    EXPECT_EQ(hands.all, std::vector<Command>{});
    hands.click("command pin");
    ASSERT_FALSE(hands.all.empty());
    EXPECT_EQ(hands.all[0], Command(command::Pin{}));
    EXPECT_FALSE(hands.session.scene().shows("palette"));
}

TEST(Palette, KeepsWhatIsRefusedAndSaysWhy) {
    Hands hands("ball_on_sine");
    hands.session.apply(parse_command("find \"grid 3\""));
    hands.rest(3);
    hands.press(key::enter);  // not a command yet
    EXPECT_TRUE(hands.all.empty());
    EXPECT_TRUE(hands.says("'grid' needs more arguments"));
    EXPECT_TRUE(hands.says("write: grid COLUMNS ROWS"));
    hands.type(" 77");
    EXPECT_FALSE(hands.says("'grid' needs more arguments")) << "another line is another matter";
    hands.press(key::enter);  // a command that the session refuses
    EXPECT_FALSE(hands.session.error().empty());
    EXPECT_TRUE(hands.session.scene().shows("palette"));
    EXPECT_EQ(hands.state.palette.wrong, hands.session.error());
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("palette"));
}

// A command that would replace an unsaved text asks first.
TEST(Palette, AsksBeforeItOpensOverChanges) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::SetText{hands.session.document().text + "# mine\n"});
    hands.session.apply(parse_command("find \"open double\""));
    hands.rest(3);
    hands.press(key::enter);
    hands.rest(3);
    EXPECT_EQ(hands.session.system(), "ball_on_sine");
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::unsaved);
    hands.click("dialog Discard");
    EXPECT_EQ(hands.session.system(), "double_pendulum");
}

TEST(Palette, TakesThePlaceOfTheHelp) {
    Hands hands("ball_on_sine");
    hands.press(key::f1);
    open_palette(hands);
    EXPECT_FALSE(hands.session.scene().shows("help"));
    EXPECT_TRUE(hands.says("Enter runs it"));
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("palette"));
}

// Words of people, not of journals: a menu, a system, a value, a page.
TEST(Palette, FindsWhatPeopleCallIt) {
    const auto enter = [](Hands& hands, const std::string& typed) {
        open_palette(hands);
        hands.all.clear();
        hands.type(typed);
        hands.rest(2);
        hands.press(key::enter);
        hands.rest(3);
        EXPECT_FALSE(hands.session.scene().shows("palette")) << typed;
        EXPECT_EQ(hands.session.error(), "") << typed;
    };
    Hands hands("double_pendulum");
    enter(hands, "energy");
    EXPECT_TRUE(hands.session.scene().shows("energy"));
    enter(hands, "ball on sine");
    EXPECT_EQ(hands.session.system(), "ball_on_sine");
    enter(hands, "e = 0.3");
    EXPECT_EQ(hands.all[0], Command(command::Set({"e", 0.3})));
    EXPECT_EQ(hands.session.value("e"), 0.3);
    enter(hands, "save as");
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::save);
    hands.press(key::escape);
}

TEST(Palette, SaysWhatCanBeTypedWhenNothingIsFound) {
    Hands hands("ball_on_sine");
    open_palette(hands);
    hands.type("qqq");
    EXPECT_TRUE(hands.says("Nothing found. Type words of a menu (energy), a system (ball on sine), a value (e = 0.3)"));
    hands.press_with_control('A');
    hands.type("e");
    EXPECT_TRUE(hands.says("e = 0.5")) << "a value is offered with what it is now";
}

TEST(Finder, PutsAWholeCommandBeforeWords) {
    const std::vector<NamedEntry> entries{{"Seek shelter 3", "", "", "action a"}, {"Energy", "", "", "action b"}};
    const auto lines = [&](const std::string& typed) {
        std::vector<std::string> all;
        for (const CommandMatch& match : find_anything(typed, entries, {})) all.push_back(match.line);
        return all;
    };
    EXPECT_EQ(lines("seek 3"), (std::vector<std::string>{"seek 3", "action a"}));
    EXPECT_EQ(lines("ener").front(), "action b");
    EXPECT_EQ(words_rank("sine ball", "ball on sine"), 1);
    EXPECT_EQ(words_rank("ball", "Ball on sine"), 0);
    EXPECT_EQ(words_rank("all", "ball on sine"), -1) << "only beginnings of words count";
}

// ---- interface scale and presentation mode ----

std::string record(Hands& hands) {
    std::string text;
    for (const Command& command : std::exchange(hands.all, {})) text += to_text(command) + "; ";
    return text;
}

TEST(UiScale, GoesByStepsAndBack) {
    Hands hands("ball_on_sine");
    for (int i = 0; i < 3; ++i) hands.press_with_control('=');
    hands.press_with_control('-');
    hands.press_with_control('0');
    hands.press_with_control('0');
    hands.press_with_control('-');
    EXPECT_EQ(record(hands), "enlarge 1.1; enlarge 1.25; enlarge 1.5; enlarge 1.25; enlarge 1; enlarge 0.9; ");
    hands.session.apply(parse_command("enlarge 3"));
    hands.press_with_control('=');
    EXPECT_EQ(record(hands), "") << "as large as it gets";
    hands.session.apply(parse_command("enlarge 3.5"));
    EXPECT_NE(hands.session.error().find("from 0.5 to 3 times the default"), std::string::npos)
        << hands.session.error();
    EXPECT_EQ(hands.session.scene().enlarged(), 3.0);
}

TEST(Presentation, ComesAndGoesAndKeepsTheKeys) {
    Hands hands("ball_on_sine");
    hands.press(key::f11);
    EXPECT_EQ(record(hands), "present on; ");
    hands.rest(2);
    EXPECT_FALSE(hands.says("Parameters"));
    EXPECT_FALSE(hands.says("impacts taylor"));
    EXPECT_FALSE(hands.says("Zeno 1"));
    const auto plots = hands.session.plotted().list().size();
    EXPECT_EQ(plots, 4U) << "those that are not seen are there all the same";
    hands.press_with_control('D');
    hands.press(key::right);
    hands.press_with_control('=');
    EXPECT_EQ(record(hands), "theme dark; step 1 event; enlarge 1.1; ");
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().presents()) << record(hands);
    hands.rest(2);
    EXPECT_TRUE(hands.says("Parameters"));
}

// A picture of it is enlarged by the command alone.
TEST(Presentation, IsDrawnLargerWithoutAWindow) {
    const test::Folder folder;
    for (const auto& [name, more] : {std::pair{"plain.png", ""}, std::pair{"twice.png", "--do 'enlarge 2'"},
                                     std::pair{"scaled.png", "--scale 2"}, std::pair{"class.png", "--do 'present on'"}})
        EXPECT_EQ(folder.run(std::string("screenshot ball_on_sine --size 900x600 --out ") + name + " " + more).status,
                  0);
    const auto pixels = [&](const char* name) { return read_png(folder.path() / name).rgb; };
    EXPECT_EQ(pixels("twice.png"), pixels("scaled.png"));
    EXPECT_NE(pixels("class.png"), pixels("plain.png"));
}

// The session's journal and its text form include it.
TEST(Presentation, IsInTheSessionsRecipe) {
    Hands hands("ball_on_sine");
    for (const char* line : {"present on", "enlarge 1.25", "find \"grid\""}) hands.session.apply(parse_command(line));
    std::string steps;
    for (const Command& step : explorer_steps(hands.session)) steps += to_text(step) + "; ";
    for (const char* line : {"present on; ", "enlarge 1.25; ", "find \"grid\"; "})
        EXPECT_NE(steps.find(line), std::string::npos) << steps;
}

}  // namespace
}  // namespace achilles
