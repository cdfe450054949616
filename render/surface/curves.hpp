// Anti-aliased curves inside an ImGui draw list. ImGui's own polylines lose ink and grow spikes at sharp corners, which
// impacts are; here every edge covers its pixels exactly, overlaps keep the larger coverage, and the whole curve is
// laid over the picture once.
//
// A curve travels in the draw list's vertex buffer behind a callback, so it lives exactly as long as the list does, and
// a frame needs no memory of its own.
#pragma once

#include <vector>

#include "figure/figure.hpp"
#include "figure/layout.hpp"
#include "surface/gl.hpp"

struct ImDrawCmd;
struct ImDrawList;

namespace achilles {

// How a curve is stroked, in pixels. The dashes count from the first point along the whole curve.
struct ScreenStroke {
    Color color;
    double width = 1.5;
    std::vector<double> dash;
};

// Draws a polyline given in pixels, breaking at points that are not finite, inside the list's current clip rectangle.
void add_curve(ImDrawList* list, const std::vector<Point>& pixels, const ScreenStroke& stroke);

// Whether the command was made by add_curve.
bool is_curve(const ImDrawCmd& command);

// Where a frame goes.
struct Target {
    GLuint framebuffer = 0;
    int width = 0, height = 0;
};

// The graphics side: the mask and its two programs.
class CurvePainter {
 public:
    // `fineness` 2: the mask has twice the resolution and is averaged down.
    CurvePainter(const Gl& gl, int fineness);
    ~CurvePainter();
    CurvePainter(const CurvePainter&) = delete;
    CurvePainter& operator=(const CurvePainter&) = delete;

    // Draws the curve of one command; the list's vertices are in `vertex_buffer`. Leaves the target bound, everything
    // else about the state changed.
    void draw(const ImDrawList& list, const ImDrawCmd& command, GLuint vertex_buffer, const Target& target);

 private:
    struct Region {
        int x, y, width, height;  // pixels, from the top left
    };
    void reserve_mask(int width, int height);
    void draw_mask(const Region& region, int fineness, double width, std::size_t first, std::size_t points,
                   GLuint vertex_buffer);
    void composite(const Region& region, int fineness, unsigned color, const Target& target);

    const Gl& gl_;
    int fineness_;
    GLuint edges_ = 0, overlay_ = 0, vertices_ = 0;
    GLuint mask_ = 0, mask_framebuffer_ = 0;
    int mask_width_ = 0, mask_height_ = 0;
};

// A picture of cells inside a draw list. Like a curve it travels in the list's vertex buffer behind a callback.

// Draws the cells as rectangles inside the list's current clip rectangle.
void add_tiles(ImDrawList* list, const Rectangle& area, const Cells& cells);

// Whether the command was made by add_tiles.
bool are_tiles(const ImDrawCmd& command);

// The graphics side.
class TilesPainter {
 public:
    explicit TilesPainter(const Gl& gl);
    ~TilesPainter();
    TilesPainter(const TilesPainter&) = delete;
    TilesPainter& operator=(const TilesPainter&) = delete;

    // Leaves the target bound, everything else about the state changed.
    void draw(const ImDrawList& list, const ImDrawCmd& command, const Target& target);

 private:
    const Gl& gl_;
    GLuint program_ = 0, vertices_ = 0;
};

// Polylines in pixels, made small before they are drawn: thinned, clipped, cut into dashes. No ImGui, no OpenGL.
struct Box {
    double x_low = 0.0, y_low = 0.0, x_high = 0.0, y_high = 0.0;
};

// A point that breaks a polyline.
Point gap_point();
bool is_finite(const Point& point);

// Fewer points, never farther than `tolerance` from the line that is left; extremes and corners stay. Breaks (points
// that are not finite) stay too, as gap points.
std::vector<Point> thinned(const std::vector<Point>& points, double tolerance);

// The parts of a polyline inside the box. `dash` is on, off, on, ... in pixels, counted from the first point along the
// whole curve, in and out of the box, so that dashes do not crawl when the view moves; empty: solid. Of dashes a
// `cap` is taken off at either end, because strokes have round ends that stick out by half their width.
std::vector<Point> cut(const std::vector<Point>& points, const Box& box, const std::vector<double>& dash, double cap);

}  // namespace achilles
