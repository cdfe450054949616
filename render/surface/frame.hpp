// What both surfaces take: a function that fills one ImGui frame, how they are set up, what a user's hand may do.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace achilles {

// Called between ImGui::NewFrame() and ImGui::Render(). An exception it throws ends the surface's life.
using FrameFunction = std::function<void()>;

// How a surface is set up; the same for the window and offscreen, so that both draw the same bytes.
struct SurfaceOptions {
    int width = 1600, height = 1000;  // pixels
    double scale = 1.0;               // of text and strokes
    double text_size = 15.0;          // pixels at scale 1, of the interface
    double figure_text_size = 14.0;   // pixels at scale 1, of figures: their text is made for this size, not stretched
    bool dark = false;                // ImGui's colours
    int curve_fineness = 1;           // 2: curves are drawn at twice the size and averaged down; finer, slower
    bool transparent = false;         // pictures keep what nothing was drawn on clear
    std::filesystem::path fonts;      // folder that holds DejaVuSans.ttf and DejaVuSansMono.ttf
};

// Keys, as is_pressed (surface/imgui_version.hpp) numbers them. Letters, digits and space are their upper case ASCII
// code, by the user's keyboard layout.
namespace key {
constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, remove = 261;
constexpr int right = 262, left = 263, down = 264, up = 265, page_up = 266, page_down = 267, home = 268, end = 269;
constexpr int f1 = 290, f11 = 300, keypad_enter = 335;
constexpr int left_shift = 340, left_control = 341, left_alt = 342, left_super = 343;
constexpr int right_shift = 344, right_control = 345, right_alt = 346, right_super = 347;
}  // namespace key

// The user's hand during one frame.
struct Input {
    double mouse_x = -1e6, mouse_y = -1e6;             // pixels; far away: not over the window
    bool left = false, right = false, middle = false;  // buttons held down
    double wheel = 0.0, wheel_sideways = 0.0;          // clicks since the last frame
    std::vector<int> keys;                             // keys held down
    std::string text;                                  // characters typed since the last frame, UTF-8
};

}  // namespace achilles
