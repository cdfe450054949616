// ImGui's setup for both surfaces: its fonts and two themes, without writing files or reading the clock. Differences
// between ImGui versions are in imgui_version.hpp.
#pragma once

#include "figure/palette.hpp"
#include "surface/frame.hpp"

struct ImDrawData;
struct ImFont;
struct ImGuiContext;

namespace achilles {

class Interface {
 public:
    // Throws std::runtime_error if a font is missing.
    explicit Interface(const SurfaceOptions& options);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    // Makes this ImGui's current context during its lifetime. A frame of one surface may draw a picture on another.
    class Active {
     public:
        explicit Active(const Interface& interface);
        ~Active();
        Active(const Active&) = delete;
        Active& operator=(const Active&) = delete;

     private:
        ImGuiContext* before_;
    };
    // Rebuilds fonts and style for this scale. The font texture must be loaded again afterwards.
    void restyle(double scale, bool dark);
    // Runs the draw function for one frame, `seconds` after the last one. Requires an Active object, as do all
    // functions below.
    const ImDrawData& frame(const FrameFunction& draw, int width, int height, double seconds);
    // Background color of the last frame.
    const float (&background() const)[3] { return background_; }

 private:
    void build_fonts(double scale);

    SurfaceOptions options_;
    ImGuiContext* context_ = nullptr;
    float background_[3] = {};
};

// Passes the user's input to ImGui's current context, before a frame.
void apply(const Input& input);

// Sets the theme of the current context. Call it before the first window of a frame.
void use_theme(bool dark);
const Theme& current_theme();

// The font of the current context whose size is closest to `pixels`. Text at the font's own size is sharp.
ImFont* font_for(double pixels);
// The monospaced font for text fields, slightly smaller than the interface's font.
ImFont* monospace_font();

}  // namespace achilles
