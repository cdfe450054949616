// Laws of dry friction (theory-friction.md 1, 2, 5).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floor/laws.hpp"
#include "model/model.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {

namespace {

// Relative error of velocities and forces that accumulated integration errors may cause.
double allowed_error(const Trajectory& trajectory) { return 1e3 * trajectory.run.options.tolerance + 1e-12; }

// The heat that the impacts at this time take back, because their friction does work.
double heat_taken_back(const Trajectory& trajectory, ContactCache& surfaces, double t) {
    double sum = 0.0;
    for (const Event& event : trajectory.events) {
        if (event.t != t || !event.friction) continue;
        double heat = 0.0;
        for (const auto& [contact, p] : event.friction->tangential)
            heat -= 0.5 * p *
                    (surfaces.slip(contact, {event.q, event.v_before, t}).u +
                     surfaces.slip(contact, {event.q, event.v_after, t}).u);
        sum += std::max(-heat, 0.0);
    }
    return sum;
}

// Whether two contacts are about to collapse: both are held already, by forces of either sign (theory-collapse.md 4).
bool is_before_collapse(const Trajectory& trajectory, double t) {
    return std::any_of(trajectory.events.begin(), trajectory.events.end(), [&](const Event& event) {
        return event.is_collapse() && event.truncation && event.truncation->t < t && t <= event.t;
    });
}

// What one sample violates: slips against the mode, friction forces outside their cones.
void check_state(const Sample& sample, ContactCache& surfaces, double error, Violations& violations) {
    const auto complain = [&](const char* what, std::size_t i, double value) {
        violations.push_back(fmt::format("{} of {}: {:.3g} at t = {:.17g}", what, i, value, sample.t));
    };
    const Mode mode = sample.mode;
    for (const std::size_t i : mode.held().with(mode.joints()).within(surfaces.rough())) {
        const double u = surfaces.slip(i, sample.state).u, size = 1.0 + sample.state.v.cwiseAbs().maxCoeff();
        const int sign = slip_sign(mode.state(i));
        if (sign == 0 && std::abs(u) > error * size) complain("what sticks has a slip", i, u);
        if (sign * u < -error * size && !surfaces.frictionless().contains(i)) complain("a slip has another sign", i, u);
    }
    ModeKinematics& motion = surfaces.motion(mode);
    for (std::size_t k = 0; k + 1 < motion.friction().size(); ++k) {
        if (motion.friction()[k].watched != FrictionFunction::upper_limit) continue;
        const double upper = motion.at(sample.state, surfaces.count() + k).value,
                     lower = motion.at(sample.state, surfaces.count() + k + 1).value;
        // Their sum is twice the limit of the friction force.
        if (std::min(upper, lower) < -error * (upper + lower))
            complain("a friction force leaves its cone", motion.friction()[k].contact, std::min(upper, lower));
    }
}

}  // namespace

Violations friction(const Trajectory& trajectory) {
    Violations violations;
    if (!trajectory.model->has_friction()) return violations;
    ContactCache surfaces(*trajectory.model, trajectory.run);
    double heat = 0.0;
    for (const Sample& sample : Sampler(trajectory).all(4)) {
        check_state(sample, surfaces, allowed_error(trajectory), violations);
        const double fall = heat - sample.heat;
        const double rounding = allowed_error(trajectory) * (std::abs(heat) + std::abs(sample.heat)) +
                                1e-13 * (trajectory.loss + trajectory.heat);
        if (fall > rounding && fall > heat_taken_back(trajectory, surfaces, sample.t) + rounding &&
            !is_before_collapse(trajectory, sample.t))
            violations.push_back(fmt::format("heat falls by {:.3g} at t = {:.17g}", fall, sample.t));
        heat = sample.heat;
    }
    return violations;
}

Violations rough_contact_force(const Trajectory& trajectory) {
    Violations violations;
    ContactCache surfaces(*trajectory.model, trajectory.run);
    const auto negative_force = [&](Mode mode, const State& state, std::size_t i) {
        return surfaces.motion(mode).at(state, i);
    };
    double strongest = 0.0;
    for (const Sample& sample : Sampler(trajectory).all(4)) {
        const auto phase = std::find_if(trajectory.phases.begin(), trajectory.phases.end(),
                                        [&](const Phase& one) { return one.start <= sample.t && sample.t < one.end; });
        if (phase == trajectory.phases.end() || !(sample.mode == phase->mode)) continue;
        for (const std::size_t i : sample.mode.held()) {
            const double force = -negative_force(sample.mode, sample.state, i).value;
            strongest = std::max(strongest, force);
            if (!(force > 0.0))
                violations.push_back(fmt::format("in contact a force is {:.3g} at t = {:.17g}", force, sample.t));
        }
    }
    for (std::size_t k = 0; k < trajectory.events.size(); ++k) {
        const Event& event = trajectory.events[k];
        if (!event.is_release()) continue;
        for (const std::size_t i : event.contacts) {
            const auto [value, rate] = negative_force(mode_before(trajectory, k), {event.q, event.v_after, event.t}, i);
            if (std::abs(value) > allowed_error(trajectory) * (1.0 + strongest))
                violations.push_back(fmt::format("released at the force {:.3g} at t = {:.17g}", -value, event.t));
            if (!(rate > 0.0)) violations.push_back(fmt::format("released while h''' <= 0 at t = {:.17g}", event.t));
        }
    }
    return violations;
}

}  // namespace achilles::test
