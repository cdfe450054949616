// Shared by the rendering tests.
#pragma once

#include <imgui.h>

#include "image/comparison.hpp"
#include "surface/offscreen.hpp"

namespace achilles::support {

inline SurfaceOptions options(int width = 600, int height = 400, double scale = 1.0) {
    SurfaceOptions result;
    result.width = width;
    result.height = height;
    result.scale = scale;
    result.fonts = ACHILLES_BINARY_DIR "/assets/fonts";
    return result;
}

// Draws on the background draw list, on white.
template <class Draw>
Image picture(Offscreen& surface, const Draw& draw) {
    return surface.frame([&] {
        ImDrawList* list = ImGui::GetBackgroundDrawList();
        list->AddRectFilled({0.0F, 0.0F}, ImGui::GetIO().DisplaySize, IM_COL32_WHITE);
        draw(list);
    });
}

inline int darkness(const Image& image, int x, int y) {
    const auto at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
    return 255 - image.rgb[at];
}

}  // namespace achilles::support
