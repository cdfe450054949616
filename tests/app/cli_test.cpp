// What a user sees on the command line: statuses, messages, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>
#include <string>
#include <vector>

#include "app/program.hpp"
#include "image/image.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

// Bad input: status 2, this message, nothing on standard output, no file.
struct Refusal {
    std::string name, arguments, message;
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.arguments; }

class Refused : public testing::TestWithParam<Refusal> {};

TEST_P(Refused, WithOneMessageAndNothingWritten) {
    const Folder folder;
    const Answer answer = folder.run(GetParam().arguments);
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err, GetParam().message);
    EXPECT_EQ(answer.out, "");
    EXPECT_TRUE(folder.files().empty());
}

const std::string more = "\n'achilles simulate --help' tells more\n";

// The names of the files in assets/systems, as a message lists them.
std::string systems() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/assets/systems"))
        names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

const Refusal refusals[] = {
    {"unknown_system", "simulate ball_on_sin --json a.json",
     "achilles: there is no system 'ball_on_sin'; did you mean 'ball_on_sine'?\n"
     "a system is a path to a .toml file or one of: " +
         systems() + "\n"},
    {"missing_file", "simulate ./no.toml", "./no.toml: there is no such file\n"},
    {"unknown_setting", "simulate ball_on_sine --set gg=3 --json a.json",
     "--set gg=3: 'gg' is no parameter, coordinate or rate of this system; did you mean 'g'?\n"},
    {"setting_without_value", "simulate ball_on_sine --set g",
     "--set g: a value is missing\nwrite --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5\n"},
    {"subnormal_parameter", "simulate ball_on_sine --set m=5e-324 --json a.json",
     "--set m=5e-324: the parameter 'm' is 5e-324: so small a number has lost digits\n"
     "0, or at least 2.3e-308 in size: choose units in which it is larger\n"},
    {"unknown_conditions", "simulate ball_on_sine --conditions shap",
     "--conditions shap: there is no 'shap' to choose; did you mean 'sharp'?\nthe choice is paper or sharp\n"},
    {"unknown_method", "simulate ball_on_sine --method tailor",
     "--method tailor: there is no 'tailor' to choose; did you mean 'taylor'?\nthe choice is dopri5 or taylor\n"},
    {"end_not_positive", "simulate ball_on_sine --end -1",
     "--end: the value must be positive and finite, but it is -1\n"},
    {"not_a_number", "simulate ball_on_sine --eps nan", "--eps nan: 'nan' is not a finite number\n"},
    {"number_with_a_tail", "simulate ball_on_sine --tolerance 1e-8x",
     "--tolerance 1e-8x: '1e-8x' is not a finite number: an operator is missing here; write '*' for a product\n"},
    {"no_impacts", "simulate ball_on_sine --max-impacts 0", "--max-impacts: at least one impact must be allowed\n"},
    {"no_steps", "simulate ball_on_sine --max-steps 0", "--max-steps: at least one step must be allowed\n"},
    {"half_a_step", "simulate ball_on_sine --max-steps 1.5", "--max-steps 1.5: this is not a whole number\n"},
    {"the_common_eps_first", "simulate ball_on_sine --eps-q -2 --eps -1",
     "--eps: the value must be positive and finite, but it is -1\n"},
    {"unwritable_output", "simulate ball_on_sine --csv a.csv --json none/a.json",
     "none/a.json: the file cannot be written: No such file or directory\n"},
    {"output_is_a_folder", "simulate ball_on_sine --json /tmp", "/tmp: the file cannot be written: Is a directory\n"},
    {"full_device", "simulate ball_on_sine --json /dev/full",
     "/dev/full: the file cannot be written: No space left on device\n"},
    {"one_file_twice", "simulate ball_on_sine --json a --csv ./a", "./a: two outputs cannot go to the same place\n"},
    {"unknown_command", "simulat ball_on_sine",
     "achilles: there is no command or system 'simulat'; did you mean 'simulate'?\n"
     "the commands are: explore, simulate, figure, frames, paper, screenshot, reproduce, check, list, help, new\n"},
    {"unknown_option", "simulate ball_on_sine --tolerence 1",
     "achilles: '--tolerence' is not expected here; did you mean '--tolerance'?" + more},
    {"no_system", "simulate", "achilles: SYSTEM is required" + more},
    {"missing_journal", "screenshot --out a.png --journal none.journal", "none.journal: there is no such file\n"},
    {"screenshot_without_a_place", "screenshot ball_on_sine",
     "achilles: --out is required\n'achilles screenshot --help' tells more\n"},
    {"bad_size", "screenshot --out a.png --size 1600",
     "--size 1600: this is no size in pixels\nwrite WIDTHxHEIGHT, as in --size 1600x1000; each from 64 to 16384\n"},
};

