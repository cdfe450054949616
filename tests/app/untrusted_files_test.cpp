// Untrusted journals, pictures and system files: what they may not do, and output to a terminal.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/inputs.hpp"
#include "image/notes.hpp"
#include "journal/journal.hpp"
#include "model/read_system.hpp"
#include "system/input_error.hpp"

namespace achilles::test {
namespace {

const std::string small = " --size 640x480 --end 0.1 ";

class UntrustedFiles : public testing::Test {
 protected:
    // A screenshot of a journal.
    Answer screenshot(const std::string& journal, const std::string& options = {}) const {
        folder.put("x.journal", journal);
        return folder.run("screenshot --journal x.journal --out a.png" + small + options);
    }
    bool has(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }
    std::string held_by(const std::string& name) const { return content(folder.path() / name); }

    const Folder folder;
};

// Refused with file and line before any command runs; nothing is read, written or drawn.
TEST_F(UntrustedFiles, JournalsUseNoFiles) {
    folder.put("victim", "mine");
    folder.put("secret.toml", "password");
    folder.put("inner.journal", "grid 1 1\n");
    const std::pair<std::string, std::string> cases[] = {
        {"save ./victim overwrite", "write ./victim"},
        {"save new.toml", "write new.toml"},
        {"export victim.svg overwrite", "write"},
        {"export new.journal", "write new.journal"},
        {"open ./secret.toml", "read ./secret.toml"},
        {"open secret.toml", "read secret.toml"},
        {"open victim", "read victim"},
        {"open /etc/passwd", "read /etc/passwd"},
        {"replay ./inner.journal", "read ./inner"},
        {"replay inner.journal", "read inner.journal"},
        {"replay victim", "read victim"},
    };
    const std::size_t before = folder.files().size() + 1;
    for (const auto& [line, requests] : cases) {
        for (const char* command : {"screenshot", "figure ball_on_sine"}) {
            folder.put("x.journal", "# a tour\ngrid 2 2\n  " + line + "\n");
            const Answer answer = folder.run(std::string(command) + " --journal x.journal --out a.png");
            EXPECT_EQ(answer.status, 2) << line;
            EXPECT_EQ(answer.err.find("x.journal:3:3: this journal would " + requests), 0U) << answer.err;
            EXPECT_NE(answer.err.find("--allow-files"), std::string::npos) << answer.err;
            EXPECT_EQ(folder.files().size(), before) << line;
        }
    }
    EXPECT_EQ(held_by("victim"), "mine");
}

TEST_F(UntrustedFiles, JournalsMayNameAssetsAndWhatTheCommandLineNames) {
    folder.put("x.journal", "open ball_on_floor\nreplay the_ball\n");
    EXPECT_EQ(folder.run("screenshot --journal x.journal --out a.png --size 640x480").status, 0);
    folder.put("mine.toml", drop_text);
    EXPECT_EQ(screenshot("open ./mine.toml\n", "mine.toml").status, 0);
    EXPECT_EQ(screenshot("open ./mine.toml\ntext \"x\"\nsave ./mine.toml\n", "mine.toml").status, 2);
    EXPECT_EQ(held_by("mine.toml"), drop_text);
    EXPECT_EQ(folder.run("screenshot --do 'open mine.toml' --do 'save b.toml' --out b.png" + small).status, 0);
    EXPECT_EQ(held_by("b.toml"), drop_text);
}

// With permission it may write new files only.
TEST_F(UntrustedFiles, AJournalThatIsTrustedOverwritesNothing) {
    folder.put("victim.toml", "mine");
    folder.put("mine.toml", drop_text);
    EXPECT_EQ(screenshot("open mine.toml\nsave copy.toml overwrite\nsave copy.toml\n", "--allow-files").status, 0);
    EXPECT_EQ(held_by("copy.toml"), drop_text);
    for (const std::string line : {"save victim.toml overwrite", "save mine.toml", "export a.svg overwrite"}) {
        folder.put("a.svg", "mine");
        const Answer answer = screenshot("open mine.toml\n" + line + "\n", "--allow-files");
        EXPECT_EQ(answer.status, 2) << line;
        EXPECT_NE(answer.err.find("x.journal:2:1: "), std::string::npos) << answer.err;
        EXPECT_NE(answer.err.find("a journal never overwrites files"), std::string::npos) << answer.err;
    }
    EXPECT_EQ(held_by("victim.toml") + held_by("a.svg"), "minemine");
}

TEST_F(UntrustedFiles, ATextThatIsNoSystemIsNotSaved) {
    EXPECT_EQ(screenshot("text \"alias ls=rm\"\nsave .bashrc\n", "--allow-files").status, 2);
    EXPECT_FALSE(has(".bashrc"));
    const Answer answer = folder.run("figure ball_on_sine --do 'text \"x\"' --do 'save b.toml' --out b.svg");
    EXPECT_EQ(answer.status, 2);
    EXPECT_FALSE(has("b.toml"));
}

// A picture is reproduced from its own content, within limits of work.
TEST_F(UntrustedFiles, WorkHasALimit) {
    std::string twelve, many;
    for (int i = 0; i < 12; ++i) twelve += "replay x.journal\n";
    const Answer nested = screenshot(twelve, "--allow-files");
    EXPECT_EQ(nested.status, 2);
    EXPECT_NE(nested.err.find("at most 10000 commands"), std::string::npos) << nested.err;
    for (int i = 0; i < 10001; ++i) many += "done\n";
    EXPECT_EQ(screenshot(many).err.find("x.journal:10001:1: a session replays at most 10000 commands"), 0U);
    EXPECT_EQ(folder.run("figure ball_on_sine --do 'step 1000000000' --out a.svg").status, 0);
    EXPECT_EQ(screenshot("step 1000000000\nstep -1000000000\n").status, 0);
    const auto refused = [&](const std::string& command, const std::string& journal, const std::string& message) {
        const std::string bare = held_by("a.png");
        const std::string head = bare.substr(0, 33) + bare.substr(bare.find("IDAT") - 4);
        folder.put("p.png", with_notes(head, {{"Achilles Command", "achilles " + command},
                                              {"Achilles System", "./s.toml\n" + drop_text},
                                              {"Achilles Journal", "j\n" + journal}}));
        const auto begin = std::chrono::steady_clock::now();
        const Answer answer = folder.run("reproduce p.png");
        EXPECT_EQ(answer.status, 2) << message;
        EXPECT_NE(answer.err.find(message), std::string::npos) << answer.err;
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10)) << message;
    };
    std::string replays, sets, words;
    for (int i = 0; i < 12; ++i) replays += "replay j\n";
    for (int i = 0; i < 1001; ++i) sets += "set y 1\n", words += " --set y=1";
    refused("screenshot ./s.toml --journal j", sets, "at most 1000 changes");
    refused("screenshot ./s.toml --size 16384x16384 --scale 8", "", "16384 x 16384 pixels is too large");
    refused("figure ./s.toml --size 8000x8000", "", "too large");
    refused("frames ./s.toml --size 8000x8000", "", "too large");
    refused("figure ./s.toml" + words, "", "2004 words");
    refused("screenshot ./s.toml --journal j", replays, "at most 10000 commands");
}

