// Parts of the JSON of a run, shared with other output.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "run/trajectory.hpp"

namespace achilles {

// null for a number that is not finite; -0.0 becomes 0.0.
inline nlohmann::ordered_json number_json(double x) {
    return std::isfinite(x) ? nlohmann::ordered_json(x + 0.0) : nlohmann::ordered_json(nullptr);
}
inline nlohmann::ordered_json number_json(const std::optional<double>& x) {
    return x ? number_json(*x) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json system_json(const Trajectory& trajectory);
nlohmann::ordered_json options_json(const Trajectory& trajectory);
nlohmann::ordered_json events_json(const Trajectory& trajectory);

}  // namespace achilles