INSTANTIATE_TEST_SUITE_P(Cli, Refused, testing::ValuesIn(refusals),
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

// Errors that appear only while running: status 3, the reason, and what was computed until then.
TEST(Cli, ARunThatLeavesTheDomainSaysWhenWhereAndWhy) {
    const Folder folder;
    const struct {
        std::string kinetic, potential, gap, beginning;
    } runs[] = {
        {"y'^2/2", "log(y)", "y + 1", "log(y) in the potential ceases to be defined, with y = "},
        {"y'^2/2", "-1/y", "y + 1", "(-1)/y in the potential ceases to be defined, with y = "},
        {"y*y'^2/2", "y", "y + 1", "the mass matrix ceases to be positive definite, with the pivot of 'y' at "},
        {"y'^2/2", "9.81*y", "y^3", "dh = 0 where contact happens: the normal is not defined, at t = 0.45"},
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

TEST(Cli, TheCommandLineOverridesTheFile) {
    const Folder folder;
    folder.put("drop.toml", drop_text + "[run]\nmethod = \"taylor\"\n[truncation]\nconditions = \"paper\"\n");
    const Answer from_file = folder.run("simulate drop.toml");
    EXPECT_EQ(from_file.status, 0);
    EXPECT_NE(from_file.out.find("taylor, tolerance"), std::string::npos) << from_file.out;
    const Answer answer = folder.run("simulate drop.toml --method dopri5 --conditions sharp");
    EXPECT_EQ(answer.status, 0);
    EXPECT_NE(answer.out.find("dopri5, tolerance"), std::string::npos) << answer.out;
    EXPECT_NE(answer.out.find("sharp conditions"), std::string::npos) << answer.out;
}

TEST(Cli, ListShowsNamesAndTitles) {
    const Answer answer = Folder().run("list");
    EXPECT_EQ(answer.status, 0);
    for (const char* line : {"(^|\n)ball_on_sine +Ball bouncing on a sinusoidal surface\n",
                             "\ndouble_pendulum +Double pendulum with a mechanical stop\n"})
        EXPECT_TRUE(std::regex_search(answer.out, std::regex(line))) << answer.out;
}

TEST(Cli, AssetsCanBeElsewhere) {
    const Folder folder;
    std::filesystem::create_directory(folder.path() / "systems");
    folder.put("systems/drop.toml", drop_text);
    folder.put("systems/notes.txt", "no system");
    EXPECT_EQ(folder.run("list", "ACHILLES_ASSETS=.").out, "drop  A ball dropped on the floor\n");
    EXPECT_EQ(folder.run("list", "ACHILLES_ASSETS=./none").status, 2);
}

TEST(Cli, HelpAndVersion) {
    const Folder folder;
    EXPECT_EQ(folder.run("--version").out, "achilles 0.1.0\n");
    for (const char* arguments : {"--help", "simulate --help", "paper --help", "list --help", "explore --help",
                                  "screenshot --help", "figure --help", "frames --help", "reproduce --help"}) {
        const Answer answer = folder.run(arguments);
        EXPECT_EQ(answer.status, 0) << arguments;
        EXPECT_NE(answer.out.find("Usage: achilles"), std::string::npos) << arguments;
    }
}

TEST(Cli, JsonHasTheContractsKeys) {
    const Answer answer = Folder().run("simulate ball_on_sine --json -");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.err, "");
    const json root = json::parse(answer.out);
    for (const char* key : {"achilles", "system", "options", "phases", "events", "end", "outcome", "statistics"})
        EXPECT_TRUE(root.contains(key)) << key;
    EXPECT_EQ(root["outcome"]["kind"], "end time");
    for (const json& event : root["events"]) {
        if (event["kind"] != "zeno") continue;
        EXPECT_NEAR(event["t"].get<double>(), 2.725142, 1e-6);
        for (const char* key : {"q", "v", "impacts", "truncation", "certificate"})
            EXPECT_TRUE(event.contains(key)) << key;
        return;
    }
    FAIL() << "no Zeno event";
}

// How long a run took is told to a person who asks, not to its files.
TEST(Cli, TheSameRunGivesTheSameBytes) {
    const Folder folder;
    const Answer first = folder.run("simulate double_pendulum --json -");
    const Answer second = folder.run("simulate double_pendulum --json - --verbose");
    EXPECT_EQ(first.out, second.out);
    EXPECT_EQ(first.err, "");
    EXPECT_NE(second.err.find(" s, of these "), std::string::npos) << second.err;
}

TEST(Cli, CommandLineGoesOverTheFileGoesOverTheDefault) {
    const Folder folder;
    folder.put("drop.toml", drop_text + "[run]\nend_time = 3.0\n[truncation]\neps_q = 1e-5\neps_v = 1e-5\n");
    const Answer answer = folder.run(
        "simulate drop.toml --set y=2 --set \"y'=-1e0\" --eps 1e-4 --eps-v 1e-3 --tolerance 1e-9 "
        "--reinitialization euclidean --json - --csv run.csv");
    ASSERT_EQ(answer.status, 0) << answer.err;
    const json root = json::parse(answer.out);
    EXPECT_EQ(root["end"]["t"], 3.0);
    EXPECT_EQ(root["options"]["tolerance"], 1e-9);
    EXPECT_EQ(root["options"]["eps_q"], 1e-4);
    EXPECT_EQ(root["options"]["eps_v"], 1e-3);
    EXPECT_EQ(root["options"]["eps_t"], 1e-4);
    EXPECT_EQ(root["options"]["conditions"], "sharp");
    EXPECT_EQ(root["options"]["reinitialization"], "euclidean");
    EXPECT_EQ(content(folder.path() / "run.csv").rfind("t,phase,y,y',gap,", 0), 0u);
    EXPECT_NE(content(folder.path() / "run.csv").find("\n0,hybrid,2,-1,"), std::string::npos);
    EXPECT_EQ(folder.files().size(), 2u);
}

TEST(Cli, ToleranceBelowWhatDoublesServeIsToldOnceAndRaised) {
    const Folder folder;
    const std::string warning =
        "achilles: warning: tolerance = 1e-30 is less than double precision can serve: 1e-15 is used\n";
    const Answer answer = folder.run("simulate ball_on_sine --end 1 --tolerance 1e-30 --json -");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.err, warning);
    EXPECT_EQ(json::parse(answer.out)["options"]["tolerance"], 1e-15);
    for (const char* command : {"figure ball_on_sine --end 1 --tolerance 1e-30 --out a.svg",
                                "screenshot ball_on_sine --end 1 --tolerance 1e-30 --out a.png"}) {
        const Answer picture = folder.run(command);
        EXPECT_EQ(picture.status, 0) << picture.err;
        EXPECT_EQ(picture.err, warning);
    }
    EXPECT_EQ(folder.run("simulate ball_on_sine --end 1 --tolerance 1e-15 --json -").err, "");
}

TEST(Cli, SaysWhatProofsAssume) {
    const Folder folder;
    const std::string out = folder.run("simulate ball_on_sine --end 3").out;
    for (const char* words :
         {"IEEE double arithmetic in round-to-nearest", "elementary functions within 2 ulp", "4 for sinh, cosh, tanh"})
        EXPECT_NE(out.find(words), std::string::npos) << out;
    const json assumed = json::parse(folder.run("simulate ball_on_sine --end 3 --json -").out)["assumed"];
    EXPECT_EQ(assumed["ulps"], 2);
    EXPECT_EQ(assumed["ulps_hyperbolic"], 4);
    EXPECT_NE(out.find(assumed["library"].get<std::string>()), std::string::npos) << out;
    // Without a Zeno point nothing is proved.
    EXPECT_EQ(folder.run("simulate ball_on_sine --end 1").out.find("assume"), std::string::npos);
}

TEST(Cli, AStoppedRunSaysSoAndWritesWhatThereIs) {
    const Folder folder;
    const Answer answer = folder.run("simulate ball_on_sine --max-impacts 3 --json a.json");
    EXPECT_EQ(answer.status, 3);
    EXPECT_NE(answer.err.find("achilles: the run stopped early: "), std::string::npos) << answer.err;
    EXPECT_EQ(json::parse(content(folder.path() / "a.json"))["outcome"]["kind"], "too many impacts");
}

TEST(Cli, TheStepsOfARunCanBeLimited) {
    const Folder folder;
    EXPECT_EQ(folder.run("simulate ball_on_sine --max-steps 30 --json a.json").status, 3);
    const json root = json::parse(content(folder.path() / "a.json"));
    EXPECT_EQ(root["outcome"]["kind"], "too many steps");
    EXPECT_EQ(root["options"]["max_steps"], 30);
}

// By its own limit, or where the system gives no more: what there is is written.
TEST(Cli, TheMemoryOfARunIsLimited) {
    const Folder folder;
    const std::string run = "simulate ball_in_bowl --end 1e8 --max-steps 1000000000 ";
    const Answer own = folder.run(run + "--memory 2e6 --json a.json");
    EXPECT_EQ(own.status, 3);
    EXPECT_NE(own.err.find("take the 2 MB that the run may have"), std::string::npos) << own.err;
    const json root = json::parse(content(folder.path() / "a.json"));
    EXPECT_EQ(root["outcome"]["kind"], "out of memory");
    EXPECT_EQ(root["options"]["memory"], 2e6);
#ifndef __SANITIZE_ADDRESS__
    const Answer systems = folder.run(run + "--memory 1e12", "ulimit -v 300000;");
    EXPECT_EQ(systems.status, 3);
    EXPECT_NE(systems.out.find("outcome: out of memory"), std::string::npos) << systems.out;
    EXPECT_NE(systems.err.find("the system has no memory for more"), std::string::npos) << systems.err;
#endif
}

TEST(Cli, AFullDeviceLeavesTheOtherFileAsItWas) {
    const Folder folder;
    folder.put("run.csv", "old");
    EXPECT_EQ(folder.run("simulate ball_on_sine --csv run.csv --json /dev/full").status, 2);
    EXPECT_EQ(content(folder.path() / "run.csv"), "old");
    EXPECT_EQ(folder.files().size(), 1u);
}

TEST(Cli, OutputReplacesAFileThroughALink) {
    const Folder folder;
    folder.put("old.json", "old");
    std::filesystem::create_symlink("old.json", folder.path() / "link.json");
    EXPECT_EQ(folder.run("simulate ball_on_sine --json link.json").status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.json"));
    EXPECT_TRUE(json::accept(content(folder.path() / "old.json")));
}

TEST(Cli, SummaryNamesPhasesAndTheZenoPoint) {
    const Answer answer = Folder().run("simulate ball_on_sine");
    EXPECT_EQ(answer.status, 0);
    for (const char* part : {"hybrid phase", "constrained phase", "zeno      t = 2.725142", "release"})
        EXPECT_NE(answer.out.find(part), std::string::npos) << part;
}

TEST(Cli, ScreenshotDrawsWhatTheJournalLeadsTo) {
    const Folder folder;
    folder.put("tour.journal", "# the second system, in contact\nopen double_pendulum\nset e 0.4\nseek 4\n");
    const std::string size = " --size 1280x800 --out ";
    ASSERT_EQ(folder.run("screenshot" + size + "start.png").status, 0);
    ASSERT_EQ(folder.run("screenshot ball_on_sine" + size + "named.png").status, 0);
    ASSERT_EQ(folder.run("screenshot --journal tour.journal" + size + "tour.png").status, 0);
    const Answer standard = folder.run("screenshot --journal tour.journal" + size + "-");
    EXPECT_EQ(standard.out, content(folder.path() / "tour.png"));
    EXPECT_EQ(read_png(folder.path() / "start.png"), read_png(folder.path() / "named.png"));
    EXPECT_NE(read_png(folder.path() / "start.png"), read_png(folder.path() / "tour.png"));
    const Image image = read_png(folder.path() / "tour.png");
    EXPECT_EQ(image.width, 1280);
    EXPECT_EQ(image.height, 800);
    EXPECT_EQ(folder.run("screenshot ball_on_sine --max-impacts 3 --out early.png").status, 3);
    EXPECT_EQ(read_png(folder.path() / "early.png").width, 1600);
}

TEST(Cli, AMissingDisplayIsOneMessageAndBeginsNoRecord) {
    const Folder folder;
    for (const char* system : {"explore ball_on_sine", "ball_on_sine", ""}) {
        const Answer answer = folder.run(std::string(system) + " --record new.journal", "DISPLAY= WAYLAND_DISPLAY=");
        EXPECT_EQ(answer.status, 2);
        EXPECT_EQ(answer.err.rfind("achilles: ", 0), 0u) << answer.err;
        EXPECT_NE(answer.err.find("display"), std::string::npos) << answer.err;
    }
    EXPECT_TRUE(folder.files().empty());
}

TEST(Cli, PaperDrawsSixFiguresTwoPagesAndATable) {
    const Folder folder;
    const Answer answer = folder.run("paper");
    ASSERT_EQ(answer.status, 0) << answer.err;
    for (const char* name : {"fig4a", "fig4b", "fig4c", "fig4d", "fig4e", "fig4f", "fig4", "zeno"}) {
        const auto file = folder.path() / "achilles-paper" / (std::string(name) + ".png");
        EXPECT_EQ(content(file).substr(1, 3), "PNG") << name;
        EXPECT_NE(answer.out.find("/achilles-paper/" + std::string(name) + ".png\n"), std::string::npos) << answer.out;
    }
    EXPECT_NE(answer.out.find("2.72514217"), std::string::npos);
    EXPECT_EQ(answer.out.rfind(content(folder.path() / "achilles-paper/table.txt"), 0), 0u);
    EXPECT_EQ(folder.run("paper --out /dev/null/x").status, 2);
    // Nothing is left of what could not be drawn, and a folder that was there stays.
    const Answer refused = folder.run("paper --out new", "ACHILLES_OFFSCREEN=none");
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.err, "achilles: ACHILLES_OFFSCREEN must be osmesa or egl, not 'none'\n");
    std::filesystem::create_directory(folder.path() / "old");
    EXPECT_EQ(folder.run("paper --out old", "ACHILLES_OFFSCREEN=none").status, 2);
    EXPECT_EQ(folder.files().size(), 2u);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "old"));
}

}  // namespace
}  // namespace achilles::test
