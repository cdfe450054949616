// Draws ImGui's draw data into its own framebuffer, so that a window, an image and a test get the same bytes.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "surface/curves.hpp"
#include "surface/damage.hpp"
#include "surface/gl.hpp"

struct ImDrawCmd;
struct ImDrawData;
struct ImDrawList;

namespace achilles {

// One per OpenGL context, which must be current for every member call including the destructor.
class Canvas {
 public:
    // `curve_fineness`: see CurvePainter.
    Canvas(const AddressFunction& address_of, int curve_fineness);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    // Uploads the font atlas of the current ImGui context. Call it again after the atlas was rebuilt.
    void load_fonts();
    // Draws the frame on an opaque color, or on transparency: of a frame after another one only what differs. Throws
    // std::runtime_error if the frame is too large.
    void draw(const ImDrawData& data, const float (&clear)[3]);
    void draw_over_nothing(const ImDrawData& data);
    // The last frame; with its alpha channel if `transparent`.
    Image read(bool transparent = false) const;
    // Copies the last frame to the default framebuffer of the context, which a window shows.
    void show() const;
    // Whether the last frame differed from the one before.
    bool has_changed() const { return has_changed_; }
    // The number of pixels that were drawn again since the beginning, for tests and measurements.
    long drawn_pixels() const { return drawn_pixels_; }

 private:
    void draw_over(const ImDrawData& data, float red, float green, float blue, float alpha);
    void resize(int width, int height);
    void draw_parts(const ImDrawData& data, const std::vector<PixelArea>& parts);
    void upload(const ImDrawList& list);
    void draw_command(const ImDrawList& list, const ImDrawCmd& command, const PixelArea& part);
    void fill(const PixelArea& area, unsigned color);
    void set_state();
    void read_vertices_from(unsigned vertex);

    Gl gl_;
    CurvePainter curves_;
    TilesPainter tiles_;
    GLuint program_ = 0, vertices_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
    GLuint fonts_ = 0, picture_ = 0;
    std::optional<unsigned> first_vertex_;  // as set in vertices_; empty: not set yet
    Target target_;
    DrawnFrame last_;                 // what `picture_` shows
    std::array<float, 4> cleared_{};  // and its color
    bool is_stale_ = true;            // the picture must be drawn as a whole
    bool has_changed_ = false;
    long drawn_pixels_ = 0;
};

}  // namespace achilles
