#include "output/energy.hpp"

namespace achilles {

EnergyBalance::EnergyBalance(const Model& model, const Run& run)
    : energy_(model.evaluator(model.energy(), run.parameters)) {}

Energies EnergyBalance::at(const Sample& sample) {
    set_state(energy_, State{sample.state.q, sample.state.v, sample.t});
    energy_.run();
    return {energy_.kinetic(), energy_.potential(), sample.work, sample.loss};
}

double energy_lost(const Trajectory& trajectory, std::size_t event) {
    const auto& events = trajectory.events;
    return events[event].loss - (event > 0 ? events[event - 1].loss : 0.0);
}

namespace {

bool meet(ContactSet a, ContactSet b) { return a.without(b) != a; }

}  // namespace

Pile pile_of(const Trajectory& trajectory, std::size_t zeno_event) {
    const auto& events = trajectory.events;
    const ContactSet contacts = events[zeno_event].contacts;
    Pile pile{zeno_event, 0, energy_lost(trajectory, zeno_event)};
    for (std::size_t i = zeno_event; i-- > 0;) {
        const Event& event = events[i];
        if (meet(event.opened, contacts)) break;
        if (!meet(event.contacts, contacts)) continue;
        if (!event.is_impact()) break;
        pile.first = i;
        ++pile.impacts;
        pile.loss += energy_lost(trajectory, i);
    }
    return pile;
}

}  // namespace achilles