// Options or text in a journal, sweeps, and contents of a picture cannot make the program use unlimited memory or time:
// each is refused before a run starts.
TEST_F(UntrustedFiles, AskForNoMoreWorkThanTheirBudget) {
    const auto is_refused = [&](const Answer& answer, const std::string& place, const std::string& message) {
        EXPECT_EQ(answer.status, 2) << message;
        EXPECT_EQ(answer.err.find(place), 0U) << answer.err;
        EXPECT_NE(answer.err.find(message), std::string::npos) << answer.err;
    };
    const std::string memory = "a run of a journal or a picture may keep at most 1000 MB";
    const std::string steps = "a run of a journal or a picture may take at most 2000000";
    const std::string points = "a sweep of a journal or a picture may have at most 4194304";
    const auto begin = std::chrono::steady_clock::now();
    is_refused(screenshot("open ball_on_sine\nmemory 1e300\nmax-steps 1000000000\nend 1e9\nset e 1\n"),
               "x.journal:2:1: ", memory);
    is_refused(screenshot("# why\n  max-steps 1000000000\n"), "x.journal:2:3: ", steps);
    is_refused(screenshot("sweep \"--over e=0:1:10000000 --print x\"\n"), "achilles: ", points);
    is_refused(screenshot("sweep \"--over memory=1e9:1e300:5 --print x\"\n"), "achilles: ", memory);
    for (const std::string run : {"memory = 1e300", "max_steps = 1000000000"}) {
        const std::string system = drop_text + "[run]\n" + run + "\n";
        is_refused(screenshot("text " + quoted(system) + "\n"), "achilles: ", run[1] == 'e' ? memory : steps);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
    EXPECT_FALSE(has("a.png"));
    // What the user types, or allows, is done.
    EXPECT_EQ(screenshot("memory 2e9\n", "--memory 2e9").status, 0);
    EXPECT_EQ(screenshot("memory 2e9\nmax-steps 3000000\n", "--allow-files").status, 0);
    EXPECT_EQ(folder.run("screenshot --do 'memory 2e9' --out b.png" + small).status, 0);
}

TEST_F(UntrustedFiles, PicturesAreMadeAgainWithinABudget) {
    ASSERT_EQ(screenshot("").status, 0);
    const std::string bare = held_by("a.png"), head = bare.substr(0, 33) + bare.substr(bare.find("IDAT") - 4);
    const auto refused = [&](const std::string& command, const std::string& message, const std::string& run = {}) {
        const std::string system = drop_text + "[run]\n" + run;
        folder.put("p.png", with_notes(head, {{"Achilles Command", "achilles " + command},
                                              {"Achilles System", "./s.toml\n" + system},
                                              {"Achilles System", "ball_on_sine\n" + system}}));
        const auto begin = std::chrono::steady_clock::now();
        const Answer answer = folder.run("reproduce p.png");
        EXPECT_EQ(answer.status, 2) << command;
        EXPECT_NE(answer.err.find(message), std::string::npos) << command << answer.err;
        EXPECT_NE(answer.err.find("to make it without this limit, run:\nachilles " + command), std::string::npos)
            << answer.err;
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10)) << command;
    };
    const std::string memory = "keep at most 1000 MB", steps = "take at most 2000000";
    for (const std::string command : {"figure ./s.toml", "frames ./s.toml", "screenshot ./s.toml", "orbit ./s.toml",
                                      "sweep ./s.toml --over y=1:2:5 --print y", "figure ./s.toml --mechanism"}) {
        refused(command + " --memory 1e300", memory);
        refused(command + " --max-steps 1000000000", steps);
        refused(command, memory, "memory = 1e300\n");
    }
    refused("paper", steps, "max_steps = 1000000000\n");
    refused("sweep ./s.toml --over y=1:2:900000000 --print y", "a picture may have at most 4194304");
    refused("sweep ./s.toml --over memory=1e9:1e300:5 --print y", memory);
}

