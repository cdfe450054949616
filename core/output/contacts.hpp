// Contacts by name in the output of a run, impulses, and the energy balance.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "run/trajectory.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// The names of these contacts and joints, in ascending order.
std::vector<std::string> contact_names(const Model& model, ContactSet contacts);
// The same joined: "bowl, post" or "bowl+post".
std::string joined_names(const Model& model, ContactSet contacts, std::string_view between = ", ");
// "stick", "slip+" or "slip-"; "open" for an open contact.
std::string_view state_word(ContactState state);
// The contacts and joints with friction that are not open in this mode.
ContactSet rough_in(const Model& model, Mode mode);
// Their states: "foot:stick+bearing:slip-". The names are those of contacts and joints by their number in a mode.
std::string modes_text(const std::vector<std::pair<std::size_t, std::string>>& names, Mode mode);
std::string modes_text(const Model& model, Mode mode);
// Whether the forces of a phase could also be distributed otherwise: between its contacts (theory-gaps.md 2.5), or
// between those that stick with equal slips and share their friction force (theory-friction.md 2).
bool has_nonunique_forces(const Phase& phase);
// Whether contacts, and joints with friction, need their names: there is more than one.
bool has_several_places(const Model& model);
// The name of a jump.
const std::string& jump_name(const Trajectory& trajectory, const Event& jump);
// The names of the contacts that impact, become held, release or pass at an event; empty for a system with one contact.
// The name of a jump.
std::string event_contacts_text(const Trajectory& trajectory, const Event& event);

// The impulses of impacts, v+ = v- + M^-1 sum p_i g_i', of the impacting contacts and of the held ones that react to
// them (theory-gaps.md 2).
class Impulses {
 public:
    explicit Impulses(const Trajectory& trajectory);
    // By contact; empty if the impulses cannot be determined.
    std::vector<std::pair<std::size_t, double>> of(std::size_t event);

 private:
    const Trajectory& trajectory_;
    ContactCache surfaces_;
};

// Slips of contacts and joints at instants of a run with dry friction.
class Slips {
 public:
    explicit Slips(const Trajectory& trajectory) : model_(*trajectory.model), cache_(model_, trajectory.run) {}
    // The direction in which a slip of this sign moves the contact or joint: "to the left", "to the right", "up" or
    // "down" by its largest rate among those of the coordinates x and y (also x1, x_a, ...; x points to the right). If
    // its slip has neither, or rates of two bodies: "with slip > 0".
    std::string direction(std::size_t which, int sign, const State& state);
    // "sticks", or "slides to the left".
    std::string verb(std::size_t which, Mode mode, const State& state);
    // The energy that friction turns into heat at an impact, sum -1/2 p_T (u- + u+) (theory-friction.md 5). It is
    // negative where the impulse of friction does work.
    double heat_of_impact(const Event& impact);

 private:
    const Model& model_;
    ContactCache cache_;
};

// The bounds on the other contacts, as parts of a sentence.
std::string other_contacts_text(const Model& model, const Certificate::OtherContactBounds& others);

// "Moreau's law at event k", for the first event before this one whose order matters but is unknown. Later proofs
// depend on this choice (theory-gaps.md 2.4). Empty if there is no such event.
std::string assumed_impact_law(const Trajectory& trajectory, std::size_t event);

// For each phase, the index after its last event. A phase includes the event that changes its mode.
std::vector<std::size_t> ends_of_phases(const Trajectory& trajectory);

// More than a few phases [first, last) that end alternately at a Zeno point and at an impact that opens held contacts.
// There may be hundreds (theory-gaps.md 2.6), so they are printed as one.
struct ChatterPhases {
    std::size_t first = 0, last = 0;
    std::size_t first_event = 0, last_event = 0;  // the events of these phases, [first_event, last_event)
};
std::vector<ChatterPhases> chatters_of(const Trajectory& trajectory);

// The energies at an instant, in the unit of the system's energy: kinetic, potential, work of forces since the start,
// dissipation at impacts and heat of friction since the start, with E(t) - E(start) = work - loss - heat
// (theory-gaps.md 1). The work may be NaN for a run stored with Recording::final_state.
struct Energies {
    double kinetic = 0.0, potential = 0.0, work = 0.0, loss = 0.0, heat = 0.0;
    double total() const { return kinetic + potential; }
};

// Evaluates the energies of a run. Use one per thread.
class EnergyBalance {
 public:
    EnergyBalance(const Model& model, const Run& run);
    Energies at(const Sample& sample);

 private:
    EnergyTerms<Evaluator<double>> energy_;
};

// The energy dissipated by this event: by an impact, or by the restart at a Zeno point; of a jump what it takes out,
// negative where it adds energy.
double energy_lost(const Trajectory& trajectory, std::size_t event);

// The impact sequence that ends at a Zeno point: all impacts of its contacts since they were last held, and the energy
// dissipated by them and the restart. A plastic impact (e = 0) is a sequence of one.
struct BounceSequence {
    std::size_t first = 0;  // index of the first of these impacts; that of the Zeno point if there is none
    int impacts = 0;
    double loss = 0.0;
};
BounceSequence bounce_sequence_of(const Trajectory& trajectory, std::size_t zeno_event);

}  // namespace achilles
