// Refused command lines: status, message, place, and no output files.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "app/program.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

// Bad input: status 2, this message, nothing on standard output, no file.
struct Refusal {
    std::string name, arguments, message;
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.arguments; }

class CommandErrors : public testing::TestWithParam<Refusal> {};

TEST_P(CommandErrors, PrintOneMessageAndWriteNothing) {
    const Folder folder;
    const Answer answer = folder.run(GetParam().arguments);
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err, GetParam().message);
    EXPECT_EQ(answer.out, "");
    EXPECT_TRUE(folder.files().empty());
}

const Refusal refusals[] = {
    {"unknown_system", "simulate ball_on_sin --json a.json",
     "achilles: there is no system 'ball_on_sin'; did you mean 'ball_on_sine'?\n"},
    {"missing_file", "simulate ./no.toml", "./no.toml: there is no such file\n"},
    {"unknown_setting", "simulate ball_on_sine --set gg=3 --json a.json",
     "--set gg=3: 'gg' is not a parameter, coordinate or rate of this system; did you mean 'g'?\n"},
    {"setting_without_value", "simulate ball_on_sine --set g",
     "--set g: a value is missing\nwrite --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5\n"},
    {"subnormal_parameter", "simulate ball_on_sine --set m=5e-324 --json a.json",
     "--set m=5e-324: the parameter 'm' is 5e-324: such a small number is not represented with full precision\nuse 0, "
     "or choose units in which it is at least 2.3e-308 in size\n"},
    {"unknown_conditions", "simulate ball_on_sine --conditions shap",
     "--conditions shap: there is no such choice; did you mean 'sharp'?\n"
     "write --conditions paper or --conditions sharp\n"},
    {"unknown_method", "simulate ball_on_sine --method tailor",
     "--method tailor: there is no such choice; did you mean 'taylor'?\nwrite --method dopri5 or --method taylor\n"},
    {"end_not_positive", "simulate ball_on_sine --end -1", "--end: the end time -1 is not after the start time 0\n"},
    {"not_a_number", "simulate ball_on_sine --eps nan", "--eps nan: 'nan' is not a finite number\n"},
    {"number_with_a_tail", "simulate ball_on_sine --tolerance 1e-8x",
     "--tolerance 1e-8x: '1e-8x' is not a finite number: 'x' may not follow a number: write numbers without units (a "
     "file has the key unit for that) and products with '*'\n"},
    {"no_impacts", "simulate ball_on_sine --max-impacts 0", "--max-impacts: at least one impact must be allowed\n"},
    {"no_steps", "simulate ball_on_sine --max-steps 0", "--max-steps: at least one step must be allowed\n"},
    {"half_a_step", "simulate ball_on_sine --max-steps 1.5",
     "--max-steps 1.5: a whole number is expected, at most 2147483647\n"},
    {"the_common_eps_first", "simulate ball_on_sine --eps-q -2 --eps -1",
     "--eps: the value must be positive and finite, but it is -1\n"},
    {"unwritable_output", "simulate ball_on_sine --csv a.csv --json none/a.json",
     "none/a.json: there is no folder none\n"},
    {"output_is_a_folder", "simulate ball_on_sine --json /tmp", "/tmp: the file cannot be written: Is a directory\n"},
    {"full_device", "simulate ball_on_sine --json /dev/full",
     "/dev/full: the file cannot be written: No space left on device\n"},
    {"one_file_twice", "simulate ball_on_sine --json a --csv ./a", "./a: two outputs cannot go to the same file\n"},
    {"unknown_command", "simulat ball_on_sine",
     "achilles: there is no command or system 'simulat'; write achilles simulate ball_on_sine\n"},
    {"unknown_option", "simulate ball_on_sine --tolerence 1",
     "achilles: simulate has no option --tolerence; did you mean '--tolerance'?\n"},
    {"no_system", "simulate",
     "achilles: a system is missing; write achilles simulate NAME: a name from 'achilles list', or a .toml file\n"},
    {"missing_journal", "screenshot --out a.png --journal none.journal", "none.journal: there is no such file\n"},
    {"screenshot_without_a_place", "screenshot ball_on_sine", "achilles: --out is missing; write --out F.png\n"},
    {"refused_step", "screenshot --do 'seek 2' --do 'set e 1.5' --out a.png --record r.journal",
     "set e 1.5: e = 1.5: the restitution must lie in [0, 1], but it is 1.5\n0 is plastic, 1 is elastic\n"},
    {"lens_of_nothing", "screenshot --do 'lens 1' --out a.png",
     "lens 1: the lens needs a Zeno point, but none is selected\nselect it first: select 10\n"},
    {"screenshot_as_svg", "screenshot --out q.svg",
     "--out q.svg: this name says SVG, but the picture is PNG\nend it in .png; for the plots alone as SVG or PDF: "
     "achilles figure\n"},
    {"screenshot_as_jpg", "screenshot --out q.JPG",
     "--out q.JPG: this name says JPG, but the picture is PNG\nend it in .png; for the plots alone as SVG or PDF: "
     "achilles figure\n"},
    {"format_against_name", "figure ball_on_sine --format pdf --out q.png",
     "--out q.png: this name says PNG, but the picture is PDF\nend it in .pdf, or leave --format out: the name gives "
     "the format\n"},
    {"bad_size", "screenshot --out a.png --size 1600",
     "--size 1600: this is not a size in pixels\nwrite WIDTHxHEIGHT, as in --size 1600x1000; each from 64 to 16384\n"},
};

INSTANTIATE_TEST_SUITE_P(Cli, CommandErrors, testing::ValuesIn(refusals),
                         [](const auto& refusal) { return refusal.param.name; });

