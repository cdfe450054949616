// Parts of what to_json() says of a run, for who says more.
#pragma once

#include <nlohmann/json.hpp>

#include "run/trajectory.hpp"

namespace achilles {

nlohmann::ordered_json system_json(const Trajectory& trajectory);
nlohmann::ordered_json options_json(const Trajectory& trajectory);
nlohmann::ordered_json events_json(const Trajectory& trajectory);

}  // namespace achilles
