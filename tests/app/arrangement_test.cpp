// Layout of the panels: no overlap, none outside the window; all can be hidden and resized.
#include "session/arrangement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/hands.hpp"
#include "image/comparison.hpp"

namespace achilles {
namespace {

using test::Hands;

Measures measures(float width, float height, float unit = 1.0F, float error = 0.0F) {
    Measures m;
    m.width = width;
    m.height = height;
    m.unit = unit;
    m.bar = 32.0F * unit;
    m.status = 30.0F * unit;
    m.timeline = 92.0F * unit;
    m.results = [unit](float) { return 54.0F * unit; };
    m.error = [error](float) { return error; };
    return m;
}

std::vector<std::pair<std::string, Rectangle>> all_of(const Arrangement& a) {
    std::vector<std::pair<std::string, Rectangle>> all{
        {"bar", a.bar},         {"controls", a.controls}, {"error", a.error},       {"mechanism", a.mechanism},
        {"results", a.results}, {"energy", a.energy},     {"timeline", a.timeline}, {"plots", a.plots},
        {"events", a.events},   {"status", a.status},     {"tabs", a.tabs},         {"caption", a.caption}};
    for (const Arrangement::Splitter& splitter : a.splitters) all.emplace_back("splitter", splitter.area);
    std::erase_if(all, [](const auto& part) { return part.second.width < 1.0F || part.second.height < 1.0F; });
    return all;
}

void expect_no_overlap(const Arrangement& arrangement, const Measures& m, const std::string& what) {
    const auto all = all_of(arrangement);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Rectangle& a = all[i].second;
        EXPECT_GE(a.x, 0.0F) << what << all[i].first;
        EXPECT_GE(a.y, 0.0F) << what << all[i].first;
        EXPECT_LE(a.x + a.width, m.width + 0.01F) << what << all[i].first;
        EXPECT_LE(a.y + a.height, m.height + 0.01F) << what << all[i].first;
        for (std::size_t j = 0; j < i; ++j) {
            const Rectangle& b = all[j].second;
            if (all[i].first == "error" || all[j].first == "error") continue;  // in front of the picture
            const bool apart = a.x + a.width <= b.x + 0.01F || b.x + b.width <= a.x + 0.01F ||
                               a.y + a.height <= b.y + 0.01F || b.y + b.height <= a.y + 0.01F;
            EXPECT_TRUE(apart) << what << all[i].first << " covers " << all[j].first;
        }
    }
}

// The energy panel below the results: with its time plot if there is room, without it if there is less, and never at
// the expense of the mechanism.
TEST(Arrangement, HasRoomForTheEnergy) {
    for (const bool presents : {false, true})
        for (const float unit : {1.0F, 1.5F, 2.0F})
            for (float height = 400.0F; height <= 1600.0F; height += 50.0F) {
                Scene scene;
                scene.perform(command::Present{presents});
                Measures m = measures(1366.0F, height, unit);
                const Arrangement without = arrange(scene, m);
                m.energy = 110.0F * unit, m.min_energy = 66.0F * unit;
                const Arrangement parts = arrange(scene, m);
                const std::string what = std::to_string(height) + ", " + std::to_string(unit) + ": ";
                expect_no_overlap(parts, m, what);
                EXPECT_TRUE(parts.energy.height == 0.0F || parts.energy.height == m.energy ||
                            parts.energy.height == m.min_energy)
                    << what;
                if (parts.energy.height > 0.0F) {
                    EXPECT_GE(parts.mechanism.height, 85.0F * unit) << what;
                    EXPECT_EQ(parts.results.height, without.results.height) << what;
                }
                if (height > 1200.0F && unit == 1.0F) {
                    EXPECT_EQ(parts.energy.height, m.energy) << what;
                }
            }
}

// Lecture: the mechanism beside one plot, and the player, at every supported size.
TEST(Arrangement, ShowsAClassWhatItLooksAt) {
    Scene scene;
    scene.perform(command::Present{true});
    EXPECT_DOUBLE_EQ(scene.text_scale(1280, 800), 1.5);
    EXPECT_GT(scene.text_scale(2560, 1440), 2.5) << "as many letters on a large surface as on a small one";
    for (const auto& [width, height, unit] : {std::tuple{1024.0F, 700.0F, 1.5F},
                                              {1366.0F, 768.0F, 1.5F},
                                              {2560.0F, 1440.0F, 1.5F},
                                              {2560.0F, 1440.0F, 3.0F},
                                              {640.0F, 480.0F, 1.5F}}) {
        for (const float error : {0.0F, 120.0F}) {
            const Measures m = measures(width, height, unit, error);
            const Arrangement parts = arrange(scene, m);
            expect_no_overlap(parts, m, "to a class ");
            for (const Rectangle* hidden : {&parts.bar, &parts.controls, &parts.events, &parts.status})
                EXPECT_EQ(hidden->height, 0.0);
            EXPECT_TRUE(parts.splitters.empty());
            EXPECT_GE(parts.mechanism.height, 90.0 * double{unit}) << width << " " << unit;
            EXPECT_NEAR(parts.mechanism.width, parts.plots.width, 0.1 * double{width});
            EXPECT_EQ(parts.error.height, double{error});
            EXPECT_EQ(parts.results.height, 0.0);
        }
    }
    scene.perform(command::Show{"plots", false});
    const Arrangement alone = arrange(scene, measures(1366.0F, 768.0F, 1.5F));
    EXPECT_EQ(alone.plots.width, 0.0);
    EXPECT_GT(alone.mechanism.width, 1300.0);
}

// Studies replace the events, at the same height, and keep that place if the events are hidden.
TEST(Arrangement, StudiesHaveThePlaceOfTheEventsAndMoveNothing) {
    for (const auto& [width, height] : {std::pair{1600.0F, 1000.0F}, {1280.0F, 720.0F}, {640.0F, 480.0F}}) {
        Scene scene;
        scene.perform(command::Show{"events", true});
        const Measures m = measures(width, height);
        const Arrangement before = arrange(scene, m);
        for (const std::string& study : command::studies) {
            scene.perform(command::Show{study, true});
            const auto events = all_of(before), now = all_of(arrange(scene, m));
            ASSERT_EQ(now.size(), events.size()) << study;
            for (std::size_t i = 0; i < now.size(); ++i) {
                EXPECT_EQ(now[i].second.x, events[i].second.x) << study << " " << now[i].first;
                EXPECT_EQ(now[i].second.y, events[i].second.y) << study << " " << now[i].first;
                EXPECT_EQ(now[i].second.width, events[i].second.width) << study << " " << now[i].first;
                EXPECT_EQ(now[i].second.height, events[i].second.height) << study << " " << now[i].first;
            }
        }
        EXPECT_EQ(scene.below(), "proof");
        scene.perform(command::Show{"events", false});
        EXPECT_GT(arrange(scene, m).events.height, 0.0F);
        scene.perform(command::Show{"proof", false});
        EXPECT_EQ(arrange(scene, m).events.height, 0.0F);
    }
}

TEST(Arrangement, NothingCoversAnythingInAnyState) {
    for (const auto& [width, height, unit] : {std::tuple{1280.0F, 800.0F, 1.0F},
                                              {1600.0F, 1000.0F, 1.0F},
                                              {2560.0F, 1600.0F, 2.0F},
                                              {1000.0F, 600.0F, 1.0F}})
        for (int hidden = 0; hidden < 16; ++hidden)
            for (const double share : {0.0, 0.02, 0.5, 0.98})
                for (const float error : {0.0F, 70.0F}) {
                    Scene scene;
                    const char* const panels[] = {"controls", "plots", "events"};
                    for (int i = 0; i < 3; ++i) scene.perform(command::Show{panels[i], (hidden >> i & 1) == 0});
                    scene.perform(command::Show{"editor", (hidden >> 3 & 1) != 0});
                    for (const std::string& panel : command::sized_panels)
                        scene.perform(command::SetPanelSize{panel, share});
                    const Measures m = measures(width, height, unit, error);
                    const Arrangement a = arrange(scene, m);
                    const std::string what = std::to_string(width) + ", hidden " + std::to_string(hidden) + ", share " +
                                             std::to_string(share) + ": ";
                    expect_no_overlap(a, m, what);
                    EXPECT_EQ(a.plots.width >= 1.0F, scene.shows("plots")) << what;
                    EXPECT_EQ(a.events.height >= 1.0F, scene.shows("events")) << what;
                    EXPECT_EQ(a.controls.width >= 1.0F, scene.shows("controls") || scene.shows("editor")) << what;
                    EXPECT_GE(a.mechanism.width, 200.0F * unit) << what;
                    EXPECT_GE(a.mechanism.height, 30.0F * unit) << what;
                }
}

// Below 1000 units of width the panels are tabs: the one shown last is in front, none is narrower than its least width.
TEST(Arrangement, PanelsAreTabsInASmallWindow) {
    struct Surface {
        float width, height, unit;
        bool has_room_beside;  // for a panel beside the mechanism
    };
    for (const Surface& s : {Surface{640, 480, 1, true},
                             {800, 600, 1, true},
                             {960, 540, 1, true},
                             {999, 1200, 1, true},
                             {1280, 720, 2, true},
                             {1280, 480, 1.2F, true},
                             {3840, 900, 3, true},
                             {1280, 720, 3, false},
                             {640, 480, 2, false},
                             {640, 480, 3, false}})
        for (const std::string& panel : command::tabs)
            for (const float error : {0.0F, 70.0F}) {
                Scene scene;
                scene.perform(command::Show{panel, true});
                Measures m = measures(s.width, s.height, s.unit, error);
                m.caption = [error](float) { return error; };
                const Arrangement a = arrange(scene, m);
                const std::string what = std::to_string(s.width) + " x " + std::to_string(s.height) + " at " +
                                         std::to_string(s.unit) + ", " + panel + ", error " + std::to_string(error) +
                                         ": ";
                expect_no_overlap(a, m, what);
                EXPECT_EQ(a.is_alone, !s.has_room_beside) << what;
                const bool is_side = panel == "controls" || panel == "editor" || panel == "plots";
                const bool is_mechanism = panel == "mechanism" && a.is_alone;
                EXPECT_EQ(a.front, panel == "editor" || (panel == "mechanism" && !a.is_alone) ? "controls" : panel)
                    << what;
                EXPECT_GT(a.tabs.width * a.tabs.height, 0.0F) << what;
                // One panel only, and wide enough.
                EXPECT_EQ((a.controls.width > 0.0F) + (a.plots.width > 0.0F) + (a.events.width > 0.0F),
                          is_mechanism ? 0 : 1)
                    << what;
                const float inside = s.width - 20.0F * s.unit;
                for (const Rectangle* one : {&a.controls, &a.plots})
                    EXPECT_TRUE(one->width == 0.0F || one->width >= std::min(240.0F * s.unit, inside)) << what;
                EXPECT_TRUE(panel != "editor" || a.controls.width >= std::min(320.0F * s.unit, inside)) << what;
                EXPECT_TRUE(a.events.width == 0.0F || a.events.width >= inside - 1.0F) << what;
                EXPECT_TRUE(a.mechanism.width == 0.0F || a.mechanism.width >= std::min(340.0F * s.unit, inside))
                    << what;
                if (s.has_room_beside && is_side && panel != "editor" && error == 0.0F) {
                    EXPECT_GT(a.mechanism.height, 80.0F * s.unit) << what;
                    EXPECT_GT(a.timeline.height, 0.0F) << what;
                }
                if (error == 0.0F && s.height >= 480.0F * s.unit && panel != "mechanism") {
                    EXPECT_GE((is_side ? a.controls.height + a.plots.height : a.events.height), 150.0F) << what;
                }
            }
    // Not below: at 1000 units all panels are shown.
    EXPECT_EQ(arrange(Scene(), measures(1000.0F, 700.0F)).front, "");
    EXPECT_EQ(arrange(Scene(), measures(1280.0F, 720.0F)).front, "");
    EXPECT_EQ(arrange(Scene(), measures(2000.0F, 1400.0F, 2.0F)).front, "");
    // A hidden panel makes room for another one.
    Scene scene;
    scene.perform(command::Show{"controls", false});
    EXPECT_EQ(arrange(scene, measures(640.0F, 480.0F)).front, "plots");
    scene.perform(command::Show{"plots", false});
    EXPECT_EQ(arrange(scene, measures(640.0F, 480.0F)).front, "events");
    scene.perform(command::Show{"events", false});
    const Arrangement alone = arrange(scene, measures(640.0F, 480.0F));
    EXPECT_EQ(alone.front, "mechanism");
    EXPECT_EQ(alone.mechanism.width, 620.0F);
}

// The tabs are pressed, keys bring a panel to the front and back, and the recipe of the session leads to the same one.
TEST(Panels, AreChosenByTabsInASmallWindow) {
    Hands hands("ball_on_sine", test::surface(640, 480));
    EXPECT_GE(hands.state.places.at("set g").width, 80.0F);
    EXPECT_GE(hands.state.places.at("systems").width, 150.0F);
    EXPECT_FALSE(hands.state.places.contains("switch Plots"));
    EXPECT_FALSE(hands.state.places.contains("plot 1"));
    hands.click("tab plots");
    EXPECT_EQ(hands.all, std::vector<Command>{(command::Show{"plots", true})});
    EXPECT_TRUE(hands.state.places.contains("plot 1"));
    hands.press_with_control('3');
    EXPECT_TRUE(hands.state.places.contains("impacts 1"));
    EXPECT_TRUE(hands.state.places.contains("copy events")) << "the buttons of the list, on a line of their own";
    const Rectangle list = hands.state.places.at("impacts 1"), button = hands.state.places.at("copy events");
    EXPECT_LE(button.y + button.height, list.y);
    Scene replayed;
    for (const Command& step : steps_to(hands.session.scene()))
        if (const auto* show = std::get_if<command::Show>(&step)) replayed.perform(*show);
    EXPECT_EQ(replayed.front(), "events");
    EXPECT_EQ(to_text(replayed), to_text(hands.session.scene()));
    hands.press_with_control('4');
    EXPECT_EQ(hands.state.front, "sweep");
    hands.click("tab events");
    EXPECT_EQ(hands.session.scene().below(), "events");
    EXPECT_EQ(hands.state.front, "events");
    hands.press_with_control('3');
    EXPECT_EQ(hands.state.front, "controls") << "again the mechanism, and what is beside it";
    EXPECT_THROW(Scene().perform(command::Show{"mechanism", false}), InputError);
    // Without room for the titles: a menu of tabs.
    Hands large("ball_on_sine", test::surface(1280, 720, 3.0));
    EXPECT_EQ(large.state.front, "mechanism");
    EXPECT_FALSE(large.state.places.contains("tab plots"));
    large.click("tabs");
    large.click("tab plots");
    EXPECT_EQ(large.state.front, "plots");
}

TEST(Arrangement, AWindowTooSmallForAnythingHasNoNegativePart) {
    for (const float width : {1.0F, 60.0F, 300.0F})
        for (const float height : {1.0F, 40.0F, 200.0F}) {
            const Arrangement a = arrange(Scene(), measures(width, height));
            for (const Rectangle& r : {a.controls, a.mechanism, a.results, a.timeline, a.plots, a.events}) {
                EXPECT_GE(r.width, 0.0F);
                EXPECT_GE(r.height, 0.0F);
            }
        }
}

// An error message must not make the configuration plane too low: it is in front of it.
TEST(Arrangement, ThePlaneIsNeverTooLow) {
    for (const auto& [width, height] : {std::pair{1280.0F, 800.0F}, {1024.0F, 700.0F}, {1000.0F, 600.0F}})
        for (const float error : {0.0F, 60.0F, 130.0F, 200.0F}) {
            Scene scene;
            const Measures m = measures(width, height, 1.0F, error);
            const Arrangement without = arrange(scene, m);
            scene.perform(command::Show{"plane", true});
            const Arrangement a = arrange(scene, m);
            const std::string what = std::to_string(height) + ", error " + std::to_string(error) + ": ";
            expect_no_overlap(a, m, what);
            EXPECT_GE(a.mechanism.height, 230.0F) << what;
            EXPECT_GE(without.mechanism.height, 90.0F) << what;
            EXPECT_EQ(a.error.height, error) << what << "all of the message is seen";
            // A message moves nothing.
            const Arrangement quiet = arrange(scene, measures(width, height));
            for (const auto& [with, bare] : {std::pair{&a.mechanism, &quiet.mechanism}, {&a.plots, &quiet.plots}}) {
                EXPECT_EQ(with->y, bare->y) << what;
                EXPECT_EQ(with->height, bare->height) << what;
            }
        }
    for (const auto& [width, height] : {std::pair{1280, 800}, {900, 600}}) {
        Hands hands("double_pendulum", test::surface(width, height));
        for (const char* line : {"show plane", "set e 7"}) hands.session.apply(parse_command(line));
        hands.rest(3);
        ASSERT_NE(hands.session.error(), "");
        ASSERT_TRUE(hands.state.places.contains("plane")) << height;
        EXPECT_GE(hands.state.places.at("plane").height, 60.0F) << height;
    }
    Scene scene;
    const Arrangement a = arrange(scene, measures(1600.0F, 1000.0F, 1.0F, 70.0F));
    EXPECT_EQ(a.error.x, a.mechanism.x);
    EXPECT_EQ(a.error.y, a.mechanism.y);
}

// The message comes after other windows were made, and is seen nevertheless.
TEST(Arrangement, AMessageIsInFrontOfThePicture) {
    Hands hands("ball_on_sine");
    hands.rest(3);
    const Rectangle before = hands.state.places.at("mechanism");
    hands.session.apply(parse_command("set e 7"));
    ASSERT_NE(hands.session.error(), "");
    hands.rest(3);
    EXPECT_EQ(hands.state.places.at("mechanism").y, before.y);
    EXPECT_EQ(hands.state.places.at("mechanism").height, before.height);
    const ImGuiWindow *message = nullptr, *picture = nullptr;
    int at = 0, message_at = 0, picture_at = 0;
    hands.surface.step(
        [&] {
            explorer(hands.session, hands.state);
            for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
                if (window->Name == std::string("error")) message = window, message_at = at;
                if (window->Name == std::string("mechanism")) picture = window, picture_at = at;
                ++at;
            }
        },
        hands.hand);
    ASSERT_NE(message, nullptr);
    ASSERT_NE(picture, nullptr);
    EXPECT_GT(message_at, picture_at);
    EXPECT_GT(message->Size.y, 20.0F);
    EXPECT_TRUE(message->Active);
}

