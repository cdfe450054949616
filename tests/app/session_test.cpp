#include <gtest/gtest.h>

#include "app/open.hpp"
#include "app/program.hpp"
#include "figure/mechanism_scene.hpp"
#include "output/output.hpp"
#include "session/event_rows.hpp"
#include "session/replay_script.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

TEST(Session, BeginsWithTheRunOfTheFile) {
    const Session session = test::session("ball_on_sine");
    EXPECT_EQ(session.time(), 0.0);
    EXPECT_FALSE(session.playing());
    EXPECT_EQ(session.plots().size(), 4U);
    EXPECT_EQ(to_text(session.trajectory()), to_text(simulate(session.model(), session.model()->default_run())));
}

TEST(Session, SettingAValueRunsTheSameModelAgain) {
    Session session = test::session("ball_on_sine");
    const auto model = session.model();
    const std::uint32_t nodes = model->equations().gaps[0].graph().size();
    const std::string before = to_text(session.trajectory());
    for (const double g : {1.1, 1.2, 1.3, 9.81}) session.apply(command::Set{"g", g});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.run().parameters[1], 9.81);
    EXPECT_EQ(session.model(), model);
    EXPECT_EQ(model->equations().gaps[0].graph().size(), nodes) << "something was derived again";
    EXPECT_NE(to_text(session.trajectory()), before);
    session.apply(command::Set{"g", 1.0});
    EXPECT_EQ(to_text(session.trajectory()), before);
    session.apply(command::Set{"x'", 0.5});
    EXPECT_EQ(session.run().v[0], 0.5);
    session.apply(command::Set{"y", 3.0});
    EXPECT_EQ(session.run().q[1], 3.0);
}

TEST(Session, WhatCannotBeDoneLeavesTheLastGoodState) {
    Session session = test::session("ball_on_sine");
    session.apply(command::Set{"g", 2.0});
    session.apply(command::Seek{3.0});
    const std::string before = to_text(session);
    const std::pair<Command, std::string> mistakes[] = {
        {command::Set{"yy", 1.0}, "did you mean 'y'"},
        {command::Set{"y", -5.0}, "gap"},
        {command::Set{"e", 1.5}, "restitution"},
        {command::SetEndTime{-1.0}, "end time"},
        {command::Tolerance{0.0}, "tolerance"},
        {command::MaxImpacts{0}, "at least one impact must be allowed"},
        {command::SetOption{"max-steps", {0}}, "at least one step must be allowed"},
        {command::Eps{1e-6, -1.0, 1e-6}, "eps"},
        {command::Select{4000}, "event"},
        {command::Open{"nowhere"}, "nowhere"}};
    for (const auto& [command, says] : mistakes) {
        session.apply(command);
        EXPECT_NE(session.error().find(says), std::string::npos) << to_text(command) << ": " << session.error();
        std::string after = to_text(session);
        after.erase(after.find("error "), ("error " + session.error() + "\n").size());
        EXPECT_EQ(after, before) << to_text(command);
    }
    session.apply(command::Set{"g", 2.0});
    EXPECT_EQ(to_text(session), before);
}

TEST(Session, AValueSaysItsUnitWhereThatFits) {
    Session session = test::session("double_pendulum");
    session.apply(parse_command("set theta1 -20 deg"));
    EXPECT_EQ(session.error(), "");
    EXPECT_NEAR(session.run().q[0], -0.3490658503988659, 1e-15);
    session.apply(parse_command("start theta1' 90deg theta1 pi/9"));
    EXPECT_NEAR(session.run().v[0], 1.5707963267948966, 1e-15);
    EXPECT_NEAR(session.run().q[0], 0.3490658503988659, 1e-15);
    session.apply(parse_command("set L1 30 deg"));
    EXPECT_NE(session.error().find("where the unit is rad, and here it is m"), std::string::npos) << session.error();
    EXPECT_EQ(session.run().parameters, session.file_run().parameters);
}

