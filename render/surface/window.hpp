// A desktop window. window.cpp is the only file that uses GLFW.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "surface/frame.hpp"

namespace achilles {

class Window {
 public:
    // Throws std::runtime_error if there is no display or no OpenGL 3.3. The window is no larger than the monitor.
    Window(const SurfaceOptions& options, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    // Draws frames until the user closes the window or close() is called.
    void run(const FrameFunction& draw);
    void close();
    // Called whenever the window is about to close. If it returns false, the window stays open.
    void on_close(std::function<bool()> may_close);
    // `moving` false: nothing changes by itself, so the window sleeps after a few frames until user input, or for at
    // most `pause` seconds if that is positive. Initially true.
    void keep_drawing(bool moving, double pause = 0.0);
    // Called by a draw function that has changed its content after drawing it: what it drew is not shown, it is called
    // again at once, and some more frames follow.
    void draw_again();
    // Wakes a sleeping window, which then draws some frames. The only member function that other threads may call.
    static void wake();
    // Takes effect from the next frame on; `scale` multiplies the scale of the monitor.
    void restyle(double scale, bool dark);
    // Covers the whole monitor, or returns to the size before.
    void fill_screen(bool full);
    void set_title(const std::string& title);
    // The window system shows the icon of the best size. Wayland ignores them.
    void set_icons(const std::vector<Image>& icons);
    // The last frame as drawn, before the window system could change it.
    Image picture();
    // Files dropped onto the window since the last call.
    std::vector<std::string> dropped();

    static bool display_available();

 private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace achilles
