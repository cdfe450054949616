// Six user tasks with few actions: what the window shows in each. tests/app/tasks_test.sh performs them in a real
// window, at the positions printed here, and counts the actions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "journal/journal.hpp"
#include "output/output.hpp"
#include "panels/widgets.hpp"

namespace achilles {
namespace {

using test::Hands;

const SurfaceOptions surface = test::surface(1280, 800);

// The number, from 1, of the n-th event of a kind.
int event_number(const Session& session, Event::Kind kind, int n) {
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i)
        if (events[i].kind == kind && --n == 0) return static_cast<int>(i) + 1;
    return 0;
}

// Prints for the script: a name without spaces, the middle, and the size.
void tell(const Hands& hands, const std::string& name, const std::string& place) {
    const Rectangle r = hands.state.places.at(place);
    std::printf("place %s %d %d %d %d\n", name.c_str(), static_cast<int>(r.x + 0.5F * r.width),
                static_cast<int>(r.y + 0.5F * r.height), static_cast<int>(r.width), static_cast<int>(r.height));
}

TEST(Tasks, ATimeAndItsIntervalAreReadWithoutAClick) {
    Hands hands("ball_on_sine", surface);
    const int zeno = event_number(hands.session, Event::Kind::zeno, 2);
    ASSERT_GT(zeno, 0);
    const std::string place = "result " + std::to_string(zeno);
    hands.point(place);
    const EventTime time = event_time(hands.session, static_cast<std::size_t>(zeno - 1));
    EXPECT_FALSE(time.bound.empty());
    EXPECT_TRUE(hands.says("Zeno point at t = " + time.text() + " s")) << hands.letters();
    EXPECT_TRUE(hands.all.empty());
    tell(hands, "zeno", place);
    tell(hands, "mechanism", "mechanism");
}

TEST(Tasks, AReleaseHasItsReasonAfterAClick) {
    Hands hands("ball_on_sine", surface);
    const std::string place = "result " + std::to_string(event_number(hands.session, Event::Kind::release, 1));
    hands.click(place);
    EXPECT_TRUE(hands.says("from here on the surface would have to pull")) << hands.letters();
    tell(hands, "release", place);
}

TEST(Tasks, TwoRunsAreComparedAfterThreeClicksAndANumber) {
    Hands hands("ball_on_sine", surface);
    tell(hands, "pin", "pin");
    tell(hands, "e", "value of set e");
    hands.click("pin");
    hands.double_click("value of set e");
    hands.type("0.3");
    hands.press(key::enter);
    EXPECT_EQ(hands.all, (std::vector<Command>{command::Pin{}, command::Set{"e", 0.3}}));
    ASSERT_EQ(hands.session.pinned().size(), 1U);
    const Trajectory& pinned = *hands.session.pinned()[0].trajectory;
    EXPECT_EQ(pinned.run.parameters[2], 0.5);
    EXPECT_EQ(hands.session.trajectory().run.parameters[2], 0.3);
    hands.rest(3);
    tell(hands, "unpin", "unpin all");
    EXPECT_TRUE(hands.says("Comparison with the pinned run")) << hands.letters();
    EXPECT_TRUE(hands.says("change e 0.3 0.5 Zeno 1")) << hands.letters();
    for (const Trajectory* run : {&pinned, &hands.session.trajectory()})
        for (std::size_t i = 0; i < run->events.size(); ++i)
            if (run->events[i].kind == Event::Kind::zeno) {
                EXPECT_TRUE(hands.says(event_time(*run, i).digits)) << hands.letters();
                break;
            }
}

TEST(Tasks, OnePlotIsSavedAfterTwoClicksAndEnter) {
    const test::Folder folder;
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    for (int time = 1; time <= 2; ++time) {
        Hands hands("ball_on_sine", surface);
        hands.click("menu of plot 2");
        if (time == 1) tell(hands, "plot", "menu of plot 2");
        if (time == 1) tell(hands, "save", "menu Save figure\u2026");
        hands.click("menu Save figure\u2026");
        hands.rest(2);
        const std::string name = hands.state.editor.path;
        EXPECT_EQ(name.rfind(time == 1 ? "ball_on_sine-height.svg" : "ball_on_sine-height-2.svg", 0), 0U) << name;
        EXPECT_TRUE(hands.says("writes to " + folder.path().string() + "/" + name)) << hands.letters();
        hands.all.clear();
        hands.press(key::enter);
        EXPECT_EQ(hands.all, std::vector<Command>{(command::Export{name, false, 2})});
        EXPECT_EQ(hands.session.error(), "");
        EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
        EXPECT_EQ(hands.session.plotted().list().size(), 4U) << "the others stay";
    }
    std::filesystem::current_path(here);
}

TEST(Tasks, AMistakeIsTakenBackAtOnce) {
    Hands hands("ball_on_sine", surface);
    const std::string text = hands.session.document().text, run = to_text(hands.session.trajectory());
    hands.session.apply(command::Show{"editor", true});
    hands.rest(2);
    tell(hands, "text", "text");
    hands.click("text");
    for (const char* letters : {"z", " =", " y"}) {  // with a pause after each: three texts, none valid
        hands.type(letters);
        hands.rest(30);
        ASSERT_FALSE(hands.session.document().problems.empty());
    }
    const std::string wrong = hands.session.document().text;
    ASSERT_EQ(hands.all.size(), 3U);
    EXPECT_FALSE(hands.session.document().problems.empty());
    hands.press_with_control('Z');
    EXPECT_EQ(hands.all.size(), 4U);
    EXPECT_TRUE(hands.session.document().problems.empty());
    EXPECT_EQ(hands.session.document().text, text);
    EXPECT_EQ(hands.state.editor.text, text);
    EXPECT_EQ(to_text(hands.session.trajectory()), run);
    while (hands.session.can_redo()) hands.session.apply(command::Redo{});
    EXPECT_EQ(hands.session.document().text, wrong) << "nothing that was typed is lost";
}

// In a valid text, undo takes back single letters.
TEST(Tasks, UndoInAGoodTextTakesLetters) {
    Hands hands("ball_on_sine", surface);
    hands.session.apply(command::Show{"editor", true});
    hands.rest(2);
    hands.click("text");
    hands.press_with_control(key::end);
    hands.type("#");
    hands.type("a");
    hands.rest(30);
    const std::string text = hands.state.editor.text;
    hands.press_with_control('Z');
    EXPECT_EQ(hands.state.editor.text, text.substr(0, text.size() - 1));
}

// ---- real window ----

// The screen of Xvfb from its file (X window dump, version 7).
Image screen(const std::string& file) {
    const std::string bytes = test::content(file);
    const auto word = [&](std::size_t i) {
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes.at(4 * i + k));
        return std::size_t{value};
    };
    Image image;
    image.width = static_cast<int>(word(4));
    image.height = static_cast<int>(word(5));
    const std::size_t begin = word(0) + 12 * word(19), stride = word(12);
    for (std::size_t y = 0; y < word(5); ++y)
        for (std::size_t x = 0; x < word(4); ++x)
            for (const std::size_t channel : {2U, 1U, 0U})
                image.rgb.push_back(static_cast<std::uint8_t>(bytes.at(begin + y * stride + 4 * x + channel)));
    return image;
}

