// Interpretation of input: numbers, ranges and units on the command line, and the messages about them.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/program.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

TEST(Suggestions, AValueOutsideItsRangeIsToldOnceAndUsed) {
    const Folder folder;
    const std::string warning =
        "achilles: warning: theta1 = 30 rad is outside its range, -1.5708 to 1.5708: for an angle in degrees write 30 "
        "deg\n";
    for (const char* command : {"simulate double_pendulum --end 0.1 --set theta1=30 --json a.json",
                                "figure double_pendulum --end 0.1 --set theta1=30 --out a.svg",
                                "screenshot double_pendulum --end 0.1 --set theta1=30 --out a.png"}) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 0);
        EXPECT_EQ(answer.err, warning) << command;
    }
    EXPECT_EQ(json::parse(content(folder.path() / "a.json"))["events"].size(), 0u);
    const Answer degrees = folder.run("simulate double_pendulum --end 0.1 --set 'theta1=30 deg' --set L1=1/2 --json -");
    EXPECT_EQ(degrees.err, "");
    EXPECT_EQ(json::parse(degrees.out)["system"]["parameters"]["L1"], 0.5);
    const Answer none = folder.run("simulate double_pendulum --set 'L1=30 deg'");
    EXPECT_EQ(none.status, 2);
    EXPECT_EQ(none.err,
              "--set L1=30 deg: '30 deg' is not a finite number: 'deg' is allowed only where the unit is rad, and here "
              "it is m\n");
}

// The same for commands of a journal.
TEST(Suggestions, WhatACommandOverstepsIsTold) {
    const Folder folder;
    for (const char* command :
         {"screenshot double_pendulum --size 640x480 --out a.png", "figure double_pendulum --out a.svg"}) {
        const Answer answer =
            folder.run(command + std::string(" --end 3 --do 'set theta1 45' --do 'seek 99' --do 'set theta1 0'"
                                             " --do 'seek -1' --do 'tolerance 1e-30' --do 'seek 3'"));
        EXPECT_EQ(answer.status, 0);
        EXPECT_EQ(
            answer.err,
            "achilles: warning: theta1 = 45 rad is outside its range, -1.5708 to 1.5708: for an angle in degrees write "
            "45 deg\nachilles: warning: seek 99: the run ends at t = 3 s\nachilles: warning: seek -1: the run begins "
            "at t = 0 s\nachilles: warning: tolerance = 1e-30 is below what double precision supports; using 1e-15\n")
            << command;
    }
}

const std::string drop =
    "title = \"drop\"\n[[coordinate]]\nname = \"y\"\nstart = 1.0\n[[parameter]]\nname = \"e\"\nvalue = "
    "0.5\n[lagrangian]\n"
    "kinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n[[constraint]]\ngap = \"y\"\nrestitution = \"e\"\n";

std::string with(const std::string& from, const std::string& to) {
    return std::string(drop).replace(drop.find(from), from.size(), to);
}

// Common mistakes in system files: the message says what to write.
TEST(Suggestions, CommonMistakesOfAFileAreToldWhatToWrite) {
    const struct {
        std::string text, message;
    } mistakes[] = {
        {with("gap = \"y\"", "gap = y"),
         "f.toml:12:7: not valid TOML: could not determine value type\n    gap = y\n          ^\nput it in quotes: gap "
         "= "
         "\"y\"\n"},
        {with("start = 1.0", "start = 30 deg  # up"),
         "f.toml:4:12: not valid TOML: expected a comment or whitespace, saw 'd'\n    start = 30 deg  # up\n           "
         "    "
         "^\nput it in quotes: start = \"30 deg\"\n"},
        {with("start = 1.0", "start = 0,4"),
         "f.toml:4:10: not valid TOML: expected a comment or whitespace, saw ','\n    start = 0,4\n             "
         "^\nwrite a decimal point: start = 0.4\n"},
        {with("9.81*y", "9.81*y + ydot"),
         "f.toml:10:23: unknown name 'ydot'; rates are written y'\n    potential = \"9.81*y + ydot\"\n                 "
         "     "
         "    ^\n"},
        {with("y'^2/2", "v^2/2"),
         "f.toml:9:12: unknown name 'v'; rates are written y'\n    kinetic = \"v^2/2\"\n               ^\nwrite "
         "y'^2/2\n"},
        {with("9.81*y", "9.81*θ1"),
         "f.toml:10:19: names have Latin letters: write theta1 for 'θ1'\n    potential = \"9.81*θ1\"\n               "
         "       ^\n"},
        {with("name = \"y\"", "name = \"θ\""),
         "f.toml:3:9: 'θ' is not a name\n    name = \"θ\"\n            ^\nspell out Greek letters: write theta\n"},
    };
    const Folder folder;
    for (const auto& [text, message] : mistakes) {
        folder.put("f.toml", text);
        const Answer answer = folder.run("simulate f.toml");
        EXPECT_EQ(answer.status, 2);
        EXPECT_EQ(answer.err, message);
    }
}

