// Mouse and keys in the window: dragged objects follow the mouse, clicks on markers select events, Escape closes the
// front.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "cli/inputs.hpp"
#include "figure/axes.hpp"
#include "journal/journal.hpp"
#include "number/angle.hpp"
#include "output/output.hpp"

namespace achilles {
namespace {

using test::Hands;

double distance(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

Point mouse(const Hands& hands) { return {hands.hand.mouse_x, hands.hand.mouse_y}; }

// Drags an object along a path and returns its largest distance from the mouse.
double follow(Hands& hands, const std::string& place, const std::vector<Point>& steps) {
    hands.point(place);
    hands.hand.left = true;
    hands.rest(1);
    double worst = 0.0;
    for (const Point& step : steps) {
        hands.hand.mouse_x += step.x;
        hands.hand.mouse_y += step.y;
        hands.rest(2);  // it is drawn where the last frame moved it
        EXPECT_EQ(hands.session.error(), "");
        worst = std::max(worst, distance(hands.middle(place), mouse(hands)));
    }
    hands.hand.left = false;
    hands.rest(2);
    return worst;
}

const std::vector<Point> up(12, Point{6.0, -9.0});

TEST(MechanismDrag, WhatIsDraggedStaysUnderTheHandAtEveryStep) {
    for (const char* system : {"ball_on_sine", "ball_in_bowl", "ball_on_floor"})
        for (const double time : {0.0, 1.0}) {
            Hands hands(system);
            hands.session.apply(command::Seek{time});
            hands.rest(2);
            EXPECT_LT(follow(hands, "body", up), 1.0) << system << " at " << time;
            EXPECT_EQ(hands.session.time(), 0.0);
        }
    // The tip of the velocity arrow: twelve steps make it several times longer.
    for (const char* system : {"ball_on_sine", "ball_in_bowl"}) {
        Hands hands(system);
        EXPECT_LT(follow(hands, "velocity", std::vector<Point>(12, Point{9.0, -3.0})), 1.0) << system;
    }
}

TEST(MechanismDrag, EveryBodyOfAMechanismCanBeDragged) {
    Hands hands("double_pendulum");
    const double theta1 = *hands.session.value("theta1"), theta2 = *hands.session.value("theta2");
    // The lower end, which depends on both angles, then the knee, which depends on one.
    ASSERT_TRUE(hands.state.places.contains("body 2"));
    std::string lowest = "body";
    for (const auto& [name, place] : hands.state.places)
        if (name.rfind("body", 0) == 0 && place.y > hands.state.places.at(lowest).y) lowest = name;
    EXPECT_LT(follow(hands, lowest, std::vector<Point>(8, Point{-2.0, -4.0})), 1.0);
    EXPECT_NE(*hands.session.value("theta2"), theta2);
    const double before = *hands.session.value("theta2");
    follow(hands, "body", std::vector<Point>(4, Point{2.0, -1.0}));
    EXPECT_NE(*hands.session.value("theta1"), theta1);
    EXPECT_NEAR(*hands.session.value("theta2"), before, 1e-12);
}

TEST(MechanismDrag, ABodyThatIsPushedIntoTheGroundStaysOnIt) {
    for (const char* place : {"body", "start"}) {
        Hands hands("ball_on_floor");
        if (std::string(place) == "start") hands.session.apply(command::Show{"plane", true});
        hands.rest(3);
        hands.point(place);
        hands.hand.left = true;
        hands.rest(1);
        for (int i = 0; i < 40; ++i) {
            hands.hand.mouse_y += 12.0;
            hands.rest(1);
            ASSERT_EQ(hands.session.error(), "") << place;
        }
        const double radius = *hands.session.value("r");
        EXPECT_GE(*hands.session.value("y"), radius - 1e-12) << place;
        EXPECT_LT(*hands.session.value("y"), radius + 1e-6) << place;
        hands.hand.mouse_y -= 480.0;  // back up, still under the mouse
        hands.rest(2);
        EXPECT_NEAR(*hands.session.value("y"), 1.0, 0.02) << place;
    }
}

// The place of the end of a line or center of a body that is nearest to a point of the world.
std::string place_of(Hands& hands, const Point& world) {
    auto grips = hands.session.mechanism().grips(hands.session.run().parameters);
    const State start = hands.session.run().start();
    std::string nearest;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < grips.size(); ++i) {
        const double away = distance(grips[i].at(start.t, start).at, world);
        if (away < least) nearest = i == 0 ? "body" : "body " + std::to_string(i + 1), least = away;
    }
    return nearest;
}

// A leg typed as bodies, held between the ends of its thigh and of its shank.
TEST(MechanismDrag, ABodyIsHeldWhereTheHandTakesIt) {
    Hands hands(test::mechanism("kneed_leg"));
    const auto value = [&](const char* name) { return *hands.session.value(name); };
    const auto hip = [&] { return Point{0.0, value("z")}; };
    const auto knee = [&] {
        return Point{value("Lt") * std::sin(value("theta")), value("z") - value("Lt") * std::cos(value("theta"))};
    };
    const auto foot = [&] {
        const double shank = value("theta") - value("kappa");
        return Point{knee().x + value("Ls") * std::sin(shank), knee().y - value("Ls") * std::cos(shank)};
    };
    const std::string at_hip = place_of(hands, hip()), at_knee = place_of(hands, knee()),
                      at_foot = place_of(hands, foot());
    const auto middle = [&](const std::string& a, const std::string& b) {
        const Point p = hands.middle(a), q = hands.middle(b);
        return Point{0.5 * (p.x + q.x), 0.5 * (p.y + q.y)};
    };
    for (const auto& [a, b] : {std::pair{at_hip, at_knee}, {at_knee, at_foot}}) {
        const Point from = middle(a, b);
        hands.hand.mouse_x = from.x, hands.hand.mouse_y = from.y;
        hands.rest(2);
        hands.hand.left = true;
        hands.rest(1);
        for (int i = 0; i < 8; ++i) {
            hands.hand.mouse_x += 3.0, hands.hand.mouse_y -= 2.0;
            hands.rest(2);
            EXPECT_EQ(hands.session.error(), "");
            EXPECT_LT(distance(middle(a, b), mouse(hands)), 1.0) << a << " to " << b << ", step " << i;
        }
        // Far below the floor: the foot stands on it.
        if (b == at_foot) hands.hand.mouse_y += 400.0;
        hands.rest(2);
        hands.hand.left = false;
        hands.rest(2);
    }
    EXPECT_GE(foot().y, -1e-12);
    EXPECT_LT(foot().y, 1e-6);
    // The drag is made of commands on coordinates: a journal repeats it.
    Session again = test::session(test::mechanism("kneed_leg"));
    for (const Command& command : parse_journal(journal_text(hands.all))) again.apply(command);
    EXPECT_EQ(to_text(again.trajectory()), to_text(hands.session.trajectory()));
    EXPECT_NE(*again.value("theta"), again.file_run().q[1]);
}

TEST(MechanismDrag, TheCameraStaysUntilAnotherViewIsAskedFor) {
    Hands hands("ball_on_sine");
    hands.point("body");
    hands.hand.left = true;
    hands.rest(1);
    for (int i = 0; i < 10; ++i) {
        hands.hand.mouse_y -= 12.0;
        hands.rest(1);
    }
    const Placement held = hands.state.held.placement;
    hands.rest(3);
    EXPECT_EQ(hands.state.held.placement.unit, held.unit);
    const Point at = hands.middle("body");
    hands.hand.left = false;
    hands.rest(3);
    EXPECT_EQ(hands.state.held.what, MechanismDrag::DragTarget::none);
    EXPECT_LT(std::hypot(hands.middle("body").x - at.x, hands.middle("body").y - at.y), 0.01);
    EXPECT_TRUE(hands.session.scene().look()) << "the camera is fixed";
    hands.session.apply(command::LookAll{});
    hands.rest(3);
    EXPECT_GT(std::abs(hands.middle("body").y - at.y), 5.0) << "all of the higher flight is seen";
}

// A drag sets decimals that the eye can tell apart: a step of one in the last place is at most a pixel. In contact the
// start stays on the surface.
TEST(MechanismDrag, ValuesAreRoundToThePixel) {
    for (const char* system : {"ball_on_sine", "double_pendulum"}) {
        Hands hands(system);
        hands.point("body");
        hands.hand.left = true;
        hands.rest(1);
        for (int i = 0; i < 12; ++i) {
            hands.hand.mouse_x += 4.0, hands.hand.mouse_y -= 3.0;
            hands.rest(2);
            // The pendulum's links do not reach the whole way.
            if (std::string(system) == "ball_on_sine") {
                EXPECT_LT(distance(hands.middle("body"), mouse(hands)), 1.5);
            }
        }
        const auto& coordinates = hands.session.description().coordinates;
        for (const CoordinateDescription& coordinate : coordinates) {
            const double value =
                *hands.session.value(coordinate.name) * (coordinate.unit == "rad" ? degrees(1.0) : 1.0);
            EXPECT_NEAR(value, std::round(value * 1e3) / 1e3, 1e-9) << system << " " << coordinate.name;
        }
    }
}

TEST(Mechanism, AZoomThatHidesTheStartSaysSo) {
    Hands hands("ball_on_sine");
    EXPECT_FALSE(hands.says("outside this view"));
    hands.session.apply(command::LookAt{10.0, 0.0, 3.0});
    hands.rest(2);
    EXPECT_TRUE(hands.says("the start is outside this view")) << hands.letters();
    hands.session.apply(command::LookAt{0.0, 2.0, 3.0});
    hands.rest(2);
    EXPECT_FALSE(hands.says("outside this view"));
}

// The forces of the contacts that are held are said beside a body under the mouse.
TEST(Mechanism, ForcesHaveTheirValuesUnderTheMouse) {
    Hands hands("ball_on_floor");
    hands.session.apply(command::Seek{2.5});
    hands.rest(2);
    hands.point("body");
    EXPECT_TRUE(hands.says("force of contact: 9.81 N")) << hands.letters();
    // The arrow says them, too, where it is outside the ball.
    ASSERT_TRUE(hands.state.places.contains("force"));
    hands.point("force");
    EXPECT_FALSE(hands.says("drag to set")) << "the ball is too large for this test";
    EXPECT_TRUE(hands.says("force of contact: 9.81 N")) << hands.letters();
    hands.session.apply(command::Seek{0.1});
    hands.rest(2);
    hands.point("body");
    EXPECT_FALSE(hands.says("force of contact")) << "in flight there is none";
    Hands rough("block_on_incline");
    rough.session.apply(command::Seek{0.5 * rough.session.trajectory().end_time});
    rough.rest(2);
    rough.point("body");
    ASSERT_TRUE(rough.session.now().contact);
    EXPECT_TRUE(rough.says("friction of")) << rough.letters();
    // The same where the arrow at the contact is, inside the block, with what the friction could be.
    ASSERT_TRUE(rough.state.places.contains("force"));
    rough.point("force");
    EXPECT_TRUE(rough.says("normal force of")) << rough.letters();
    EXPECT_TRUE(rough.says("of at most")) << rough.letters();
    const Rectangle world = rough.state.places.at("mechanism");
    rough.hand.mouse_x = world.x + 0.95 * world.width, rough.hand.mouse_y = world.y + 0.05 * world.height;
    rough.rest(2);
    EXPECT_FALSE(rough.says("normal force of")) << "beside the arrow there is nothing to say";
}

TEST(Marks, AClickWithinEightPixelsSelectsThatEvent) {
    Hands hands("ball_on_sine");
    const auto& events = hands.session.trajectory().events;
    const auto index = [&](Event::Kind kind) {
        std::size_t i = 0;
        while (events[i].kind != kind) ++i;
        return i;
    };
    const Rectangle line = hands.state.places.at("timeline");
    const double end = hands.session.run().options.end_time;
    for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release})
        for (const double slip : {-5.0, 0.0, 5.0}) {
            const std::size_t wanted = index(kind);
            hands.session.apply(command::Select{0});
            hands.all.clear();
            hands.hand.mouse_x = line.x + 8.0 + events[wanted].t / end * (line.width - 16.0) + slip;
            hands.hand.mouse_y = line.y + 6.0 + 18.0 - (kind == Event::Kind::impact ? 4.0 : 8.0);
            hands.rest(2);
            EXPECT_GT(hands.tooltip().height, 0.0F) << "hovering names it";
            hands.hand.left = true;
            hands.rest(2);
            hands.hand.left = false;
            hands.rest(2);
            EXPECT_EQ(hands.session.selected(), static_cast<int>(wanted) + 1) << slip;
            EXPECT_EQ(hands.session.time(), events[wanted].t);
            EXPECT_EQ(hands.all.size(), 1U) << "it is no seek";
        }
    // In a plot over time and in a path: at the curve's point of that event.
    hands.session.apply(command::Select{0});
    hands.rest(2);
    for (const std::size_t plot : {1U, 3U})
        for (const std::size_t wanted : {std::size_t{0}, index(Event::Kind::zeno), index(Event::Kind::release)}) {
            hands.session.apply(command::Select{0});
            hands.all.clear();
            const PanelMap map(hands.session.plots()[plot], hands.state.places.at("plot " + std::to_string(plot)));
            const auto values = hands.session.values(plot, sample_at(hands.session.trajectory(), events[wanted]));
            hands.hand.mouse_x = map.x(values[0]) + 4.0;
            hands.hand.mouse_y = map.y(values[1]) - 3.0;
            hands.rest(2);
            EXPECT_GT(hands.tooltip().height, 0.0F);
            hands.hand.left = true;
            hands.rest(2);
            hands.hand.left = false;
            hands.rest(2);
            hands.settle();  // it could become a double click
            EXPECT_EQ(hands.session.selected(), static_cast<int>(wanted) + 1) << plot;
        }
    // Away from all markers a click seeks.
    hands.session.apply(command::Select{0});
    hands.click("timeline", 0.5);
    EXPECT_EQ(hands.session.selected(), 0);
    EXPECT_NEAR(hands.session.time(), 10.0, 0.1);
}