TEST(Session, AValueOutsideItsRangeIsToldAndUsed) {
    Session session = test::session("double_pendulum");
    session.apply(parse_command("set theta1 30"));
    EXPECT_EQ(session.run().q[0], 30.0);
    EXPECT_EQ(session.notice(),
              "theta1 = 30 rad is outside its range, -1.5708 to 1.5708: for an angle in degrees write 30 deg");
    session.apply(parse_command("set m1 2"));
    EXPECT_EQ(session.notice(), "") << "it was told once";
    // The same applies to a file with such a value.
    const test::Folder folder;
    std::string text = read_text(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml");
    const std::string_view range = "range = [-10.0, 10.0]";
    text.replace(text.find(range), range.size(), "range = [1, 2]");
    folder.put("outside.toml", text);
    session.apply(command::Open{(folder.path() / "outside.toml").string()});
    EXPECT_EQ(session.notice(), "x = 0 m is outside its range, 1 to 2");
}

// Also for several values at once.
TEST(Session, StartsOutsideTheirRangesAreTold) {
    Session session = test::session("double_pendulum");
    session.apply(parse_command("start theta1 30 theta1' 0.5 theta2 0.2"));
    EXPECT_EQ(session.warnings(),
              (std::vector<std::string>{
                  "theta1 = 30 rad is outside its range, -1.5708 to 1.5708: for an angle in degrees write 30 deg"}));
    EXPECT_EQ(session.notice(), "") << "no card comes and goes under a hand that drags";
    session.apply(parse_command("start theta2 0.3"));
    EXPECT_TRUE(session.warnings().empty());
}

// It opens if there is a Zeno point, and otherwise gives an error. The recorded commands do the same.
TEST(Session, TheLensOpensAtAZenoPoint) {
    Session session = test::session("ball_on_sine");
    session.apply(command::ShowLens{2.0});
    EXPECT_EQ(session.error(), "the lens needs a Zeno point, but none is selected\nselect it first: select 10");
    EXPECT_FALSE(session.scene().shows("lens"));
    session.apply(command::Select{10});
    session.apply(command::ShowLens{2.0});
    EXPECT_EQ(session.error(), "");
    EXPECT_TRUE(session.scene().shows("lens"));
    Session again = test::session("ball_on_sine");
    for (const Command& command : recipe(session)) {
        again.apply(command);
        EXPECT_EQ(again.error(), "") << to_text(command);
    }
    EXPECT_EQ(to_text(again.scene()), to_text(session.scene()));
}

TEST(Session, OptionsChangeTheRun) {
    Session session = test::session("double_pendulum");
    session.apply(command::SetEndTime{5.0});
    EXPECT_EQ(session.trajectory().end_time, 5.0);
    session.apply(command::Tolerance{1e-8});
    session.apply(command::Eps{1e-3, 1e-4, 1e-5});
    session.apply(command::SetReinitialization{Reinitialization::euclidean});
    const Options& options = session.run().options;
    EXPECT_EQ(options.tolerance, 1e-8);
    EXPECT_EQ(options.truncation.eps_v, 1e-4);
    EXPECT_EQ(options.truncation.reinitialization, Reinitialization::euclidean);
    EXPECT_EQ(session.error(), "");
}

TEST(Session, PlaysAndFindsEvents) {
    Session session = test::session("ball_on_sine");
    const auto& events = session.trajectory().events;
    session.apply(command::Select{2});
    EXPECT_EQ(session.selected(), 2);
    EXPECT_EQ(session.time(), events[1].t);
    session.apply(command::Seek{1e9});
    EXPECT_EQ(session.time(), session.trajectory().end_time);
    EXPECT_EQ(session.notice(), "seek 1000000000: the run ends at t = 20 s");
    session.apply(command::Pause{});
    EXPECT_NE(session.notice(), "") << "it stays until something else is done";
    play_on(session, 1.0);
    session.apply(command::Set{"m", 1.0});
    session.apply(command::Seek{20.0});
    EXPECT_EQ(session.notice(), "");
    session.apply(command::Play{});
    EXPECT_TRUE(session.playing());
    EXPECT_EQ(session.time(), 0.0) << "play at the end means once more";
    session.apply(command::Pause{});
    EXPECT_FALSE(session.playing());
    session.apply(command::Seek{15.0});
    EXPECT_EQ(session.now().phase, Phase::Kind::constrained);
    session.apply(command::SetEndTime{1.0});
    EXPECT_EQ(session.time(), 1.0) << "the present stays inside the run";
    EXPECT_EQ(session.selected(), 0);
}

// Stepping chooses the event; the list, the card and the strip follow.
TEST(Session, StepsByEventsByZenoPointsAndByFrames) {
    Session session = test::session("ball_on_sine");
    const auto& events = session.trajectory().events;
    const auto step = [&](const char* line) {
        session.apply(parse_command(line));
        EXPECT_EQ(session.error(), "") << line;
        return session.selected();
    };
    EXPECT_EQ(step("step 1 event"), 1);
    EXPECT_EQ(session.time(), events[0].t);
    EXPECT_EQ(step("step 2 event"), 3);
    EXPECT_EQ(step("step -1 event"), 2);
    EXPECT_EQ(step("step 1 zeno"), 10);
    EXPECT_EQ(session.time(), events[9].t);
    const int second = step("step 1 zeno");
    EXPECT_EQ(events[static_cast<std::size_t>(second - 1)].kind, Event::Kind::zeno);
    EXPECT_EQ(step("step -1 zeno"), 10);
    EXPECT_EQ(step("step -1 zeno"), 0);
    EXPECT_EQ(session.time(), 0.0) << "before the first: the start of the run";
    step("step 3 event");
    EXPECT_EQ(step("step 1 frame"), 0) << "between events none is chosen";
    EXPECT_NEAR(session.time(), events[2].t + 1.0 / 60.0, 1e-12);
    EXPECT_EQ(step("step 1000 event"), 0);
    EXPECT_EQ(session.time(), session.trajectory().end_time);
    // The word of earlier journals moves the time alone.
    step("select 10");
    EXPECT_EQ(step("step 1"), 10);
    EXPECT_EQ(session.time(), events[10].t);
}

TEST(Session, KeepsTheChosenEventByItsMeaning) {
    Session session = test::session("ball_on_sine");
    const auto zeno = [&](int n) {
        const auto& events = session.trajectory().events;
        for (std::size_t i = 0; i < events.size(); ++i)
            if (is_zeno_point(events[i]) && --n == 0) return static_cast<int>(i) + 1;
        return 0;
    };
    session.apply(command::Select{zeno(2)});
    const int before = session.selected();
    session.apply(command::Set{"e", 0.4});
    EXPECT_NE(zeno(2), before) << "the number changes";
    EXPECT_EQ(session.selected(), zeno(2));
    EXPECT_EQ(session.time(), session.trajectory().events[static_cast<std::size_t>(zeno(2) - 1)].t);
    // Elsewhere the time stays.
    session.apply(command::Seek{1.0});
    session.apply(command::Set{"e", 0.45});
    EXPECT_EQ(session.selected(), zeno(2));
    EXPECT_EQ(session.time(), 1.0);
    session.apply(command::Select{2});
    session.apply(command::Set{"e", 0.5});
    EXPECT_EQ(session.selected(), 2) << "the second impact is the second one";
    session.apply(command::Select{zeno(2)});
    session.apply(command::SetEndTime{5.0});
    EXPECT_EQ(session.selected(), 0) << "this run has no second Zeno point";
}

// Whatever the start time is.
TEST(Session, BeginsAndBeginsAgainWhereTheRunStarts) {
    Session session = test::session("ball_on_sine");
    session.apply(command::SetEndTime{1.0});
    session.apply(command::SetOption("start-time", {-3.0}));
    EXPECT_EQ(session.error(), "");
    session.apply(command::StepEvents{-100});
    EXPECT_EQ(session.time(), -3.0);
    session.apply(command::Seek{1.0});
    session.apply(command::Play{});
    EXPECT_EQ(session.time(), -3.0);
}

TEST(Session, PlaysToTheEndOrRoundAndRound) {
    Session session = test::session("ball_on_sine");
    play_on(session, 1.0);
    EXPECT_EQ(session.time(), 0.0) << "it does not play";
    session.apply(command::Play{});
    play_on(session, 1.5);
    EXPECT_EQ(session.time(), 1.5);
    session.apply(command::Loop{true});
    session.apply(command::Seek{19.5});
    play_on(session, 1.0);
    EXPECT_TRUE(session.playing());
    EXPECT_EQ(session.time(), 0.0);
    session.apply(command::Loop{false});
    session.apply(command::Seek{19.5});
    play_on(session, 1.0);
    EXPECT_FALSE(session.playing());
    EXPECT_EQ(session.time(), 20.0);
}

TEST(Session, OpensAnotherSystem) {
    Session session = test::session("ball_on_sine");
    session.apply(command::Seek{4.0});
    session.apply(command::Open{"double_pendulum"});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.system(), "double_pendulum");
    EXPECT_EQ(to_text(session), to_text(test::session("double_pendulum")));
}

