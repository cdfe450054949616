// What is said of the contacts of a run, by name.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

// The names of these contacts, in their order.
std::vector<std::string> contact_names(const Model& model, ContactSet contacts);
// The same as one text, "bowl, post" or "bowl+post".
std::string joined_names(const Model& model, ContactSet contacts, std::string_view between = ", ");
// Of an event: the names of the contacts that land, come to rest or leave. Empty where the system has one contact, which goes
// without saying.
std::string contacts_told(const Trajectory& trajectory, const Event& event);

// The impulses of impacts, v+ = v- + M^-1 sum p_i g_i': of the contacts that land, and of the held ones that these press
// (theory-gaps.md 2).
class Impulses {
 public:
    explicit Impulses(const Trajectory& trajectory);
    // Contact by contact; empty where they cannot be told.
    std::vector<std::pair<std::size_t, double>> of(std::size_t event);

 private:
    const Trajectory& trajectory_;
    Surfaces surfaces_;
};

// What is proved of the other contacts, one part of a sentence after the other.
std::string others_told(const Model& model, const Certificate::Others& others);

// "Moreau's law at event k": the first before this one whose order matters and could not be told, which all that is proved
// later stands on (theory-gaps.md 2.4). Empty where there is none.
std::string given(const Trajectory& trajectory, std::size_t event);

// Of each phase, the event after its last one: a phase ends with that which changes what is held.
std::vector<std::size_t> ends_of_phases(const Trajectory& trajectory);

// Phases [first, last) that end in turn with a Zeno point and with an impact that opens what was held, more than a few:
// hundreds are possible (theory-gaps.md 2.6). They are told as one.
struct Chatter {
    std::size_t first = 0, last = 0;
    std::size_t first_event = 0, last_event = 0;  // theirs, the same way
};
std::vector<Chatter> chatters_of(const Trajectory& trajectory);

// Where the energy of a run is and where it went: E(t) - E(start) = work - loss (theory-gaps.md 1).

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
