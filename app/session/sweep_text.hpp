// The picture of a sweep in words, the current run in it, and what the sweep panel offers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweep.hpp"
#include "analysis/table.hpp"
#include "figure/label.hpp"
#include "session/command.hpp"
#include "session/session.hpp"
#include "session/study_jobs.hpp"

namespace achilles {

// The current run's value along an axis, in the file's unit.
std::optional<double> present_value(const Session& session, const SweepAxis& axis);
// Adds the commands that move the current run to a point. All values are set at once: an intermediate state might be
// infeasible.
void go_to_point(const SweepData& data, const std::vector<double>& values, Commands& commands);
// "3 impacts before the cut, Zeno point at 2.7251 s, release at 3.7318 s": the events of the run at a point. For a
// tooltip within one frame, only the beginning of a long run is simulated.
std::string events_at(const Session& session, const Run& run);
// The row of the grid point nearest to these values, if it is computed.
std::optional<std::size_t> sweep_row_at(const SweepData& data, const std::vector<double>& values);
std::string sweep_quantity_text(double value, const ShownUnit& unit);
// What was printed of a point, one quantity a line.
std::string sweep_row_text(const SweepData& data, std::size_t row);

// ---- what the sweep panel offers ----

// Quantities offered in the menu, and the derivative of the first with respect to the x axis.
std::vector<std::string> offered_prints(const SystemDescription& description, const SweepSpec& sweep);
// The command that shows this sweep around the current run.
command::ShowSweep showing(const SweepSpec& sweep, const SystemDescription& description);
// The axis of a sweep over the range of the slider with this name: a parameter, an initial value or an option.
// nullopt if no slider has this name.
std::optional<SweepAxis> axis_for(const Session& session, const std::string& name);

}  // namespace achilles
