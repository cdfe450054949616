// A proof of the current run in the explorer and in figures: when it is valid and what is shown.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <thread>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "journal/journal.hpp"
#include "output/precision.hpp"
#include "output/proof.hpp"
#include "pictures/export.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::Folder;
using test::Hands;

Session proved(const std::string& system, const std::string& line = "prove") {
    Session session = test::session(system);
    session.apply(parse_command(line));
    EXPECT_EQ(session.error(), "");
    return session;
}

// It equals that of the command line, bit for bit.
TEST(SessionProof, IsThatOfTheCommandLine) {
    const Session session = proved("ball_on_sine");
    ASSERT_NE(session.proof(), nullptr);
    const Enclosure& proof = session.proof()->enclosure;
    EXPECT_TRUE(proof.end);
    EXPECT_EQ(proof.proved_until, 20.0);
    const Enclosure alone = prove(session.model(), problem_from_decimals(session.run()));
    ASSERT_EQ(proof.events.size(), alone.events.size());
    for (std::size_t i = 0; i < alone.events.size(); ++i) {
        EXPECT_EQ(proof.events[i].t.lo(), alone.events[i].t.lo());
        EXPECT_EQ(proof.events[i].t.hi(), alone.events[i].t.hi());
    }
    EXPECT_GT(proof.samples.size(), 1000U);
    for (std::size_t i = 0; i < session.trajectory().events.size(); ++i) EXPECT_NE(session.enclosed(i), nullptr) << i;
    EXPECT_NE(to_text(session).find("prove: end time until 20\n"), std::string::npos);
}

// Integration options do not matter; any other change invalidates it.
TEST(SessionProof, IsGoneWithTheRunThatItIsOf) {
    for (const char* change : {"set e 0.6", "set x' 1.4", "end 15", "start x 0.1 y 2.1", "max-impacts 500",
                               "open double_pendulum", "text \"\""}) {
        Session session = proved("ball_on_sine");
        session.apply(parse_command(change));
        EXPECT_TRUE(session.proof() == nullptr || !session.document().problems.empty()) << change;
        if (std::string(change) != "text \"\"") {
            EXPECT_EQ(session.enclosed(0), nullptr) << change;
            EXPECT_EQ(to_text(session).find("prove"), std::string::npos) << change;
        }
        session.apply(command::Undo{});
        EXPECT_NE(session.proof(), nullptr) << change << ": it is this run again";
    }
    Session session = proved("ball_on_sine");
    for (const char* same : {"tolerance 1e-9", "eps 1e-7", "conditions paper", "method dopri5", "seek 3", "pin",
                             "theme dark", "grid 1 1", "set g 1"}) {
        session.apply(parse_command(same));
        EXPECT_NE(session.proof(), nullptr) << same;
    }
    session.apply(parse_command("prove off"));
    EXPECT_EQ(session.proof(), nullptr);
    EXPECT_FALSE(session.proof_command());
}

TEST(SessionProof, IsRefusedAsOnTheCommandLine) {
    Session ball = test::session("ball_on_sine");
    for (const auto& [line, told] : {std::pair{"prove e=0.6..0.7", "e = 0.5 in the present run is not in [0.6, 0.7]"},
                                     {"prove e=0.5..1.5", "the part above 1 is impossible"},
                                     {"prove z=0..1", "'z'"},
                                     {"prove e=0.5", "'e=0.5' is not an interval"},
                                     {"prove e=0.6..0.5", "LOW is above HIGH"}}) {
        ball.apply(parse_command(line));
        EXPECT_NE(ball.error().find(told), std::string::npos) << line << ": " << ball.error();
        EXPECT_EQ(ball.proof(), nullptr);
    }
    EXPECT_THROW(parse_command("prove width -1"), InputError);
    EXPECT_THROW(parse_command("prove width"), InputError);
}

