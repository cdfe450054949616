#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "journal/journal.hpp"

namespace achilles {
namespace {

const std::vector<Command> one_of_each{
    command::Open{"ball_on_sine"},
    command::Open{"/some/a \"strange\" #1\\file.toml"},
    command::Set{"g", 9.81},
    command::Set{"x'", -1.5},
    command::Set{"theta1", 0.1 + 0.2},
    command::SetEndTime{20.0},
    command::Tolerance{1e-10},
    command::Eps{1e-6, 1e-6, 1e-6},
    command::Eps{1e-6, 2e-6, 1.0 / 3.0},
    command::SetConditions{Conditions::sharp},
    command::SetReinitialization{Reinitialization::euclidean},
    command::Seek{3.2},
    command::ShowSensitivity{"zeno_time(2)"},
    command::FindOrbit{"--from end --continue e=0.1:0.9"},
    command::StopOrbit{},
    command::SelectBranchPoint{12},
    command::Play{},
    command::Pause{},
    command::Select{25},
    command::SetGrid{3, 2},
    command::PlotView{2, "t", {"y", "x'^2 + y'^2"}},
    command::Zoom{1, -1.0, 1e-7, 0.1 + 0.2, 3.0},
    command::Fit{4},
    command::AxisScale{1, false, true},
    command::ShowCurve{1, 2, false},
    command::Link{false},
    command::New{},
    command::Reload{},
    command::SetText{"title = \"A \\ \\n ball\"\n\t# \u03b8\r\n"},
    command::SetText{""},
    command::Save{"mine.toml", false},
    command::Save{"a folder/mine\n.toml", true},
    command::Show{"editor", true},
    command::Prove{},
    command::Prove{1e-6, {"e=0.4..0.6", "x'=1.4..1.6"}},
    command::StopProof{},
    command::Find{"grid 3"},
    command::Enlarge{1.25},
    command::Present{true},
    command::Present{true, {"e", "x'"}},
    command::Animate{"e", 0.2, {0.5235987755982988, "30 deg"}, 8.0},
    command::Animate{"x'", -1.0, 1.0},
    command::StopAnimation{},
    command::Show{"trail", false},
    command::SetStart{{{"x", 0.1 + 0.2}, {"x'", -1.5}}},
    command::LookAt{-1.5, 1e-7, 3.0},
    command::LookAll{},
    command::DefaultPlane{},
    command::ShowPlane{"gap", "sin(y) + 1"},
    command::SetCamera{"zeno"},
    command::Turn{-30.5, 45.0},
    command::TurnBack{},
    command::Speed{0.001},
    command::Loop{true},
    command::StepEvents{-1},
    command::StepEvents{1, "zeno"},
    command::Undo{},
    command::Redo{},
    command::Pin{},
    command::Pin{3},
    command::Unpin{},
    command::Unpin{2},
    command::UnpinAll{},
    command::ShowPinned{2, false},
    command::Recall{4},
    command::PlotDifference{3, true},
    command::ShowLens{2.5},
    command::SetTheme{true},
    command::SetTheme{false},
    command::SetPanelSize{"controls", 0.3},
    command::SetPanelSize{"plots", 0.0},
    command::Reset{},
    command::EndEdit{},
    command::SetMethod{Method::dopri5},
    command::MaxImpacts{1000},
    command::SetOption{"max-steps", {100000}},
    command::SetOption{"memory", {2.5e8}},
    command::SetRange{2, true, -1.0, 0.1 + 0.2},
    command::SetRange{1, false, 0.0, 1e-7},
    command::Export{"a folder/run.json", false},
    command::Export{"ball.svg", true},
    command::Export{"ball.svg", false, 2},
    command::Export{"plot", true, 3},
    command::Copy{"figure"},
    command::Copy{"plots", 2},
    command::Say{"A ball, \"bouncing\" # and more"},
    command::Say{""},
    command::Wait{2.5},
    command::Replay{"the_ball"},
};

TEST(Command, ReadsBackWhatItWrites) {
    for (const Command& command : one_of_each) EXPECT_EQ(parse_command(to_text(command)), command) << to_text(command);
}

TEST(Command, LooksAsTheManualSays) {
    EXPECT_EQ(to_text(command::Open{"ball_on_sine"}), "open ball_on_sine");
    EXPECT_EQ(to_text(command::Set{"g", 9.81}), "set g 9.81");
    EXPECT_EQ(to_text(command::Set{"x'", 1.5}), "set x' 1.5");
    EXPECT_EQ(to_text(command::Seek{3.2}), "seek 3.2");
    EXPECT_EQ(to_text(command::Eps{1e-6, 1e-6, 1e-6}), "eps 1e-06");
    EXPECT_EQ(to_text(command::SetText{"a = \"1\"\nb\\"}), "text \"a = \\\"1\\\"\\nb\\\\\"");
    EXPECT_EQ(to_text(command::SetTheme{true}), "theme dark");
    EXPECT_EQ(to_text(command::SetPanelSize{"events", 0.0}), "size events auto");
    EXPECT_EQ(to_text(command::SetPanelSize{"events", 0.25}), "size events 0.25");
    EXPECT_EQ(to_text(command::Save{"mine.toml", true}), "save mine.toml overwrite");
    EXPECT_EQ(parse_command("set g 1/4"), Command(command::Set{"g", 0.25}));
    for (const char* line : {"set theta1 30 deg", "set theta1 \"30 deg\"", "set theta1 30deg"})
        EXPECT_NEAR(std::get<command::Set>(parse_command(line)).value.value, 0.5235987755982988, 1e-15) << line;
    EXPECT_EQ(to_text(parse_command("set theta1 30 deg")), "set theta1 \"30 deg\"");
    EXPECT_EQ(to_text(parse_command("start a 30 deg b 1 c pi")), "start a \"30 deg\" b 1 c 3.141592653589793");
    EXPECT_EQ(to_text(parse_command("animate e 0.2 0.9 over 8")), "animate e 0.2 0.9 over 8");
    EXPECT_EQ(to_text(parse_command("step -1 frame")), "step -1 frame");
    EXPECT_EQ(parse_command("eps 1e-6"), Command(command::Eps{1e-6, 1e-6, 1e-6}));
    EXPECT_EQ(parse_command("  seek\t3.2   # then look"), Command(command::Seek{3.2}));
}

TEST(Journal, ReadsBackWhatItWrites) {
    EXPECT_EQ(parse_journal(journal_text(one_of_each)), one_of_each);
    EXPECT_EQ(parse_journal("# a tour\n\nplay\r\n   # on\npause"),
              (std::vector<Command>{command::Play{}, command::Pause{}}));
    EXPECT_TRUE(parse_journal("").empty());
}

struct Mistake {
    const char* line;
    int column;
    const char* says;
};

TEST(Journal, NamesThePlaceOfAMistake) {
    const Mistake mistakes[] = {{"save", 5, "needs more"},
                                {"step 1 zenno", 8, "did you mean 'zeno'"},
                                {"copy plotz", 6, "did you mean 'plots'"},
                                {"copy plots 0", 12, "plots count from 1"},
                                {"animate e 0.2", 14, "needs more"},
                                {"theme blue", 7, "there is no theme 'blue'"},
                                {"size plot 0.3", 6, "did you mean 'plots'"},
                                {"size plots 1.5", 12, "cannot take 1.5 of the window"},
                                {"size plots wide", 12, "not a finite number"},
                                {"save a b", 8, "save FILE overwrite"},
                                {"export a.svg plot", 14, "export FILE plot 2"},
                                {"export a.svg plot 0", 19, "plots count from 1"},
                                {"export a.svg plot x", 19, "'x'"},
                                {"export a.svg plot 1 2", 21, "export FILE overwrite"},
                                {"show contrls", 6, "did you mean 'controls'"},
                                {"text a b", 8, "unexpected argument 'b'"},
                                {"new file", 5, "unexpected argument 'file'"},
                                {"  seeek 3", 3, "did you mean 'seek'"},
                                {"seek", 5, "needs more"},
                                {"seek 3 4", 8, "unexpected argument '4'"},
                                {"seek soon", 6, "'soon' is not a finite number"},
                                {"seek inf", 6, "not a finite number"},
                                {"seek nan", 6, "not a finite number"},
                                {"seek 1e999", 6, "not a finite number"},
                                {"seek 3x", 6, "not a finite number"},
                                {"set g", 6, "needs more"},
                                {"set g 0,4", 7, "write a decimal point, 0.4"},
                                {"set g abc", 7, "'abc' is not a finite number"},
                                {"set g 1 2", 9, "unexpected argument '2'"},
                                {"set g 30 degrees", 10, "unexpected argument 'degrees'"},
                                {"start x 1 y", 11, "this name has no value"},
                                {"eps 1 2", 7, "one number or three"},
                                {"conditions strict", 12, "'strict'"},
                                {"reinitialization none", 18, "'none'"},
                                {"select 1.5", 8, "whole number"},
                                {"max-steps 1.5", 11, "whole number"},
                                {"method", 7, "write: method taylor, or: method dopri5"},
                                {"method tailor", 8, "unknown method 'tailor'"},
                                {"eps 1 2 3 4", 11, "write: eps 1e-6, or: eps POSITION VELOCITY TIME"},
                                {"open \"half", 6, "quotes"},
                                {"play now", 6, "unexpected argument"},
                                {"look al", 8, "write: look X Y WIDTH, or: look all"},
                                {"\"look all\"", 1, "there is no command"},
                                {"\x01\xff", 1, "no command"}};
    for (const Mistake& mistake : mistakes) {
        try {
            parse_journal(std::string("# first\nplay\n") + mistake.line + "\nplay\n", "tour.journal");
            ADD_FAILURE() << mistake.line;
        } catch (const InputError& error) {
            EXPECT_EQ(error.file, "tour.journal");
            EXPECT_EQ(error.at.line, 3) << mistake.line;
            EXPECT_EQ(error.at.column, mistake.column) << mistake.line;
            EXPECT_NE(std::string(error.what()).find(mistake.says), std::string::npos) << error.what();
        }
    }
}

// Every name appears once; twice if the command also switches off, and for `look` and `look all`.
TEST(Command, IsListedOnce) {
    std::string list;
    try {
        parse_command("nonsense");
    } catch (const InputError& error) {
        list = error.hint;
    }
    const std::string start = "the commands are: ";
    ASSERT_EQ(list.rfind(start, 0), 0u) << list;
    std::istringstream names(list.substr(start.size()));
    std::set<std::string> all;
    for (std::string name; std::getline(names >> std::ws, name, ',');) EXPECT_TRUE(all.insert(name).second) << name;
    for (const Command& command : one_of_each) {
        const std::string text = to_text(command);
        EXPECT_TRUE(all.contains(text.substr(0, text.find(' ')))) << text;
    }
    EXPECT_TRUE(all.contains("hide") && all.contains("unpin"));
    EXPECT_EQ(all.size(), 68u) << list;
}

TEST(Command, ListsAllWhereNoneIsNear) {
    try {
        parse_command("seekk 3");
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_EQ(error.message, "there is no command 'seekk'; did you mean 'seek'?");
        EXPECT_EQ(error.hint, "");
    }
}

// Every option has a command, alone or with others; invalid values are refused when the command is performed.
TEST(Command, SetsEveryOption) {
    for (const auto group : options_by_command()) {
        const command::SetOption use(group[0], Options{});
        EXPECT_EQ(use.values.size(), group.size());
        EXPECT_EQ(parse_command(to_text(use)), Command(use));
        EXPECT_EQ(to_text(use).rfind(std::string(group[0].command) + " ", 0), 0u);
    }
    EXPECT_EQ(to_text(command::SetOption("max-steps", {30})), "max-steps 30");
}

TEST(Journal, IsAFileThatGrowsLineByLine) {
    const auto file = std::filesystem::temp_directory_path() / "achilles_command_test.journal";
    {
        JournalFile journal(file);
        std::vector<Command> so_far;
        for (const Command& command : one_of_each) {
            journal.append(command);
            so_far.push_back(command);
            EXPECT_EQ(read_journal(file), so_far);
        }
        journal.append(command::Set{"e", 3.0});  // the session refuses it
        journal.take_back();
        EXPECT_EQ(read_journal(file), so_far);
        journal.append(one_of_each.front());
        so_far.push_back(one_of_each.front());
        EXPECT_EQ(read_journal(file), so_far);
        journal.take_back();
    }
    EXPECT_THROW(JournalFile{file}, InputError);  // an existing record is kept
    EXPECT_EQ(read_journal(file), one_of_each);
    std::filesystem::remove(file);
    EXPECT_THROW(read_journal(file), InputError);
    EXPECT_THROW(read_journal(std::filesystem::temp_directory_path()), InputError);
    EXPECT_THROW(JournalFile("/nowhere/at/all"), InputError);
}

}  // namespace
}  // namespace achilles
