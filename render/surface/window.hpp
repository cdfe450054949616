// A desktop window. The only file that knows GLFW.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "surface/frame.hpp"

namespace achilles {

class Window {
 public:
    // Throws std::runtime_error if there is no display or no OpenGL 3.3.
    Window(const SurfaceOptions& options, const std::string& title);
    ~Window();
    // Draws frames until the user closes the window or close() is called.
    void run(const FrameFunction& draw);
    void close();
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
