// Where the energy of a run is and where it went: E(t) - E(start) = work - loss (theory-gaps.md 1).
#pragma once

#include <cstddef>

#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// At an instant, in the unit of the system's energy: what moves, what is stored, and what forces have done and impacts
// have taken since the start. The work is no number where the run kept the ends of steps alone.
struct Energies {
    double kinetic = 0.0, potential = 0.0, work = 0.0, loss = 0.0;
    double total() const { return kinetic + potential; }
};

// One per thread.
class EnergyBalance {
 public:
    EnergyBalance(const Model& model, const Run& run);
    Energies at(const Sample& sample);

 private:
    EnergyTerms<Evaluator<double>> energy_;
};

// What this event alone has taken: of an impact, or of the restart at a Zeno point.
double energy_lost(const Trajectory& trajectory, std::size_t event);

// The impacts of the contacts that come to rest at a Zeno point since these were held last, and what they and the restart
// have taken together. A landing without a bounce (e = 0) is a pile of one.
struct Pile {
    std::size_t first =
        0;  // the first of these impacts, an index into the events; the Zeno point itself where there is none
    int impacts = 0;
    double loss = 0.0;
};
Pile pile_of(const Trajectory& trajectory, std::size_t zeno_event);

}  // namespace achilles
