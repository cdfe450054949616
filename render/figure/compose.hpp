// Composes a panel from a trajectory and a view: decides every limit, tick, color and marker.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "figure/trace.hpp"
#include "model/model.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

class Precision;

// A view compiled once for its model, so that another run needs no parsing. Keeps a reference to the model.
class PreparedView {
 public:
    // Throws InputError for an invalid expression.
    PreparedView(const Model& model, const ViewDescription& view);

    // Label, unit and conversion factor of one expression (180/pi for an angle shown in degrees).
    struct ViewQuantity {
        std::string label, unit;
        double factor = 1.0;
        bool is_time = false;
        std::optional<std::size_t> coordinate{};  // its number, if the expression is a coordinate
        std::string text{};                       // the expression as typed
    };
    const std::string& title() const { return title_; }
    const Program& program() const { return program_; }
    const std::vector<ViewQuantity>& quantities() const { return quantities_; }  // x, then every y
    // Label of the y axis: the one in the file, else the name of the only curve, or the names of two or three.
    const std::string& label() const { return label_; }
    // Displayed unit of all curves; "" if they differ.
    std::string unit() const;

 private:
    static ViewQuantity quantity(const SystemDescription& description, const std::string& written,
                                 const std::string& unit);

    std::string title_, label_;
    Program program_;  // x, then every y
    std::vector<ViewQuantity> quantities_;
};

// Default name of a view without one: "y, z over x", as typed.
std::string name_of(const ViewDescription& view);
// Title above the plot: the name, typeset as a formula if the name is the expression that is plotted.
std::string title_of(const ViewDescription& view);

// Samples that outline a run: its steps, with more between them for a short run, a selection for a very long one.
// Curves have their own sampling (trace.hpp).
std::vector<Sample> plot_samples(const Trajectory& trajectory);

// How a panel is viewed. Limits are in displayed units; without limits the axes fit the data. A logarithmic axis shows
// positive values only.
struct Framing {
    using Limits = std::optional<std::array<double, 2>>;
    Limits x, y;
    bool log_x = false, log_y = false;
    std::set<std::size_t> hidden;  // hidden curves, counted from 0 in the order of the view's y
    bool legend = true;            // if there are several curves
    // Print style: paths have equal axes, h = 0 is drawn, and parts that retrace an earlier part are left out. The
    // legend stands above the panel, where it hides no data.
    bool for_print = false;
    // Plot the distance between this run and other runs over time (difference.hpp).
    bool difference = false;
    Resolution size{};       // approximate size of the plot area
    bool is_coarse = false;  // curves go straight through some samples of the run, except in a part of it
    friend bool operator==(const Framing&, const Framing&) = default;
};

// The panel of one view up to the last sample: hybrid phases dashed, constrained ones solid, squares at impacts,
// markers at Zeno points, releases and events of friction. Plots over time of a system with several contacts, or joints
// with friction, have a bar for each. Whatever lies after the horizon of the run (s), if that comes before its end, is
// pale.
Panel compose(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
              const Theme& theme, const Framing& framing = {}, std::optional<double> horizon = {});

// Opacity (of 255) of the curves after the horizon, and their legend text.
inline constexpr std::uint8_t pale_beyond = 70;
std::string beyond_text(double horizon);

// Values of the view's quantities at one sample, x first, in displayed units.
std::vector<double> values_at(const Trajectory& trajectory, const Sample& sample, const PreparedView& view);

// Estimated errors of these values; infinite where nothing is known about them.
std::vector<double> errors_at(const Trajectory& trajectory, const Sample& sample, const PreparedView& view,
                              const Precision& precision);

// The sample drawn at an event: the state after it.
Sample sample_at(const Trajectory& trajectory, const Event& event);

// Shows the legend in the corner where it hides least. If every corner has a curve in it, the panel is extended at the
// top.
void place_legend(Panel& panel);

// A grid of panels.
Figure compose(const Trajectory& trajectory, std::span<const ViewDescription> views, const Theme& theme, int columns);

// Evaluates all quantities of a view at a sample, x first, in displayed units. Keeps references to view and trajectory.
class Values {
 public:
    Values(const PreparedView& view, const Trajectory& trajectory)
        : evaluator_(trajectory.model->evaluator(view.program(), trajectory.run.parameters)),
          reads_(view.program().inputs_of(view.program().output_count())),
          quantities_(view.quantities()),
          forces_(*trajectory.model, trajectory.run.parameters) {}
    void set(const Sample& sample) { forces_.run_view(evaluator_, sample, reads_); }
    double operator[](std::size_t i) const {
        const double value = evaluator_.output(i) * quantities_[i].factor;
        return floors_.empty() || std::abs(value) > floors_[i] ? value : 0.0;
    }
    // From now on a quantity whose size is at most its floor is 0: on a logarithmic axis, rounding errors of what is 0
    // would have most of the decades.
    void set_floors(std::vector<double> floors) { floors_ = std::move(floors); }
    // Whether a quantity depends on an input (model/derive.hpp).
    bool reads(std::size_t slot) const { return reads_[slot]; }

 private:
    Evaluator<double> evaluator_;
    std::vector<bool> reads_;  // for each input slot: whether the program reads it
    std::span<const PreparedView::ViewQuantity> quantities_;
    ContactForces forces_;
    std::vector<double> floors_{};  // one for each quantity, beginning with x; empty if there is none
};

// A bar for each contact, then for each joint with friction, of a run up to the time `end` (s): filled in the color of
// its phase (phase_color) while the contact is held, with ticks at its impacts. Marks of one color that are closer than
// the resolution of this axis are merged.
std::vector<TimeBar> contact_bars(const Trajectory& trajectory, double end, const Axis& time, const Theme& theme);

}  // namespace achilles
