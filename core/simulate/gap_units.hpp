// The unit that tolerances of a gap are meant in (theory-gaps.md 2.7).
#pragma once

#include <vector>

#include "simulate/impact.hpp"

namespace achilles {

// Of each contact the power of 256 that is nearest to |dh|: what 1 m of a coordinate makes of its gap. With it no course depends on
// the unit that a gap is written in.
class GapUnits {
 public:
    GapUnits(const Model& model, const Run& run);
    // At a state. They are found anew where a coordinate has moved on by more than 1, for a gap such as exp(x) y.
    const std::vector<double>& at(const State& state);
    double operator[](std::size_t contact) const { return units_[contact]; }

 private:
    void find(const State& state);

    std::vector<ContactKinematics> surfaces_;
    Vector place_;
    std::vector<double> units_;
};

}  // namespace achilles
