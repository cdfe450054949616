// Pictures as data, without ImGui. A Figure has panels with limits, ticks, curves and markers; a Drawing is the
// mechanism at one instant. Both can be printed, compared and drawn. Every decision is made here, none by the painters.
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
// This point interrupts a curve.
constexpr Point break_of_curve{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

// Lengths are in layout points: 1 point = 1 pixel at scale 1.
struct Stroke {
    Color color;
    double width = 1.5;
    std::vector<double> dash;  // on, off, ...; empty: solid
};

struct Curve {
    std::string label;  // "": not in the legend
    Stroke stroke;
    std::vector<Point> points;      // data coordinates; a NaN point breaks the curve
    bool is_between_cells = false;  // a boundary in the panel's raster, drawn where its cells are wide enough
};

struct Markers {
    enum class MarkerShape {
        square,
        circle,
        triangle,
        inverted_triangle,
        diamond,
        hexagon,
        bar
    };  // bar: a vertical line over the height of the panel
    std::string label;
    MarkerShape shape = MarkerShape::square;
    Color fill, edge;
    double size = 6.0;  // width
    std::vector<Point> points;
    double apart = 0.05;  // minimum distance from other drawn markers, also from larger ones of other kinds
    double lift = 0.0;    // distance above its point at which a marker is drawn
};

// Intervals and instants along the x axis, drawn as a thin bar below the plot area.
struct TimeBar {
    struct TimeMark {
        double low = 0.0, high = 0.0;  // equal: an instant, drawn as a tick
        Color color;
    };
    std::string label;
    std::vector<TimeMark> marks;  // in painting order
};

// An interval of the x axis, shaded over the full height behind everything. It may extend beyond the limits.
struct Band {
    std::string label;
    Color color;
    double low = 0.0, high = 0.0;
};

struct Tick {
    double value = 0.0;
    std::string label;  // "": a minor tick
};

struct Axis {
    std::string label;  // UTF-8; combining dots U+0307 and U+0308 follow their letter
    double low = 0.0, high = 1.0;
    bool logarithmic = false;
    std::vector<Tick> ticks;
    bool labeled = true;  // false: no labels, because a neighboring panel shows the same axis
};

// A grid of colored cells of equal size, row by row from the top.
struct Cells {
    int columns = 0, rows = 0;
    std::vector<Color> colors;
    friend bool operator==(const Cells&, const Cells&) = default;
};

// Cells over a rectangle of the plot, which may extend beyond the limits. On a logarithmic axis, equal cells are equal
// factors.
struct Raster {
    std::shared_ptr<const Cells> cells;  // null: no raster
    double left = 0.0, right = 1.0, bottom = 0.0, top = 1.0;
};

// Points too many for markers, drawn as small dots, each in its own color with the last on top. Without colors, a dot
// darkens with the logarithm of the number of points in it.
struct Dots {
    std::vector<Point> points;
    std::vector<Color> colors;  // one per point, or empty
    Color ink;                  // color of the darkest dot, if `colors` is empty
    // Number of equally spaced positions between `left` and `right` at which points stand; 0 if they stand anywhere.
    // Dots are as wide as the spacing unless that would make them dashes.
    int columns = 0;
    double left = 0.0, right = 0.0;
};

// Color scale for numbers, beside the plot area.
struct ColorBar {
    Axis axis;
    std::vector<Color> colors;  // equally spaced from axis.low to axis.high; empty: no scale
};

// Region between two curves over the same x, with a line along each: a proved enclosure. A NaN breaks it.
struct Tube {
    struct Slice {
        double x = 0.0, low = 0.0, high = 0.0;
    };
    std::string label;
    Color fill, edge;
    std::vector<Slice> slices;
};

// The part of a run after its horizon, which is not reliable (sensitivity/error_estimate.hpp). Drawn pale, below the
// rest.
struct HorizonTail {
    std::string label;  // "": no such part
    std::vector<Curve> curves;
    std::vector<Markers> markers;
};

// Hatching of the plot area, behind everything.
struct Hatch {
    std::string label;  // "": not in the legend
    Color color{0, 0, 0, 0};
};

struct Panel {
    std::string title;  // "(a)", or a view's name
    Axis x, y;
    bool equal_axes = false;   // one unit has the same length on both axes
    bool shows_proof = false;  // a plot over t: it can show the tube of a proof and where the proof ends
    int rows = 1;              // number of figure rows that the panel spans
    std::vector<Band> bands;
    Hatch hatch;
    Raster raster;  // this and the members down to `boundary` are drawn behind the curves
    Dots dots;
    ColorBar color_bar;
    std::vector<Tube> tubes;
    Curve boundary;  // drawn behind the curves: the boundary h = 0
    HorizonTail beyond;
    std::vector<Curve> curves;
    std::size_t courses =
        2;  // of a view: number of curves of each quantity, one for each look of a phase (palette.hpp)
    std::vector<Markers> markers;
    std::vector<TimeBar> time_bars;  // top to bottom
    bool legend = false;
    bool legend_above = false;                  // in a line above the plot area; else in a corner of it:
    std::array<double, 2> legend_at{1.0, 1.0};  // corner of the plot area: (0,0) bottom left, (1,1) top right
};

// An entry of a legend: a stroke, marker, hatched box or piece of a tube, and its meaning.
struct Key {
    std::string label;
    std::variant<Stroke, Markers, Hatch, Tube> sign;
};

struct Figure {
    int columns = 1;
    std::vector<Panel> panels;  // row by row, each in the first free cell
    std::vector<Key> keys;      // legend above all panels; empty: no legend
    Color background{255, 255, 255, 255};
    Color ink{30, 30, 30, 255};  // axes and text
    Color grid{225, 225, 225, 255};
    double text_size = 14.0;     // layout points
    double smallest_text = 0.5;  // minimum size of a label that shrinks to fit, as a fraction of text_size
};

// The figure as text with 9 significant digits. Golden tests compare it before they compare pixels.
std::string to_text(const Figure& figure);

// ---- the mechanism at one instant: evaluated shapes in world coordinates ----

struct DrawnShape {
    enum class Kind { disc, polyline, text, area };  // area: filled convex polygons of one opaque color
    Kind kind = Kind::polyline;
    std::vector<Point> points;  // world; disc and text: one point, the center. A NaN point ends a line or polygon
    double radius = 0.0;        // disc, in world units
    std::string text;           // UTF-8
    Stroke stroke;              // outline, and color of a text; width 0: no outline
    bool fill = false;          // disc, closed polyline
    Color fill_color;
    bool closed = false;                // polyline: the last point is joined to the first
    bool moves = false;                 // depends on the coordinates; false: a static part of the world
    std::optional<std::size_t> item{};  // index among the file's drawings
};

struct Drawing {
    std::vector<DrawnShape> shapes;                                 // in painting order
    double x_low = -1.0, x_high = 1.0, y_low = -1.0, y_high = 1.0;  // the part of the world that must be visible
    double size = 2.0;  // size of the world that the run needs, whatever the view; symbols are scaled by it
};

}  // namespace achilles
