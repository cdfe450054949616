// Content of a plane of two quantities besides the run: zero lines of the gaps, the region where all gaps are open,
// lines of equal energy, and arrows at impacts. All are in displayed units.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "figure/compose.hpp"
#include "figure/field.hpp"

namespace achilles {

// The quantity on an axis of a plane.
struct PlaneAxis {
    std::string text;
    double factor = 1.0;                       // to displayed units
    std::optional<Eigen::Index> coordinate{};  // the coordinate that it is, or whose rate it is
    bool is_rate = false;
    std::optional<std::size_t> gap{};  // the contact whose gap it is
    // The component of the state on this axis, which must be a coordinate or a rate.
    double& of(State& state) const { return (is_rate ? state.v : state.q)[*coordinate]; }
};

using PlaneTexts = std::pair<std::string, std::string>;

// The planes of any system, the default first: two coordinates; a coordinate and its rate; a gap and its rate.
std::vector<PlaneTexts> planes_of(const SystemDescription& description);

// A plane of two quantities, compiled for a model. Keeps a reference to the model.
class Plane {
 public:
    // Throws InputError for an invalid expression.
    Plane(const Model& model, const PlaneTexts& texts);

    const PreparedView& view() const { return view_; }
    const PlaneAxis& x() const { return x_; }
    const PlaneAxis& y() const { return y_; }
    // Whether a point of the plane, with the other coordinates and rates, is a state.
    bool is_of_states() const { return x_.coordinate && y_.coordinate; }
    // Whether both axes are coordinates.
    bool is_of_coordinates() const { return is_of_states() && !x_.is_rate && !y_.is_rate; }
    // Position of a state in a plane of states.
    Point at(State state) const { return {x_.of(state) * x_.factor, y_.of(state) * y_.factor}; }

    // A line h = 0, without the parts where another gap is negative: segments, separated by NaN points.
    struct Surface {
        std::size_t contact = 0;
        std::vector<Point> points;
    };
    struct Surfaces {
        std::vector<Surface> lines;
        std::vector<std::vector<Point>> open;  // disjoint convex polygons where no gap is negative
    };
    // Surfaces within the limits, of the gaps that depend on the axes; other coordinates are those of `state`. If the
    // axes are not coordinates, only a gap that is itself an axis has a surface.
    Surfaces surfaces(std::span<const double> parameters, const State& state, const Drawing& limits) const;
    // The components of a state that the surfaces depend on. The surfaces are unchanged while these are.
    std::vector<double> surfaces_key(const State& state) const { return values_at(state, surface_slots_); }

    // Lines of equal energy at round values: potential energy in a plane of two coordinates, total energy in a plane
    // with a rate. The other coordinates and rates are those of `state`. Empty if the axes are not coordinates or
    // rates.
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
    std::vector<bool> is_shown_;  // for each contact: whether its gap depends on an axis
    std::vector<std::size_t> surface_slots_, level_slots_;
};

// From the state before an impact to the state after it; `coming` is the position shortly before.
struct ImpactArrow {
    Point from, to, coming;
};
// Arrows of the impacts at which a quantity of the view jumps, in a plot of width x height pixels between the limits of
// its panel. No arrow is shorter than `least` pixels, nor closer than that to another at both ends. Only the first of
// very many impacts are considered.
std::vector<ImpactArrow> impact_arrows(const Trajectory& trajectory, const PreparedView& view, const Panel& panel,
                                       double width, double height, double least);

// The lines h = 0 of all gaps as a view shows them, without the parts where another gap is negative, in displayed
// units: segments, separated by NaN points.
// The axes of the view may be two coordinates. Then the gaps that depend on these only are drawn, between the limits of
// `panel`. In a system of two coordinates they may be any functions of these (a point of a mechanism). Then the range
// of the run is drawn, extended by half on each side. The result is empty for every other view. A gap that depends on
// time is drawn at time t. Without t (a whole run) it is left out, because the path may cross any one of its lines.
// `size`: of the plot area.
std::vector<Point> boundary(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                            const Panel& panel, std::optional<double> t = {}, const Resolution& size = {400.0, 300.0});

// Whether any gap of the model depends on time.
bool has_moving_gap(const Model& model);

}  // namespace achilles
