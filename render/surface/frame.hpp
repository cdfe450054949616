// What both surfaces take: a function that fills one ImGui frame.
#pragma once

#include <filesystem>
#include <functional>

namespace achilles {

// Called between ImGui::NewFrame() and ImGui::Render().
using FrameFunction = std::function<void()>;

// How a surface is set up; the same for the window and offscreen, so that both draw the same bytes.
struct SurfaceOptions {
    int width = 1600, height = 1000;    // pixels
    double scale = 1.0;                 // of text and strokes
    double text_size = 15.0;            // pixels at scale 1
    bool dark = false;                  // ImGui's colours
    std::filesystem::path fonts;        // folder that holds DejaVuSans.ttf
};

}  // namespace achilles