// Runs that are each within the limits may exceed them together.
TEST(Budget, CountsAllRuns) {
    Options few;
    few.max_steps = 100;
    const auto budget = std::make_shared<Budget>("say so", few);
    SystemSource library;
    library.budget = budget;
    const SystemDescription description = parse_system(drop_text, "drop.toml");
    achilles::Run run = default_run(description);
    run.options.max_steps = 100;
    run.options.end_time = 0.5;
    Session session("drop.toml", description, run, library);
    const double full_run = static_cast<double>(session.trajectory().statistics.steps) / few.max_steps;
    ASSERT_GT(full_run, 0.0);
    budget->limit();
    int runs = 0;
    const auto forever = [&] {
        for (; runs < 10000; ++runs) session.apply(command::Set{"y", 1.0 + 1e-6 * runs});
    };
    EXPECT_THROW(forever(), PermissionDenied);
    EXPECT_NEAR(runs * full_run, Budget::max_full_runs, 0.5);
    // The session stays valid and continues after the limits are lifted.
    EXPECT_THROW(session.apply(command::SetOption("max-steps", {101})), PermissionDenied);
    budget->lift();
    EXPECT_TRUE(session.apply(command::SetOption("max-steps", {101})));
    EXPECT_TRUE(session.apply(command::Undo{}));
    budget->limit();
    EXPECT_THROW(session.apply(command::Redo{}), PermissionDenied);
    EXPECT_EQ(session.trajectory().run.options.max_steps, 100);
    EXPECT_TRUE(session.apply(command::Set{"y", 1.5})) << "what ran before the limits were lifted does not count";
}