TEST(Suggestions, AnEndingThatSaysOtherwiseIsAWarning) {
    const Folder folder;
    folder.put("drop.toml", drop);
    const Answer crossed = folder.run("simulate drop.toml --end 0.1 --json a.csv --csv a.json");
    EXPECT_EQ(crossed.status, 0);
    EXPECT_EQ(crossed.err,
              "achilles: warning: --json a.csv: the output is not csv, although the name says so\nachilles: warning: "
              "--csv a.json: the output is not json, although the name says so\n");
    EXPECT_EQ(folder.run("simulate drop.toml --end 0.1 --json b.json --csv b.csv").err, "");
}

TEST(Suggestions, WhatASettingMakesImpossibleIsToldWithTheSetting) {
    const Folder folder;
    folder.put("drop.toml", drop);
    folder.put("square.toml", with("gap = \"y\"", "gap = \"y^2\""));
    folder.put("broken.toml", with("value = 0.5", "value = 1.5"));
    const std::string flat =
        "the start is in contact, and dh = 0 there: the normal is not defined\nwrite a gap whose dh is not 0 where h = "
        "0, for example x instead of x^2 or x^3\n";
    const std::string large = "the restitution must lie in [0, 1], but it is 1.5\n";
    const std::pair<std::string, std::string> mistakes[] = {
        {"simulate drop.toml --set y=2 --set e=1.5", "--set e=1.5: " + large + "0 is plastic, 1 is elastic\n"},
        {"check drop.toml --set e=1.5", "--set e=1.5: " + large + "0 is plastic, 1 is elastic\n"},
        {"figure drop.toml --set e=1.5 --out a.svg", "--set e=1.5: " + large + "0 is plastic, 1 is elastic\n"},
        {"screenshot drop.toml --set e=1.5 --out a.png", "--set e=1.5: " + large + "0 is plastic, 1 is elastic\n"},
        {"simulate square.toml --set y=0", "--set y=0: " + flat},
        {"simulate square.toml --set y=1e-170", "--set y=1e-170: " + flat},
        {"simulate drop.toml --set ydot=1",
         "--set ydot=1: 'ydot' is not a parameter, coordinate or rate of this system; rates are written y'\n"},
        {"simulate double_pendulum --set θ1=1",
         "--set θ1=1: 'θ1' is not a parameter, coordinate or rate of this system; did you mean 'theta1'?\n"},
        {"simulate broken.toml --set y=2",
         "broken.toml:13:16: " + large + "    restitution = \"e\"\n                   ^\n0 is plastic, 1 is elastic\n"},
        {"figure drop.toml --do \"set e 1.5\" --out a.svg",
         "set e 1.5: e = 1.5: " + large + "0 is plastic, 1 is elastic\n"},
        {"figure drop.toml --do \"plot 1 t y,e\" --out a.svg",
         "plot 1 t y,e: unexpected ','\n    y,e\n     ^\nwrite: plot NUMBER X Y..., expressions with spaces in double "
         "quotes\n"},
        {"simulate drop", "achilles: there is no system 'drop'; did you mean the file drop.toml?\n"},
        {"simulate drop.toml --set end=3", "--set end=3: 'end' is an option of the run, --end on the command line\n"},
        {"simulate drop.toml --set tolerance=1e-6",
         "--set tolerance=1e-6: 'tolerance' is an option of the run, --tolerance on the command line\n"},
        {"simulate .", ".: this is a folder; a system file is expected, for example ./broken.toml\n"}};
    for (const auto& [arguments, message] : mistakes) {
        const Answer answer = folder.run(arguments);
        EXPECT_EQ(answer.status, 2) << arguments;
        EXPECT_EQ(answer.err, message) << arguments;
        EXPECT_EQ(folder.files().size(), 3u) << arguments;
    }
}