TEST(Marks, NeitherTheRightButtonNorADoubleClickSeeks) {
    Hands hands("ball_on_sine");
    hands.right_click("plot 1", 0.45);
    EXPECT_EQ(hands.session.time(), 0.0);
    hands.all.clear();
    hands.double_click("plot 1", 0.45);
    hands.settle();
    int seeks = 0, fits = 0;
    for (const Command& command : hands.all) {
        seeks += std::holds_alternative<command::Seek>(command) ? 1 : 0;
        fits += std::holds_alternative<command::Fit>(command) ? 1 : 0;
    }
    EXPECT_EQ(seeks, 0);
    EXPECT_EQ(fits, 1);
}

// Below the buttons of the player is the timeline, which a tooltip must not cover.
TEST(Player, TooltipsStandAboveIt) {
    Hands hands("ball_on_sine");
    for (const char* place : {"play", "loop"}) {
        hands.point(place);
        const Rectangle tooltip = hands.tooltip(), button = hands.state.places.at(place);
        EXPECT_GT(tooltip.height, 0.0F) << place;
        EXPECT_LE(tooltip.y + tooltip.height, button.y) << place;
    }
}

TEST(Escape, BelongsToWhatIsInFront) {
    Hands hands("ball_on_sine");
    hands.click("pin");
    hands.press_with_control('O');
    ASSERT_EQ(hands.state.editor.asking, EditorState::OpenDialog::open);
    hands.press(key::escape);
    EXPECT_EQ(hands.state.editor.asking, EditorState::OpenDialog::nothing);
    EXPECT_TRUE(hands.session.scene().shows("runs")) << "the dialog had it";
    hands.double_click("value of set g");
    hands.press(key::escape);
    EXPECT_TRUE(hands.session.scene().shows("runs")) << "the field had it";
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("runs"));
    EXPECT_EQ(hands.session.pinned().size(), 1U) << "the table is closed, the run stays";
    // Escape closes first the lens, then the card.
    hands.session.apply(command::Select{10});
    hands.session.apply(command::Show{"lens", true});
    hands.rest(2);
    hands.press(key::escape);
    EXPECT_FALSE(hands.session.scene().shows("lens"));
    EXPECT_EQ(hands.session.selected(), 10);
    hands.press(key::escape);
    EXPECT_EQ(hands.session.selected(), 0);
}

