#include "simulate/explain.hpp"

#include <cmath>

#include "certify/truncation.hpp"
#include "simulate/impact.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

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
    reason.cut = next != nullptr && next->kind == Event::Kind::zeno;
    reason.energy_before = energy_at(impact.v_before);
    reason.energy_after = energy_at(impact.v_after);

    ContactKinematics surface(model, run);
    const State before{impact.q, impact.v_before, impact.t};
    const Contact contact = surface.at(before);
    const Collision collision{before, std::abs(contact.hdot),
                              reinitialize(contact, before.v, Reinitialization::kinetic),
                              reinitialize(contact, before.v, run.options.truncation.reinitialization)};
    reason.normal_acceleration = surface.normal_acceleration(collision.with(collision.restart));
    if (reason.normal_acceleration < 0.0) reason.attempt = truncation_conditions(model, run)->prove_any(collision);
    return reason;
}

ReleaseReason explain_release(const Trajectory& trajectory, std::size_t event) {
    const Event& release = trajectory.events[event];
    const Model& model = *trajectory.model;
    const State state{release.q, release.v_after, release.t};
    ContactKinematics surface(model, trajectory.run);
    const double W = surface.at(state).W;
    ReleaseReason reason;
    reason.lambda = -surface.normal_acceleration(state) / W;
    reason.jerk = surface.jerk(state);
    // hddot vanishes here, so the change of W does not matter.
    reason.lambda_rate = -reason.jerk / W;

    constexpr int instants = 60;
    double start = 0.0;
    for (const Phase& phase : trajectory.phases)
        if (phase.kind == Phase::Kind::constrained && phase.end <= release.t) start = phase.start;
    auto force = model.evaluator(model.force(), trajectory.run.parameters);
    Sampler sampler(trajectory);
    for (int i = 0; i < instants; ++i) {  // the release itself belongs to the flight
        const double t = start + (release.t - start) * i / instants;
        set_state(force, sampler.at(t).state);
        force.run();
        reason.force.emplace_back(t, force.output(0));
    }
    reason.force.emplace_back(release.t, reason.lambda);
    return reason;
}

}  // namespace achilles
