// Common input of both surfaces: a function that fills one ImGui frame, options, and user input.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace achilles {

// Called between ImGui::NewFrame() and ImGui::Render(). After an exception from it the surface must not be used.
using FrameFunction = std::function<void()>;

// Options of a surface. They are the same for the window and offscreen, so that both draw the same bytes.
struct SurfaceOptions {
    int width = 1600, height = 1000;  // pixels
    double scale = 1.0;               // of text and strokes
    double text_size = 15.0;          // of the interface, pixels at scale 1
    double figure_text_size = 14.0;   // of figures, pixels at scale 1: their fonts are rasterized at this size
    bool dark = false;                // dark theme
    int curve_fineness = 1;           // 2: curves are drawn at twice the resolution and averaged down; finer, slower
    bool transparent = false;         // pictures stay transparent where nothing was drawn
    std::filesystem::path fonts;      // folder of DejaVuSans.ttf and DejaVuSansMono.ttf
};

// Key codes for is_pressed() (surface/imgui_version.hpp). Letters, digits and space have their uppercase ASCII codes,
// according to the keyboard layout.
namespace key {
constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, remove = 261;
constexpr int right = 262, left = 263, down = 264, up = 265, page_up = 266, page_down = 267, home = 268, end = 269;
constexpr int f1 = 290, f11 = 300, keypad_enter = 335;
constexpr int left_shift = 340, left_control = 341, left_alt = 342, left_super = 343;
constexpr int right_shift = 344, right_control = 345, right_alt = 346, right_super = 347;
}  // namespace key

// User input during one frame.
struct Input {
    double mouse_x = -1e6, mouse_y = -1e6;             // pixels; far away: not over the window
    bool left = false, right = false, middle = false;  // buttons held down
    double wheel = 0.0, wheel_sideways = 0.0;          // clicks since the last frame
    std::vector<int> keys;                             // keys held down
    std::string text;                                  // characters typed since the last frame, UTF-8
};

// Queue of user input, passed to ImGui frame by frame. ImGui 1.86 sees only the state at the start of a frame. A click
// or key press shorter than a frame would be lost, so a second change of the same kind waits for the next frame.

class Events {
 public:
    void mouse_at(double x, double y);
    void mouse_left();                   // the mouse left the window
    void button(int number, bool down);  // 0 left, 1 right, 2 middle
    void wheel(double sideways, double clicks);
    void key(int code, bool down);
    void character(unsigned code_point);
    // Releases all keys and buttons, because the window lost the keyboard focus.
    void release_all();

    bool empty() const { return waiting_.empty(); }
    // True if all pending events are moves of the mouse.
    bool are_moves() const;
    // Input during the next frame. In a text field it contains all pending characters, so that slow frames do not delay
    // typing. Keys with other effects wait for the characters before them.
    Input next(bool is_typing = false);

 private:
    struct InputEvent {
        enum class Kind { mouse, button, wheel, key, character };
        Kind kind;
        int code = 0;
        bool down = false;
        double x = 0.0, y = 0.0;
    };
    void apply(const InputEvent& event);
    bool is_letter(const InputEvent& event) const;

    std::deque<InputEvent> waiting_;
    Input held_;
};

}  // namespace achilles