TEST(Escape, ClosesMenus) {
    Hands hands("ball_on_sine");
    for (const auto& [open, line] : {std::pair{"bar File", "menu Save"},
                                     {"bar View", "menu Plots"},
                                     {"systems", "open double_pendulum"},
                                     {"menu of plot 1", "expression y"}}) {
        hands.state.places.erase(line);
        hands.click(open);
        ASSERT_TRUE(hands.state.places.contains(line)) << open;
        hands.press(key::escape);
        hands.state.places.erase(line);
        hands.rest(2);
        EXPECT_FALSE(hands.state.places.contains(line)) << open;
    }
    EXPECT_TRUE(hands.all.empty());
}

TEST(PlotMenu, KeepsWhatWasMistyped) {
    Hands hands("ball_on_sine");
    hands.click("menu of plot 2");
    hands.click("expression y");
    hands.press_with_control('A');
    hands.type("y, max_y");
    hands.press(key::enter);
    EXPECT_NE(hands.session.error(), "");
    EXPECT_EQ(hands.state.plot_menu.y, "y, max_y");
    hands.state.places.erase("expression y");
    hands.rest(2);
    ASSERT_TRUE(hands.state.places.contains("expression y")) << "the menu is closed";
    // The field is still active: after correction the menu closes.
    hands.press_with_control('A');
    hands.type("y, gap");
    hands.press(key::enter);
    EXPECT_EQ(hands.session.error(), "");
    EXPECT_EQ(hands.session.plotted().list()[1].view.y.size(), 2U);
    hands.state.places.erase("expression y");
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.contains("expression y"));
}

