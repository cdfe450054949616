// The mechanism that a system file draws, evaluated at a state.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "model/model.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// The point by which a mechanism is held: the centre of the last disc or box that moves, else the end of the last line
// that does. Evaluates its program, so one per thread.
class Grip {
 public:
    struct Hold {
        Point at;
        double radius = 0.0;  // of the disc, or the largest in the box; 0 without one
    };
    Hold at(double t, const State& state);

 private:
    friend class Mechanism;
    std::optional<Evaluator<double>> run_;  // none: the coordinates are the place
    std::size_t t_ = 0;                     // input
    std::size_t first_ = 0;                 // output
    std::size_t sizes_ = 0;                 // so many outputs after it are sizes: a radius, or width and height
};

class Mechanism {
 public:
    // Compiles every [[drawing]]. Where the file has none: a disc and the zero line of the gap for coordinates x and y,
    // else a note. Throws InputError for an expression that is none. Refers to the model.
    explicit Mechanism(const Model& model);

    // The shapes at a time and a state, seen within given limits (see limits()): curves are smooth there. What belongs to a
    // contact that is held is lit, and the body (grip()) for one to which nothing belongs.
    enum class Part { all, what_moves };
    Drawing draw(double t, const State& state, std::span<const double> parameters, const Drawing& limits,
                 const Theme& theme, ContactSet held = {}, Part part = Part::all) const;

    // The part of the world that a whole run needs, so that a moving picture stands still. Only the limits are set.
    Drawing limits(const Trajectory& trajectory, std::span<const Sample> samples) const;

    // Nothing where no shape moves but texts, curves and what lies between others.
    std::optional<Grip> grip(std::span<const double> parameters) const;
    // That one, then every other point by which a hand can take hold: centres, and both ends of lines. Some may stand
    // still.
    std::vector<Grip> grips(std::span<const double> parameters) const;
    // Of every disc that moves, and is not what is touched, its centre and radius, with its place among the file's drawings.
    std::vector<std::pair<std::size_t, Grip>> discs(std::span<const double> parameters) const;
    // Whether there is nothing to draw but a note that says so.
    bool is_empty() const { return items_.empty() && !plane_; }

 private:
    struct Item {
        DrawingDescription description;
        Program program;     // its points' x and y, then radius, sizes or limits of the curve's parameter, then width
        bool moves = false;  // it names a coordinate, or t
    };
    struct Placed {
        std::vector<Point> points;  // of a box its corners
        double radius = 0.0, width = 2.0;
        std::vector<double> sizes{};
    };
    Placed place(const Item& item, Evaluator<double>& run, double t, const State& state,
                 const Drawing* seen = nullptr) const;
    std::vector<Point> line_between(const Item& item, Evaluator<double>& run, const Placed& placed, double world) const;
    Grip grip_of(const Item& item, std::size_t point, std::span<const double> parameters) const;
    const Item* body() const;
    void add_plane(Drawing& drawing, double t, const State& state, std::span<const double> parameters,
                   const Theme& theme) const;

    const Model& model_;
    Run start_;  // as the file has it: parts are at rest there
    std::vector<Item> items_;
    bool plane_ = false;  // no drawing, but coordinates x and y
};

// Curves as smooth as a picture needs: dense where it looks, coarse elsewhere.

using ParametricCurve = std::function<Point(double)>;

// Points of a curve over [low, high]: `pieces` + 1 at equal steps of its parameter, and between those in or near what is
// seen as many more as bring the chords within 5e-5 of the picture's diagonal, so that no corner shows at any zoom. What is
// seen: the drawing's limits.
std::vector<Point> refined(const ParametricCurve& curve, double low, double high, int pieces, const Drawing& seen);

}  // namespace achilles
