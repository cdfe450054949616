#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "paint/paint.hpp"
#include "render/samples.hpp"
#include "render/support.hpp"
#include "surface/curves.hpp"
#include "surface/frame.hpp"
#include "surface/imgui_version.hpp"
#include "surface/memory_context.hpp"
#include "surface/window.hpp"

namespace achilles {
namespace {

// A figure, a mechanism and widgets.
void everything() {
    paint(samples::figure(2), ImGui::GetBackgroundDrawList(), {0, 0, 600, 250});
    paint(samples::mechanism(), ImGui::GetBackgroundDrawList(), {300, 250, 300, 150});
    ImGui::SetNextWindowPos({10, 260});
    ImGui::SetNextWindowSize({250, 120});
    ImGui::Begin("panel");
    static float value = 0.5F;
    ImGui::SliderFloat("\u03b8\u2081", &value, 0.0F, 1.0F);
    ImGui::Button("press");
    ImGui::End();
}

template <class Action>
std::string complaint(const Action& action) {
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(Offscreen, DrawsTheSameBytesEveryTime) {
    Offscreen a(support::options());
    const Image first = a.frame(everything, 3);
    EXPECT_EQ(a.frame(everything), first);
    Offscreen b(support::options());
    EXPECT_EQ(b.frame(everything, 3), first);
}

TEST(Offscreen, DrawsTheSameBytesByOsmesaAndByEgl) {
    if (const std::string missing = complaint([] { LoadedLibrary("libOSMesa.so.8"); }); !missing.empty())
        GTEST_SKIP() << missing << ": Mesa has dropped it";
    std::vector<Image> images;
    for (const char* library : {"osmesa", "egl", "osmesa"}) {
        setenv("ACHILLES_OFFSCREEN", library, 1);
        SurfaceOptions options = support::options();
        options.curve_fineness = 2;
        Offscreen surface(options);
        images.push_back(surface.frame(everything, 3));
    }
    unsetenv("ACHILLES_OFFSCREEN");
    EXPECT_EQ(images[0], images[1]);
    EXPECT_EQ(images[0], images[2]);
}

TEST(Offscreen, KnowsNoOtherLibrary) {
    setenv("ACHILLES_OFFSCREEN", "mesa", 1);
    EXPECT_EQ(complaint([] { Offscreen(support::options()); }), "ACHILLES_OFFSCREEN must be osmesa or egl, not 'mesa'");
    unsetenv("ACHILLES_OFFSCREEN");
}

TEST(Offscreen, KeepsClearWhatNothingWasDrawnOn) {
    SurfaceOptions options = support::options(200, 100);
    options.transparent = true;
    Offscreen surface(options);
    const Image image = surface.frame([] {
        ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, {50, 100}, IM_COL32(200, 100, 50, 255));
        ImGui::GetBackgroundDrawList()->AddRectFilled({50, 0}, {100, 100}, IM_COL32(200, 100, 50, 128));
    });
    ASSERT_EQ(image.alpha.size(), 20000u);
    EXPECT_EQ(image.alpha[10], 255);
    EXPECT_EQ(image.alpha[60], 128);
    EXPECT_EQ(image.alpha[150], 0);
    for (const std::size_t x : {10U, 60U}) {
        EXPECT_NEAR(image.rgb[3 * x], 200, 1);
        EXPECT_NEAR(image.rgb[3 * x + 1], 100, 1);
        EXPECT_NEAR(image.rgb[3 * x + 2], 50, 1);
    }
    EXPECT_EQ(png_bytes(image).at(25), 6);  // color type: RGBA
}

TEST(Offscreen, DrawsTheSameBytesWithAnyNumberOfThreads) {
    const char* before = std::getenv("LP_NUM_THREADS");
    const std::string kept = before != nullptr ? before : "";
    std::vector<Image> images;
    for (const char* threads : {"0", "1", "2"}) {
        setenv("LP_NUM_THREADS", threads, 1);
        Offscreen surface(support::options());
        images.push_back(surface.frame(everything, 3));
    }
    before != nullptr ? setenv("LP_NUM_THREADS", kept.c_str(), 1) : unsetenv("LP_NUM_THREADS");
    EXPECT_EQ(images[0], images[1]);
    EXPECT_EQ(images[0], images[2]);
}

TEST(Offscreen, SaysWhatItCannotDo) {
    SurfaceOptions options = support::options();
    options.fonts = "/nowhere";
    EXPECT_NE(complaint([&] { Offscreen surface(options); }).find("fonts-dejavu-core"), std::string::npos);
    for (const int width : {0, -5, 20000})
        EXPECT_NE(complaint([&] { Offscreen surface(support::options(width, 100)); }).find("16384"), std::string::npos);
    EXPECT_NE(complaint([&] { Offscreen surface(support::options(100, 100, 0.0)); }).find("scale"), std::string::npos);
}

TEST(Offscreen, DrawsPicturesAsLargeAsTheLimit) {
    Offscreen surface(support::options(16384, 40));
    const Image image = support::picture(surface, [](ImDrawList* list) {
        add_curve(list, {{0, 20}, {16384, 20}}, {{0, 0, 0, 255}, 4.0, {}});
    });
    EXPECT_EQ(support::darkness(image, 16380, 20), 255);
}

TEST(Offscreen, TakesAMouseAndAKeyboard) {
    Offscreen surface(support::options());
    float value = 0.0F;
    std::string typed(20, '\0');
    bool space = false;
    const auto draw = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 200});
        ImGui::Begin("panel");
        ImGui::SetNextItemWidth(300.0F);
        ImGui::SliderFloat("s", &value, 0.0F, 1.0F);
        ImGui::InputText("name", typed.data(), typed.size());
        space = space || is_pressed(' ');
        ImGui::End();
    };
    Input hand;
    hand.mouse_x = 20.0;
    hand.mouse_y = 45.0;
    surface.step(draw, hand);
    surface.step(draw, hand);
    hand.left = true;
    surface.step(draw, hand);
    hand.mouse_x = 160.0;
    surface.step(draw, hand);
    EXPECT_NEAR(value, 0.5F, 0.05F);
    hand.left = false;
    surface.step(draw, hand);
    hand.mouse_y = 75.0;
    surface.step(draw, hand);
    hand.left = true;
    surface.step(draw, hand);
    hand.left = false;
    surface.step(draw, hand);
    hand.text = "x\u03b8";
    surface.step(draw, hand);
    EXPECT_STREQ(typed.c_str(), "x\u03b8");
    hand.text.clear();
    hand.keys = {' '};
    surface.step(draw, hand);
    EXPECT_TRUE(space);
}