TEST(Plots, NoGridShowsAPlotTwice) {
    for (const char* system : {"ball_on_sine", "double_pendulum", "ball_on_floor", "impact_oscillator", "falling_rod"})
        for (const char* grid : {"grid 3 3", "grid 4 4"}) {
            Session session = test::session(system);
            // Also in plots chosen by the user.
            for (const char* line : {"grid 1 1", "plot 1 t energy", grid}) session.apply(parse_command(line));
            ASSERT_EQ(session.error(), "");
            std::set<std::string> shown;
            for (const Plot& plot : session.plotted().list()) {
                std::string text = plot.view.x.text;
                for (const Text& y : plot.view.y) text += " " + y.text;
                EXPECT_TRUE(shown.insert(text).second) << system << ", " << grid << ": " << text;
            }
        }
}

TEST(Plots, HuesAreOfCurvesAndDashesOfPhases) {
    Session session = test::session("ball_on_sine");
    for (const char* theme : {"theme light", "theme dark"}) {
        session.apply(parse_command(theme));
        session.apply(parse_command("plot 1 t x y"));
        const std::vector<Curve>& curves = session.plots()[0].curves;
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(curves[i].stroke.dash.empty(), i % 2 == 1);
            EXPECT_EQ(curves[i].stroke.color, curves[i - i % 2].stroke.color);
            for (const Phase::Kind kind : {Phase::Kind::hybrid, Phase::Kind::constrained})
                EXPECT_NE(curves[i].stroke.color, phase_color(session.theme(), kind));
        }
    }
}

