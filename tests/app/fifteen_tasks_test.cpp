// Fifteen tasks of a student (fifteen_tasks.txt): what the explorer shows in each. tests/app/fifteen_tasks_test.sh
// performs them in a real window, at the positions printed here, and counts the actions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "output/output.hpp"
#include "panels/widgets.hpp"

namespace achilles::fifteen_tasks {
namespace {

// As in a window, a short run is proved by itself.
struct Hands : test::Hands {
    Hands(const std::string& system, const SurfaceOptions& options) : test::Hands(system, options) {
        session.prove_behind();
        session.settle();
        rest(3);
    }
};

const SurfaceOptions surface = test::surface(1280, 800);

void tell(const std::string& name, const Point& at) {
    ASSERT_TRUE(at.x > 0.0 && at.x < 1280.0 && at.y > 0.0 && at.y < 800.0) << name << " is not seen";
    std::printf("place %s %ld %ld\n", name.c_str(), std::lround(at.x), std::lround(at.y));
}

// Prints the middle of a place for the script, under a name without spaces.
void tell(const Hands& hands, const std::string& name, const std::string& place) {
    ASSERT_TRUE(hands.state.places.contains(place)) << place;
    tell(name, hands.middle(place));
}

void use(Hands& hands, const std::string& name, const std::string& place) {
    tell(hands, name, place);
    hands.click(place);
}

// Prints both ends of a drag, and performs it.
void drag(Hands& hands, const std::string& name, const Point& from, const Point& to) {
    tell(name + "_from", from);
    tell(name + "_to", to);
    hands.hand.mouse_x = from.x, hands.hand.mouse_y = from.y;
    hands.rest(2);
    hands.hand.left = true;
    hands.rest(30);
    for (int i = 1; i <= 8; ++i) {
        hands.hand.mouse_x = from.x + (to.x - from.x) * i / 8.0;
        hands.hand.mouse_y = from.y + (to.y - from.y) * i / 8.0;
        hands.rest(2);
    }
    hands.hand.left = false;
    hands.rest(3);
    hands.settle();
}

// The number, from 1, of the n-th event of a kind.
int number_of(const Session& session, Event::Kind kind, int n) {
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i)
        if (events[i].kind == kind && --n == 0) return static_cast<int>(i) + 1;
    return 0;
}

std::string second_zeno(const Session& session) {
    return "result " + std::to_string(number_of(session, Event::Kind::zeno, 2));
}

TEST(FifteenTasks, ASliderChangesTheMotionThatIsPlayed) {
    Hands hands("ball_on_sine", surface);
    const Rectangle slider = hands.state.places.at("set e");
    const Point middle = hands.middle("set e");
    const std::string before = to_text(hands.session.trajectory());
    drag(hands, "e", middle, {middle.x + 0.25 * slider.width, middle.y});
    EXPECT_NEAR(*hands.session.value("e"), 0.75, 0.05);
    EXPECT_NE(to_text(hands.session.trajectory()), before);
    hands.press(' ');
    EXPECT_TRUE(hands.session.playing());
}

TEST(FifteenTasks, AZenoPointHasItsTimeAndItsCertificate) {
    Hands hands("ball_on_sine", surface);
    use(hands, "zeno", second_zeno(hands.session));
    for (const char* seen : {"Zeno 2, time 12.46577", "PROVED", "It would bounce infinitely often"})
        EXPECT_TRUE(hands.says(seen)) << hands.letters();
}

TEST(FifteenTasks, AReleaseHasItsReason) {
    Hands hands("ball_on_sine", surface);
    const int release = number_of(hands.session, Event::Kind::release, 1);
    std::printf("release %d\n", release);
    std::printf("place release %ld %ld\n", std::lround(hands.middle("result " + std::to_string(release)).x),
                std::lround(hands.middle("result " + std::to_string(release)).y));
    hands.click("result " + std::to_string(release));
    EXPECT_TRUE(hands.says("from here on the surface would have to pull")) << hands.letters();
}

TEST(FifteenTasks, TheLensShowsTheAccumulation) {
    Hands hands("ball_on_sine", surface);
    hands.click(second_zeno(hands.session));
    use(hands, "lens", "open lens");
    EXPECT_TRUE(lens_is_open(hands.session));
    EXPECT_TRUE(hands.says("infinitely many bounces")) << hands.letters();
}

// The record of the steps leads to the same event in another session, which did not play.
TEST(FifteenTasks, AStepEndsThePlaybackAtAnEventAndShowsIt) {
    Hands hands("ball_on_sine", surface);
    hands.press(' ');
    play_on(hands.session, 1.0);
    for (const int event : {1, 2}) {
        hands.press(key::right);
        EXPECT_FALSE(hands.session.playing());
        EXPECT_EQ(hands.session.selected(), event);
        EXPECT_EQ(hands.session.time(), hands.session.trajectory().events[static_cast<std::size_t>(event - 1)].t);
        EXPECT_TRUE(hands.says("Impact, event " + std::to_string(event))) << hands.letters();
    }
    Session again = test::session("ball_on_sine");
    for (const Command& command : hands.all) again.apply(command);
    EXPECT_EQ(to_text(again), to_text(hands.session));
}

TEST(FifteenTasks, ABodyIsPlacedByHand) {
    Hands hands("ball_on_sine", surface);
    const Point body = hands.middle("body");
    drag(hands, "body_start", body, {body.x + 40.0, body.y - 30.0});
    tell("body", body);
    tell("body_to", {body.x + 40.0, body.y - 30.0});
    EXPECT_GT(*hands.session.value("x"), 0.3);
    EXPECT_GT(*hands.session.value("y"), 2.2);
    EXPECT_LT(std::hypot(hands.middle("body").x - body.x - 40.0, hands.middle("body").y - body.y + 30.0), 1.5)
        << "it lies where it was put";
}

TEST(FifteenTasks, TwoRestitutionsStandSideBySide) {
    Hands hands("ball_on_sine", surface);
    use(hands, "pin", "pin");
    hands.session.apply(command::Show{"palette", true});
    hands.rest(3);
    hands.type("e = 0.3");
    hands.press(key::enter);
    EXPECT_EQ(*hands.session.value("e"), 0.3);
    ASSERT_EQ(hands.session.pinned().size(), 1U);
    hands.rest(2);
    for (const Trajectory* run : {hands.session.pinned()[0].trajectory.get(), &hands.session.trajectory()}) {
        const int zeno = number_of(hands.session, Event::Kind::zeno, 1);
        ASSERT_GT(zeno, 0);
        for (std::size_t i = 0; i < run->events.size(); ++i)
            if (run->events[i].kind == Event::Kind::zeno) {
                EXPECT_TRUE(hands.says(event_time(*run, i).digits)) << hands.letters();
                break;
            }
    }
}

TEST(FifteenTasks, KeysOpenTheExportsOfAFigureAndOfAFilm) {
    for (const auto& [key, path] : {std::pair{'P', "ball_on_sine.svg"}, {'M', "ball_on_sine.mp4"}}) {
        Hands hands("ball_on_sine", surface);
        hands.state.reads_folders = false;
        hands.press_with_control(key);
        EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::export_run) << path;
        EXPECT_EQ(hands.state.editor.path, path);
    }
}