TEST(Offscreen, RestylesBetweenFrames) {
    Offscreen surface(support::options());
    const Image light = surface.frame(everything, 3);
    surface.restyle(1.0, true);
    EXPECT_GT(worst_tile(surface.frame(everything, 3), light), 0.3);
    surface.restyle(1.0, false);
    EXPECT_EQ(surface.frame(everything, 3), light);
}

TEST(Events, AClickWithinAFrameIsSeen) {
    Events events;
    events.mouse_at(3, 4);
    events.button(0, true);
    events.button(0, false);
    events.key('A', true);
    events.key('A', false);
    events.character(0x3b8);
    const Input first = events.next();
    EXPECT_TRUE(first.left);
    EXPECT_EQ(first.mouse_x, 3.0);
    EXPECT_FALSE(events.empty());
    const Input second = events.next();
    EXPECT_FALSE(second.left);
    EXPECT_EQ(second.keys, std::vector<int>{'A'});
    const Input third = events.next();
    EXPECT_TRUE(third.keys.empty());
    EXPECT_EQ(third.text, "\u03b8");
    EXPECT_TRUE(events.empty());
}

TEST(Events, ASlowFrameKeepsUpWithTypingAndKeepsItsOrder) {
    Events events;
    const auto press = [&](int code, const char* text) {
        events.key(code, true);
        for (; *text != '\0'; ++text) events.character(static_cast<unsigned char>(*text));
        events.key(code, false);
    };
    press('A', "a");
    press('B', "b");
    events.key(key::left_shift, true);
    press('C', "C");
    events.key(key::left_shift, false);
    press(key::left, "");  // acts on the text typed before it only
    press('D', "d");
    events.key(key::left_control, true);
    press('S', "");
    events.key(key::left_control, false);
    press('E', "e");
    events.button(0, true);  // and so does a click
    press('F', "f");
    std::vector<std::string> texts;
    std::vector<std::vector<int>> keys;
    while (!events.empty()) {
        const Input input = events.next(true);
        texts.push_back(input.text);
        keys.push_back(input.keys);
    }
    std::string all;
    for (const std::string& text : texts) all += text;
    EXPECT_EQ(all, "abCdef");
    EXPECT_EQ(texts[0], "abC");
    EXPECT_EQ(keys[1], std::vector<int>{key::left});
    EXPECT_EQ(texts[1], "");
    const auto with_control = std::find(keys.begin(), keys.end(), std::vector<int>{key::left_control, 'S'});
    ASSERT_NE(with_control, keys.end()) << "Ctrl+S is seen";
    EXPECT_EQ(texts[static_cast<std::size_t>(with_control - keys.begin())], "");
    EXPECT_EQ(texts.back(), "f") << "after the click";
    EXPECT_LT(texts.size(), 12U);
}

