// A run that stays beside the present one, as it was when it was pinned.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depend/error_estimate.hpp"
#include "figure/figure.hpp"
#include "figure/touch.hpp"
#include "simulate/sampler.hpp"
#include "system/description.hpp"

namespace achilles {

struct PinnedRun {
    int place = 1;   // from 1 to most_pinned: its colour
    int number = 0;  // of those that were asked for, so many before it: whichever run is there first
    bool shown = true;
    std::shared_ptr<const Trajectory> trajectory;
    std::shared_ptr<Sampler> sampler;
    std::shared_ptr<const std::vector<Sample>> samples;  // for plots
    std::shared_ptr<const std::optional<ErrorEstimate>>
        estimate;  // nothing where another run was made before it was there
    std::optional<double> horizon() const {
        return *estimate ? horizon_before_end(*trajectory, **estimate) : std::nullopt;
    }
    std::shared_ptr<const Touch> touch;        // how its discs rest in the present drawing,
    std::shared_ptr<const Mechanism> touched;  // of this mechanism,
    double touched_size = 0.0;                 // in a world of this size
    std::string name;                          // how it differs from the others and the present one; empty: not at all
    std::vector<Panel> plots;                  // of what is plotted now
    int revision = -1;                         // of that,
    bool dark = false;                         // and in which theme
};

// Whether two descriptions are of one system: the same coordinates, parameters, energies, forces and contacts, whatever the
// values, ranges, views and drawings. Then a run of one is a run of the other.
bool same_system(const SystemDescription& a, const SystemDescription& b);

}  // namespace achilles
