// Pinned runs: names, order, removal, and comparison.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "figure/difference.hpp"
#include "figure/palette.hpp"
#include "journal/journal.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

using test::apply;
using test::Hands;

std::string refused(Session& session, const std::string& line) {
    session.apply(parse_command(line));
    return session.error();
}

std::vector<std::string> names(const Session& session) {
    std::vector<std::string> all{session.name_of_run()};
    for (const PinnedRun& run : session.pinned()) all.push_back(run.name);
    return all;
}

std::vector<int> places(const Session& session) {
    std::vector<int> all;
    for (const PinnedRun& run : session.pinned()) all.push_back(run.place);
    return all;
}

using Names = std::vector<std::string>;

TEST(Runs, AreCalledByWhatDiffers) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\n");
    EXPECT_EQ(names(session), (Names{"", ""}));
    apply(session, "set e 0.3\n");
    EXPECT_EQ(names(session), (Names{"\U0001D452 = 0.3", "\U0001D452 = 0.5"}));
    apply(session, "pin\nstart x 0.1 y 2\neps 1e-4\n");
    EXPECT_EQ(names(session), (Names{"\U0001D452 = 0.3, \U0001D465(0) = 0.1\u00a0m, eps 0.0001",
                                     "\U0001D452 = 0.5, \U0001D465(0) = 0\u00a0m, eps 1e-06",
                                     "\U0001D452 = 0.3, \U0001D465(0) = 0\u00a0m, eps 1e-06"}));
    apply(session, "unpin all\npin\nset e 0.3000000001\npin\nset e 0.3000000002\n");
    EXPECT_EQ(names(session)[1] == names(session)[2], false) << names(session)[1];
}

TEST(Runs, StandAtPlacesThatStay) {
    Session session = test::session("ball_on_floor");
    apply(session, "pin\nset e 0.1\npin\nset e 0.2\npin\nunpin 2\nset e 0.3\n");
    EXPECT_EQ(places(session), (std::vector<int>{1, 3}));
    apply(session, "pin\nset e 0.4\npin 6\n");
    EXPECT_EQ(places(session), (std::vector<int>{1, 3, 2, 6}));
    apply(session, "unpin\n");
    EXPECT_EQ(places(session), (std::vector<int>{1, 3, 2})) << "the last that was pinned";
    EXPECT_EQ(refused(session, "pin 3"), "a run is already pinned at 3\nunpin 3 first, or: pin");
    EXPECT_NE(refused(session, "pin 7").find("there is no place 7"), std::string::npos);
    EXPECT_NE(refused(session, "unpin 6").find("there is no run pinned at 6"), std::string::npos);
    EXPECT_NE(refused(session, "recall 5").find("there is no run pinned at 5"), std::string::npos);
    EXPECT_NE(refused(session, "pinned 5 off").find("there is no run pinned at 5"), std::string::npos);
    EXPECT_EQ(session.pinned().size(), 3U);
    apply(session, "pin\nset e 0.65\npin\nset e 0.75\npin\nset e 0.85\n");
    EXPECT_NE(refused(session, "pin").find("6 runs are pinned"), std::string::npos);
    apply(session, "unpin all\nunpin\n");
    EXPECT_TRUE(session.pinned().empty());
}

TEST(Runs, ArePinnedOnce) {
    Session session = test::session("ball_on_floor");
    apply(session, "pin\nset e 0.1\nreset\n");
    EXPECT_NE(refused(session, "pin").find("this run is already pinned, as 1"), std::string::npos);
}

// Later changes do not affect them.
TEST(Runs, StayAsTheyWere) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\n");
    const Trajectory* const before = session.pinned()[0].trajectory.get();
    apply(session, "set e 0.3\nset g 2\nundo\nundo\nredo\n");
    EXPECT_EQ(session.pinned()[0].trajectory.get(), before) << "undo is for the present run";
    apply(session, "recall 1\n");
    EXPECT_EQ(session.run(), before->run);
    EXPECT_EQ(session.pinned().size(), 1U);
    EXPECT_EQ(names(session), (Names{"", ""})) << "the same";
    apply(session, "undo\n");
    EXPECT_EQ(session.value("e"), 0.3);
}

