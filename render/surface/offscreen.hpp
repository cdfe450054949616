// Frames without a display: Mesa's software renderer in memory. The only file that knows OSMesa.
#pragma once

#include <memory>

#include "image/image.hpp"
#include "surface/frame.hpp"

namespace achilles {

class Offscreen {
 public:
    // Loads libOSMesa at run time. Throws std::runtime_error naming the package if it is missing, or what is out of limits.
    explicit Offscreen(const SurfaceOptions& options);
    ~Offscreen();
    // Draws `passes` frames (ImGui needs three before windows have settled) with a fixed time step and reads the last.
    Image frame(const FrameFunction& draw, int passes = 1);

 private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace achilles
