// What a plane of two quantities shows besides the run in it: where each gap is zero and all are open, lines of equal
// energy, impacts as arrows. All of it in the units that are shown.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "figure/compose.hpp"
#include "figure/field.hpp"

namespace achilles {

// What an axis of a plane measures, as it is written.
struct PlaneAxis {
    std::string text;
    double factor = 1.0;                       // to the units that are shown
    std::optional<Eigen::Index> coordinate{};  // that it is, or whose rate
    bool is_rate = false;
    std::optional<std::size_t> gap{};  // the contact whose gap it is
    // Of an axis that is a coordinate or a rate.
    double& of(State& state) const { return (is_rate ? state.v : state.q)[*coordinate]; }
};

using PlaneTexts = std::pair<std::string, std::string>;

// The planes that any system has, the one that is shown first at first: two coordinates; a coordinate and its rate; a gap
// and its rate.
std::vector<PlaneTexts> planes_of(const SystemDescription& description);

// Two quantities, compiled for a model, to which it refers.
class Plane {
 public:
    // Throws InputError for an expression that is none.
    Plane(const Model& model, const PlaneTexts& texts);

    const PreparedView& view() const { return view_; }
    const PlaneAxis& x() const { return x_; }
    const PlaneAxis& y() const { return y_; }
    // Whether a point of it, with the other coordinates and rates, is a state.
    bool is_of_states() const { return x_.coordinate && y_.coordinate; }
    // Whether both are coordinates.
    bool is_of_coordinates() const { return is_of_states() && !x_.is_rate && !y_.is_rate; }
    // Of a plane of states: where a state is.
    Point at(State state) const { return {x_.of(state) * x_.factor, y_.of(state) * y_.factor}; }

    // A line h = 0, less where another gap is negative: segments, separated by NaN points.
    struct Surface {
        std::size_t contact = 0;
        std::vector<Point> points;
    };
    struct Surfaces {
        std::vector<Surface> lines;
        std::vector<std::vector<Point>> open;  // convex parts, none over another: no gap is negative there
    };
    // Within the limits, of those gaps that depend on what the plane shows; the others are as in the state. Of axes that are no
    // coordinates, a gap that is one of them.
    Surfaces surfaces(std::span<const double> parameters, const State& state, const Drawing& limits) const;
    // All of a state that these depend on: while it is the same, so are they.
    std::vector<double> surfaces_key(const State& state) const { return values_at(state, surface_slots_); }

    // Where the energy has round values: in a plane of two coordinates the potential one, with a rate the total one, of the
    // state in whose other coordinates and rates the plane lies. Nothing where the axes are no coordinates and rates.
    struct Level {
        std::string label;
        std::vector<Point> points;  // segments, separated by NaN points
    };
    std::vector<Level> levels(std::span<const double> parameters, const State& state, const Drawing& limits) const;
    std::vector<double> levels_key(const State& state) const { return values_at(state, level_slots_); }

 private:
    std::optional<PlaneFunction> gap(std::size_t contact, std::span<const double> parameters, const State& state) const;
    std::vector<std::size_t> slots_of(std::span<const Expression> expressions) const;
    std::vector<double> values_at(const State& state, const std::vector<std::size_t>& slots) const;

    const Model* model_;
    PreparedView view_;
    PlaneAxis x_, y_;
    std::vector<bool> is_shown_;  // of each contact: its gap depends on an axis
    std::vector<std::size_t> surface_slots_, level_slots_;
};

// From the state before an impact to the one after it, and where the motion was a little earlier.
struct ImpactArrow {
    Point from, to, coming;
};
// Of the impacts at which something jumps that the view shows, those that are seen in a plot so large (pixels) between the
// limits of its panel: none shorter than `least`, none nearer than that to another at both its ends. Of a run with very many
// impacts the first.
std::vector<ImpactArrow> impact_arrows(const Trajectory& trajectory, const PreparedView& view, const Panel& panel,
                                       double width, double height, double least);

// The line h = 0 of every gap as a view shows it, less where another gap is negative, in the units that are shown;
// segments, separated by NaN points. The view's axes are two coordinates, of the gaps that depend on them alone, seen
// between the limits of `panel`; or, in a system of two coordinates, any functions of them (a point of a mechanism), seen
// where the run goes and half as far again. Empty for every other view. A gap that depends on time is drawn as it is at t:
// of a whole run, where there is no such time, it is left out, since any line of it would be one that the path may cross.
// `size`: of the plot area.
std::vector<Point> boundary(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                            const Panel& panel, std::optional<double> t = {}, const Resolution& size = {400.0, 300.0});

// Whether a gap of the model depends on time.
bool has_moving_gap(const Model& model);

}  // namespace achilles
