// Frames without a display: Mesa's software renderer in memory, by OSMesa or, where that is missing, by EGL. Only
// memory_context.cpp knows OSMesa, only egl.cpp EGL.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "image/image.hpp"
#include "surface/frame.hpp"

namespace achilles {

// Memory for libraries that end the process where the system refuses them any.

// There is not enough memory, in a sentence.
class NotEnoughMemory : public std::bad_alloc {
 public:
    explicit NotEnoughMemory(std::string sentence) : sentence_(std::move(sentence)) {}
    const char* what() const noexcept override { return sentence_.c_str(); }

 private:
    std::string sentence_;
};

// Throws NotEnoughMemory where the process may not have so many bytes more, by its limit of memory (ulimit -v): Mesa and LLVM
// would end it by a segmentation fault. Nothing stays reserved.
void check_room(const std::string& purpose, std::size_t bytes);

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