TEST(Runs, LeaveWithTheirSystemAndComeBack) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\nset e 0.3\npin\nset e 0.4\nopen double_pendulum\n");
    EXPECT_TRUE(session.pinned().empty());
    EXPECT_EQ(session.notice(), "2 pinned runs of ball_on_sine were unpinned; undo restores them");
    apply(session, "undo\n");
    EXPECT_EQ(session.system(), "ball_on_sine");
    EXPECT_EQ(places(session), (std::vector<int>{1, 2}));
    EXPECT_EQ(session.drawn(0).curves.size(), 3 * session.plots()[0].curves.size());
    apply(session, "redo\n");
    EXPECT_TRUE(session.pinned().empty());
    apply(session, "undo\n");
    // Another value in the text is the same system; another energy is not.
    std::string text = session.document().text;
    const std::size_t at = text.find("title");
    text.insert(at, "# a remark\n");
    session.apply(command::SetText{text});
    ASSERT_TRUE(session.document().problems.empty());
    EXPECT_EQ(places(session), (std::vector<int>{1, 2}));
    EXPECT_EQ(session.drawn(0).curves.size(), 3 * session.plots()[0].curves.size());
    const std::size_t energy = text.find("m/2*(x'^2");
    ASSERT_NE(energy, std::string::npos);
    text.insert(energy, "1*");
    session.apply(command::SetText{text});
    ASSERT_TRUE(session.document().problems.empty()) << session.document().problems[0].what();
    EXPECT_TRUE(session.pinned().empty());
    EXPECT_EQ(session.notice(), "2 pinned runs of ball_on_sine were unpinned; undo restores them");
    apply(session, "undo\n");
    EXPECT_EQ(places(session), (std::vector<int>{1, 2}));
}

TEST(Runs, PinnedRunsRespectTheMemoryLimit) {
    Session session = test::session("ball_on_sine");
    const double bytes = bytes_of(session.trajectory());
    session.apply(command::SetOption{"memory", {2.5 * bytes}});
    apply(session, "pin\nset e 0.45\npin\nset e 0.4\n");
    EXPECT_NE(refused(session, "pin").find("the pinned runs would take"), std::string::npos) << session.error();
    EXPECT_EQ(session.pinned().size(), 2U);
}

// Where two runs coincide, both are visible.
TEST(Runs, LieUnderThePresentOneAndThinner) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\nset e 0.3\npin\nreset\n");
    const std::vector<Curve>& curves = session.drawn(0).curves;
    ASSERT_EQ(curves.size(), 6U);
    for (const std::size_t i : {0U, 1U, 2U, 3U})
        EXPECT_LT(curves[i].stroke.width, 0.8 * curves[4 + i % 2].stroke.width) << i;
    for (const int run : {0, 1}) {
        EXPECT_EQ(curves[2 * static_cast<std::size_t>(run)].stroke.color, run_color(session.theme(), run + 1));
        EXPECT_FALSE(curves[2 * static_cast<std::size_t>(run)].stroke.dash.empty()) << "a dash tells the hybrid phase";
        EXPECT_TRUE(curves[2 * static_cast<std::size_t>(run) + 1].stroke.dash.empty());
    }
    for (const std::size_t own : {4U, 5U}) EXPECT_EQ(curves[own].stroke.color, session.theme().ink);
    apply(session, "pinned 1 off\n");
    EXPECT_EQ(session.drawn(0).curves.size(), 4U);
    apply(session, "unpin all\n");
    EXPECT_EQ(session.drawn(0).curves[0].stroke.color, phase_color(session.theme(), Phase::Kind::hybrid));
}

