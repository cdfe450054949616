// Frames without a display: Mesa's software renderer in memory, by OSMesa or, where that is missing, by EGL. Only
// osmesa.cpp knows OSMesa, only egl.cpp EGL.
#pragma once

#include <memory>

#include "image/image.hpp"
#include "surface/frame.hpp"

namespace achilles {

class Offscreen {
 public:
    // Loads the library at run time. Throws std::runtime_error naming the packages if both are missing, or what is out
    // of limits.
    explicit Offscreen(const SurfaceOptions& options);
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;
    // Draws `passes` frames (ImGui needs three before windows have settled) with a fixed time step and reads the last.
    Image frame(const FrameFunction& draw, int passes = 1);
    // The same with a mouse and a keyboard.
    Image frame(const FrameFunction& draw, int passes, const Input& input);
    // One frame that nobody looks at: everything happens but the drawing of pixels.
    void step(const FrameFunction& draw, const Input& input = {});
    // From the next frame on.
    void restyle(double scale, bool dark);

 private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace achilles
