// A desktop window. The only file that knows GLFW.
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
    // Asked whenever the window is to be closed; if it says no, the window stays.
    void on_close(std::function<bool()> may_close);
    // false: nothing moves by itself, so after a few frames the window sleeps until the user does something, or where
    // `pause` is positive so many seconds at most. true at first.
    void keep_drawing(bool moving, double pause = 0.0);
    // For a draw function that has changed what it shows after it drew it: some more frames follow, as after an event.
    void draw_again();
    // Wakes a sleeping window, which draws some frames; the only member that another thread may call.
    static void wake();
    // From the next frame on; `scale` comes on top of what the monitor asks for.
    void restyle(double scale, bool dark);
    void set_title(const std::string& title);
    // The last frame as it was drawn, before the window system touched it.
    Image picture();
    // Files dropped on the window since the last call.
    std::vector<std::string> dropped();

    static bool display_available();

 private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace achilles
