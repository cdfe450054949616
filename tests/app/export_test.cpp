// Exports of a session reproduce it: figures, data, journals, command lines.
#include "pictures/export.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/open.hpp"
#include "app/program.hpp"
#include "journal/journal.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "pictures/origin.hpp"
#include "session/replay_script.hpp"
#include "session/worker.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

using test::apply;

// Sessions that differ from their files in various ways.
const std::string changes[] = {
    "",
    "set e 0.3\nset x' 0.7333333333333333\nend 17\n",
    "start x 0.1 y 2.5 g 1.5 m 3\ntolerance 1e-9\nmethod dopri5\nmax-impacts 5000\nmax-steps 70000\n",
    "eps 1e-5\nconditions paper\nreinitialization euclidean\n",
    "eps 1e-5 1e-4 1e-3\n",
    "grid 3 1\nplot 2 x \"x'^2 + y'^2\" \"y - sin(x)\"\nzoom 1 0.5 4 -2 3\nlog 2 y on\ncurve 2 1 off\n",
    "grid 1 2\nlink off\nzoom 1 0 5 -1 2\nzoom 2 1 3 -1 2\nrange 1 y -4 4\n",
    "zoom 1 0 5 -1 2\nlink off\nzoom 2 1 3 -1 2\nfit 1\nlink on\n",
    "zoom 1 0 5 -1 2\nplot 1 t y\nplot 2 t gap\n",
    "set e 0.7\npin\nset e 0.2\nconditions paper\nselect 3\nseek 1\n",
    "pin\nset e 0.7\npin\nset x 1\neps 1e-5\npin\nunpin 2\npinned 3 off\nset e 0.2\npin 5\ndifference 2 on\nhide "
    "runs\n",
    "pin\nset e 0.7\npin\nunpin 1\nset e 0.2\npin\nreset\ndifference 1 on\nrange 1 y 1e-9 1\n",
    "look 1 2 3\nhide trail\nshow lens\nhide force\nspeed 0.1\nloop on\nselect 10\nlens 2.5\nsay \"a # \\\"b\\\"\"\n",
    "text \"title = \\\"no system\\\"\"\nset g 2\n",
};

TEST(Recipe, LeadsToTheSameSession) {
    for (const std::string& journal : changes) {
        Session session = test::session("ball_on_sine"), again = test::session("double_pendulum");
        apply(session, journal);
        const std::vector<Command> steps = recipe(session);
        for (const Command& step : steps) again.apply(step);
        EXPECT_EQ(to_text(again), to_text(session)) << journal << "\nby\n" << journal_text(steps);
        EXPECT_EQ(again.run(), session.run()) << journal;
        ASSERT_EQ(again.pinned().size(), session.pinned().size()) << journal;
        for (std::size_t i = 0; i < again.pinned().size(); ++i)
            EXPECT_EQ(to_text(*again.pinned()[i].trajectory), to_text(*session.pinned()[i].trajectory)) << journal;
        EXPECT_EQ(parse_journal(journal_text(steps)), steps);
    }
}

TEST(Recipe, OfAnUntouchedSessionIsOneLine) {
    EXPECT_EQ(journal_text(recipe(test::session("ball_on_sine"))), "open ball_on_sine\n");
}

TEST(Recipe, KeepsAPinnedRunOfTheTextBeforeItWasEdited) {
    Session session = test::session("double_pendulum"), again = test::session("ball_on_sine");
    apply(session, "new\nend 5\npin\n");
    std::string text = session.document().text;
    text.replace(text.find("9.81"), 4, "1.62");
    session.apply(command::SetText{text});
    ASSERT_TRUE(session.document().problems.empty());
    for (const Command& step : recipe(session)) again.apply(step);
    EXPECT_EQ(to_text(again), to_text(session));
    ASSERT_EQ(again.pinned().size(), 1U);
    EXPECT_EQ(to_text(*again.pinned()[0].trajectory), to_text(*session.pinned()[0].trajectory));
    EXPECT_EQ(again.value("g"), 1.62);
}

// A copied command line produces the same bytes as the export.
TEST(CopyCommand, MakesTheSameRunAndFigure) {
    for (const std::string& journal : changes) {
        if (journal.find("text") != std::string::npos) continue;
        const test::Folder folder;
        Session session = test::session("ball_on_sine");
        apply(session, journal);
        for (const std::string ending : {"json", "svg"}) {
            const std::string here = (folder.path() / ("here." + ending)).string();
            session.apply(command::Export{here, false});
            ASSERT_EQ(session.error(), "");
            session.apply(command::Copy{ending == "json" ? "run" : "figure"});
            ASSERT_EQ(session.error(), "");
            ASSERT_EQ(session.copied().rfind("achilles ", 0), 0U);
            const test::Answer answer = folder.run(session.copied().substr(9));
            ASSERT_EQ(answer.status, 0) << session.copied() << "\n" << answer.err;
            const std::string there = test::content(folder.path() / ("ball_on_sine." + ending));
            EXPECT_EQ(there, test::content(here)) << session.copied();
        }
    }
}