TEST(Cli, BadTomlIsShownWithItsPlace) {
    const Folder folder;
    folder.put("bad.toml", "title = \"x\"\n[[coordinate]\n");
    const Answer answer = folder.run("simulate bad.toml --json a.json");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err.rfind("bad.toml:2:", 0), 0u) << answer.err;
    EXPECT_NE(answer.err.find("\n    [[coordinate]\n"), std::string::npos) << answer.err;
    EXPECT_NE(answer.err.find('^'), std::string::npos) << answer.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"bad.toml"});
}

TEST(Cli, EveryMistakeIsShownAndNothingWritten) {
    const Folder folder;
    std::string bad = drop_text;
    bad.replace(bad.find("start = 1.0"), 11, "start = inf");
    bad.replace(bad.find("9.81*y"), 6, "9.81*z");
    folder.put("bad.toml", bad);
    const Answer answer = folder.run("simulate bad.toml --json a.json");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.out, "");
    EXPECT_EQ(answer.err,
              "bad.toml:4:9: 'start' in [[coordinate]] must be finite, not inf\n    start = inf\n            ^\n\n"
              "bad.toml:7:19: unknown name 'z'\n    potential = \"9.81*z\"\n                      ^\n");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"bad.toml"});
}

TEST(Cli, WhatTheCommandLineSetsIsCheckedAtTheStart) {
    const Folder folder;
    folder.put("drop.toml", drop_text);
    const Answer answer = folder.run("simulate drop.toml --set y=-1 --json a.json");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err, "--set y=-1: the gap is negative at the start: h = -1\nchoose a start with h(q) >= 0\n");
    EXPECT_EQ(folder.run("simulate drop.toml --set y=1e999").err, "--set y=1e999: '1e999' is not a finite number\n");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"drop.toml"});
}

// Errors during a run: status 3, the reason, and the results so far.
TEST(Cli, ARunThatLeavesTheDomainSaysWhenWhereAndWhy) {
    const Folder folder;
    const struct {
        std::string kinetic, potential, gap, beginning;
    } runs[] = {
        {"y'^2/2", "log(y)", "y + 1", "log(y) in the potential becomes undefined, with y = "},
        {"y'^2/2", "-1/y", "y + 1", "(-1)/y in the potential becomes undefined, with y = "},
        {"y*y'^2/2", "y", "y + 1", "the mass matrix is no longer positive definite: the pivot of 'y' is "},
        {"y'^2/2", "9.81*y", "y^3", "dh = 0 at the contact: the normal is not defined, at t = 0.45"},
    };
    for (const auto& run : runs) {
        folder.put("edge.toml",
                   "title = \"edge\"\n[[coordinate]]\nname = \"y\"\nstart = 1.0\n[lagrangian]\nkinetic = \"" +
                       run.kinetic + "\"\npotential = \"" + run.potential + "\"\n[[constraint]]\ngap = \"" + run.gap +
                       "\"\nrestitution = 0.5\n");
        const Answer answer = folder.run("simulate edge.toml --json edge.json");
        EXPECT_EQ(answer.status, 3) << run.beginning;
        const std::string start = "achilles: the run stopped early: " + run.beginning;
        EXPECT_EQ(answer.err.substr(0, start.size()), start);
        EXPECT_NE(answer.err.find(", q = ("), std::string::npos) << answer.err;
        EXPECT_NE(answer.err.find("), v = ("), std::string::npos) << answer.err;
        const json root = json::parse(content(folder.path() / "edge.json"));
        EXPECT_EQ(root["outcome"]["kind"], "left the domain");
        EXPECT_GT(root["end"]["t"].get<double>(), 0.1);
    }
}

TEST(Cli, AJournalsMistakeIsShownWithItsPlace) {
    const Folder folder;
    folder.put("tour.journal", "play\n  seeek 3\n");
    const Answer answer = folder.run("screenshot --journal tour.journal --out a.png");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err.rfind("tour.journal:2:3: there is no command 'seeek'; did you mean 'seek'?\n", 0), 0u)
        << answer.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"tour.journal"});
}

// The picture would lack the effect of the command, so none is written.
TEST(Cli, ALineOfAJournalThatIsRefusedIsBadInput) {
    const Folder folder;
    folder.put("tour.journal", "set g 2\nselect 9999\nseek 1\n");
    for (const char* command : {"screenshot --journal tour.journal --out a.png",
                                "screenshot --allow-files --do 'replay tour.journal' --out a.png",
                                "figure ball_on_sine --journal tour.journal --out a.svg"}) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 2) << command;
        EXPECT_NE(answer.err.find("there is no event 9999"), std::string::npos) << answer.err;
        EXPECT_EQ(folder.files(), std::vector<std::string>{"tour.journal"}) << command;
    }
}

TEST(Cli, AFullDeviceLeavesTheOtherFileAsItWas) {
    const Folder folder;
    folder.put("run.csv", "old");
    EXPECT_EQ(folder.run("simulate ball_on_sine --csv run.csv --json /dev/full").status, 2);
    EXPECT_EQ(content(folder.path() / "run.csv"), "old");
    EXPECT_EQ(folder.files().size(), 1u);
}

TEST(Cli, AMissingDisplayIsOneMessageAndBeginsNoRecord) {
    const Folder folder;
    for (const char* system : {"explore ball_on_sine", "ball_on_sine", ""}) {
        const Answer answer = folder.run(std::string(system) + " --record new.journal", "DISPLAY= WAYLAND_DISPLAY=");
        EXPECT_EQ(answer.status, 2);
        EXPECT_EQ(answer.err.rfind("achilles: ", 0), 0u) << answer.err;
        EXPECT_NE(answer.err.find("DISPLAY"), std::string::npos) << answer.err;
    }
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace achilles::test
