// From a trajectory and a view to a panel: every limit, tick, colour and marker is decided here.
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

// A view compiled for its model, once; composing again for another run parses nothing. It refers to the model.
class PreparedView {
 public:
    // Throws InputError for an expression that is none.
    PreparedView(const Model& model, const ViewDescription& view);

    // What one expression is called and by what its values are multiplied (180/pi for an angle shown in degrees).
    struct Quantity {
        std::string label, unit;
        double factor = 1.0;
        bool is_time = false;
        std::optional<std::size_t> coordinate{};  // if it is one: its number
        std::string text{};                       // as it is written
    };
    const std::string& title() const { return title_; }
    const Program& program() const { return program_; }
    const std::vector<Quantity>& quantities() const { return quantities_; }  // x, then every y
    // What the y axis is called: as the file says, else a curve's name, or those of two or three.
    const std::string& label() const { return label_; }
    // The unit of all curves, as it is shown; "" where they have several.
    std::string unit() const;

 private:
    static Quantity quantity(const SystemDescription& description, const std::string& written, const std::string& unit);

    std::string title_, label_;
    Program program_;  // x, then every y
    std::vector<Quantity> quantities_;
};

// What a view is called that no file names: "y, z over x", as they are written.
std::string name_of(const ViewDescription& view);
// What stands over its plot: its name, set as a formula where that is what is plotted.
std::string title_of(const ViewDescription& view);

// Samples that show where a run goes: its steps, of a short run with more between them, of a very long one some of them.
// Curves are sampled by themselves (trace.hpp).
std::vector<Sample> plot_samples(const Trajectory& trajectory);

// How a panel is looked at. Limits are in the units that are shown; without them the data fits. On a logarithmic axis
// only what is positive is seen.
struct Framing {
    using Limits = std::optional<std::array<double, 2>>;
    Limits x, y;
    bool log_x = false, log_y = false;
    std::set<std::size_t> hidden;  // curves, counted from 0 as the view's y
    bool legend = true;            // where there are several curves
    // For print a path is true to shape, h = 0 is drawn in it, and what lies on what is there already is not drawn again;
    // a legend stands above the panel, where it needs no room of the data.
    bool for_print = false;
    // Not the quantities but how far those of other runs are from them, over time (difference.hpp).
    bool difference = false;
    Resolution size{};  // of the plot area, about
    friend bool operator==(const Framing&, const Framing&) = default;
};

// The panel of one view until the last of the samples: hybrid phases dashed, constrained ones solid, squares at
// impacts, markers at Zeno points and releases. Over time a run of several contacts has a bar for each.
// What lies after the horizon of the run (s), where that comes before its end, is pale.
Panel compose(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
              const Theme& theme, const Framing& framing = {}, std::optional<double> horizon = {});

// How opaque it is then, of 255; and what its legend says.
inline constexpr std::uint8_t pale_beyond = 70;
std::string beyond_text(double horizon);

// What the view's quantities are at one sample, x first, in the units that are shown.
std::vector<double> values_at(const Trajectory& trajectory, const Sample& sample, const PreparedView& view);

// How well they are known; infinite where the estimate says that nothing is.
std::vector<double> errors_at(const Trajectory& trajectory, const Sample& sample, const PreparedView& view,
                              const Precision& precision);

// What is drawn at an event: the state after it.
Sample sample_at(const Trajectory& trajectory, const Event& event);

// Switches the legend on and puts it into the corner that hides least; where every corner has a curve in it, the panel
// gets room at the top.
void place_legend(Panel& panel);

// A grid of panels.
Figure compose(const Trajectory& trajectory, std::span<const ViewDescription> views, const Theme& theme, int columns);

// Evaluates all of a view's quantities at a sample, x first, in the units they are shown in. Refers to view and trajectory.
class Values {
 public:
    Values(const PreparedView& view, const Trajectory& trajectory)
        : evaluator_(trajectory.model->evaluator(view.program(), trajectory.run.parameters)),
          reads_(view.program().inputs_of(view.program().output_count())),
          quantities_(view.quantities()),
          forces_(*trajectory.model, trajectory.run.parameters) {}
    void set(const Sample& sample) { forces_.run_view(evaluator_, sample, reads_); }
    double operator[](std::size_t i) const { return evaluator_.output(i) * quantities_[i].factor; }
    // Whether a quantity depends on an input (model/derive.hpp).
    bool reads(std::size_t slot) const { return reads_[slot]; }

 private:
    Evaluator<double> evaluator_;
    std::vector<bool> reads_;  // by slot
    std::span<const PreparedView::Quantity> quantities_;
    ContactForces forces_;
};

// A bar for each contact of a run until a time: filled in the colour of constrained phases while it is held, ticked at
// its impacts. What is nearer together than can be seen on this axis is one.
std::vector<TimeBar> contact_bars(const Trajectory& trajectory, double end, const Axis& time, const Theme& theme);

}  // namespace achilles
