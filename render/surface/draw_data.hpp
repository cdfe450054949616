// Draws ImGui's draw data into its own framebuffer, so that a window, an image and a test get the same bytes.
#pragma once

#include "image/image.hpp"
#include "surface/curves.hpp"
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
    // Draws the frame on an opaque color, or on transparency. Throws std::runtime_error if the frame is too large.
    void draw(const ImDrawData& data, const float (&clear)[3]);
    void draw_over_nothing(const ImDrawData& data);
    // The last frame; with its alpha channel if `transparent`.
    Image read(bool transparent = false) const;
    // Copies the last frame to the default framebuffer of the context, which a window shows.
    void show() const;

 private:
    void draw_over(const ImDrawData& data, float red, float green, float blue, float alpha);
    void resize(int width, int height);
    void draw_list(const ImDrawList& list);
    void draw_triangles(const ImDrawCmd& command);
    void set_state();

    Gl gl_;
    CurvePainter curves_;
    TilesPainter tiles_;
    GLuint program_ = 0, vertices_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
    GLuint fonts_ = 0, picture_ = 0;
    Target target_;
};

}  // namespace achilles
