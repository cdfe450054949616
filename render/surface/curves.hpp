// Anti-aliased curves in an ImGui draw list. ImGui's own polylines lose ink and have spikes at sharp corners, such as
// impacts. Here the coverage of every pixel by every edge is exact, overlapping edges keep the larger coverage, and the
// whole curve is blended once.
//
// A curve is stored in the vertex buffer of the draw list, behind a callback. Hence it lives as long as the list, and a
// frame needs no extra memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "figure/figure.hpp"
#include "figure/layout.hpp"
#include "surface/gl.hpp"

struct ImDrawCmd;
struct ImDrawList;
struct ImDrawVert;

namespace achilles {

// Stroke of a curve, in pixels. The dashes continue from the first point along the whole curve.
struct ScreenStroke {
    Color color;
    double width = 1.5;
    std::vector<double> dash;
};

// Draws a polyline given in pixels inside the list's current clip rectangle. Points that are not finite break it.
void add_curve(ImDrawList* list, const std::vector<Point>& pixels, const ScreenStroke& stroke);

// Whether add_curve() made the command.
bool is_curve(const ImDrawCmd& command);

// Framebuffer that receives a frame.
struct Target {
    GLuint framebuffer = 0;
    int width = 0, height = 0;
};

// A rectangle of pixels, from the top left.
struct PixelArea {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const PixelArea&, const PixelArea&) = default;
};
// The pixels in both, of no width or height if there are none; and the smallest area around both.
PixelArea common(const PixelArea& a, const PixelArea& b);
PixelArea around(const PixelArea& a, const PixelArea& b);
// The pixels inside the clip rectangle of triangles or tiles.
PixelArea clip_of(const ImDrawCmd& command);
// The content of a curve or of tiles in the list, and the pixels that they may change; nothing for another command.
std::span<const unsigned char> curve_or_tiles(const ImDrawList& list, const ImDrawCmd& command, PixelArea& area);

// A curve as it is stored in a list: the whole pixels with its visible part, its width, its color and its points.
// `uv.x` of a point says whether an edge leads to the next one.
struct StoredCurve {
    PixelArea area;
    double width;
    unsigned color;
    std::span<const ImDrawVert> points;
};
constexpr float pen_down = 1.0F, pen_up = 0.0F;
StoredCurve stored_curve(const ImDrawList& list, const ImDrawCmd& command);

// OpenGL part: the coverage masks of the curves of a frame, and two programs.
class CurvePainter {
 public:
    // `fineness` 2: the mask has twice the resolution and is averaged down.
    CurvePainter(const Gl& gl, int fineness);
    ~CurvePainter();
    CurvePainter(const CurvePainter&) = delete;
    CurvePainter& operator=(const CurvePainter&) = delete;

    // Begins a frame. Then every curve to be drawn is added, with the part of the picture in which it is drawn; its
    // pixels do not depend on the part.
    void begin();
    void add(const ImDrawList& list, const ImDrawCmd& command, const Target& target, const PixelArea& part);
    // Draws the curves one after the other in the order in which they were added. The target stays bound; all other
    // state may change. Needs blending and the scissor test enabled.
    void draw_next(const Target& target);

    // A vertex: the ends of an edge, or the origin and size of an area, pixels.
    struct Four {
        float a, b, c, d;
    };

 private:
    struct PreparedCurve {
        PixelArea region, part;  // of the picture: all pixels of the curve, and those to be drawn
        int fineness = 1;
        double width = 0.0;
        unsigned color = 0;
        std::size_t first_edge = 0, edges = 0, first_area = 0, areas = 0;  // quadrilaterals in vertices_
        int x = 0, y = 0;                                                  // place of `part` in the mask
    };
    void load();
    void place_masks(std::size_t first, int& width, int& height);
    void reserve_mask(int width, int height);
    void draw_masks(std::size_t first);
    void draw_mask(const PreparedCurve& curve);
    void composite(const PreparedCurve& curve, const Target& target);

    const Gl& gl_;
    int fineness_;
    GLuint edges_ = 0, overlay_ = 0, vertex_array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
    GLuint mask_ = 0, mask_framebuffer_ = 0;
    int mask_width_ = 0, mask_height_ = 0;
    std::vector<PreparedCurve> curves_;
    std::vector<Four> vertices_;
    std::size_t next_ = 0, masked_ = 0;  // the curve to be drawn next; those before `masked_` have had a mask
    std::size_t indexed_ = 0;            // quadrilaterals for which there are indices
    bool is_loaded_ = false;
};

// ---- rasters of cells: stored like curves, in the list's vertex buffer behind a callback ----

// Draws the cells as rectangles inside the list's current clip rectangle.
void add_tiles(ImDrawList* list, const Rectangle& area, const Cells& cells);

// Whether add_tiles() made the command.
bool are_tiles(const ImDrawCmd& command);

// OpenGL part.
class TilesPainter {
 public:
    explicit TilesPainter(const Gl& gl);
    ~TilesPainter();
    TilesPainter(const TilesPainter&) = delete;
    TilesPainter& operator=(const TilesPainter&) = delete;

    // Draws what lies in `part`. The target stays bound; all other state may change.
    void draw(const ImDrawList& list, const ImDrawCmd& command, const Target& target, const PixelArea& part);

 private:
    const Gl& gl_;
    GLuint program_ = 0, vertices_ = 0;
};

// ---- polylines in pixels, reduced before drawing: thinned, clipped, split into dashes; without ImGui and OpenGL ----
struct ClipBox {
    double x_low = 0.0, y_low = 0.0, x_high = 0.0, y_high = 0.0;
};

// A point that breaks a polyline.
Point gap_point();
bool is_finite(const Point& point);

// Reduces the number of points. No point is farther than `tolerance` from the remaining line; extremes and corners are
// kept. Breaks (points that are not finite) remain as gap points.
std::vector<Point> thinned(const std::vector<Point>& points, double tolerance);

// The parts of a polyline inside the box. `dash`: lengths on, off, on, ... in pixels; empty: solid. Dashes continue
// from the first point along the whole curve, inside and outside the box, so that they do not move with the view. Each
// dash is shortened by `cap` at both ends, because strokes have round ends that extend by half their width.
std::vector<Point> cut(const std::vector<Point>& points, const ClipBox& box, const std::vector<double>& dash,
                       double cap);

}  // namespace achilles
