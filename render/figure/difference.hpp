// How far other runs of a system are from the present one, quantity by quantity, over time and on a logarithmic axis.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "figure/compose.hpp"

namespace achilles {

// A run that is compared with the present one, of a model with the same coordinates and parameters.
struct ComparedRun {
    const Trajectory* run = nullptr;
    std::string name;  // for the legend
    Color color;
    std::optional<double> horizon{};  // s, where it comes before the end of the run
};

// |q_other(t) - q_present(t)| of every y of a view (and of its x where that is no time), both runs completed past their Zeno
// points, as long as both last; in the units that are shown. A run is told by its colour, where there are several quantities
// each by its dash. What is less than the rounding noise of the quantities' sizes is drawn there, at the lower end of the
// axis. Of `framing` the limits and what is hidden count. Without another run the panel is empty. What lies after the horizon of
// either run is pale.
Panel difference(const Trajectory& present, std::span<const ComparedRun> others, const PreparedView& view,
                 const Framing& framing, std::optional<double> horizon = {});

// Which of a view's quantities such a panel has.
std::vector<std::size_t> compared_quantities(const PreparedView& view, const Framing& framing);

}  // namespace achilles
