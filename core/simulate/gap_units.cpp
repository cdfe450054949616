#include <algorithm>
#include <cmath>

#include "simulate/gap_units.hpp"

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

GapUnits::GapUnits(const Model& model, const Run& run) : units_(model.contacts(), 1.0) {
    for (std::size_t i = 0; i < model.contacts(); ++i) surfaces_.emplace_back(model, run, i);
    find(run.start());
}

void GapUnits::find(const State& state) {
    constexpr double step = 8.0;  // of the exponent: a size of about 1 gives 1
    place_ = state.q;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        const double size = size_of(surfaces_[i], state);
        const bool is_usable = size > 0.0 && std::isfinite(size);
        units_[i] = is_usable ? std::exp2(step * std::round(std::log2(size) / step)) : 1.0;
    }
}

const std::vector<double>& GapUnits::at(const State& state) {
    constexpr double far = 1.0;
    if ((state.q - place_).cwiseAbs().maxCoeff() > far) find(state);
    return units_;
}

}  // namespace achilles
