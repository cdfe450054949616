// Pictures as data. A figure: panels, limits, ticks, curves, markers, all decided. A drawing: the mechanism at one instant. Both
// can be printed, compared and drawn; whoever draws them decides nothing. No ImGui here.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace achilles {

struct Color {
    std::uint8_t r = 0, g = 0, b = 0, a = 255;
    friend bool operator==(const Color&, const Color&) = default;
};

struct Point {
    double x = 0.0, y = 0.0;
};
// A curve is interrupted where it has this point.
constexpr Point break_of_curve{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

// Lengths are in points of the layout: 1 unit = 1 pixel at scale 1.
struct Stroke {
    Color color;
    double width = 1.5;
    std::vector<double> dash;  // on, off, ...; empty: solid
};

struct Curve {
    std::string label;  // "" : not in the legend
    Stroke stroke;
    std::vector<Point> points;  // data coordinates; a NaN point breaks the curve
};

struct Markers {
    enum class Shape { square, circle, triangle, diamond, bar };  // bar: a vertical line over the whole panel
    std::string label;
    Shape shape = Shape::square;
    Color fill, edge;
    double size = 6.0;  // across
    std::vector<Point> points;
    double apart = 0.05;  // one that is nearer than this to another is not drawn
    double lift = 0.0;    // drawn so much above its point
};

// What lasts and what happens along the x axis, as a thin bar under the plot area.
struct TimeBar {
    struct Mark {
        double low = 0.0, high = 0.0;  // equal: an instant, drawn as a tick
        Color color;
    };
    std::string label;
    std::vector<Mark> marks;  // painted in this order
};

// A stretch of the x axis, over the whole height and behind everything; it may go on beyond the limits.
struct Band {
    std::string label;
    Color color;
    double low = 0.0, high = 0.0;
};

struct Tick {
    double value = 0.0;
    std::string label;  // "" : minor
};

struct Axis {
    std::string label;  // UTF-8; combining dots U+0307, U+0308 stand after the letter they belong to
    double low = 0.0, high = 1.0;
    bool logarithmic = false;
    std::vector<Tick> ticks;
    bool labelled = true;  // false: ticks alone, because another panel beside this one shows the same axis
};

// A picture of cells, all of one size: row by row from the top.
struct Cells {
    int columns = 0, rows = 0;
    std::vector<Color> colors;
    friend bool operator==(const Cells&, const Cells&) = default;
};

// Cells over a rectangle of the plot, which may go on beyond the limits. On a logarithmic axis equal cells are equal factors.
struct Raster {
    std::shared_ptr<const Cells> cells;  // null: none
    double left = 0.0, right = 1.0, bottom = 0.0, top = 1.0;
};

// Points too many for markers: each is a small dot of its own colour, the last one above. Without colours a dot is darker
// the more points are in it, by the logarithm of their number.
struct Dots {
    std::vector<Point> points;
    std::vector<Color> colors;  // so many, or none
    Color ink;                  // of the fullest dot, where there are none
    // Where points stand at so many even places from left to right: a dot is then as wide as a place, unless it were a
    // dash. 0: anywhere.
    int columns = 0;
    double left = 0.0, right = 0.0;
};

// What the colours of numbers mean, beside the plot area.
struct ColorBar {
    Axis axis;
    std::vector<Color> colors;  // from axis.low on, evenly; empty: no bar
};

// What lies between two curves over the same x, with a line along both: where something is proved to be. A NaN breaks it.
struct Tube {
    struct Slice {
        double x = 0.0, low = 0.0, high = 0.0;
    };
    std::string label;
    Color fill, edge;
    std::vector<Slice> slices;
};

// What a run does after its horizon, from where on it is not trusted (depend/error_estimate.hpp): drawn pale, under the rest.
struct Beyond {
    std::string label;  // "" : there is nothing of it
    std::vector<Curve> curves;
    std::vector<Markers> markers;
};

// Strokes across the plot area, behind all, seen where nothing covers them.
struct Hatch {
    std::string label;  // "" : not in the legend
    Color color{0, 0, 0, 0};
};

struct Panel {
    std::string title;  // "(a)", or a view's name
    Axis x, y;
    bool equal_axes = false;   // one unit is the same length on both axes
    bool shows_proof = false;  // a proof has its tube and its end here: it is a plot over t
    int rows = 1;              // of the figure's, that it stands beside
    std::vector<Band> bands;
    Hatch hatch;
    Raster raster;  // behind the curves, as is what follows until there
    Dots dots;
    ColorBar color_bar;
    std::vector<Tube> tubes;
    Curve boundary;  // behind the curves: what the path cannot cross
    Beyond beyond;
    std::vector<Curve> curves;
    std::vector<Markers> markers;
    std::vector<TimeBar> time_bars;  // from top to bottom
    bool legend = false;
    bool legend_above = false;  // in a line above the plot area, where it covers nothing; else in a corner of it:
    std::array<double, 2> legend_at{1.0, 1.0};  // corner of the plot area: (0,0) bottom left, (1,1) top right
};

// A line of a legend: a stroke, a marker, a hatched field or a piece of a tube, and its meaning.
struct Key {
    std::string label;
    std::variant<Stroke, Markers, Hatch, Tube> sign;
};

struct Figure {
    int columns = 1;
    std::vector<Panel> panels;  // row by row, each in the first place that is free
    std::vector<Key> keys;      // a legend above all panels; empty: none
    Color background{255, 255, 255, 255};
    Color ink{30, 30, 30, 255};  // axes and text
    Color grid{225, 225, 225, 255};
    double text_size = 14.0;     // points
    double smallest_text = 0.5;  // of a label that shrinks where room is short, as a share of text_size
};

// The figure as text, 9 significant digits: what golden tests compare before pixels.
std::string to_text(const Figure& figure);

// The mechanism at one instant, as data: shapes already evaluated, in world coordinates.

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