std::string with(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(Session, ATextTakesEffectAndKeepsWhatTheSlidersChanged) {
    Session session = test::session("ball_on_sine");
    const std::string text = session.document().text;
    EXPECT_EQ(text, test::content(session.description().file));
    session.apply(command::Set{"g", 2.0});
    session.apply(command::Set{"x'", 1.25});
    session.apply(command::SetEndTime{12.0});
    session.apply(command::Seek{6.0});
    session.apply(command::SetText{with(text, "value = 0.5", "value = 0.25")});
    EXPECT_EQ(session.error(), "");
    EXPECT_TRUE(session.document().problems.empty());
    EXPECT_TRUE(session.document().is_changed());
    EXPECT_EQ(session.run().parameters[2], 0.25) << "the text changed it";
    EXPECT_EQ(session.run().parameters[1], 2.0) << "a slider changed it, and the text did not";
    EXPECT_EQ(session.run().v[0], 1.25);
    EXPECT_EQ(session.run().options.end_time, 12.0);
    EXPECT_EQ(session.time(), 6.0) << "the present stays";
    session.apply(command::SetText{with(session.document().text, "rate = 1.5", "rate = -1.5")});
    EXPECT_EQ(session.run().v[0], -1.5);
    // Values that do not fit the new text are replaced by those of the text.
    session.apply(command::Set{"y", 1.0});
    session.apply(command::SetText{with(session.document().text, "y - sin(x)", "y - sin(x) - 1.5")});
    EXPECT_TRUE(session.document().problems.empty());
    EXPECT_EQ(session.run().q[1], 2.0);
}

// Values from the command line still override an edited text, unless the text changes them.
TEST(Session, ATextKeepsWhatTheCommandLineSaid) {
    const SystemDescription description = test::system("ball_on_sine");
    auto run = default_run(description);
    assign(run, description, "g=3");
    run.options.end_time = 7.0;
    Session session("ball_on_sine", description, run, test::library());
    const std::string text = session.document().text;
    session.apply(command::SetText{text + "# more\n"});
    EXPECT_EQ(session.run().parameters[1], 3.0);
    EXPECT_EQ(session.run().options.end_time, 7.0);
    session.apply(command::SetText{with(text, "end_time = 20.0", "end_time = 5.0")});
    EXPECT_EQ(session.run().options.end_time, 5.0);
    EXPECT_EQ(session.run().parameters[1], 3.0);
}

TEST(Session, ATextThatIsNoSystemIsToldAndLeavesTheRun) {
    Session session = test::session("ball_on_sine");
    const std::string before = to_text(session.trajectory()), text = session.document().text;
    const std::pair<std::string, int> mistakes[] = {{with(text, "m*g*y", "m*gg*y"), 21},  // unknown name
                                                    // the gap is negative
                                                    {with(text, "start = 2.0", "start = -2.0"), 23},
                                                    {with(text, "run = {", "run = {{"), 25},       // not TOML
                                                    {with(text, "\"lambda\"", "\"lamda\""), 38}};  // in a view
    for (const auto& [wrong, line] : mistakes) {
        session.apply(command::SetText{wrong});
        ASSERT_EQ(session.document().problems.size(), 1U) << line;
        EXPECT_EQ(session.document().problems[0].at.line, line) << session.document().problems[0].what();
        EXPECT_EQ(session.document().text, wrong);
        EXPECT_EQ(to_text(session.trajectory()), before);
        EXPECT_NE(to_text(session).find("problem "), std::string::npos);
    }
    session.apply(command::SetText{text});
    EXPECT_TRUE(session.document().problems.empty());
    EXPECT_EQ(to_text(session), to_text(test::session("ball_on_sine")));
}

TEST(Session, OpensAFileThatIsNoSystemInTheEditor) {
    const test::Folder folder;
    folder.put("wrong.toml", "title = 3");
    const std::string wrong = (folder.path() / "wrong.toml").string();
    Session session = test::session("ball_on_sine");
    const std::string before = to_text(session.trajectory());
    session.apply(command::Open{wrong});
    EXPECT_TRUE(session.shows_editor());
    EXPECT_EQ(session.document().file, wrong);
    EXPECT_EQ(session.document().text, "title = 3");
    EXPECT_FALSE(session.document().is_changed());
    EXPECT_EQ(session.document().problems[0].file, wrong);
    EXPECT_EQ(to_text(session.trajectory()), before);
    EXPECT_EQ(session.system(), "ball_on_sine");
}

TEST(Session, BeginsANewSystem) {
    Session session = test::session("double_pendulum");
    session.apply(command::New{});
    EXPECT_TRUE(session.document().problems.empty());
    EXPECT_FALSE(session.document().is_changed());
    EXPECT_EQ(session.document().file, "");
    EXPECT_EQ(session.trajectory().outcome.kind, Outcome::Kind::end_time);
    EXPECT_EQ(session.trajectory().phases.size(), 2U) << "it comes to rest past a Zeno point";
}

TEST(Session, SavesWhereItIsToldAndWritesOverItsOwnFileAlone) {
    const test::Folder folder;
    folder.put("other.toml", "other");
    const std::string mine = (folder.path() / "mine.toml").string(), other = (folder.path() / "other.toml").string();
    Session session = test::session("ball_on_sine");
    session.apply(command::Set{"g", 2.0});
    session.apply(command::SetText{session.document().text + "# mine\n"});
    session.apply(command::Save{other});
    EXPECT_NE(session.error().find("the file already exists"), std::string::npos);
    EXPECT_EQ(test::content(other), "other");
    session.apply(command::Save{session.description().file});
    EXPECT_NE(session.error(), "") << "an asset is no file of the user's";
    session.apply(command::Save{(folder.path() / "none" / "mine.toml").string()});
    EXPECT_NE(session.error().find("there is no folder"), std::string::npos);
    EXPECT_TRUE(session.document().is_changed());
    session.apply(command::Save{mine});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(test::content(mine), session.document().text);
    EXPECT_FALSE(session.document().is_changed());
    EXPECT_EQ(session.system(), mine);
    EXPECT_EQ(session.run().parameters[1], 2.0);
    session.apply(command::SetText{session.document().text + "# more\n"});
    session.apply(command::Save{folder.path() / "." / "mine.toml"});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(test::content(mine), session.document().text);
    session.apply(command::Save{other, true});
    EXPECT_EQ(test::content(other), session.document().text);
    EXPECT_EQ(folder.files().size(), 2U);
}

// A file that another program has written is read again; sliders keep what they changed.
TEST(Session, ReadsItsFileAgain) {
    const test::Folder folder;
    const std::string text = read_text(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml");
    folder.put("mine.toml", text);
    const std::string mine = (folder.path() / "mine.toml").string();
    Session session = test::session("ball_on_floor");
    session.apply(command::Reload{});
    EXPECT_NE(session.error().find("no file of its own"), std::string::npos) << session.error();
    session.apply(command::Open{mine});
    session.apply(command::Set{"g", 2.0});
    folder.put("mine.toml", with(text, "value = 0.5", "value = 0.25"));
    session.apply(command::Reload{});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.value("e"), 0.25);
    EXPECT_EQ(session.value("g"), 2.0);
    EXPECT_FALSE(session.document().is_changed());
    folder.put("mine.toml", "title = 3");
    session.apply(command::Reload{});
    EXPECT_FALSE(session.document().problems.empty());
    EXPECT_EQ(session.value("e"), 0.25) << "the last good system stays";
    session.apply(command::Undo{});
    EXPECT_EQ(session.value("e"), 0.25);
}

TEST(ContactChanges, AreAllEventsButTheImpacts) {
    std::size_t found = 0;
    for (const char* system : {"ball_on_sine", "double_pendulum", "triple_pendulum", "cart_pendulum",
                               "ball_on_egg_crate", "impact_oscillator", "falling_rod", "bead_in_ring"}) {
        const Session session = test::session(system);
        std::vector<std::size_t> expected;
        const auto& events = session.trajectory().events;
        for (std::size_t i = 0; i < events.size(); ++i)
            if (events[i].kind != Event::Kind::impact) expected.push_back(i);
        EXPECT_EQ(turns(session.trajectory()), expected) << system;
        found += expected.size();
    }
    EXPECT_GT(found, 20U);
}

TEST(Session, KnowsWhereThePresentStandsInAPlot) {
    Session session = test::session("double_pendulum");
    session.apply(command::Seek{2.0});
    const std::vector<double> values = session.values(0, session.now());
    EXPECT_EQ(values[0], 2.0);
    EXPECT_NEAR(values[1], session.now().state.q[0] * 57.29577951308232, 1e-9);
}

// At the cut, the picture and the line beside it show the restarted motion in contact.
TEST(Session, SaysAtACutWhatThePictureShows) {
    Session session = test::session("ball_on_sine");
    const Event& zeno = session.trajectory().events.at(9);
    ASSERT_TRUE(zeno.truncation);
    const double cut = zeno.truncation->t;
    ASSERT_LT(cut, zeno.t);
    for (const double t : {0.0, 0.5 * cut, cut, 0.5 * (cut + zeno.t), zeno.t, zeno.t + 0.1}) {
        const Sample now = session.at(t);
        const PhaseLabel label = phase_label(*session.model(), now);
        EXPECT_EQ(label.color == PhaseLook::contact, now.contact) << t;
        EXPECT_EQ(label.text, t < cut ? "in flight" : t < zeno.t ? "cut, in contact" : "in contact") << t;
    }
}

}  // namespace
}  // namespace achilles