TEST(Arrangement, ASplitterGivesTheShareThatPutsItWhereTheHandIs) {
    for (const char* panel : {"controls", "plots", "events"}) {
        Scene scene;
        const Measures m = measures(1600, 1000);
        for (const Arrangement::Splitter& splitter : arrange(scene, m).splitters) {
            if (splitter.panel != panel) continue;
            const double x = splitter.area.x + 0.5 * splitter.area.width + 40.0;
            const double y = splitter.area.y + 0.5 * splitter.area.height - 30.0;
            scene.perform(command::SetPanelSize{panel, splitter.share_at(x, y)});
            for (const Arrangement::Splitter& now : arrange(scene, m).splitters) {
                if (now.panel != panel) continue;
                if (now.moves_sideways)
                    EXPECT_NEAR(now.area.x + 0.5 * now.area.width, x, 1.5) << panel;
                else
                    EXPECT_NEAR(now.area.y + 0.5 * now.area.height, y, 1.5) << panel;
            }
        }
    }
}

TEST(Panels, AreHiddenAndShownFromTheBarTheMenuAndTheKeyboard) {
    Hands hands("ball_on_sine");
    hands.click("switch Plots");
    EXPECT_EQ(hands.all, std::vector<Command>{(command::Show{"plots", false})});
    hands.state.places.clear();
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.contains("plot 1"));
    EXPECT_TRUE(hands.state.places.contains("set g"));
    hands.click("bar View");
    hands.click("menu Controls");
    hands.state.places.clear();
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.contains("set g"));
    EXPECT_TRUE(hands.state.places.contains("impacts 1"));
    hands.press_with_control('3');
    hands.state.places.clear();
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.contains("impacts 1"));
    EXPECT_TRUE(hands.state.places.contains("mechanism"));
    const Rectangle alone = hands.state.places.at("mechanism");
    EXPECT_GT(alone.width, 1200.0F);
    for (const char* panel : {"Controls", "Plots", "Events"}) hands.click(std::string("switch ") + panel);
    EXPECT_TRUE(hands.state.places.contains("plot 1"));
    EXPECT_TRUE(hands.state.places.contains("impacts 1"));
    EXPECT_LT(hands.state.places.at("mechanism").width, 0.5F * alone.width);
    Session fresh = test::session("ball_on_sine");
    fresh.apply(command::Show{"events", true});  // shown last
    EXPECT_EQ(to_text(hands.session), to_text(fresh));
}