// Messages use the unit that was typed. An angle that looks like degrees gets a hint.
TEST(Suggestions, AnAngleInDegreesIsToldInDegrees) {
    const Folder folder;
    const std::pair<const char*, const char*> told[] = {
        {"'theta1=400 deg'", "theta1 = 400 deg is outside its range, -90 to 90\n"},
        {"'theta1=3*pi'", "theta1 = 540 deg is outside its range, -90 to 90\n"},
        {"theta1=2", "theta1 = 2 rad is outside its range, -1.5708 to 1.5708\n"},
        {"theta1=30",
         "theta1 = 30 rad is outside its range, -1.5708 to 1.5708: for an angle in degrees write 30 deg\n"}};
    for (const auto& [setting, warning] : told)
        EXPECT_EQ(folder.run("simulate double_pendulum --end 0.1 --json a.json --set " + std::string(setting)).err,
                  std::string("achilles: warning: ") + warning);
    const Answer rate = folder.run("simulate double_pendulum --end 0.1 --set \"theta1'=20 deg/s\" --json -");
    EXPECT_NEAR(json::parse(rate.out)["start"]["v"][0].get<double>(), 0.349065850398866, 1e-15) << rate.err;
}

TEST(Suggestions, StepsWarnAsOptionsDo) {
    const Answer answer = Folder().run(
        "figure double_pendulum --end 0.1 --set m1=7 --do \"tolerance 1e-30\" --do \"set theta1 3\" --out a.svg");
    EXPECT_EQ(answer.err,
              "achilles: warning: m1 = 7 kg is outside its range, 0.1 to 5\n"
              "achilles: warning: tolerance = 1e-30 is below what double precision supports; using 1e-15\n"
              "achilles: warning: theta1 = 3 rad is outside its range, -1.5708 to 1.5708\n");
}

TEST(Data, HoldsTheInstantsThatWereAskedFor) {
    const Folder folder;
    ASSERT_EQ(folder.run("simulate ball_on_sine --samples 5 --json a.json --csv a.csv --plain-names").status, 0);
    const json root = json::parse(content(folder.path() / "a.json"));
    ASSERT_EQ(root["samples"].size(), 5u);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(root["samples"][static_cast<std::size_t>(i)]["t"], 5.0 * i);
    EXPECT_EQ(root["samples"][4]["q"], root["end"]["q"]);
    EXPECT_EQ(root["start"]["v"], (json{1.5, 0.0}));
    const std::string csv = content(folder.path() / "a.csv");
    EXPECT_EQ(csv.rfind("t,phase,x,y,x_rate,y_rate,gap,gap_rate,lambda_,energy,j,event\n0,hybrid,0,2,1.5,0,", 0), 0u)
        << csv;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
    folder.put("t.txt", "3\n1\n");
    const Answer answer = folder.run("simulate ball_on_sine --times t.txt --json -");
    EXPECT_EQ(json::parse(answer.out)["samples"][1]["t"], 1.0);
}

// They start at the start time of the run, which need not be 0.
TEST(Data, EquidistantInstantsBeginWithTheRun) {
    const Answer answer =
        Folder().run("simulate ball_on_vibrating_table --start-time 0.5 --end 1 --samples 3 --json -");
    std::vector<double> times;
    const json run = json::parse(answer.out);
    for (const json& sample : run["samples"]) times.push_back(sample["t"]);
    EXPECT_EQ(times, (std::vector{0.5, 0.75, 1.0})) << answer.err;
}

TEST(Data, InstantsThatCannotBeAreBadInput) {
    const Folder folder;
    folder.put("t.txt", "3\n21\n");
    const std::pair<const char*, const char*> mistakes[] = {
        {"--times t.txt --csv a.csv",
         "t.txt:2:1: 21 is outside the run, 0 to 20; leave it out, or change --end\n    21\n    ^\n"},
        {"--times none.txt --csv a.csv", "none.txt: there is no such file\n"},
        {"--samples 1 --csv a.csv", "--samples 1: a whole number from 2 to 1000000 is expected\n"},
        {"--samples 2.5 --csv a.csv", "--samples 2.5: a whole number from 2 to 1000000 is expected\n"},
        {"--samples 5 --times t.txt --csv a.csv", "--samples: the instants are already given by --times\n"},
        {"--samples 5", "--samples: this needs --csv F or --json F\n"},
        {"--plain-names --json a.json", "--plain-names: this needs --csv F\n"}};
    for (const auto& [arguments, message] : mistakes) {
        const Answer answer = folder.run(std::string("simulate ball_on_sine ") + arguments);
        EXPECT_EQ(answer.status, 2) << arguments;
        EXPECT_EQ(answer.err, message);
        EXPECT_EQ(folder.files().size(), 1u) << arguments;
    }
}

}  // namespace
}  // namespace achilles::test