// A window does not wait: the proof reports its progress, and a command or another run cancels it.
TEST(SessionProof, IsMadeOnAThreadOfItsOwn) {
    Session session = test::session("arm_at_wall", 0.0);
    session.settle();
    session.apply(command::Prove{});
    ASSERT_NE(session.proof_under_way(), nullptr);
    EXPECT_EQ(session.proof(), nullptr);
    EXPECT_TRUE(session.proof_command());
    double last = -1.0;
    for (int i = 0; i < 2000 && session.proof_under_way() != nullptr; ++i) {
        EXPECT_GE(session.proof_under_way()->time, last);
        last = session.proof_under_way()->time;
        if (last > 0.0) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        session.update();
    }
    EXPECT_GT(last, 0.0);
    // A figure exported meanwhile shows the run without the proof, and its command says so.
    EXPECT_EQ(command_for(session, "figure").find("prove"), std::string::npos);
    EXPECT_NE(command_for(session, "explorer").find("prove"), std::string::npos);
    session.apply(command::StopProof{});
    EXPECT_EQ(session.proof_under_way(), nullptr);
    session.settle();
    EXPECT_EQ(session.proof(), nullptr);

    session.apply(command::Prove{});
    ASSERT_NE(session.proof_under_way(), nullptr);
    session.apply(parse_command("end 0.5"));
    EXPECT_EQ(session.proof_under_way(), nullptr);
    EXPECT_FALSE(session.proof_command());
    session.settle();
    EXPECT_EQ(session.proof(), nullptr);

    // A proof requested while its run is under way starts when that is finished.
    session.apply(parse_command("end 0.6"));
    session.apply(command::Prove{});
    session.settle();
    ASSERT_NE(session.proof(), nullptr) << session.error();
    EXPECT_EQ(session.proof()->claim.run.options.end_time, 0.6);
}

TEST(SessionProof, IsInTheRecipeAndInFigures) {
    Session session = proved("ball_on_sine", "prove width 1e-4 e=0.4999..0.5001");
    EXPECT_EQ(to_text(Command(*session.proof_command())), "prove width 0.0001 e=0.4999..0.5001");
    EXPECT_FALSE(session.proof()->enclosure.end);
    Session again = test::session("ball_on_sine");
    for (const Command& command : recipe(session)) again.apply(command);
    EXPECT_EQ(to_text(again), to_text(session));
    int tubes = 0;
    for (std::size_t i = 0; i < session.plots().size(); ++i) tubes += static_cast<int>(session.drawn(i).tubes.size());
    EXPECT_GT(tubes, 1);
    for (const Panel& panel : session.plots()) EXPECT_TRUE(panel.tubes.empty());
    const std::string figure = to_text(figure_of(session, {}));
    EXPECT_NE(figure.find("key \"proved: start \u00b1 0.0001, e in [0.4999, 0.5001]\""), std::string::npos) << figure;
    EXPECT_NE(figure.find("key \"undecided from "), std::string::npos);
    EXPECT_NE(figure.find("tube"), std::string::npos);
    EXPECT_NE(command_for(session, "figure").find("--do 'prove width 0.0001 e=0.4999..0.5001'"), std::string::npos)
        << command_for(session, "figure");
    session.apply(command::StopProof{});
    EXPECT_EQ(to_text(figure_of(session, {})).find("tube"), std::string::npos);
}

// The word "proved" is used only for proofs.
TEST(ProofPanels, SayProvedOfProofsAlone) {
    for (const char* system : {"ball_on_sine", "kneed_leg"}) {
        Hands hands(system, test::surface(1600, 1000));
        const auto& events = hands.session.trajectory().events;
        for (std::size_t i = 0; i < events.size(); i += i < 12 ? 1 : 7) {
            hands.session.apply(command::Select{static_cast<int>(i) + 1});
            hands.session.apply(command::Show{"lens", events[i].kind == Event::Kind::zeno});
            hands.rest(1);
            const std::string letters = hands.letters();
            EXPECT_EQ(letters.find("roved"), std::string::npos) << system << " event " << i + 1;
        }
    }
}

TEST(ProofPanels, TellWhatIsProved) {
    Hands hands("ball_on_sine", test::surface(1600, 1000));
    hands.click("tab proof");
    EXPECT_TRUE(hands.says("Prove this run"));
    hands.click("prove");
    hands.session.settle();
    hands.rest(2);
    ASSERT_NE(hands.session.proof(), nullptr);
    EXPECT_TRUE(hands.says("proved to t = 20 s"));
    EXPECT_TRUE(hands.says("Zeno 1, proved"));
    EXPECT_TRUE(hands.says("Proved to t = 20 s: the exact motion lies in the tubes"));
    const auto zeno = std::find_if(hands.session.trajectory().events.begin(), hands.session.trajectory().events.end(),
                                   [](const Event& event) { return event.kind == Event::Kind::zeno; });
    const auto at = static_cast<std::size_t>(zeno - hands.session.trajectory().events.begin());
    const EventTime time = event_time(hands.session, at);
    EXPECT_TRUE(time.is_proved);
    EXPECT_TRUE(hands.says(time.text())) << time.text();
    hands.click("tab events");
    EXPECT_TRUE(hands.says("proved \u00b7 "));
    hands.session.apply(command::Select{static_cast<int>(at) + 1});
    hands.rest(2);
    EXPECT_TRUE(hands.says("Zeno 1, time " + time.text() + " s, PROVED"));
    EXPECT_FALSE(hands.state.places.contains("prove run"));
    EXPECT_TRUE(hands.says("Covered by the proof of this run"));
    hands.session.apply(command::Select{0});
    hands.click("tab proof");
    EXPECT_TRUE(hands.says(proved_text(hands.session, at))) << "in the list of the proof, too";
    EXPECT_TRUE(hands.says("Forget proof"));
    hands.click("prove");
    EXPECT_EQ(hands.session.proof(), nullptr);
    EXPECT_FALSE(hands.says("proved to"));
    // A wider box from the menu, for which the proof ends undecided.
    hands.click("spreads");
    hands.click("prove 0.0001");
    hands.session.settle();
    hands.rest(2);
    ASSERT_NE(hands.session.proof(), nullptr);
    EXPECT_FALSE(hands.session.proof()->enclosure.end);
    EXPECT_TRUE(hands.says(", then undecided (start \u00b1 0.0001)"));
    hands.session.apply(parse_command("set e 0.6"));
    hands.rest(2);
    EXPECT_FALSE(hands.says("proved"));
}

