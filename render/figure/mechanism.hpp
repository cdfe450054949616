// The drawing of a mechanism from its system file, evaluated at a state.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "figure/space_view.hpp"
#include "model/model.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// A point that moves with a body, in terms of its drawing: a corner, plus shares of two edges that begin there.
struct MaterialPoint {
    std::size_t drawing = 0;                 // index among the file's drawings
    std::size_t corner = 0;                  // of its points, or of the corners of a box
    std::array<std::size_t, 2> ends{};       // of the edges
    std::array<double, 2> shares{0.0, 0.0};  // of the edges
};

// The reference point of a mechanism: the center of the last moving disc or box, else the end of the last moving line.
// It evaluates its program, so use one per thread.
class AnchorPoint {
 public:
    struct Hold {
        Point at;
        double radius = 0.0;            // of the disc, or of the largest disc in the box; 0 for a point of a line
        std::optional<double> depth{};  // of a system in space: toward the viewer
    };
    Hold at(double t, const State& state);

 private:
    friend class Mechanism;
    std::optional<Evaluator<double>> run_;   // nullopt: the coordinates are the position
    std::size_t t_ = 0;                      // input slot of t
    std::size_t first_ = 0;                  // output slot of the point's x
    std::size_t sizes_ = 0;                  // number of size outputs after the point: a radius, or width and height
    std::optional<MaterialPoint> material_;  // in place of that point; with sizes, of a box
    std::optional<SpaceView> space_;         // in place of the program
    double radius_ = 0.0;                    // in space
};

class Mechanism {
 public:
    // Compiles every [[drawing]]. A file without any gets a disc and the zero line of the gap if its coordinates are x
    // and y, else a note. Throws InputError for an invalid expression. Keeps a reference to the model.
    // A system in space (SpaceView::shows) is drawn as it is seen from `direction`, or if it has no drawing.
    explicit Mechanism(const Model& model, const std::optional<ViewAngles>& direction = {});

    // The shapes at a time and a state. Curves are smooth within `limits`, the visible part (see limits()). Shapes that
    // belong to a held contact are highlighted in its color (phase_color); if none belongs to it, the body (grip()) is
    // highlighted.
    enum class DrawnPart { all, moving };
    Drawing draw(double t, const State& state, std::span<const double> parameters, const Drawing& limits,
                 const Theme& theme, Mode mode = {}, DrawnPart part = DrawnPart::all) const;

    // The part of the world that a whole run needs, so that the picture need not move. Only the limits of the drawing
    // are set.
    Drawing limits(const Trajectory& trajectory, std::span<const Sample> samples) const;

    // The body. nullopt if no shape moves except texts, curves and connecting parts.
    std::optional<AnchorPoint> grip(std::span<const double> parameters) const;
    // The body, then every point that the mouse can drag: centers and both ends of lines that move. One end of such a
    // line may be fixed.
    std::vector<AnchorPoint> grips(std::span<const double> parameters) const;
    // The point of a moving line, or inside a moving box or polygon, that is nearest to `at`. nullopt if none is within
    // `reach`.
    std::optional<MaterialPoint> material_point(const Point& at, double reach, double t, const State& state,
                                                std::span<const double> parameters) const;
    // nullopt if the mechanism has no such drawing.
    std::optional<AnchorPoint> grip(const MaterialPoint& point, std::span<const double> parameters) const;
    // Index among the file's drawings, center and radius of every moving disc that is not itself a contact surface.
    std::vector<std::pair<std::size_t, AnchorPoint>> discs(std::span<const double> parameters) const;
    // Whether the drawing has only a note that there is nothing to draw.
    bool is_empty() const { return items_.empty() && !plane_ && !space_; }
    // The projection of a system in space; null if the drawing of the file is shown.
    const SpaceView* space() const { return space_ ? &*space_ : nullptr; }

 private:
    struct Item {
        DrawingDescription description;
        Program program;     // x and y of its points, then radius, sizes or parameter limits of the curve, then width
        bool moves = false;  // it names a coordinate or t
    };
    struct EvaluatedDrawing {
        std::vector<Point> points;  // corners, for a box
        double radius = 0.0, width = 2.0;
        std::vector<double> sizes{};
    };
    EvaluatedDrawing place(const Item& item, Evaluator<double>& run, double t, const State& state,
                           const Drawing* seen = nullptr) const;
    std::vector<Point> line_between(const Item& item, Evaluator<double>& run, const EvaluatedDrawing& placed,
                                    double world) const;
    AnchorPoint grip_of(const Item& item, std::size_t point, std::span<const double> parameters) const;
    const Item* body() const;
    void add_plane(Drawing& drawing, double t, const State& state, std::span<const double> parameters,
                   const Theme& theme) const;
    void add_ball(Drawing& drawing, const State& state, std::span<const double> parameters, const Theme& theme,
                  Mode mode) const;
    double ball_radius(std::span<const double> parameters) const;
    Drawing limits_in_space(std::span<const Sample> samples) const;

    const Model& model_;
    Run start_;  // as in the file: springs and dampers are at rest there
    std::vector<Item> items_;
    bool plane_ = false;  // no drawing, but coordinates x and y
    std::optional<SpaceView> space_;
    std::optional<Item> ball_;  // in space: the disc of the file that moves
};

// ---- curves refined to the picture: dense in the visible part, coarse elsewhere ----

using ParametricCurve = std::function<Point(double)>;

// Points of a curve over [low, high]: `pieces` + 1 points at equal steps of the parameter. In or near `seen`, more
// points are added until chords are within 5e-5 of the picture's diagonal, so that no corner is visible at any zoom.
// `seen`: the limits of the drawing.
std::vector<Point> refined(const ParametricCurve& curve, double low, double high, int pieces, const Drawing& seen);

}  // namespace achilles
