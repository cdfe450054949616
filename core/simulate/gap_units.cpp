#include <algorithm>
#include <cmath>

#include "simulate/impact.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

namespace {

// |dh|, or how much h changes in a unit of way along dh, where that is much less: as of sin(1e9 x).
double size_of(ContactKinematics& surface, const State& start) {
    constexpr double much = 16.0;
    const Contact contact = surface.at(start);
    const double slope = contact.g.norm();
    double change = 0.0;
    for (const double way : {-1.0, 1.0}) {
        State beside = start;
        beside.q += way / slope * contact.g;
        const double h = surface.at(beside).h;
        change = std::max(change, std::isfinite(h) ? std::abs(h - contact.h) : slope);
    }
    return slope > much * change ? change : slope;
}

}  // namespace

std::vector<double> gap_units(const Model& model, const Run& run) {
    constexpr double step = 8.0;  // of the exponent: what is about 1 is 1
    std::vector<double> units;
    for (std::size_t i = 0; i < model.contacts(); ++i) {
        ContactKinematics surface(model, run, i);
        const double size = size_of(surface, run.start());
        const bool is_usable = size > 0.0 && std::isfinite(size);
        units.push_back(is_usable ? std::exp2(step * std::round(std::log2(size) / step)) : 1.0);
    }
    return units;
}

}  // namespace achilles
