#include "laws/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulate/impact.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {

namespace {

// What a law asks of the model at a state.
class Probe {
 public:
    explicit Probe(const Trajectory& t)
        : model(*t.model),
          surface(model, t.run),
          restitution(model.evaluator(model.restitution(), t.run.parameters).output(0)),
          energy_(model.evaluator(model.energy(), t.run.parameters)) {}

    double energy(const State& state) {
        set_state(energy_, state);
        energy_.run();
        return energy_.output(0);
    }
    // |T| + |V|: what the energy's relative errors refer to.
    double energy_scale(const State& state) {
        energy(state);
        return std::abs(energy_.output(1)) + std::abs(energy_.output(2));
    }
    // -hddot = W lambda.
    double press(const State& state) { return -surface.normal_acceleration(state); }

    const Model& model;
    ContactKinematics surface;
    double restitution;

 private:
    Evaluator<double> energy_;
};

void complain(Violations& violations, bool holds, const std::string& sentence) {
    if (!holds) violations.push_back(sentence);
}

double largest(const Vector& x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

}  // namespace

Violations energy(const Trajectory& trajectory) {
    Violations violations;
    Probe probe(trajectory);
    const std::vector<Sample> samples = Sampler(trajectory).all();
    double scale = 1e-300;
    for (const Sample& sample : samples) scale = std::max(scale, probe.energy_scale(sample.state));
    // Over one smooth stretch the local errors add up: 4e-10 was measured at tolerance 1e-10.
    const double allowed = 100.0 * trajectory.run.options.tolerance * scale;
    const Sample* first = nullptr;
    double start = 0.0;
    for (const Sample& sample : samples) {
        if (!first || first->j != sample.j || first->contact != sample.contact) {
            first = &sample;
            // A flight may be one step: its samples alone would not tell that all of them are moved.
            const Event* event = sample.j > 0 ? &trajectory.events[static_cast<std::size_t>(sample.j) - 1] : nullptr;
            start = probe.energy(event && !sample.contact ? State{event->q, event->v_after} : sample.state);
        }
        const double drift = probe.energy(sample.state) - start;
        complain(violations, std::abs(drift) <= allowed,
                 fmt::format("the energy drifts by {:.3g} up to t = {:.9g}", drift, sample.t));
    }
    const double rounding = 1e-14 * scale;
    for (const Event& event : trajectory.events) {
        const State before{event.q, event.v_before}, after{event.q, event.v_after};
        const double jump = probe.energy(after) - probe.energy(before);
        complain(violations, jump <= rounding, fmt::format("the energy rises by {:.3g} at t = {:.9g}", jump, event.t));
        const Contact contact = probe.surface.at(before);
        double expected = 0.0;
        if (event.kind == Event::Kind::impact)
            expected = -(1.0 - probe.restitution * probe.restitution) * contact.hdot * contact.hdot / (2.0 * contact.W);
        complain(violations, std::abs(jump - expected) <= rounding,
                 fmt::format("the energy jumps by {:.17g} and not by {:.17g} at t = {:.9g}", jump, expected, event.t));
    }
    return violations;
}

Violations gap(const Trajectory& trajectory) {
    Violations violations;
    Probe probe(trajectory);
    for (const Sample& sample : Sampler(trajectory).all(8)) {
        const double h = probe.surface.at(sample.state).h;
        complain(violations, h >= -1e-12 * std::max(1.0, sample.state.q.norm()),
                 fmt::format("the gap is {:.3g} at t = {:.17g}", h, sample.t));
    }
    return violations;
}

Violations phases(const Trajectory& trajectory) {
    Violations violations;
    Probe probe(trajectory);
    const auto check = [&](bool holds, const std::string& what, double t) {
        complain(violations, holds, fmt::format("{} at t = {:.17g}", what, t));
    };
    const std::vector<Phase>& phases = trajectory.phases;
    if (phases.empty()) return {"there is no phase"};
    check(phases.front().start == 0.0, "the first phase starts", phases.front().start);
    check(phases.back().end == trajectory.end_time, "the last phase ends", phases.back().end);
    check(phases.back().kind == trajectory.end_phase, "the end is in another phase than the last", phases.back().end);

    std::size_t next = 0;  // event
    const auto next_is = [&](Event::Kind kind) {
        return next < trajectory.events.size() && trajectory.events[next].kind == kind;
    };
    for (std::size_t i = 0; i < phases.size(); ++i) {
        const Phase& phase = phases[i];
        check(phase.start < phase.end || (i + 1 == phases.size() && phase.start == phase.end), "a phase is empty",
              phase.start);
        int impacts = 0;
        double t = phase.start;
        for (; next_is(Event::Kind::impact) && trajectory.events[next].t <= phase.end; ++next, ++impacts) {
            const Event& event = trajectory.events[next];
            check(event.t >= t, "an impact comes out of order", event.t);
            t = event.t;
            const Contact contact = probe.surface.at({event.q, event.v_before});
            check(std::abs(contact.h) <= 1e-12 * std::max(1.0, event.q.norm()), "an impact is off the surface", t);
            check(contact.hdot < 0.0 && event.impact_speed == -contact.hdot, "an impact does not approach", t);
            const Vector expected =
                event.v_before - (1.0 + probe.restitution) * contact.hdot * contact.impulse_direction;
            check(largest(event.v_after - expected) <= 1e-14 * (1.0 + largest(expected)), "an impact is not Newton's",
                  t);
        }
        check(impacts == phase.impacts, "a phase has another number of impacts than it says", phase.start);
        check(impacts == 0 || phase.kind == Phase::Kind::hybrid, "an impact in contact", phase.start);
        if (i + 1 == phases.size()) break;
        check(phase.end == phases[i + 1].start, "phases do not abut", phase.end);
        check(phase.kind != phases[i + 1].kind, "phases do not alternate", phase.end);
        const bool hybrid = phase.kind == Phase::Kind::hybrid;
        if (!next_is(hybrid ? Event::Kind::zeno : Event::Kind::release)) {
            check(false, "a phase ends without its event", phase.end);
            return violations;
        }
        const Event& event = trajectory.events[next++];
        check(event.t == phase.end, "a phase does not end at its event", event.t);
        check(event.v_before == event.v_after, "a velocity jumps where nothing strikes", event.t);
        const Contact contact = probe.surface.at({event.q, event.v_after});
        check(std::abs(contact.h) <= 1e-12 * std::max(1.0, event.q.norm()) &&
                  std::abs(contact.hdot) <= 1e-12 * std::max(1.0, event.v_after.norm()),
              "h = hdot = 0 does not hold", event.t);
        if (!hybrid) continue;
        check(event.impacts == impacts, "a Zeno point counts other impacts", event.t);
        check(probe.press({event.q, event.v_after}) > 0.0, "hddot < 0 does not hold at a Zeno point", event.t);
        if (!event.certificate || !event.certificate->certified || !event.truncation) {
            check(false, "a Zeno point without a certificate", event.t);
            continue;
        }
        check(event.truncation->t >= t && event.truncation->t <= event.t, "a truncation is out of order", event.t);
        check(event.certificate->zeno_low <= event.t && event.t <= event.certificate->zeno_high,
              "the Zeno time is outside its interval", event.t);
    }
    check(next == trajectory.events.size(), "there are events after the last phase", trajectory.end_time);
    return violations;
}

Violations contact_force(const Trajectory& trajectory) {
    Violations violations;
    Probe probe(trajectory);
    double strongest = 0.0;
    for (const Phase& phase : trajectory.phases) {
        if (phase.kind != Phase::Kind::constrained) continue;
        // The last instant is the release, or the end of the run.
        for (const Sample& sample : Sampler(trajectory).all(4)) {
            if (sample.t < phase.start || sample.t >= phase.end || !sample.contact) continue;
            const double press = probe.press(sample.state);
            strongest = std::max(strongest, press);
            complain(violations, press > 0.0,
                     fmt::format("in contact -hddot = {:.3g} at t = {:.17g}", press, sample.t));
        }
    }
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::release) continue;
        const State state{event.q, event.v_after};
        complain(violations, std::abs(probe.press(state)) <= 1e-12 * strongest,
                 fmt::format("released while -hddot = {:.3g} at t = {:.17g}", probe.press(state), event.t));
        complain(violations, probe.surface.jerk(state) > 0.0,
                 fmt::format("released while h''' <= 0 at t = {:.17g}", event.t));
    }
    return violations;
}

}  // namespace achilles::test