// Compared through screenshots with the arguments of the explorer's command line.
TEST(CopyCommand, OpensTheSameExplorer) {
    for (const std::string& journal : {changes[1], changes[9], changes[10]}) {
        const test::Folder folder;
        Session session = test::session("ball_on_sine");
        apply(session, journal);
        session.apply(command::Copy{"explorer"});
        const std::string line = session.copied();
        ASSERT_EQ(line.rfind("achilles explore ball_on_sine", 0), 0U) << line;
        const std::string size = " --size 700x500 --out ";
        EXPECT_EQ(folder.run("screenshot" + line.substr(16) + size + "line.png").status, 0);
        folder.put("j.journal", journal_text(recipe(session)));
        EXPECT_EQ(folder.run("screenshot --journal j.journal" + size + "journal.png").status, 0);
        const auto pixels = [&](const char* name) {
            const std::string bytes = test::content(folder.path() / name);
            return bytes.substr(bytes.find("IDAT"));
        };
        EXPECT_TRUE(pixels("line.png") == pixels("journal.png")) << line;
    }
}

TEST(CopyCommand, QuotesForAShellAndNamesFilesAnywhere) {
    const test::Folder folder;
    folder.put("it's mine.toml", test::content(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_floor.toml"));
    const std::string path = (folder.path() / "it's mine.toml").string();
    SystemSource library = test::library();
    library.find = [](const std::string& name) { return name; };
    Session session(path, read_system(path), library);
    session.apply(command::Copy{"run"});
    const test::Folder elsewhere;
    EXPECT_EQ(elsewhere.run(session.copied().substr(9)).status, 0) << session.copied();
    EXPECT_TRUE(fs::exists(elsewhere.path() / "it's mine.json"));
    session.apply(command::SetText{session.document().text + "# more"});
    const int copies = session.copies();
    session.apply(command::Copy{"run"});
    EXPECT_NE(session.error().find("save it first"), std::string::npos) << session.error();
    EXPECT_EQ(session.copies(), copies);
    session.apply(command::New{});
    session.apply(command::Copy{"run"});
    EXPECT_NE(session.error().find("save it first"), std::string::npos) << session.error();
}

TEST(Export, WritesWholeFilesOrSaysWhyNot) {
    const test::Folder folder;
    Session session = test::session("ball_on_sine");
    const auto in_folder = [&](const char* name) { return (folder.path() / name).string(); };
    for (const char* name : {"a.svg", "a.png", "a.json", "a.csv", "a.journal"}) {
        session.apply(command::Export{in_folder(name), false});
        EXPECT_EQ(session.error(), "");
        EXPECT_EQ(session.notice(), "wrote " + in_folder(name));
        session.apply(command::Export{in_folder(name), false});
        EXPECT_NE(session.error().find("the file already exists"), std::string::npos);
        session.apply(command::Export{in_folder(name), true});
        EXPECT_EQ(session.error(), "");
    }
    EXPECT_EQ(picture_format(test::content(in_folder("a.png"))), "png");
    EXPECT_EQ(nlohmann::json::parse(test::content(in_folder("a.json")))["outcome"]["kind"], "end time");
    EXPECT_EQ(test::content(in_folder("a.csv")).rfind("t,phase,", 0), 0U);
    EXPECT_EQ(test::content(in_folder("a.journal")), "open ball_on_sine\n");
    for (const auto& [name, says] : {std::pair{"a.bmp", "does not say what to export"},
                                     {"no/folder/a.svg", "there is no folder"},
                                     {"", "missing"},
                                     {"-", "missing"}}) {
        session.apply(command::Export{*name == '\0' || *name == '-' ? name : in_folder(name), false});
        EXPECT_NE(session.error().find(says), std::string::npos) << session.error();
    }
    EXPECT_EQ(folder.files().size(), 5U);
}

// A single plot stores its origin and is reproduced; the other plots are not affected.
TEST(Export, TakesOnePlotAlone) {
    for (const std::string& journal : changes) {
        if (journal.find("text") != std::string::npos) continue;
        const test::Folder folder;
        Session session = test::session("ball_on_sine");
        apply(session, journal);
        const std::string before = to_text(session);
        const auto count = static_cast<int>(session.plotted().list().size());
        session.apply(command::Export{(folder.path() / "one.svg").string(), false, count});
        ASSERT_EQ(session.error(), "") << journal;
        EXPECT_EQ(to_text(session), before);
        const test::Answer answer = folder.run("reproduce one.svg --out again.svg");
        EXPECT_EQ(answer.status, 0) << journal << answer.err;
        EXPECT_EQ(test::content(folder.path() / "one.svg"), test::content(folder.path() / "again.svg")) << answer.out;
        EXPECT_NE(answer.out.find("--columns 1"), std::string::npos) << answer.out;
        session.apply(command::Export{(folder.path() / "two.svg").string(), false, count + 1});
        EXPECT_NE(session.error().find(fmt::format("there is no plot {}", count + 1)), std::string::npos);
        session.apply(command::Export{(folder.path() / "run.json").string(), false, 1});
        EXPECT_NE(session.error().find("end it in .svg, .png or .pdf"), std::string::npos) << session.error();
        EXPECT_EQ(folder.files().size(), 2U);
    }
}

// A run that is cancelled or not finished is not exported.
TEST(Export, WaitsForARunThatIsUnderWay) {
    const test::Folder folder;
    Session session = test::session("ball_on_sine", 0.0);
    session.apply(command::SetStart{{{"e", 1.0}}});
    session.apply(command::MaxImpacts{1000000000});
    session.apply(command::SetEndTime{1e9});
    ASSERT_NE(session.under_way(), nullptr);
    for (const char* name : {"a.svg", "a.json", "a.csv", "a.journal"}) {
        session.apply(command::Export{(folder.path() / name).string(), false});
        EXPECT_NE(session.error().find("under way"), std::string::npos) << session.error();
    }
    session.apply(command::Open{"double_pendulum"});
    session.apply(command::Export{(folder.path() / "a.json").string(), false});
    EXPECT_TRUE(folder.files().empty() || session.error().empty());
    for (const std::string& name : folder.files())
        EXPECT_EQ(test::content(folder.path() / name).find("cancelled"), std::string::npos) << name;
}

// A picture may be untrusted: exports of its commands are not repeated.
TEST(Export, IsNotDoneByAPictureThatIsReproduced) {
    const test::Folder folder;
    ASSERT_EQ(folder.run("figure ball_on_sine --do 'export run.json' --do 'grid 1 1' --out f.svg").status, 0);
    EXPECT_TRUE(fs::remove(folder.path() / "run.json"));
    EXPECT_EQ(folder.run("reproduce f.svg").status, 0);
    EXPECT_FALSE(fs::exists(folder.path() / "run.json"));
}

// No two strokes of the legend are the same, on paper and on a dark screen: a phase is not taken for a run.
TEST(Export, TheLegendOfPinnedRunsHasDifferentSigns) {
    for (const bool dark : {false, true}) {
        Session session = test::session("ball_on_sine");
        session.apply(parse_command("pin"));
        session.apply(parse_command("set e 0.7"));
        PublicationStyle style;
        style.dark = dark;
        std::vector<Stroke> strokes;
        for (const Key& key : figure_of(session, style).keys)
            if (const auto* const stroke = std::get_if<Stroke>(&key.sign)) strokes.push_back(*stroke);
        ASSERT_GE(strokes.size(), 4U);
        const auto is_color = [](const Color& a, const Color& b) { return a.r == b.r && a.g == b.g && a.b == b.b; };
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(is_color(strokes[i].color, strokes[k].color) && strokes[i].dash == strokes[k].dash)
                    << i << " and " << k;
        const Stroke &own = strokes[strokes.size() - 2], &pinned = strokes.back();
        EXPECT_TRUE(is_color(own.color, (dark ? dark_theme() : light_theme()).ink));
        EXPECT_LT(pinned.width, own.width);
    }
}

// With a pinned run the legend names both runs.
TEST(Figure, NamesBothRunsByWhatDiffers) {
    const auto last_keys = [](const std::string& journal) {
        Session session = test::session("double_pendulum");
        apply(session, journal);
        std::vector<std::string> labels;
        for (const Key& key : figure_of(session, {}).keys) labels.push_back(key.label);
        return std::vector<std::string>(labels.end() - 2, labels.end());
    };
    using Labels = std::vector<std::string>;
    EXPECT_EQ(last_keys("pin\nset e 0.3\n"), (Labels{"𝑒 = 0.3", "𝑒 = 0.5"}));
    EXPECT_EQ(last_keys("pin\nset theta1 -20 deg\nset m1 2\n"),
              (Labels{"𝑚₁ = 2\u00a0kg, 𝜃₁(0) = \u221220°", "𝑚₁ = 1\u00a0kg, 𝜃₁(0) = 30°"}));
    EXPECT_EQ(last_keys("pin\neps 0.1\n"), (Labels{"eps 0.1", "eps 1e-06"}));
    EXPECT_EQ(last_keys("pin\n")[1], "pinned run");
}

// The surface is drawn over the range of both runs.
TEST(Figure, DrawsTheSurfaceUnderBothRuns) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\nset e 0.3\nset x' 1.2\n");
    const Figure figure = figure_of(session, {});
    const Panel& path = figure.panels[3];
    double right = 0.0;
    for (const Point& point : path.boundary.points)
        if (std::isfinite(point.x)) right = std::max(right, point.x);
    ASSERT_TRUE(path.equal_axes);
    EXPECT_GT(right, path.x.high - 0.02 * (path.x.high - path.x.low));
}

TEST(Figure, RefusesStepsThatAreRefused) {
    const test::Folder folder;
    for (const char* steps : {"--do 'set nothing 1'", "--do 'sett e 1'", "--do 'plot 1 t yy'",
                              "--do 'grid 1 1' --view height", "--do 'text \"no\"'", "--journal none.journal"}) {
        const test::Answer answer = folder.run(std::string("figure ball_on_sine --out a.svg ") + steps);
        EXPECT_EQ(answer.status, 2) << steps << answer.err;
        EXPECT_NE(answer.err, "");
    }
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace achilles
