// The command line: exit statuses and files. For refused input see command_errors_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "app/program.hpp"
#include "image/image.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

TEST(Cli, TheCommandLineOverridesTheFile) {
    const Folder folder;
    folder.put("drop.toml", drop_text + "[run]\nmethod = \"taylor\"\n[truncation]\nconditions = \"paper\"\n");
    const Answer from_file = folder.run("simulate drop.toml --verbose");
    EXPECT_EQ(from_file.status, 0);
    EXPECT_NE(from_file.out.find("taylor, tolerance"), std::string::npos) << from_file.out;
    const Answer answer = folder.run("simulate drop.toml --method dopri5 --conditions sharp --verbose");
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
    const std::string version = folder.run("--version").out;
    EXPECT_TRUE(
        std::regex_match(version, std::regex("achilles 0\\.1\\.0 \\(commit ([0-9a-f]{7,12}( with changes)?|unknown: "
                                             "built from files outside of a git repository)\\)\n")))
        << version;
    for (const char* arguments : {"--help", "simulate --help", "paper --help", "list --help", "explore --help",
                                  "screenshot --help", "figure --help", "frames --help", "reproduce --help"}) {
        const Answer answer = folder.run(arguments);
        EXPECT_EQ(answer.status, 0) << arguments;
        EXPECT_NE(answer.out.find("Usage: achilles"), std::string::npos) << arguments;
    }
}

// The commit is one of the source's repository. (It need not be the last one: the program may be older.)
TEST(Cli, TheVersionHasACommitOfTheSource) {
    const Folder folder;
    const std::string version = folder.run("--version").out, git = "git -C '" ACHILLES_SOURCE_DIR "' ";
    if (std::system((git + "rev-parse HEAD >/dev/null 2>&1").c_str()) != 0) GTEST_SKIP() << "there is no repository";
    std::smatch commit;
    ASSERT_TRUE(std::regex_search(version, commit, std::regex("commit ([0-9a-f]{7,12})"))) << version;
    EXPECT_EQ(std::system((git + "cat-file -e '" + commit[1].str() + "^{commit}'").c_str()), 0) << version;
}

