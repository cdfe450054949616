// Frames without a display: Mesa's software renderer in memory, via OSMesa or, if that is missing, EGL. Only
// memory_context.cpp uses OSMesa, only egl.cpp uses EGL.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "image/image.hpp"
#include "surface/frame.hpp"

namespace achilles {

// ---- memory for libraries that abort the process if an allocation fails ----

// Out of memory, with a message.
class NotEnoughMemory : public std::bad_alloc {
 public:
    explicit NotEnoughMemory(std::string sentence) : sentence_(std::move(sentence)) {}
    const char* what() const noexcept override { return sentence_.c_str(); }

 private:
    std::string sentence_;
};

// Throws NotEnoughMemory if the memory limit of the process (ulimit -v) does not leave room for this many more bytes.
// Mesa and LLVM would crash with a segmentation fault instead. Nothing stays reserved.
void check_room(const std::string& purpose, std::size_t bytes);

class Offscreen {
 public:
    // Loads the library at run time. Throws std::runtime_error with the names of the packages if both are missing, or
    // if an option is out of range.
    explicit Offscreen(const SurfaceOptions& options);
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;
    // Draws `passes` frames with a fixed time step and reads the last one. ImGui needs three frames until windows have
    // settled.
    Image frame(const FrameFunction& draw, int passes = 1);
    // The same with mouse and keyboard input.
    Image frame(const FrameFunction& draw, int passes, const Input& input);
    // Runs one frame without rendering its pixels.
    void step(const FrameFunction& draw, const Input& input = {});
    // Takes effect from the next frame on.
    void restyle(double scale, bool dark);

 private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace achilles