TEST(TimeLimitDeathTest, EndsTheProcess) {
    const auto endless = [] {
        TimeLimit limit;
        limit.arm("say so", 1);
        for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    };
    EXPECT_EXIT(endless(), testing::ExitedWithCode(2), "takes longer than 1 s; nothing is written\nsay so");
    TimeLimit limit;
    limit.arm("say so", 1);
    limit.disarm();
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
}

// A window asks about each file; Enter does not answer.
TEST(FileQuestion, IsAskedAndAnswered) {
    Hands hands("ball_on_sine");
    for (const bool allowed : {false, true}) {
        hands.state.file_question = FileQuestion{"a.journal", "write /home/me/a.toml", 1, {}};
        hands.rest(3);
        EXPECT_TRUE(hands.says("write /home/me/a.toml, and one more file")) << hands.letters();
        hands.press(key::enter);
        ASSERT_TRUE(hands.state.file_question);
        EXPECT_FALSE(hands.state.file_question->answer);
        hands.click(allowed ? "dialog Allow" : "dialog Refuse");
        EXPECT_EQ(hands.state.file_question->answer, allowed);
        hands.state.file_question.reset();
        hands.rest(3);
    }
    EXPECT_TRUE(hands.all.empty());
}

// Permission is for one file and one direction; all others are asked about separately.
TEST_F(UntrustedFiles, PermissionIsForOneFile) {
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    folder.put("a.toml", drop_text);
    const std::string text = "open " + path("a.toml") + "\nsave " + path("b.toml") + "\nopen " + path("a.toml") +
                             "\nexport " + path("c.svg") + "\n";
    FilePolicy trust;
    std::vector<std::string> asked;
    for (int i = 0; i < 4; ++i) {
        try {
            EXPECT_EQ(parse_trusted(text, "x.journal", trust).size(), 4U);
            break;
        } catch (const PermissionDenied& problem) {
            ASSERT_FALSE(problem.requests.empty());
            EXPECT_EQ(problem.requests.size(), 3U - asked.size());
            asked.push_back(problem.requests.front());
            trust.answered[problem.requests.front()] = true;
        }
    }
    EXPECT_EQ(asked, (std::vector<std::string>{"read " + path("a.toml"), "write " + path("b.toml"),
                                               "write " + path("c.svg")}));
    EXPECT_THROW(parse_trusted("save " + path("a.toml"), "x.journal", trust), PermissionDenied);
    trust.answered["write " + path("b.toml")] = false;
    EXPECT_THROW(parse_trusted(text, "x.journal", trust), PermissionDenied);
    // A permitted write still does not overwrite a file.
    trust.answered["write " + path("a.toml")] = true;
    try {
        parse_trusted("save " + path("a.toml"), "x.journal", trust);
        FAIL();
    } catch (const PermissionDenied& problem) {
        EXPECT_TRUE(problem.requests.empty());
        EXPECT_NE(std::string(problem.what()).find("never overwrites files"), std::string::npos);
    }
}

// A picture also names files: none is read without permission, and otherwise the stored text is used.
TEST_F(UntrustedFiles, APictureThatIsDroppedReadsNoFileUnasked) {
    folder.put("own.toml", drop_text);
    const std::string own = (folder.path() / "own.toml").string(), picture = (folder.path() / "p.svg").string();
    ASSERT_EQ(folder.run("figure " + own + " --set y=2 --out p.svg").status, 0);
    FilePolicy trust;
    try {
        session_in(picture, trust);
        FAIL();
    } catch (const PermissionDenied& question) {
        EXPECT_EQ(question.requests, std::vector<std::string>{"read " + own});
    }
    trust.answered["read " + own] = true;
    EXPECT_EQ(session_in(picture, trust).front(), Command(command::Open{own}));
    trust.answered["read " + own] = false;
    EXPECT_EQ(session_in(picture, trust).front(), Command(command::New{}));
    EXPECT_EQ(session_in(picture, trust_of(false, {own})).front(), Command(command::Open{own})) << "named by the user";
    std::filesystem::remove(own);
    EXPECT_EQ(session_in(picture, {}).front(), Command(command::New{})) << "nothing to be asked about";
    ASSERT_EQ(::mkfifo(own.c_str(), 0600), 0);
    EXPECT_EQ(session_in(picture, {}).front(), Command(command::New{})) << "nor does it wait for a pipe";
}

