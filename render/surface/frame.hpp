// What both surfaces take: a function that fills one ImGui frame, how they are set up, what a user's hand may do.
#pragma once

#include <deque>
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

// What the user's hands did, in order, handed to ImGui a frame at a time. ImGui 1.86 sees only the state at the start
// of a frame: a click or key shorter than a frame would be lost, so a second change of the same kind waits for the
// next.

class Events {
 public:
    void mouse_at(double x, double y);
    void mouse_left();                   // left the window
    void button(int number, bool down);  // 0 left, 1 right, 2 middle
    void wheel(double sideways, double clicks);
    void key(int code, bool down);
    void character(unsigned code_point);
    // Nothing is held any more: the window lost the keyboard.
    void release_all();

    bool empty() const { return waiting_.empty(); }
    // The hand during the next frame. While somebody is typing, all the letters that have come are in it: a slow frame
    // must not fall behind the hand. Keys that do something else wait for the letters before them.
    Input next(bool is_typing = false);

 private:
    struct Event {
        enum class Kind { mouse, button, wheel, key, character };
        Kind kind;
        int code = 0;
        bool down = false;
        double x = 0.0, y = 0.0;
    };
    void apply(const Event& event);
    bool is_letter(const Event& event) const;

    std::deque<Event> waiting_;
    Input held_;
};

}  // namespace achilles
