// What the sweep panel offers: quantities, axes, and the command that shows a sweep.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/sweep.hpp"
#include "session/command.hpp"
#include "session/study_jobs.hpp"

namespace achilles {

class Session;

// Quantities offered in the menu, and the derivative of the first with respect to the x axis.
std::vector<std::string> offered_prints(const SystemDescription& description, const SweepSpec& sweep);
// The command that shows this sweep around the current run.
command::ShowSweep showing(const SweepSpec& sweep, const SystemDescription& description);
// The axis of a sweep over the range of the slider with this name: a parameter, an initial value or an option.
// nullopt if no slider has this name.
std::optional<SweepAxis> axis_for(const Session& session, const std::string& name);

}  // namespace achilles