// Escape sequences in a title, source, command, name or error message do not reach the terminal.
TEST_F(UntrustedFiles, EscapeSequencesDoNotReachTheTerminal) {
    EXPECT_EQ(printable("a\x1b[31m\tb\n\x07\r\xC2\x9B"
                        "c\x7F\xE2\x80\xAE\xFF\xC3\xA9"),
              "a?[31m\tb\n???c???\xC3\xA9");
    const auto clean = [](const Answer& answer) {
        for (const char c : answer.out + answer.err)
            if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') return false;
        return (answer.out + answer.err).find("\xC2\x9B") == std::string::npos;
    };
    const std::string evil = "source = \"\\u001b]0;x\\u0007\"\n" + [] {
        std::string text = drop_text;
        return text.replace(text.find("A ball"), 6, "\\u001b[2J\\u009b");
    }();
    std::filesystem::create_directories(folder.path() / "assets/systems");
    folder.put("evil.toml", evil);
    folder.put("assets/systems/evil.toml", evil);
    for (const std::string command : {"simulate evil.toml", "check evil.toml", "check evil.toml --latex"}) {
        const Answer answer = folder.run(command);
        EXPECT_EQ(answer.status, 0) << answer.err;
        EXPECT_TRUE(clean(answer)) << answer.out;
    }
    const Answer list = folder.run("list", "ACHILLES_ASSETS=assets");
    EXPECT_NE(list.out.find("evil"), std::string::npos);
    EXPECT_TRUE(clean(list));
    EXPECT_TRUE(clean(screenshot("open \"./\x1b[2J\"\n")));
    EXPECT_TRUE(clean(screenshot("\x1b[2J\n")));
    ASSERT_EQ(screenshot("").status, 0);
    const std::string png = held_by("a.png"), bare = png.substr(0, 33) + png.substr(png.find("IDAT") - 4);
    for (const std::string command : {"achilles figure './s\x1b[2J.toml'", "achilles figure ./s.toml --do '\x1b[2J'",
                                      "achilles figure ./s.toml '--set=\x1b[2J=1'"}) {
        folder.put("p.png",
                   with_notes(bare, {{"Achilles Command", command}, {"Achilles System", "./s.toml\n" + evil}}));
        EXPECT_TRUE(clean(folder.run("reproduce p.png"))) << command;
    }
    folder.put("p.png", with_notes(bare, {{"Achilles Command", "achilles figure ./s.toml '--view=\x1b[2J'"},
                                          {"Achilles System", "./s.toml\n" + evil}}));
    EXPECT_TRUE(clean(folder.run("reproduce p.png")));
}

// The same for JSON, which preserves every character when read back.
TEST_F(UntrustedFiles, JsonSteersNoTerminalAndKeepsWhatItSays) {
    const std::string title = "a\x1b[2J\x7F\xC2\x9B[31m\xE2\x80\xAE\xE2\x81\xA6\xC3\xA9\n\"\\";
    std::string text = drop_text;
    text.replace(text.find("A ball dropped on the floor"), 27,
                 "a\\u001b[2J\\u007f\\u009b[31m\\u202e\\u2066\xC3\xA9\\n\\\"\\\\");
    text.replace(text.find("start = 1.0"), 11, "start = 1.0\nunit = \"m\\u009b\"");
    folder.put("evil.toml", text);
    const Answer answer = folder.run("simulate evil.toml --json -");
    ASSERT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(printable(answer.out), answer.out);
    EXPECT_NE(answer.out.find("\\u007f\\u009b[31m\\u202e\\u2066\xC3\xA9\\n"), std::string::npos) << answer.out;
    const auto written = nlohmann::json::parse(answer.out);
    EXPECT_EQ(written["system"]["title"], title);
    EXPECT_EQ(written["units"]["y"], "m\xC2\x9B");
    EXPECT_EQ(folder.run("simulate evil.toml --json a.json").status, 0);
    EXPECT_EQ(held_by("a.json"), answer.out) << "the same run gives the same bytes";
    EXPECT_EQ(printable(folder.run("simulate evil.toml --csv - --units").out),
              folder.run("simulate evil.toml --csv - --units").out);
}

}  // namespace
}  // namespace achilles::test
