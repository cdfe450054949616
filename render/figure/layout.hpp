// A figure laid out: every area, path, marker and line of words with its place in pixels, in the order of painting.
// What is left to do is strokes, onto a screen or into a file. No ImGui here.
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

// How wide a label of a size will be: each kind of drawing has letters of its own.
using Measure = std::function<float(const std::string& label, float size)>;

struct Fill {
    Rectangle area;
    Color color;
};

struct Path {
    std::vector<Point> points;  // pixels; points that are not finite break it
    Stroke stroke;              // in pixels
    Rectangle clip;
};

// What lies between two lines that have as many points, each above its own.
struct Strip {
    std::vector<Point> upper, lower;  // pixels
    Color color;
    Rectangle clip;
};

struct Mark {
    Markers::Shape shape = Markers::Shape::square;
    Point at;
    Color fill, edge;
    double size = 6.0, edge_width = 1.0;
};

// Cells as rectangles, all of them in the area; those that are clear show what is behind.
struct Tiles {
    Rectangle area, clip;
    std::shared_ptr<const Cells> cells;
};

struct TextRun {
    float x = 0, y = 0;  // the top of the line where `anchor` of its length is behind: 0 its start, 0.5 its middle
    float anchor = 0;
    std::string label;
    Color color;
    float size = 14;
    bool upwards = false;  // turned by 90 degrees to the left; x is then the top of the letters
};

using Sheet = std::vector<std::variant<Fill, Path, Strip, Mark, Tiles, TextRun>>;

// From a figure to a sheet: where the axes, legends and labels of every panel stand. The only home of a figure's
// typography, for the window, PNG and SVG alike.

// The whole figure in the area; scale multiplies text sizes and stroke widths.
Sheet layout(const Figure& figure, const Measure& width, Rectangle area, double scale);

// The plot area inside the axes of every panel, and the place that it could have filled.
struct PlotArea {
    Rectangle plot, place;
};
std::vector<PlotArea> plot_areas(const Figure& figure, const Measure& width, Rectangle area, double scale);

// One panel in the style of a figure, added to the sheet; returns the plot area inside the axes.
Rectangle layout(const Panel& panel, const Figure& style, const Measure& width, Rectangle area, double scale,
                 Sheet& sheet);

}  // namespace achilles