TEST(FifteenTasks, ANewTextHasTheKeyboardAndAMistakeIsTakenBack) {
    Hands hands("ball_on_sine", surface);
    hands.press_with_control('N');
    hands.rest(3);
    ASSERT_TRUE(hands.session.shows_editor());
    const std::string text = hands.session.document().text;
    EXPECT_NE(text, test::session("ball_on_sine").document().text) << "it is another system";
    hands.type("oops");
    hands.rest(40);
    EXPECT_FALSE(hands.session.document().problems.empty());
    EXPECT_EQ(hands.session.document().text, "oops" + text);
    hands.press_with_control('Z');
    hands.rest(2);
    EXPECT_EQ(hands.session.document().text, text);
    EXPECT_TRUE(hands.session.document().problems.empty());
}

TEST(FifteenTasks, AnOpenedEditorHasTheKeyboard) {
    Hands hands("ball_on_sine", surface);
    hands.press_with_control('E');
    hands.rest(3);
    EXPECT_TRUE(hands.state.editor.is_active);
    // A text that a journal shows leaves the keys to the player.
    Hands other("ball_on_sine", surface);
    other.session.apply(command::Show{"editor", true});
    other.rest(3);
    EXPECT_FALSE(other.state.editor.is_active);
}

TEST(FifteenTasks, EquationsHaveATab) {
    Hands hands("ball_on_sine", surface);
    use(hands, "equations", "tab equations");
    for (int i = 0; i < 500 && derives_equations(hands.state); ++i) hands.rest(1);
    EXPECT_TRUE(hands.says("bouncing would end at a Zeno point")) << hands.letters();
}

TEST(FifteenTasks, ACurveBecomesAMapByOneName) {
    Hands hands("ball_on_sine", surface);
    hands.press_with_control('4');
    hands.session.settle();
    hands.rest(3);
    ASSERT_TRUE(hands.session.sweep_job().data());
    EXPECT_EQ(hands.session.sweep().axes.size(), 1U);
    use(hands, "second_axis", "sweep y");
    use(hands, "second_name", "sweep y x'");
    EXPECT_EQ(hands.session.sweep().axes.size(), 2U);
    EXPECT_EQ(hands.state.focus.front, 0U) << "the menu is closed";
}