// Prints positions for proof_window_test.sh.
TEST(ProofPanels, TellWhereTheyAre) {
    Hands hands("ball_on_sine");
    hands.click("tab proof");
    const auto tell = [&](const char* name, const std::string& place) {
        std::cout << name << " " << std::lround(hands.middle(place).x) << " " << std::lround(hands.middle(place).y)
                  << "\n";
    };
    tell("tab", "tab proof");
    tell("prove", "prove");
    tell("more", "spreads");
    hands.click("spreads");
    tell("wider", "prove 1e-06");
}

// ---- command line ----

TEST(ProofFigure, IsDrawnAndMadeAgain) {
    const Folder folder;
    for (const std::string format : {"svg", "png"}) {
        const std::string picture = "ball." + format;
        const test::Answer drawn =
            folder.run("figure ball_on_floor --proof --width 1e-3 --set e=0.495..0.505 --view height --out " + picture);
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        EXPECT_EQ(drawn.err, "");
        const test::Answer again = folder.run("reproduce " + picture);
        EXPECT_EQ(again.status, 0) << again.err;
        EXPECT_NE(again.out.find("--proof --width 1e-3"), std::string::npos) << again.out;
        EXPECT_NE(again.err.find("the same bytes"), std::string::npos) << again.err;
    }
    const std::string svg = test::content(folder.path() / "ball.svg");
    EXPECT_NE(svg.find("proved: start \u00b1 0.001, e in [0.495, 0.505]"), std::string::npos);
    EXPECT_NE(svg.find("fill-opacity"), std::string::npos);
    EXPECT_EQ(folder.run("figure ball_on_floor --proof --width 0.000123456789 --view height --out narrow.svg").status,
              0);
    EXPECT_NE(test::content(folder.path() / "narrow.svg").find("proved: start \u00b1 0.000123456789"),
              std::string::npos);
    // The same by the explorer's command.
    EXPECT_EQ(
        folder.run("figure ball_on_floor --set e=0.5 --do \"prove width 1e-3 e=0.495..0.505\" --out do.svg").status, 0);
    EXPECT_NE(test::content(folder.path() / "do.svg").find("proved: start \u00b1 0.001, e in"), std::string::npos);
    EXPECT_EQ(folder.run("reproduce do.svg").status, 0);
}

TEST(ProofFigure, SaysWhereItEndsAndWhatItDoesNotCover) {
    const Folder folder;
    const test::Answer undecided = folder.run("figure ball_on_sine --proof --set e=0.49..0.51 --out undecided.svg");
    EXPECT_EQ(undecided.status, 3);
    EXPECT_NE(undecided.err.find("achilles: undecided at t = "), std::string::npos) << undecided.err;
    EXPECT_NE(test::content(folder.path() / "undecided.svg").find("undecided from "), std::string::npos);
    for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
             {"ball_on_sine --do \"prove e=0.5..1.1\"", "the part above 1 is impossible"},
             {"ball_on_sine --width 1e-6", "add --proof"},
             {"ball_on_sine --proof --mechanism", "leave --mechanism out"},
             {"ball_on_sine --proof --set e=0.6..0.5", "LOW is above HIGH"},
             {"ball_on_sine --proof --set e=0.9..1.1", "the part above 1 is impossible"}}) {
        const test::Answer refused = folder.run("figure " + arguments + " --out refused.svg");
        EXPECT_EQ(refused.status, 2) << arguments;
        EXPECT_NE(refused.err.find(told), std::string::npos) << arguments << "\n" << refused.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "refused.svg"));
}

}  // namespace
}  // namespace achilles
