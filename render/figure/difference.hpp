// Distance between the present run of a system and other runs, for each quantity, over time and on a logarithmic axis.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "figure/compose.hpp"

namespace achilles {

// A run compared with the present one. Both models have the same coordinates and parameters.
struct ComparedRun {
    const Trajectory* run = nullptr;
    std::string name;  // for the legend
    Color color;
    std::optional<double> horizon{};  // s, if it comes before the end of the run
};

// Panel of |q_other(t) - q_present(t)| for every y of a view (and its x unless that is time), in displayed units, while
// both runs last.
// Both runs continue past their Zeno points. Colors identify runs; dashes identify quantities, if there are several.
// Values below the rounding noise of the quantities are drawn at the lower end of the axis. Of `framing`, the limits
// and `hidden` apply. The panel is empty without another run. Curves are pale after the horizon of either run.
Panel difference(const Trajectory& present, std::span<const ComparedRun> others, const PreparedView& view,
                 const Framing& framing, std::optional<double> horizon = {});

// The quantities of a view that such a panel shows.
std::vector<std::size_t> compared_quantities(const PreparedView& view, const Framing& framing);

}  // namespace achilles
