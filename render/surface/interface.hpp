// ImGui as both surfaces set it up: its fonts, two looks, no file written, no clock read. What depends on
// ImGui's version is in imgui_version.hpp.
#pragma once

#include "figure/palette.hpp"
#include "surface/frame.hpp"

struct ImDrawData;
struct ImFont;
struct ImGuiContext;

namespace achilles {

class Interface {
 public:
    // Throws std::runtime_error if the font is missing.
    explicit Interface(const SurfaceOptions& options);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    // Makes this ImGui's current context for a while: a frame of one surface may draw a picture on another.
    class Active {
     public:
        explicit Active(const Interface& interface);
        ~Active();
        Active(const Active&) = delete;
        Active& operator=(const Active&) = delete;

     private:
        ImGuiContext* before_;
    };
    // Rebuilds fonts and style for this scale; the font texture must be loaded again afterwards.
    void restyle(double scale, bool dark);
    // One frame of the draw function, `seconds` after the last. Must be active, like all that follows from it.
    const ImDrawData& frame(const FrameFunction& draw, int width, int height, double seconds);
    // The colour behind everything in the last frame.
    const float (&background() const)[3] { return background_; }

 private:
    void build_fonts(double scale);

    SurfaceOptions options_;
    ImGuiContext* context_ = nullptr;
    float background_[3] = {};
};

// Hands the user's input to ImGui's current context, before a frame.
void apply(const Input& input);

// From here on everything in the current context has this theme's colours; before a frame's first window.
void use_theme(bool dark);
const Theme& current_theme();

// The font of the current context made for a size nearest to the one asked for: text at that size is sharp.
ImFont* font_for(double pixels);
// The font whose letters are all of one width, for text that is edited, a little smaller than the interface's.
ImFont* monospace_font();

}  // namespace achilles