// README and the manual cite the version of the build.
TEST(Cli, TheVersionIsCitedEverywhere) {
    const std::string version = Folder().run("--version").out.substr(9, 5);
    EXPECT_NE(content(ACHILLES_SOURCE_DIR "/README.md").find("*Achilles " + version + ":"), std::string::npos);
    EXPECT_NE(content(ACHILLES_SOURCE_DIR "/assets/manual/paper.md").find("version = {" + version + "}"),
              std::string::npos);
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

// The computing time is printed only on request and never written to files.
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

TEST(Cli, TooSmallToleranceIsRaisedWithOneWarning) {
    const Folder folder;
    const std::string warning =
        "achilles: warning: tolerance = 1e-30 is below what double precision supports; using 1e-15\n";
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
    const std::string out = folder.run("simulate ball_on_sine --end 3 --verbose").out;
    for (const char* words :
         {"IEEE double arithmetic, rounded to nearest", "elementary functions within 2 ulp", "4 for sinh, cosh, tanh"})
        EXPECT_NE(out.find(words), std::string::npos) << out;
    const json assumed = json::parse(folder.run("simulate ball_on_sine --end 3 --json -").out)["assumed"];
    EXPECT_EQ(assumed["ulps"], 2);
    EXPECT_EQ(assumed["ulps_hyperbolic"], 4);
    EXPECT_NE(out.find(assumed["library"].get<std::string>()), std::string::npos) << out;
    // Without a Zeno point there is no certificate.
    EXPECT_EQ(folder.run("simulate ball_on_sine --end 1 --verbose").out.find("assume"), std::string::npos);
}

TEST(Cli, AStoppedRunSaysSoAndWritesWhatThereIs) {
    const Folder folder;
    const Answer answer = folder.run("simulate ball_on_sine --max-impacts 3 --json a.json");
    EXPECT_EQ(answer.status, 3);
    EXPECT_NE(answer.err.find("achilles: the run stopped early: "), std::string::npos) << answer.err;
    EXPECT_EQ(json::parse(content(folder.path() / "a.json"))["outcome"]["kind"], "too many impacts");
    // The summary states the reason, so the message does not repeat it.
    const Answer summed_up = folder.run("simulate ball_on_sine --max-impacts 3");
    const std::string reason = "3 impacts by t = ";
    EXPECT_NE(summed_up.out.find(reason), std::string::npos) << summed_up.out;
    EXPECT_EQ(summed_up.err, "achilles: the run stopped early: too many impacts\n");
}

TEST(Cli, TheStepsOfARunCanBeLimited) {
    const Folder folder;
    EXPECT_EQ(folder.run("simulate ball_on_sine --max-steps 30 --json a.json").status, 3);
    const json root = json::parse(content(folder.path() / "a.json"));
    EXPECT_EQ(root["outcome"]["kind"], "too many steps");
    EXPECT_EQ(root["options"]["max_steps"], 30);
}

// Memory limits: the run's own and the system's. The results so far are written.
TEST(Cli, TheMemoryOfARunIsLimited) {
    const Folder folder;
    const std::string run = "simulate ball_in_bowl --end 1e8 --max-steps 1000000000 ";
    const Answer own = folder.run(run + "--memory 2e6 --json a.json");
    EXPECT_EQ(own.status, 3);
    EXPECT_NE(own.err.find("use all of the 2 MB allowed"), std::string::npos) << own.err;
    const json root = json::parse(content(folder.path() / "a.json"));
    EXPECT_EQ(root["outcome"]["kind"], "out of memory");
    EXPECT_EQ(root["options"]["memory"], 2e6);
#ifndef __SANITIZE_ADDRESS__
    const Answer systems = folder.run(run + "--memory 1e12", "ulimit -v 300000;");
    EXPECT_EQ(systems.status, 3);
    EXPECT_NE(systems.out.find(" s of 100000000 s: out of memory\n"), std::string::npos) << systems.out;
    EXPECT_NE(systems.out.find("and no more memory is available on this machine. Try"), std::string::npos)
        << systems.out;
    EXPECT_EQ(systems.err, "achilles: the run stopped early: out of memory\n");
#endif
}

TEST(Cli, OutputReplacesAFileThroughALink) {
    const Folder folder;
    folder.put("old.json", "old");
    std::filesystem::create_symlink("old.json", folder.path() / "link.json");
    EXPECT_EQ(folder.run("simulate ball_on_sine --json link.json").status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.json"));
    EXPECT_TRUE(json::accept(content(folder.path() / "old.json")));
}

// The summary has at most 15 lines: what happened, a row per change of the contact state, the accuracy, and what to
// type next. Numbers have only digits that certificates and error estimate support.
TEST(Cli, SimulateAnswersFirst) {
    const Answer answer = Folder().run("simulate ball_on_sine");
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(
        answer.out.rfind("Ball bouncing on a sinusoidal surface: simulated to t = 20 s, in contact at the end\n\n", 0),
        0u)
        << answer.out;
    EXPECT_LE(std::count(answer.out.begin(), answer.out.end(), '\n'), 15) << answer.out;
    for (const char* line : {"\n +t \\(s\\) +event +x \\(m\\) +y \\(m\\)\n", "\n +0 +start +0 +2 +free flight\n",
                             "\n +2\\.725142 +Zeno +4\\.60890 +-0\\.994650 +contact begins; impacts since 1\\.694 s "
                             "dissipated 0\\.301 J\n",
                             "\n +3\\.731822 +release +", "contact force reached zero\n", "\n +20 +end +11\\.50370",
                             "\nZeno times certified within 7e-7 s and 1\\.4e-7 s \\(truncation only\\); estimated "
                             "integration error 1e-8 s\\.\n",
                             "achilles prove ball_on_sine\n", "21 impacts, 42 steps"})
        EXPECT_TRUE(std::regex_search(answer.out, std::regex(line))) << line << "\n" << answer.out;
    const Answer stopped = Folder().run("simulate ball_on_sine --max-impacts 3 --set e=0.6");
    EXPECT_NE(stopped.out.find(" s of 20 s: too many impacts\n  "), std::string::npos) << stopped.out;
    EXPECT_NE(stopped.out.find("Try a larger --max-impacts"), std::string::npos) << stopped.out;
    EXPECT_NE(stopped.out.find("achilles prove ball_on_sine --set e=0.6\n"), std::string::npos) << stopped.out;
}

TEST(Cli, SummaryNamesPhasesAndTheZenoPoint) {
    const Answer answer = Folder().run("simulate ball_on_sine --verbose");
    EXPECT_EQ(answer.status, 0);
    for (const char* part : {"\nin flight, t = 0 to ", "\nin contact, t = ", "zeno      t = 2.725142", "release"})
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
    // Nothing remains after a failure to draw, but an existing folder is kept.
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
