// Links: a session in the address of the explorer in a browser.
#include "journal/link.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "app/hands.hpp"
#include "app/open.hpp"
#include "app/program.hpp"
#include "journal/journal.hpp"

namespace achilles::test {
namespace {

// A new session after the journal in the link, read as a stranger's.
Session opened(const std::string& link) {
    Session opened = session("ball_on_sine");
    const auto trust = trust_of(false, {});
    for (const Command& command : parse_trusted(journal_in_link(link), "the link", trust)) {
        EXPECT_TRUE(opened.apply(command)) << to_text(command) << ": " << opened.error();
    }
    opened.settle();
    return opened;
}

TEST(Link, LeadsToTheSameSession) {
    Session made = session("double_pendulum");
    for (const char* line : {"set e 0.31", "pin", "set theta1 20 deg", "grid 2 1", "plot 2 t energy", "seek 1.25",
                             "show sweep", "theme dark"})
        ASSERT_TRUE(made.apply(parse_command(line))) << line << ": " << made.error();
    made.settle();
    const std::string link = link_of(made);
    EXPECT_EQ(link.rfind("http://127.0.0.1:8000/#run=", 0), 0u);
    EXPECT_LT(link.size(), 1000u);
    EXPECT_EQ(link.substr(link.find('=') + 1)
                  .find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
              std::string::npos);
    EXPECT_EQ(to_text(opened(link)), to_text(made));
    std::printf("link %s\n", link.c_str());  // tests/web/run opens it in a browser
}

TEST(Link, HasTheTextOfAFileOfTheUser) {
    const Folder folder;
    const std::string file = (folder.path() / "mine.toml").string();
    folder.put("mine.toml", read_text(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_floor.toml"));
    Session made = session("ball_on_sine");
    ASSERT_TRUE(made.apply(command::Open{file})) << made.error();
    ASSERT_TRUE(made.apply(command::Set{"e", 0.25}));
    made.settle();
    const std::string link = link_of(made);
    EXPECT_EQ(journal_in_link(link).find(folder.path().string()), std::string::npos);
    const Session there = opened(link);
    EXPECT_EQ(there.description().source_text, made.description().source_text);
    EXPECT_EQ(to_text(there.trajectory()), to_text(made.trajectory()));
}

TEST(Link, IsCopiedByItsCommand) {
    Session made = session("ball_on_sine");
    ASSERT_EQ(setenv("ACHILLES_WEB", "https://example.org/runs/", 1), 0);
    EXPECT_TRUE(made.apply(parse_command("copy link"))) << made.error();
    unsetenv("ACHILLES_WEB");
    EXPECT_EQ(made.copied().rfind("https://example.org/runs/#run=", 0), 0u);
    EXPECT_EQ(made.copies(), 1);
}

std::string message_of(const std::string& link) {
    try {
        return "accepted: " + journal_in_link(link);
    } catch (const InputError& problem) {
        return problem.message;
    }
}

TEST(Link, RefusesDamageAndFloods) {
    const std::string link = link_of(session("ball_on_sine"));
    EXPECT_EQ(message_of("http://127.0.0.1:8000/"), "there is no run in this link");
    for (const std::string& text : {link.substr(0, link.size() - 5), link + "*", link.substr(0, link.find('=') + 2),
                                    link.substr(0, link.find('=') + 1)})
        EXPECT_EQ(message_of(text), "the run in this link is damaged") << text;
    Session made = session("ball_on_sine");
    made.apply(command::New{});
    made.apply(command::SetText{std::string(largest_file + 1, ' ')});
    EXPECT_EQ(message_of(link_of(made)), "the run in this link is too large for a journal");
}

// Changed, missing and doubled letters. The checksum finds nearly all; the others must at least be ordinary journals.
TEST(Link, DamageIsNeverMoreThanAMessage) {
    const std::string link = link_of(session("double_pendulum"));
    const std::size_t start = link.find('=') + 1;
    std::mt19937 engine(1);
    int damaged = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string text = link;
        for (std::size_t changes = 1 + engine() % 3; changes > 0; --changes) {
            const std::size_t at = start + engine() % (text.size() - start);
            switch (engine() % 4) {
                case 0:
                    text[at] = static_cast<char>(engine() % 256);
                    break;
                case 1:
                    text[at] = "AZaz09-_"[engine() % 8];
                    break;
                case 2:
                    text.erase(at, 1 + engine() % 4);
                    break;
                default:
                    text.insert(at, text.substr(at, 1 + engine() % 8));
            }
            if (text.size() <= start) break;
        }
        try {
            parse_trusted(journal_in_link(text), "the link", trust_of(false, {}));
        } catch (const InputError&) {
            ++damaged;
        }
    }
    EXPECT_GT(damaged, 1800);
}

// What a stranger's journal may not do, a link may not do.
TEST(Link, HasTheRightsOfAJournal) {
    const auto refusal = [](const std::string& journal) -> std::string {
        try {
            parse_trusted(journal, "the link", trust_of(false, {}));
        } catch (const PermissionDenied& problem) {
            return problem.what();
        }
        return "allowed";
    };
    EXPECT_NE(refusal("save \"stranger.toml\"\n").find("would write stranger.toml"), std::string::npos);
    EXPECT_NE(refusal("max-steps 100000000\n").find("--allow-files"), std::string::npos);
    // A link reads no file, so a journal may replay it.
    EXPECT_EQ(refusal("replay \"" + link_of(session("ball_on_sine")) + "\"\n"), "allowed");
}

// `achilles screenshot LINK` is the picture of the session, and a damaged link ends with a message before a window opens.
TEST(Link, IsASystemOnTheCommandLine) {
    const Folder folder;
    Session made = session("ball_on_floor");
    ASSERT_TRUE(made.apply(parse_command("set e 0.25")));
    ASSERT_TRUE(made.apply(parse_command("theme dark")));
    made.settle();
    const std::string link = link_of(made);
    Answer answer = folder.run("screenshot '" + link + "' --size 800x500 --out link.png --record link.journal");
    EXPECT_EQ(answer.status, 0) << answer.err;
    answer = folder.run("screenshot ball_on_floor --do 'set e 0.25' --do 'theme dark' --size 800x500 --out typed.png");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(folder.run("compare link.png typed.png --threshold 0").status, 0);
    EXPECT_NE(content(folder.path() / "link.journal").find("set e 0.25"), std::string::npos);
    // The picture carries the link, and can be made again.
    answer = folder.run("reproduce link.png --out again.png");
    EXPECT_EQ(answer.status, 0) << answer.err;
    EXPECT_EQ(content(folder.path() / "again.png"), content(folder.path() / "link.png"));

    for (const std::string before : {"", "explore "}) {
        answer = folder.run(before + "'" + link.substr(0, link.size() - 3) + "'");
        EXPECT_EQ(answer.status, 2);
        EXPECT_EQ(answer.err, "the link: the run in this link is damaged\ncopy the whole link\n") << before;
    }
    answer = folder.run("screenshot '" + link + "' --journal the_ball --out no.png");
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("leave out the link or --journal"), std::string::npos) << answer.err;
}

// ---- panels of a page ----

struct PageHands : Hands {
    PageHands() : Hands("ball_on_sine") {
        state.on_page = true;
        state.choose_file = [this] { ++choices; };
        rest(2);
    }
    int choices = 0;
};

TEST(BrowserPage, OffersWhatABrowserCanDo) {
    PageHands hands;
    hands.click("bar File");
    for (const char* entry : {"New", "Open\u2026", "Save", "Export figure\u2026", "Export data\u2026", "Copy link"})
        EXPECT_TRUE(hands.state.places.contains("menu " + std::string(entry))) << entry;
    for (const char* entry : {"Quit", "Export film\u2026", "Open recent"})
        EXPECT_FALSE(hands.state.places.contains("menu " + std::string(entry))) << entry;
    hands.click("menu Copy link");
    EXPECT_TRUE(is_link(hands.session.copied()));
    hands.press_with_control('Q');
    EXPECT_FALSE(hands.state.editor.may_close);
    EXPECT_EQ(hands.choices, 0);
    hands.press_with_control('O');
    EXPECT_EQ(hands.choices, 1);
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::nothing);
}

TEST(BrowserPage, FindsNoFilmInThePalette) {
    for (const bool on_page : {false, true}) {
        Hands hands("ball_on_sine");
        hands.state.on_page = on_page;
        hands.session.apply(parse_command("show palette"));
        hands.rest(3);
        hands.state.palette.text = "export film";
        hands.rest(3);
        EXPECT_EQ(hands.says("Export film"), !on_page);
    }
}

// The form has no film and no PDF, and no folders; the file goes to the browser when it is written.
TEST(BrowserPage, DownloadsWhatItWrites) {
    const Folder folder;
    std::vector<std::string> downloads;
    SystemSource source = library();
    source.after_writing = [&](const std::string& file) {
        EXPECT_GT(content(file).size(), 100u) << file;
        downloads.push_back(file);
    };
    Session made("ball_on_sine", system("ball_on_sine"), source);
    made.settle();
    const std::string figure = (folder.path() / "a.svg").string(), text = (folder.path() / "a.toml").string();
    EXPECT_TRUE(made.apply(command::Export{figure})) << made.error();
    EXPECT_TRUE(made.apply(command::Save{text, false})) << made.error();
    EXPECT_FALSE(made.apply(command::Save{figure, false}));  // it exists: nothing is written
    EXPECT_EQ(downloads, (std::vector{figure, text}));

    PageHands hands;
    hands.session.apply(parse_command("show export"));
    hands.rest(4);
    EXPECT_TRUE(hands.state.places.contains("take svg"));
    EXPECT_FALSE(hands.state.places.contains("take pdf"));
    EXPECT_TRUE(hands.says("downloads ball_on_sine"));
    hands.click("take what");
    EXPECT_TRUE(hands.state.places.contains("take the mechanism as it is now"));
    EXPECT_FALSE(hands.state.places.contains("take a film: the mechanism in motion beside the plots"));
}

}  // namespace
}  // namespace achilles::test
