// A picture of cells inside an ImGui draw list. Like a curve (surface/curves.hpp) it travels in the list's vertex buffer
// behind a callback: it lives as long as the list does, and a frame needs no memory of its own.
#pragma once

#include "figure/sheet.hpp"
#include "surface/curves.hpp"
#include "surface/gl.hpp"

namespace achilles {

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

}  // namespace achilles