TEST(RunTable, SaysWhatDiffersAndWhatFollows) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\nset e 0.3\npin\nset e 0.6\nset x' 0.2\n");
    const RunTable& table = session.run_table();
    const auto row = [&](const std::string& name) {
        const auto found =
            std::find_if(table.rows.begin(), table.rows.end(), [&](const RunTable::Row& r) { return r.name == name; });
        EXPECT_NE(found, table.rows.end()) << name << "\n" << to_text(table);
        return found == table.rows.end() ? RunTable::Row() : *found;
    };
    ASSERT_GE(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0].name, "\U0001D452");
    EXPECT_EQ(table.rows[0].values, (Names{"0.6", "0.5", "0.3"}));
    EXPECT_EQ(table.rows[0].differs, (std::vector<bool>{false, true, true}));
    EXPECT_TRUE(table.rows[1].is_cause);
    EXPECT_FALSE(table.rows[2].is_cause);
    EXPECT_EQ(row("Zeno 1 (s)").values[1], "2.7251422") << to_text(table);
    EXPECT_TRUE(row("Zeno 1 (s)").differs[1]);
    EXPECT_EQ(row("end (s)").differs, (std::vector<bool>{false, false, false}));
    EXPECT_TRUE(row("Zeno 1 (s)").change.empty()) << "of two runs alone";
    apply(session, "unpin\n");
    const auto number = [](std::string text) {
        constexpr std::string_view minus = "\u2212";
        if (text.starts_with(minus)) text.replace(0, minus.size(), "-");
        return std::stod(text);
    };
    const RunTable::Row zeno = row("Zeno 1 (s)");
    ASSERT_FALSE(zeno.change.empty());
    const double more = number(zeno.values[0]) - number(zeno.values[1]);
    EXPECT_NEAR(number(zeno.change), more, 0.01 * std::abs(more)) << "how much more the present run has";
}

TEST(RunTable, SaysInWordsWhereRunsPart) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\nset e 0.3\n");
    EXPECT_TRUE(session.run_table().divergences.empty()) << to_text(session.run_table());
    apply(session, "end 3\n");
    ASSERT_EQ(session.run_table().divergences.size(), 1U) << to_text(session.run_table());
    EXPECT_EQ(session.run_table().divergences[0].first, 1U);
    EXPECT_EQ(session.run_table().divergences[0].second,
              "after Zeno 1: release at 3.7318 s; the present run: no further event until 3 s");
    EXPECT_NE(to_text(session.run_table()).find("same events until | \u2013 | Zeno 1 *\n"), std::string::npos)
        << to_text(session.run_table());
}

TEST(Difference, IsThatOfTheCompletedRuns) {
    Session session = test::session("ball_on_sine");
    apply(session, "pin\nset e 0.3\ndifference 2 on\n");
    const Panel& panel = session.drawn(1);
    ASSERT_EQ(panel.curves.size(), 1U);
    EXPECT_TRUE(panel.y.logarithmic);
    EXPECT_TRUE(panel.legend);
    EXPECT_EQ(panel.curves[0].label, "\U0001D452 = 0.5");
    EXPECT_EQ(panel.curves[0].stroke.color, run_color(session.theme(), 1));
    const PreparedView& view = *session.plotted().list()[1].prepared;
    const std::size_t quantity = compared_quantities(view, {}).front();
    const PinnedRun& pinned = session.pinned()[0];
    Sampler now(session.trajectory());
    double largest = 0.0;
    int at_the_floor = 0;
    for (const Point& point : panel.curves[0].points) {
        const double a = values_at(session.trajectory(), now.at(point.x), view)[quantity],
                     b = values_at(*pinned.trajectory, pinned.sampler->at(point.x), view)[quantity];
        EXPECT_NEAR(point.y, std::max(std::abs(a - b), panel.y.low), 1e-12);
        largest = std::max(largest, point.y);
        if (point.y == panel.y.low) ++at_the_floor;
    }
    EXPECT_GT(at_the_floor, 10) << "until the first impact the runs are the same";
    EXPECT_GT(largest, 0.1);
    EXPECT_LE(panel.y.low, 1e-12);
    EXPECT_EQ(panel.x.high, session.trajectory().end_time);
    // Up to the end of the shorter run.
    apply(session, "end 5\n");
    for (const Point& point : session.drawn(1).curves[0].points) EXPECT_LE(point.x, 5.0);
    // For a path both coordinates, distinguished by their dash patterns.
    apply(session, "plot 1 x y\ndifference 1 on\n");
    ASSERT_EQ(session.drawn(0).curves.size(), 2U);
    EXPECT_NE(session.drawn(0).curves[0].stroke.dash, session.drawn(0).curves[1].stroke.dash);
    apply(session, "unpin all\n");
    EXPECT_TRUE(session.drawn(0).curves.empty());
    EXPECT_FALSE(session.plots()[0].curves.empty());
}