TEST(Files, ANoteNamesTheFolderAndASystemGetsItsEnding) {
    const test::Folder folder;
    SystemSource library = test::library();
    library.folder = folder.path().string();
    Session session("ball_on_sine", test::system("ball_on_sine"), library);
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    session.apply(command::Export{"mine.svg", false});
    std::filesystem::current_path(here);
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.notice(), "wrote " + (folder.path() / "mine.svg").string());

    Hands hands("ball_on_sine");
    hands.click("bar File");
    hands.click("menu Save as\u2026");
    hands.press_with_control('A');
    hands.type((folder.path() / "mine").string());
    hands.press(key::enter);
    EXPECT_EQ(hands.session.error(), "");
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "mine.toml"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "mine"));
}

// A picture dropped on the window restores its session.
TEST(DroppedFile, APictureOpensAsASession) {
    const test::Folder folder;
    const std::string picture = (folder.path() / "a.png").string(), figure = (folder.path() / "b.svg").string();
    ASSERT_EQ(
        folder
            .run(
                "screenshot double_pendulum --set g=2 --end 9 --do 'grid 1 1' --do 'seek 2' --size 700x500 --out a.png")
            .status,
        0);
    ASSERT_TRUE(is_picture(picture));
    Session session = test::session("ball_on_sine");
    for (const Command& command : session_in(picture, {})) session.apply(command);
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.description().title, test::system("double_pendulum").title);
    EXPECT_EQ(*session.value("g"), 2.0);
    EXPECT_EQ(session.run().options.end_time, 9.0);
    EXPECT_EQ(session.time(), 2.0);
    EXPECT_EQ(session.plotted().list().size(), 1U);
    // A system without a file is opened as an unsaved text.
    const std::string own = (folder.path() / "own.toml").string();
    std::filesystem::copy_file(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_floor.toml", own);
    ASSERT_EQ(folder.run("figure ./own.toml --set e=0.3 --view height --out b.svg").status, 0);
    std::filesystem::remove(own);
    Session other = test::session("ball_on_sine");
    for (const Command& command : session_in(figure, {})) other.apply(command);
    EXPECT_EQ(other.error(), "");
    EXPECT_EQ(other.document().file, "");
    EXPECT_EQ(*other.value("e"), 0.3);
    EXPECT_EQ(other.plotted().list().size(), 1U);
    EXPECT_THROW(session_in(ACHILLES_SOURCE_DIR "/README.md", {}), InputError);
}

}  // namespace
}  // namespace achilles