TEST(Panels, AreResizedByTheGapBesideThem) {
    Hands hands("ball_on_sine");
    for (const auto& [panel, dx, dy] :
         {std::tuple{"controls", 60.0, 0.0}, std::tuple{"plots", 50.0, 0.0}, std::tuple{"events", 0.0, -70.0}}) {
        const std::string name = std::string("splitter ") + panel;
        const Rectangle before = hands.state.places.at(name);
        hands.all.clear();
        hands.point(name);
        hands.hand.left = true;
        hands.rest(1);
        for (int i = 0; i < 5; ++i) {
            hands.hand.mouse_x += dx / 5.0;
            hands.hand.mouse_y += dy / 5.0;
            hands.rest(1);
        }
        hands.rest(1);
        hands.hand.left = false;
        hands.rest(2);
        ASSERT_GE(hands.all.size(), 3U) << panel;
        EXPECT_EQ(to_text(hands.all.back()).rfind(std::string("size ") + panel, 0), 0U) << to_text(hands.all.back());
        const Rectangle after = hands.state.places.at(name);
        EXPECT_NEAR(after.x - before.x, dx, 2.0) << panel;
        EXPECT_NEAR(after.y - before.y, dy, 2.0) << panel;
    }
    // The recorded journal leads to the same sizes; resizing is not an undo step.
    EXPECT_FALSE(hands.session.can_undo());
    Session replayed = test::session("ball_on_sine");
    for (const char* panel : {"controls", "plots", "events"})
        replayed.apply(command::SetPanelSize{panel, hands.session.scene().share(panel)});
    EXPECT_EQ(to_text(replayed), to_text(hands.session));
    // A double click on the gap restores the automatic size.
    hands.point("splitter plots");
    for (int i = 0; i < 2; ++i) {
        hands.hand.left = true;
        hands.rest(1);
        hands.hand.left = false;
        hands.rest(1);
    }
    EXPECT_EQ(hands.session.scene().share("plots"), 0.0);
}

