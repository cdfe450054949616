// From a trajectory and a view to a panel: every limit, tick, colour and marker is decided here.
#pragma once

#include <span>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "model/model.hpp"

namespace achilles {

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
    };
    const std::string& name() const { return name_; }
    const Program& program() const { return program_; }
    const std::vector<Quantity>& quantities() const { return quantities_; }  // x, then every y

 private:
    static Quantity quantity(const SystemDescription& description, const std::string& written);

    std::string name_;
    Program program_;  // x, then every y
    std::vector<Quantity> quantities_;
};

// The samples a plot needs: dense enough to look smooth, bounded for any number of impacts. All panels share them.
std::vector<Sample> plot_samples(const Trajectory& trajectory);

// The panel of one view: hybrid phases dashed, constrained ones solid, squares at impacts, markers at Zeno points and
// releases.
Panel compose(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
              const Theme& theme);

// Switches the legend on and puts it into the corner that hides least; where every corner has a curve in it, the panel
// gets room at the top.
void place_legend(Panel& panel);

// A grid of panels.
Figure compose(const Trajectory& trajectory, std::span<const ViewDescription> views, const Theme& theme, int columns);

}  // namespace achilles
