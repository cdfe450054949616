#include "simulate/explain.hpp"

#include <cmath>

#include "certify/truncation.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/impact.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

std::size_t first_of(ContactSet contacts, const Model& model) {
    for (std::size_t i = 0; i < model.contacts(); ++i)
        if (contacts.contains(i)) return i;
    return 0;
}

// The held contacts of a mode that never need a force.
ContactSet unpressed_at(const Trajectory& trajectory, Mode mode, const State& state) {
    ContactSet found;
    if (mode.is_free()) return found;
    ContactCache surfaces(*trajectory.model, trajectory.run);
    const State scale = scale_of(trajectory);
    for (const std::size_t i : mode.held())
        if (const Mode others = trajectory.model->unconstrained(mode, i);
            surfaces.is_nearly_free(i, others, state, scale) && surfaces.never_needs_force(i, others))
            found = found.with(i);
    return found;
}

}  // namespace

ImpactReason explain_impact(const Trajectory& trajectory, std::size_t event) {
    const Event& impact = trajectory.events[event];
    const Model& model = *trajectory.model;
    const Run& run = trajectory.run;
    auto energy = model.evaluator(model.energy(), run.parameters);
    const auto energy_at = [&](const Vector& v) {
        set_state(energy, State{impact.q, v, impact.t});
        energy.run();
        return energy.total();
    };
    ImpactReason reason;
    const Event* next = event + 1 < trajectory.events.size() ? &trajectory.events[event + 1] : nullptr;
    reason.cut = next != nullptr && next->truncation && next->truncation->t == impact.t;
    reason.energy_before = energy_at(impact.v_before);
    reason.energy_after = energy_at(impact.v_after);

    reason.mode = mode_before(trajectory, event);
    if (impact.contacts.count() != 1 || !impact.opened.empty() || model.has_friction()) return reason;
    const std::size_t which = first_of(impact.contacts, model);
    reason.contact = which;
    const Mode motion = reason.mode.only(load_bearing_contacts(trajectory, reason.mode, impact.t));
    ContactKinematics surface(model, run, which, motion);
    const State before{impact.q, impact.v_before, impact.t};
    const Contact contact = surface.at(before);
    const Collision collision{before, std::abs(contact.hdot),
                              reinitialize(contact, before.v, Reinitialization::kinetic),
                              reinitialize(contact, before.v, run.options.truncation.reinitialization)};
    reason.normal_acceleration = surface.normal_acceleration(collision.with(collision.restart));
    if (reason.normal_acceleration < 0.0)
        reason.attempt = truncation_conditions(model, run, which, motion, unpressed_at(trajectory, motion, before))
                             ->prove_any(collision);
    return reason;
}

ReleaseReason explain_release(const Trajectory& trajectory, std::size_t event) {
    const Event& release = trajectory.events[event];
    const Model& model = *trajectory.model;
    const State state{release.q, release.v_after, release.t};
    ReleaseReason reason;
    const std::size_t which = reason.contact = first_of(release.contacts, model);
    const Mode mode = mode_before(trajectory, event);
    const bool unique = load_bearing_contacts(trajectory, mode, release.t) == mode.held();
    ContactKinematics surface(model, trajectory.run, which,
                              unique ? model.unconstrained(mode, which)
                                     : release.mode.only(load_bearing_contacts(trajectory, release.mode, release.t)));
    const double W = surface.at(state).W;
    reason.lambda = -surface.normal_acceleration(state) / W;
    reason.jerk = surface.jerk(state);
    // hddot is 0 at a release, so the derivative of W has no effect.
    reason.lambda_rate = -reason.jerk / W;

    constexpr int instants = 60;
    double start = trajectory.run.options.start_time;
    for (const Phase& phase : trajectory.phases) {
        if (phase.end > release.t) break;
        if (!phase.mode.is_held(which)) start = phase.end;
    }
    ContactForces forces(model, trajectory.run.parameters);
    Sampler sampler(trajectory);
    for (int i = 0; i < instants; ++i) {  // the release itself belongs to the next phase
        const double t = start + (release.t - start) * i / instants;
        forces.set(sampler.at(t));
        reason.force.emplace_back(t, forces.force(which));
    }
    reason.force.emplace_back(release.t, reason.lambda);
    return reason;
}

}  // namespace achilles