TEST(Theme, IsChosenInTheWindowAndChangesPlotsAndPanels) {
    Hands hands("ball_on_sine");
    const Image light = hands.picture();
    hands.click("switch theme");
    EXPECT_EQ(hands.all, std::vector<Command>{command::SetTheme{true}});
    EXPECT_TRUE(hands.session.theme().dark);
    const Color hybrid = phase_color(dark_theme(), Phase::Kind::hybrid);
    EXPECT_EQ(hands.session.plots()[0].curves[0].stroke.color, hybrid);
    hands.hand = {};
    const Image dark = hands.picture();
    EXPECT_GT(worst_tile(light, dark), 0.5);
    // The whole window: no corner keeps the light background.
    for (const auto& [x, y] :
         {std::pair{1, 1}, std::pair{1278, 1}, std::pair{1, 798}, std::pair{1278, 798}, std::pair{286, 400}}) {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * 1280 + static_cast<std::size_t>(x));
        EXPECT_LT(int{dark.rgb[at]}, 80) << x << ", " << y;
    }
    hands.press_with_control('D');
    EXPECT_FALSE(hands.session.theme().dark);
    hands.hand = {};
    EXPECT_EQ(hands.picture(), light);
}

TEST(Theme, IsPartOfTheJournalButNoChangeOfTheSystem) {
    Session session = test::session("ball_on_sine");
    session.apply(parse_command("theme dark"));
    EXPECT_FALSE(session.can_undo());
    EXPECT_NE(to_text(session).find("theme dark\n"), std::string::npos);
    // So do plots made later.
    session.apply(parse_command("set g 2"));
    EXPECT_EQ(session.plots()[0].curves[0].stroke.color, phase_color(dark_theme(), Phase::Kind::hybrid));
    session.apply(parse_command("open double_pendulum"));
    EXPECT_EQ(session.plots()[0].curves[0].stroke.color, phase_color(dark_theme(), Phase::Kind::hybrid));
}

}  // namespace
}  // namespace achilles
