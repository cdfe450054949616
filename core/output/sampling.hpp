// Which instants of a run its files hold.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "simulate/sampler.hpp"

namespace achilles {

// Instants of a run, in the order in which they are asked for; nothing: step ends and events.
using Instants = std::optional<std::vector<double>>;

// So many, at equal distances, from `start` to `end` with both: at least 2.
std::vector<double> equidistant(int count, double start, double end);
// One a line, a constant expression each; an empty line, or what follows #, is none. `name` stands for the file. Throws
// InputError, too, for one that is not in [start, end].
std::vector<double> read_instants(std::string_view text, const std::string& name, double start, double end);

// Step ends and events, an impact as two, before and after it; where steps are long, so many instants between them that a plot
// of them is a curve.
std::vector<Sample> samples_of_curve(const Trajectory& trajectory);
// The states at these instants, after an event that happens there. Instants that the run did not reach have none.
std::vector<Sample> samples_at(const Trajectory& trajectory, const std::vector<double>& times);

}  // namespace achilles