class WindowOnDisplay : public testing::Test {
 protected:
    void SetUp() override {
        if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no DISPLAY";
    }
};

TEST_F(WindowOnDisplay, AWindowDrawsTheBytesOfOffscreen) {
    Offscreen surface(support::options());
    const Image expected = surface.frame(everything, 3);
    Window window(support::options(), "achilles");
    int frames = 0;
    window.run([&] {
        everything();
        if (++frames == 3) window.close();
    });
    const Image shown = window.picture();
    EXPECT_EQ(shown.width, expected.width);
    EXPECT_EQ(worst_tile(shown, expected), 0.0);
    EXPECT_EQ(shown, expected);
    // One thread, two kinds of context, alternating.
    EXPECT_EQ(surface.frame(everything, 3), expected);
    EXPECT_EQ(window.picture(), expected);
}

TEST_F(WindowOnDisplay, AFrameMayDrawAPictureOffscreen) {
    Offscreen surface(support::options());
    const Image expected = surface.frame(everything, 3);
    Window window(support::options(), "achilles");
    int frames = 0;
    Image inner;
    window.run([&] {
        ImGui::Begin("outer");
        if (++frames == 2) inner = surface.frame(everything, 3);
        ImGui::End();
        if (frames == 3) window.close();
    });
    EXPECT_EQ(inner, expected);
    EXPECT_EQ(window.picture().width, 600);
}

TEST_F(WindowOnDisplay, AWindowThatRestsStillWakes) {
    Window window(support::options(200, 100), "achilles");
    window.keep_drawing(false);
    int frames = 0;
    window.run([&] {
        Window::wake();
        if (++frames == 10) window.close();
    });
    EXPECT_EQ(frames, 10);
    EXPECT_TRUE(window.dropped().empty());
}

// An idle window draws nothing until it is woken, even while a text field is active.
TEST_F(WindowOnDisplay, AWindowThatRestsDrawsNothing) {
    Window window(support::options(200, 100), "achilles");
    window.keep_drawing(false);
    int frames = 0, when_woken = 0;
    std::atomic<bool> is_over = false;
    char letters[8] = "";
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(2500));
        is_over = true;
        Window::wake();
    });
    window.run([&] {
        ImGui::SetKeyboardFocusHere();
        ImGui::InputText("letters", letters, sizeof letters);
        ++frames;
        if (!is_over) when_woken = frames;
        if (is_over) window.close();
    });
    later.join();
    // A few frames to settle after the window appeared; drawing twice a second would give more.
    EXPECT_LE(when_woken, 12);
}

TEST(Window, WithoutADisplayThereIsAMessage) {
    const char* before = std::getenv("DISPLAY");
    const std::string kept = before != nullptr ? before : "";
    unsetenv("DISPLAY");
    EXPECT_FALSE(Window::display_available());
    EXPECT_NE(complaint([] { Window window(support::options(), "achilles"); }).find("window"), std::string::npos);
    if (before != nullptr) setenv("DISPLAY", kept.c_str(), 1);
}

TEST(LoadedLibrary, NamesItselfAndWhatItLacks) {
    EXPECT_EQ(complaint([] { LoadedLibrary("libnone.so.1"); }), "libnone.so.1 is missing");
    const LoadedLibrary library("libm.so.6");
    double (*cosine)(double) = nullptr;
    library.find("cos", cosine);
    EXPECT_EQ(cosine(0.0), 1.0);
    EXPECT_EQ(complaint([&] { library.find("no_such_function", cosine); }), "libm.so.6 lacks no_such_function");
}

}  // namespace
}  // namespace achilles