// Number of differing pixels in an area, except near the mouse pointer, which the screen shows.
int differences(const Image& a, const Image& b, const Rectangle& area, const Input& hand) {
    int count = 0;
    for (int y = static_cast<int>(area.y); y < static_cast<int>(area.y + area.height); ++y)
        for (int x = static_cast<int>(area.x); x < static_cast<int>(area.x + area.width); ++x) {
            if (std::hypot(x - hand.mouse_x, y - hand.mouse_y) < 26.0) continue;
            const auto at = [&](const Image& image) {
                return image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x);
            };
            count += std::equal(at(a), at(a) + 3, at(b)) ? 0 : 1;
        }
    return count;
}

// The area with the result of a task.
Rectangle answer_of(const std::string& task, Hands& hands) {
    const auto& places = hands.state.places;
    const Rectangle low = places.at("splitter events"), side = places.at("splitter plots");
    if (task == "read") return hands.tooltip();
    if (task == "why" || task == "compare") return {low.x, low.y + low.height, low.width, 740.0F - low.y - low.height};
    if (task == "save") return {low.x, 40.0F, side.x - low.x, places.at("timeline").y - 40.0F};
    return {side.x + side.width, 40.0F, 1270.0F - side.x - side.width, low.y - 40.0F};  // the plots
}

// The script saves for every task the screen, the record, and the mouse position.
TEST(TasksOnDisplay, TheWindowAnswersWhatItsRecordSays) {
    const char* given = std::getenv("ACHILLES_TASKS");
    if (given == nullptr) GTEST_SKIP() << "no ACHILLES_TASKS";
    for (const char* task : {"read", "why", "compare", "save", "own", "typo"}) {
        const std::filesystem::path folder = std::filesystem::path(given) / task;
        Hands hands("ball_on_sine", surface);
        SystemSource library = test::library();
        library.exports = false;
        library.folder = std::filesystem::path(given).string();
        library.save = [](Document& document, const std::string& file, bool) { mark_saved(document, file); };
        Session session("ball_on_sine", test::system("ball_on_sine"), library);
        session.prove_behind();  // as in a window
        for (const Command& command : read_journal(folder / "record")) session.apply(command);
        session.settle();
        EXPECT_EQ(session.error(), "") << task;
        EXPECT_TRUE(session.document().problems.empty()) << task;
        std::sscanf(test::content(folder / "mouse").c_str(), "%lf %lf", &hands.hand.mouse_x, &hands.hand.mouse_y);
        PanelState state = test::panels();
        Image expected;
        expected = hands.surface.frame([&] { explorer(session, state); }, 6, hands.hand);
        hands.state = state;
        const Rectangle area =
            std::string(task) == "read" ? [&] { hands.rest(4); return hands.tooltip(); }() : answer_of(task, hands);
        ASSERT_GT(area.width * area.height, 1000.0F) << task;
        ASSERT_LE(area.y + area.height, static_cast<float>(expected.height)) << task << ": it goes beyond the screen";
        const int wrong = differences(screen((folder / "screen").string()), expected, area, hands.hand);
        if (wrong > 0) write_png(expected, folder / "expected.png");
        EXPECT_EQ(wrong, 0) << task << ": of " << area.width << " x " << area.height << " at " << area.x << ", "
                            << area.y;
    }
}

}  // namespace
}  // namespace achilles
