// How near a run comes to where it has no derivative (theory-derivatives.md 8).
#pragma once

#include <optional>

namespace achilles {

struct DerivativeMargins {
    std::optional<double> grazing_speed;  // the least speed of an impact with hddot > 0
    std::optional<double> gap_minimum;    // the least minimum of a gap along a flight
    std::optional<double> a_inf;          // the least -hddot at a Zeno point
    std::optional<double> release_jerk;   // the least h''' at a release
};

}  // namespace achilles