TEST(RunsPanel, ShowsHidesRecallsAndRemoves) {
    Hands hands("ball_on_sine");
    EXPECT_FALSE(hands.state.places.contains("unpin all"));
    hands.click("pin");
    hands.session.apply(command::Set{"e", 0.3});
    hands.rest(1);
    hands.click("pin");
    hands.session.apply(command::Set{"e", 0.2});
    hands.rest(2);
    EXPECT_TRUE(hands.says("present: e = 0.2")) << hands.letters();
    EXPECT_TRUE(hands.says("\u00d7 use e = 0.3")) << hands.letters();
    hands.click("pinned 2");
    EXPECT_FALSE(hands.session.pinned_at(2)->shown);
    hands.click("pinned 2");
    EXPECT_TRUE(hands.session.pinned_at(2)->shown);
    hands.click("recall 2");
    EXPECT_EQ(hands.session.value("e"), 0.3);
    EXPECT_TRUE(hands.says("Comparison with the pinned runs")) << hands.letters();
    hands.click("runs table");
    EXPECT_FALSE(hands.says("Comparison with the pinned runs"));
    hands.click("runs table");
    EXPECT_TRUE(hands.says("Comparison with the pinned runs"));
    hands.click("unpin 1");
    EXPECT_EQ(places(hands.session), std::vector<int>{2});
    hands.click("unpin all");
    EXPECT_TRUE(hands.session.pinned().empty());
    EXPECT_EQ(hands.session.error(), "");
}

TEST(RunsPanel, TurnsAPlotIntoTheDifference) {
    Hands hands("ball_on_sine");
    hands.session.apply(command::Pin{});
    hands.session.apply(command::Set{"e", 0.3});
    hands.rest(2);
    hands.click("menu of plot 1");
    hands.click("difference");
    EXPECT_TRUE(hands.session.plotted().list()[0].framing.difference);
    EXPECT_TRUE(hands.says("difference: ")) << hands.letters();
    hands.press(key::escape);
    hands.point("plot 0");
    EXPECT_TRUE(hands.says("(e = 0.5)")) << hands.letters();
    hands.click("plot 0", 0.5);
    EXPECT_GT(hands.session.time(), 1.0) << "a click goes to that time";
}

// A run under way is pinned when it is finished.
TEST(Runs, ThatAreUnderWayArePinnedWhenTheyAreThere) {
    Session session("ball_on_sine", test::system("ball_on_sine"), test::library());
    session.set_patience(0.0);
    session.apply(command::Set{"e", 0.3});
    session.apply(command::Pin{});
    session.apply(command::Set{"e", 0.4});
    session.apply(command::Pin{});
    session.set_patience({});
    session.apply(command::Set{"e", 0.6});
    ASSERT_EQ(session.pinned().size(), 2U);
    EXPECT_EQ(session.pinned()[0].trajectory->run.parameters[2], 0.3);
    EXPECT_EQ(session.pinned()[1].trajectory->run.parameters[2], 0.4);
    EXPECT_EQ(session.trajectory().run.parameters[2], 0.6);
}