// A window proves short runs by itself; the strip, the status line and the copied events have the intervals.
TEST(FifteenTasks, ARunOfFewStepsIsProvedByItself) {
    test::Hands hands("ball_on_sine", surface);
    hands.rest(2);
    EXPECT_FALSE(hands.says("proved")) << "a picture has no proof that was not asked for";
    const Point before = hands.middle(second_zeno(hands.session));
    hands.session.prove_behind();
    hands.session.settle();
    hands.rest(3);
    ASSERT_NE(hands.session.shown_proof(), nullptr);
    EXPECT_EQ(hands.session.proof(), nullptr) << "nobody asked for tubes";
    EXPECT_EQ(hands.middle(second_zeno(hands.session)).x, before.x) << "the strip does not move";
    for (const char* seen : {"Zeno 1, proved", "proved to t = 20 s"}) EXPECT_TRUE(hands.says(seen)) << hands.letters();
    EXPECT_TRUE(hands.all.empty());
    hands.click("tab proof");
    EXPECT_TRUE(hands.says("Show tubes"));
    EXPECT_FALSE(hands.says("Prove this run")) << "it is proved";
    // The next run stops it, and is proved in turn.
    hands.session.apply(command::Set{"e", 0.4});
    hands.session.settle();
    ASSERT_NE(hands.session.shown_proof(), nullptr);
    EXPECT_EQ(hands.session.shown_proof()->claim.run.parameters[2], 0.4);
    // A longer one is not: the limit is a number of steps, not of seconds.
    hands.session.apply(command::SetEndTime{100.0});
    hands.session.settle();
    EXPECT_EQ(hands.session.shown_proof(), nullptr);
    EXPECT_EQ(hands.session.enclosed(0), nullptr);
    hands.rest(2);
    EXPECT_FALSE(hands.says("proved"));
}

TEST(FifteenTasks, AParameterChosenForTheBranchStartsTheSearch) {
    Hands hands("ball_down_a_wave", surface);
    hands.session.apply(command::Set{"e", 0.3});
    hands.press_with_control('6');
    hands.rest(2);
    use(hands, "along", "orbit along");
    use(hands, "along_b", "orbit along b");
    hands.session.settle();
    hands.rest(4);
    ASSERT_TRUE(hands.session.orbit() && hands.session.orbit()->answer.branch);
    EXPECT_TRUE(hands.session.orbit_point()) << "the run starts on the periodic run";
    EXPECT_EQ(hands.state.focus.front, 0U) << "the menu is closed";
    const Rectangle plot = hands.state.places.at("branch plot 1");
    const auto before = hands.session.orbit_point();
    drag(hands, "branch", {plot.x + 0.2 * plot.width, plot.y + 0.5 * plot.height},
         {plot.x + 0.9 * plot.width, plot.y + 0.5 * plot.height});
    EXPECT_TRUE(hands.session.orbit_point());
    EXPECT_NE(hands.session.orbit_point(), before);
}

TEST(FifteenTasks, TheLastFileIsOpenedAgainByAKey) {
    const test::Folder folder;
    const std::string own = (folder.path() / "own.toml").string();
    std::filesystem::copy_file(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_floor.toml", own);
    Hands hands("ball_on_sine", surface);
    const auto press = [&] {
        hands.hand.keys = {key::left_control, key::left_shift};
        hands.rest(1);
        hands.hand.keys.push_back('T');
        hands.rest(2);
        hands.hand.keys.clear();
        hands.rest(2);
    };
    press();
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::open) << "without a last file, any can be chosen";
    hands.press(key::escape);
    hands.state.recent = {own, "/elsewhere/other.toml"};
    press();
    EXPECT_EQ(hands.session.document().file, own);
    press();
    EXPECT_EQ(hands.all.back(), Command(command::Open{"/elsewhere/other.toml"})) << "the one that is not open";
}

TEST(FifteenTasks, ALecturePlaysAValueAndGoesToTheNextSystem) {
    Hands hands("ball_on_sine", surface);
    hands.press(key::f11);
    hands.surface.restyle(hands.session.scene().text_scale(1280.0, 800.0), false);  // as the window does
    hands.rest(4);
    use(hands, "animate", "animate e");
    ASSERT_NE(hands.session.animation(), nullptr);
    play_on(hands.session, 1.0);
    EXPECT_NE(*hands.session.value("e"), 0.5);
    hands.press(key::down);
    EXPECT_EQ(hands.session.system(), "double_pendulum");
    EXPECT_TRUE(hands.session.scene().presents());
}

}  // namespace
}  // namespace achilles::fifteen_tasks
