// A figure after layout: every area, path, marker and line of text with its position in pixels, in painting order.
// Painters only draw it, onto a screen or into a file. No ImGui here.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "figure/figure.hpp"

namespace achilles {

struct Rectangle {
    float x = 0, y = 0, width = 0, height = 0;  // pixels
};

// Width of a label at a text size, in pixels. Each kind of output has its own font.
using Measure = std::function<float(const std::string& label, float size)>;

struct Fill {
    Rectangle area;
    Color color;
};

struct Path {
    std::vector<Point> points;  // pixels; points that are not finite break the path
    Stroke stroke;              // lengths in pixels
    Rectangle clip;
};

// Region between two lines with the same number of points, each upper point above its lower point.
struct Strip {
    std::vector<Point> upper, lower;  // pixels
    Color color;
    Rectangle clip;
};

struct Mark {
    Markers::MarkerShape shape = Markers::MarkerShape::square;
    Point at;
    Color fill, edge;
    double size = 6.0, edge_width = 1.0;
};

// Cells as rectangles that fill the area. Transparent cells show the background.
struct Tiles {
    Rectangle area, clip;
    std::shared_ptr<const Cells> cells;
};

struct TextRun {
    float x = 0, y = 0;  // y: top of the line; x: the point at fraction `anchor` of its length (0: start, 0.5: middle)
    float anchor = 0;
    std::string label;
    Color color;
    float size = 14;
    bool upwards = false;  // rotated by 90 degrees counterclockwise; x is then the top of the letters
};

using Sheet = std::vector<std::variant<Fill, Path, Strip, Mark, Tiles, TextRun>>;

// From a figure to a sheet: positions of the axes, legends and labels of every panel. All typography of figures is
// decided here, for the window, PNG and SVG.

// Lays out the whole figure in the area; `scale` multiplies text sizes and stroke widths.
Sheet layout(const Figure& figure, const Measure& width, Rectangle area, double scale);

// Plot area inside the axes of a panel, the area before it was shrunk to equal axes, and the plot area without the time
// bars at its bottom.
struct PlotArea {
    Rectangle plot, place, inner;
};
std::vector<PlotArea> plot_areas(const Figure& figure, const Measure& width, Rectangle area, double scale);

// Adds one panel in the style of a figure to the sheet. Returns the plot area inside the axes.
Rectangle layout(const Panel& panel, const Figure& style, const Measure& width, Rectangle area, double scale,
                 Sheet& sheet);

}  // namespace achilles
