// Ten tasks of a researcher and a teacher (ten_tasks.txt): what the explorer shows in each. tests/app/ten_tasks_test.sh
// performs them in a real window, at the positions printed here, and counts the actions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/explore.hpp"
#include "figure/camera.hpp"
#include "figure/mechanism_scene.hpp"
#include "model/model.hpp"
#include "output/output.hpp"
#include "panels/widgets.hpp"
#include "session/results_text.hpp"

namespace achilles::ten_tasks {
namespace {

using test::Hands;

const SurfaceOptions surface = test::surface(1280, 800);

// Prints the middle of a place for the script, under a name without spaces.
void tell(const Hands& hands, const std::string& name, const std::string& place) {
    ASSERT_TRUE(hands.state.places.contains(place)) << place;
    const Point at = hands.middle(place);
    ASSERT_TRUE(at.x > 0.0 && at.x < 1280.0 && at.y > 0.0 && at.y < 800.0) << place << " is not seen";
    std::printf("place %s %ld %ld\n", name.c_str(), std::lround(at.x), std::lround(at.y));
}

// Prints it and clicks it.
void use(Hands& hands, const std::string& name, const std::string& place) {
    tell(hands, name, place);
    hands.click(place);
}

void give(Hands& hands, const std::string& command) {
    hands.session.apply(parse_command(command));
    ASSERT_EQ(hands.session.error(), "");
    hands.rest(2);
}

// Index of the second Zeno point in a run of the ball on the sine.
std::size_t second_zeno(const Trajectory& run) {
    int count = 0;
    for (std::size_t i = 0; i < run.events.size(); ++i)
        if (run.events[i].kind == Event::Kind::zeno && ++count == 2) return i;
    return 0;
}

std::string result(const Hands& hands) {
    return "result " + std::to_string(second_zeno(hands.session.trajectory()) + 1);
}

TEST(TenTasks, TheZenoConditionHasItsValueAtAnImpact) {
    Hands hands("ball_on_sine", surface);
    use(hands, "equations", "tab equations");
    use(hands, "zeno", result(hands));
    // Past the last impact, after which the contact is held, to the one before.
    for (int i = 0; i < 2; ++i) hands.press(key::left);
    const Trajectory& run = hands.session.trajectory();
    EXPECT_EQ(hands.session.time(), run.events[second_zeno(run) - 2].t);
    EXPECT_TRUE(hands.says("< 0: bouncing would end at a Zeno point")) << hands.letters();
}

TEST(TenTasks, WhatDiffersFromTheFileIsSeenWithoutAHand) {
    Hands hands("ball_on_sine", surface);
    for (const char* command : {"set e 0.3", "set x' 1.2", "method dopri5"}) give(hands, command);
    EXPECT_TRUE(hands.says("Differs from the file"));
    for (const char* line : {"e = 0.3", "file: 0.5", "1.2 m/s", "dopri5", "file: taylor"})
        EXPECT_TRUE(hands.says(line)) << line << ": " << hands.letters();
}

TEST(TenTasks, ThreeRestitutionsHaveTheirSecondZenoTimesInATable) {
    Hands hands("ball_on_sine", surface);
    use(hands, "pin", "pin");
    give(hands, "set e 0.3");
    use(hands, "pin_again", "pin");
    give(hands, "set e 0.7");
    ASSERT_EQ(hands.session.pinned().size(), 2U);
    for (const Trajectory* run : {hands.session.pinned()[0].trajectory.get(),
                                  hands.session.pinned()[1].trajectory.get(), &hands.session.trajectory()})
        EXPECT_TRUE(hands.says(event_time(*run, second_zeno(*run)).digits)) << hands.letters();
}

TEST(TenTasks, AFigureHasTheWidthOfAColumnAndLettersOf8Points) {
    const test::Folder folder;
    Session session = test::session("ball_on_sine");
    session.apply(parse_command("export " + (folder.path() / "height.svg").string() + " plot 2 width 85 font 8"));
    ASSERT_EQ(session.error(), "");
    EXPECT_NE(test::content(folder.path() / "height.svg").find("width=\"85mm\""), std::string::npos);
}

TEST(TenTasks, AClassSeesOnePlotInLargeLetters) {
    Hands hands("ball_on_sine", surface);
    hands.press(key::f11);
    EXPECT_TRUE(hands.session.scene().presents());
    EXPECT_GT(hands.session.scene().text_scale(1280.0, 800.0), 1.3);
    hands.state.places.clear();
    hands.rest(2);
    for (const char* seen : {"mechanism", "plot 0", "set e"}) EXPECT_TRUE(hands.state.places.contains(seen)) << seen;
    for (const char* hidden : {"plot 1", "set g", "event 1"})
        EXPECT_FALSE(hands.state.places.contains(hidden)) << hidden;
}

TEST(TenTasks, TheLastBouncesAreSeenInTheMechanism) {
    Hands hands("ball_on_sine", surface);
    hands.click(result(hands));
    hands.press(key::left);
    use(hands, "camera", "camera");
    use(hands, "camera_zeno", "menu zeno: zoom in on the next Zeno point");
    EXPECT_EQ(hands.session.scene().camera(), CameraMode::zeno);
    // The view is at most a thousandth as wide as that of the whole run.
    const auto width = [&](CameraMode mode) {
        const Drawing seen =
            hands.session.mechanism_scene().camera().at(mode, hands.session.now(), {400.0, 300.0, 0.0, 0.0});
        return seen.x_high - seen.x_low;
    };
    EXPECT_LT(width(CameraMode::zeno), 1e-3 * width(CameraMode::fit));
}

TEST(TenTasks, ASystemOfSeveralContactsIsFoundByItsGroup) {
    Hands hands("ball_on_sine", surface);
    hands.state.systems = known_systems();
    hands.press_with_control('G');
    hands.rest(3);
    tell(hands, "gallery", "gallery ball_on_sine");
    hands.point("gallery ball_on_sine");
    const auto is_seen = [&] {
        const auto place = hands.state.places.find("gallery double_pendulum_two_stops");
        return place != hands.state.places.end() && place->second.y > 0.0F && place->second.y < 600.0F;
    };
    int notches = 0;
    for (; notches < 60 && !is_seen(); ++notches) {
        hands.hand.wheel = -1.0;
        hands.rest(1);
        hands.hand.wheel = 0.0;
        hands.rest(1);
    }
    hands.rest(3);
    EXPECT_TRUE(hands.says("several contacts")) << hands.letters();
    std::printf("notches %d\n", notches);  // the script turns the wheel as far
    use(hands, "several", "gallery double_pendulum_two_stops");
    EXPECT_EQ(hands.session.system(), "double_pendulum_two_stops");
    EXPECT_GT(hands.session.model()->contacts(), 1U);
}

TEST(TenTasks, WhatImpactsTookIsSaidBesideTheEnergy) {
    Hands hands("ball_on_sine", surface);
    use(hands, "view", "bar View");
    use(hands, "view_energy", "menu Energy");
    use(hands, "zeno_over_energy", result(hands));
    EXPECT_TRUE(hands.says("impact loss")) << hands.letters();
}

TEST(TenTasks, AFileOfYesterdayStandsInTheMenu) {
    Hands hands("ball_on_sine", surface);
    hands.state.recent = {"/elsewhere/mine.toml"};
    use(hands, "file", "bar File");
    tell(hands, "recent_menu", "menu Open recent");
    hands.point("menu Open recent");
    hands.rest(30);
    tell(hands, "recent", "menu /elsewhere/mine.toml");
}

}  // namespace
}  // namespace achilles::ten_tasks