// However long each takes, they are listed in the order of the requests.
TEST(Runs, StandInTheOrderInWhichTheyWerePinned) {
    Session session = test::session("ball_on_floor");
    for (const char* line : {"set e 1", "end 20000"}) session.apply(parse_command(line));
    session.set_patience(0.0);
    session.apply(command::Set{"g", 8.0});
    session.apply(command::Pin{});
    session.set_patience(1.0);
    session.apply(command::SetStart{{{"e", 0.5}, {"g", 9.0}}});  // this one is finished at once
    ASSERT_EQ(session.under_way(), nullptr);
    session.apply(command::Pin{});
    session.settle();
    ASSERT_EQ(session.pinned().size(), 2U);
    EXPECT_EQ(session.pinned()[0].place, 1);
    EXPECT_EQ(session.pinned()[1].place, 2);
}

// A run to be pinned continues beside the next one, without waiting, and is not mentioned in comparisons meanwhile.
TEST(Runs, UnfinishedRunsArePinnedWithoutWaiting) {
    Hands hands("ball_on_sine");
    Session& session = hands.session;
    session.set_patience(0.02);
    test::ask_for_a_long_run(session);
    ASSERT_NE(session.under_way(), nullptr);
    session.apply(command::Pin{});
    EXPECT_EQ(session.pins_under_way(), std::vector<int>{1});
    for (int i = 0; i < 5; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        session.apply(command::Set{"g", 5.0 + i});
        session.update();
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
    }
    session.apply(command::Pin{});
    session.apply(command::Pin{});
    EXPECT_NE(session.error().find("this run will be pinned, as 2"), std::string::npos) << session.error();
    EXPECT_EQ(session.pins_under_way(), (std::vector<int>{1, 2}));
    EXPECT_TRUE(session.pinned().empty());
    EXPECT_TRUE(session.run_table().rows.empty());
    hands.rest(2);
    EXPECT_TRUE(hands.says("still under way")) << hands.letters();
    // Each can be cancelled, by its place or as the last; changing the system cancels all.
    hands.click("unpin 1");
    EXPECT_EQ(session.pins_under_way(), std::vector<int>{2});
    session.apply(parse_command("unpin"));
    EXPECT_TRUE(session.pins_under_way().empty());
    session.apply(command::Pin{});
    const auto begin = std::chrono::steady_clock::now();
    session.apply(command::Open{"double_pendulum"});
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
    EXPECT_TRUE(session.pins_under_way().empty());
    EXPECT_EQ(session.error(), "");
}

TEST(Runs, ThatAreUnderWayArriveWithUpdate) {
    Session session = test::session("ball_on_floor");
    for (const char* line : {"set e 1", "end 20000"}) session.apply(parse_command(line));
    session.set_patience(0.0);
    session.apply(command::Set{"g", 8.0});
    session.apply(command::Pin{});
    session.apply(command::Set{"g", 9.0});
    EXPECT_TRUE(session.pinned().empty());
    for (int i = 0; i < 20000 && (session.under_way() != nullptr || session.pinned().empty()); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        session.update();
    }
    ASSERT_EQ(session.pinned().size(), 1U);
    EXPECT_EQ(session.pinned()[0].trajectory->outcome.kind, Outcome::Kind::end_time);
    EXPECT_EQ(session.pinned()[0].trajectory->run.parameters[2], 8.0);
    EXPECT_EQ(session.trajectory().run.parameters[2], 9.0);
}

TEST(Runs, AreInAPictureThatIsMadeAgain) {
    const test::Folder folder;
    const test::Answer made = folder.run(
        "screenshot ball_on_sine --do pin --do 'set e 0.3' --do pin --do 'unpin 1' --do 'set e 0.7' --do pin --do "
        "'pinned 2 "
        "off' --do 'difference 2 on' --do 'set e 0.6' --size 900x600 --out runs.png");
    ASSERT_EQ(made.status, 0) << made.err;
    const test::Answer again = folder.run("reproduce runs.png");
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_NE(again.err.find("the same bytes"), std::string::npos) << again.err;
}

}  // namespace
}  // namespace achilles
