#include <cmath>

#include "simulate/impact.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

std::vector<double> gap_units(const Model& model, const Run& run) {
    std::vector<double> units;
    for (std::size_t i = 0; i < model.contacts(); ++i) {
        const double slope = ContactKinematics(model, run, i).at(run.start()).g.norm();
        units.push_back(slope > 0.0 && std::isfinite(slope) ? std::exp2(std::round(std::log2(slope))) : 1.0);
    }
    return units;
}

}  // namespace achilles
