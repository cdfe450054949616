// The mechanism at one instant, as data: shapes already evaluated, in world coordinates. No ImGui here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "figure/figure.hpp"

namespace achilles {

struct Shape {
    enum class Kind { disc, polyline, text, area };  // area: convex polygons, filled, of one opaque colour
    Kind kind = Kind::polyline;
    std::vector<Point> points;  // world; disc and text: one point, the centre. A NaN point ends a line or a polygon
    double radius = 0.0;        // disc, in world units
    std::string text;           // UTF-8
    Stroke stroke;              // outline, and the colour of a text; width 0: no outline
    bool fill = false;          // disc, closed polyline
    Color fill_color;
    bool closed = false;                // polyline: the last point is joined to the first
    bool moves = false;                 // with the coordinates; else it is part of the world
    std::optional<std::size_t> item{};  // which of the file's drawings it is
};

struct Drawing {
    std::vector<Shape> shapes;                                      // painted in this order
    double x_low = -1.0, x_high = 1.0, y_low = -1.0, y_high = 1.0;  // the world that must be visible
    double size = 2.0;  // of the world that the run needs, however it is looked at: what signs in it are measured by
};

}  // namespace achilles
