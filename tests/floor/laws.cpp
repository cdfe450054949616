#include "floor/laws.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/complementarity.hpp"
#include "model/model.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {

namespace {

double largest(const Vector& x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

// x with W x = b; of least norm if gradients are linearly dependent.
Eigen::VectorXd least(const ContactMatrix<double>& W, const Eigen::VectorXd& b) {
    return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(W).solve(b);
}

// Ratio of the smallest to the largest eigenvalue of W: 0 if gradients are linearly dependent.
double min_pivot(const ClosedContacts& held) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> values(Eigen::MatrixXd(held.W), Eigen::EigenvaluesOnly);
    return values.eigenvalues().minCoeff() / values.eigenvalues().maxCoeff();
}

// Quantities of the model at a state that the laws need.
class Probe {
 public:
    explicit Probe(const Trajectory& t)
        : model(*t.model),
          surfaces(model, t.run),
          trajectory_(t),
          energy_(model.evaluator(model.energy(), t.run.parameters)),
          flight_(model.evaluator(model.motion({}).program, t.run.parameters)) {
        for (std::size_t i = 0; i < model.contacts(); ++i)
            restitution.push_back(model.evaluator(model.restitution(i), t.run.parameters).output(0));
    }

    double energy(const State& state) {
        set_state(energy_, state);
        energy_.run();
        return energy_.output(0);
    }
    // |T| + |V|, the scale of relative errors of the energy.
    double energy_scale(const State& state) {
        energy(state);
        return std::abs(energy_.output(1)) + std::abs(energy_.output(2));
    }
    // |V| + sum |M_ij v_i v_j|/2, the scale of rounding errors of the energy if the terms of T cancel.
    double terms_scale(const State& state) {
        const auto kinetic = [&](Eigen::Index i, Eigen::Index j) {
            State part{state.q, Vector::Zero(state.v.size()), state.t};
            part.v[i] = state.v[i];
            part.v[j] = state.v[j];
            energy(part);
            return energy_.output(1);
        };
        double sum = 0.0;
        for (Eigen::Index i = 0; i < state.v.size(); ++i) {
            sum += kinetic(i, i);
            for (Eigen::Index j = 0; j < i; ++j) sum += std::abs(kinetic(i, j) - kinetic(i, i) - kinetic(j, j));
        }
        return sum + std::abs(energy_.output(2));
    }
    // Tolerance for h = 0.
    static double off(const State& state) { return 1e-12 * std::max(1.0, state.q.norm()); }
    // hddot of a contact without constraints, where these contacts act on the forces.
    double acceleration_of(std::size_t contact, const State& state, const ClosedContacts& held) {
        const Mode acting = Mode().with_acting(held.contacts_at(held.places_of(model.equations().in_forces)));
        return surfaces.of(contact, acting).normal_acceleration(state);
    }
    // The smallest of these forces but for those of latched contacts, which may pull.
    static double least_force(const Eigen::VectorXd& forces, const ClosedContacts& held, ContactSet latched) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < held.which.size(); ++i)
            if (!latched.contains(held.which[i])) least = std::min(least, forces[static_cast<Eigen::Index>(i)]);
        return least;
    }
    // The contact forces that hold these contacts: W lambda = -hddot.
    Eigen::VectorXd forces(const State& state, const ClosedContacts& held) {
        Eigen::VectorXd hddot(static_cast<Eigen::Index>(held.which.size()));
        for (Eigen::Index i = 0; i < hddot.size(); ++i)
            hddot[i] = acceleration_of(held.which[static_cast<std::size_t>(i)], state, held);
        return least(held.W, -hddot);
    }

    // The same; if the forces are not unique, a nonnegative solution if there is one.
    Eigen::VectorXd pressing(const State& state, const ClosedContacts& held) {
        const Eigen::VectorXd of_any_sign = forces(state, held);
        if (min_pivot(held) > 1e-9) return of_any_sign;
        const auto choice = solve_complementarity(held.W, ContactVector<double>(-held.W * of_any_sign));
        return choice ? Eigen::VectorXd(choice->p) : of_any_sign;
    }
    // The largest remaining acceleration of a held gap under the reported forces, relative to that by the largest
    // force.
    double off_balance(const State& state, const ClosedContacts& held, ContactForces& told) {
        Eigen::VectorXd left(static_cast<Eigen::Index>(held.which.size())), lambda = left;
        for (Eigen::Index i = 0; i < left.size(); ++i) {
            left[i] = acceleration_of(held.which[static_cast<std::size_t>(i)], state, held);
            lambda[i] = told.force(held.which[static_cast<std::size_t>(i)]);
        }
        const double size = 1e-300 + left.cwiseAbs().maxCoeff() + (held.W.cwiseAbs() * lambda.cwiseAbs()).maxCoeff();
        return (left + held.W * lambda).cwiseAbs().maxCoeff() / size;
    }

    // Scale of rounding errors of a contact force: the force that would stop the largest acceleration.
    double force_scale(const State& state, const Contact& contact) {
        set_state(flight_, state);
        flight_.run();
        double most = 0.0;
        for (Eigen::Index i = 0; i < contact.g.size(); ++i)
            most = std::max(most, std::abs(flight_.output(static_cast<std::size_t>(i))));
        return contact.g.lpNorm<1>() * most / contact.W;
    }

    const Model& model;
    ContactCache surfaces;
    std::vector<double> restitution;
    // Two contacts that collapse at a tie have a plastic impact (theory-collapse.md 4).
    double restitution_at(const Event& impact, std::size_t contact) const {
        for (const Event& event : trajectory_.events)
            if (event.is_collapse() && !event.truncation && event.t == impact.t && event.contacts.contains(contact))
                return 0.0;
        return restitution[contact];
    }

 private:
    const Trajectory& trajectory_;
    EnergyTerms<Evaluator<double>> energy_;
    Evaluator<double> flight_;
};

void complain(Violations& violations, bool holds, const std::string& sentence) {
    if (!holds) violations.push_back(sentence);
}

ContactSet held_before(const Event& event) { return event.mode.held().with(event.opened).without(event.contacts); }

// The Zeno point or the collapse of the impact sequence that was cut at this impact, if there is one.
const Event* cut_at(const Trajectory& trajectory, const Event& event) {
    for (const Event* next = &event + 1; next != trajectory.events.data() + trajectory.events.size(); ++next)
        if (next->is_zeno() || next->is_collapse())
            return next->truncation && next->truncation->t == event.t ? next : nullptr;
        else if (next->t > event.t)
            return nullptr;
    return nullptr;
}

// Whether the sequence was cut at this impact and the run ends before the Zeno point. The restart is then not recorded.
bool ends_cut(const Trajectory& trajectory, const Event& event) {
    return &event == &trajectory.events.back() && !trajectory.pieces.empty() &&
           trajectory.pieces.back().start >= event.t && trajectory.pieces.back().mode.held() != event.mode.held();
}

State before(const Event& event) { return {event.q_before(), event.v_before, event.t}; }
State after(const Event& event) { return {event.q, event.v_after, event.t}; }

// The contacts of an impact: the impacting ones, the held ones, and those with a recorded impulse.
ContactSet struck(const Event& event) {
    ContactSet set = event.contacts.with(held_before(event));
    if (event.joint)
        for (const auto& [contact, impulse] : event.joint->impulses) set = set.with(contact);
    return set;
}

// An impact reconstructed from the velocity jump: the impulses p of its contacts, hdot before and after.
struct Blow {
    Blow(Probe& probe, const Event& event)
        : contacts(probe.surfaces.at(before(event), struck(event))),
          rates(contacts.rates()),
          rates_after(probe.surfaces.at(after(event), contacts.contacts_at(all())).rates()),
          p(least(contacts.W, rates_after - rates)) {
        for (std::size_t i = 0; i < contacts.which.size(); ++i)
            if (held_before(event).contains(contacts.which[i])) rates[static_cast<Eigen::Index>(i)] = 0.0;
        // If gradients are linearly dependent, or nearly so, velocities do not determine the impulses: use the recorded
        // ones.
        if (!event.joint) return;
        Eigen::VectorXd told = Eigen::VectorXd::Zero(p.size());
        for (const auto& [contact, impulse] : event.joint->impulses)
            for (std::size_t i = 0; i < contacts.which.size(); ++i)
                if (contacts.which[i] == contact) told[static_cast<Eigen::Index>(i)] = impulse;
        p = told;
    }
    ContactSet all() const {
        ContactSet set;
        for (std::size_t i = 0; i < contacts.which.size(); ++i) set = set.with(i);
        return set;
    }

    ClosedContacts contacts;
    Eigen::VectorXd rates, rates_after, p;
};

// The same with friction, from the recorded impulses: gaps and slips are rows, and the rates before and after are theirs.
struct RoughBlow {
    RoughBlow(Probe& probe, const Event& event)
        : rows(probe.surfaces.rows(before(event), struck(event), struck(event).within(probe.surfaces.rough()), {})),
          p(Eigen::VectorXd::Zero(rows.size())),
          rates(p),
          rates_after(p) {
        for (const auto& [contact, impulse] : event.joint->impulses) p[rows.gap_of(contact)] = impulse;
        for (const auto& [contact, impulse] : event.friction->tangential) p[rows.slip_of(contact)] = impulse;
        const ContactRows next = probe.surfaces.rows(after(event), struck(event), all_slips(), {});
        for (Eigen::Index k = 0; k < rows.size(); ++k) {
            rates[k] = row(k).rate;
            rates_after[k] = next.rows[static_cast<std::size_t>(k)].rate;
        }
    }
    const ContactRows::Row& row(Eigen::Index k) const { return rows.rows[static_cast<std::size_t>(k)]; }
    ContactSet all_slips() const {
        ContactSet set;
        for (const auto& [contact, slip] : rows.slips) set = set.with(contact);
        return set;
    }

    ContactRows rows;
    Eigen::VectorXd p, rates, rates_after;
};

// The exchange of energy in an impact by its impulses.
Exchange exchange_of(Probe& probe, const Event& event) {
    Exchange sum;
    if (event.friction) {
        const RoughBlow blow(probe, event);
        for (Eigen::Index k = 0; k < blow.rows.size(); ++k) {
            sum.work -= blow.p[k] * blow.row(k).drift;
            (blow.row(k).is_slip ? sum.heat : sum.loss) -= 0.5 * blow.p[k] * (blow.rates[k] + blow.rates_after[k]);
        }
        return sum;
    }
    const Blow blow(probe, event);
    for (std::size_t i = 0; i < blow.contacts.which.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        sum.work -= blow.p[k] * blow.contacts.contacts[i].gap_t;
        sum.loss -= 0.5 * blow.p[k] * (1.0 - probe.restitution_at(event, blow.contacts.which[i])) * blow.rates[k];
    }
    return sum;
}

// Coulomb's law of an impact: |p_T| <= mu p, and where the slip goes on, p_T = -mu p against it. Coefficients that vary
// are those of another state.
void coulomb(Violations& violations, Probe& probe, const Event& event, double rounding) {
    const RoughBlow blow(probe, event);
    const auto check = [&](bool holds, const char* what) {
        complain(violations, holds, fmt::format("{} at t = {:.17g}", what, event.t));
    };
    check(largest(event.v_after - blow.rows.after(event.v_before, blow.p)) <= rounding,
          "an impact with friction is not along impulses");
    for (const auto& [contact, slip] : blow.rows.slips) {
        const Eigen::Index gap = blow.rows.gap_of(contact), k = blow.rows.slip_of(contact);
        if (probe.surfaces.varying().contains(contact) || probe.surfaces.never_slides(contact)) continue;
        const double most = slip.coefficient * blow.p[gap], off = 1e-9 * std::abs(most) + rounding / blow.rows.W(k, k);
        check(std::abs(blow.p[k]) <= most + off, "an impulse of friction leaves its cone");
        if (std::abs(blow.rates_after[k]) > 1e-9 * (1.0 + largest(event.v_before)))
            check(std::abs(blow.p[k] + std::copysign(most, blow.rates_after[k])) <= off,
                  "an impulse of friction is not against the slip");
    }
}

// Moreau's law (theory-gaps.md 2.1), with one closed contact Newton's. Velocities jump by impulses p >= 0 of impacting
// or held contacts, and hdot+ = -e hdot- where p > 0.
void moreau(Violations& violations, Probe& probe, const Event& event) {
    const Blow blow(probe, event);
    const double rounding = 1e-14 * (1.0 + std::max(largest(event.v_before), largest(event.v_after)));
    const auto check = [&](bool holds, const char* what) {
        complain(violations, holds, fmt::format("{} at t = {:.17g}", what, event.t));
    };
    if (event.friction)
        coulomb(violations, probe, event, 10.0 * rounding);
    else
        check(largest(event.v_after - blow.contacts.after(event.v_before, blow.p)) <= rounding,
              "an impact is not along impulses");
    for (std::size_t i = 0; i < blow.contacts.which.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const std::size_t contact = blow.contacts.which[i];
        const bool is_capped = event.friction && event.friction->capped.contains(contact);
        const double e = probe.restitution_at(event, contact) * (is_capped ? *event.friction->energy_cap : 1.0);
        const double left = blow.rates_after[k] + e * blow.rates[k];
        const double allowed = rounding * (1.0 + blow.contacts.contacts[i].g.norm());
        // The change of the contact's own hdot by its impulse. For a contact that is closed only nearly it is rounding
        // error.
        const double push = blow.p[k] * blow.contacts.contacts[i].W;
        check(push >= -allowed, "an impulse pulls");
        if (push > 100.0 * allowed) check(std::abs(left) <= allowed, "an impact is not Newton's");
        if (event.contacts.contains(contact) || held_before(event).contains(contact))
            check(left >= -allowed, "an impact leaves a gap closing");
    }
}

}  // namespace

Violations energy(const Trajectory& trajectory) {
    Violations violations;
    Probe probe(trajectory);
    const std::vector<Sample> samples = Sampler(trajectory).all();
    double scale = 1e-3;  // tolerances are absolute for states below 1: a dimer of grams and millimeters
    for (const Sample& sample : samples)
        scale = std::max({scale, probe.energy_scale(sample.state), std::abs(sample.work), sample.loss + sample.heat});
    // Local errors add up: 4e-10 was measured at tolerance 1e-10 over one smooth segment. So do those of impacts.
    const double impacts = static_cast<double>(trajectory.statistics.impacts);
    const double allowed = (100.0 + impacts) * trajectory.run.options.tolerance * scale;
    const auto balance = [&](const State& state, const auto& booked) {
        return probe.energy(state) - booked.work + booked.loss + booked.heat;
    };
    const double start = balance(samples.front().state, samples.front());
    const auto check = [&](double found, double t) {
        complain(violations, std::abs(found - start) <= allowed,
                 fmt::format("energy less work, loss and heat drifts by {:.3g} up to t = {:.9g}", found - start, t));
    };
    for (const Sample& sample : samples) check(balance(sample.state, sample), sample.t);
    double lost = 0.0;
    for (const Event& event : trajectory.events) {
        // The loss of the restart is recorded with the impact. A pair also restarts from other coordinates.
        const Event* const cut = event.kind == Event::Kind::impact ? cut_at(trajectory, event) : nullptr;
        const bool restarts = cut || ends_cut(trajectory, event);
        const State next = cut ? State{cut->truncation->q, cut->truncation->v, event.t} : after(event);
        if (cut ? cut->contacts.count() == 1 : !restarts) check(balance(next, event), event.t);
        const double jump = probe.energy(after(event)) - probe.energy(before(event));
        const double terms = std::max(probe.terms_scale(before(event)), probe.terms_scale(after(event)));
        const double rounding = 1e-14 * std::max(scale, terms);
        Exchange booked;
        if (event.kind == Event::Kind::impact) {
            booked = exchange_of(probe, event);
            complain(
                violations, restarts || std::abs(event.loss - lost - booked.loss) <= rounding,
                fmt::format("{:.17g} is lost and not {:.17g} at t = {:.9g}", event.loss - lost, booked.loss, event.t));
        }
        const double change = booked.work - booked.loss - booked.heat;
        if (event.is_jump()) {  // its loss is what the energies say
            lost = event.loss;
            continue;
        }
        complain(violations, std::abs(jump - change) <= rounding,
                 fmt::format("the energy jumps by {:.17g} and not by {:.17g} at t = {:.9g}", jump, change, event.t));
        // The Euclidean restart may increase the energy.
        complain(violations, restarts || event.loss >= lost - rounding,
                 fmt::format("energy is found at t = {:.9g}", event.t));
        lost = event.loss;
    }
    return violations;
}

Violations gap(const Trajectory& trajectory) {
    Violations violations;
    Probe probe(trajectory);
    for (const Sample& sample : Sampler(trajectory).all(8))
        for (std::size_t i = 0; i < probe.model.contacts(); ++i) {
            if (sample.inactive.contains(i)) continue;
            const double h = probe.surfaces.of(i).at(sample.state).h;
            complain(violations, h >= -Probe::off(sample.state),
                     fmt::format("gap {} is {:.3g} at t = {:.17g}", i, h, sample.t));
        }
    return violations;
}

namespace {

// Checks a phase and its events in order.
class PhaseCheck {
 public:
    PhaseCheck(const Trajectory& trajectory, Violations& violations)
        : trajectory_(trajectory), violations_(violations), probe_(trajectory) {}

    // The event with this index.
    void take(std::size_t index) {
        const Event& event = trajectory_.events[index];
        const Phase& phase = trajectory_.phases[at_];
        const bool jumps_next = index + 1 < trajectory_.events.size() && trajectory_.events[index + 1].is_jump() &&
                                trajectory_.events[index + 1].t == event.t;
        check(event.t >= t_ && event.t <= phase.end, "an event comes out of order", event.t);
        t_ = event.t;
        switch (event.kind) {
            case Event::Kind::impact:
                impact(event, phase);
                break;
            case Event::Kind::zeno:
                zeno(event, phase);
                break;
            case Event::Kind::release:
                release(event, phase);
                break;
            case Event::Kind::stick:
            case Event::Kind::slip:
            case Event::Kind::reversal:
                friction(event, phase);
                break;
            case Event::Kind::collapse:
                collapse(event);
                return next(event);
            case Event::Kind::jump:
                check(event.jump != nullptr, "a jump has no name", event.t);
                break;
            case Event::Kind::pass:
                still(event, event.mode.held());
                check(event.inactive.without(event.contacts) != event.inactive, "a contact counts after its pass",
                      event.t);
                break;
        }
        if (jumps_next && event.is_discontinuous()) return;  // the jumps of an instant end the phase together
        if (event.is_jump()) return next(event);
        const bool is_rough = probe_.surfaces.has_friction();
        if (is_rough ? !(event.mode == phase.mode) : event.mode.held() != phase.mode.held()) next(event);
    }
    void finish() {
        const Phase& last = trajectory_.phases.back();
        check(at_ + 1 == trajectory_.phases.size(), "there are phases after the last event", t_);
        check(impacts_ == last.impacts, "the last phase has another number of impacts than it says", last.start);
    }

 private:
    void check(bool holds, const char* what, double t) {
        complain(violations_, holds, fmt::format("{} at t = {:.17g}", what, t));
    }
    void next(const Event& event) {
        const Phase& phase = trajectory_.phases[at_];
        check(phase.end == event.t, "a phase does not end at its event", event.t);
        check(impacts_ == phase.impacts, "a phase has another number of impacts than it says", phase.start);
        impacts_ = 0;
        if (at_ + 1 == trajectory_.phases.size()) return check(false, "a phase is missing", event.t);
        ++at_;
        check(trajectory_.phases[at_].start == event.t, "phases do not abut", event.t);
        check(trajectory_.phases[at_].mode.held() == event.mode.held(),
              "a phase holds other contacts than its event says", event.t);
        check(!probe_.surfaces.has_friction() || trajectory_.phases[at_].mode == event.mode,
              "a phase sticks or slips otherwise than its event says", event.t);
    }
    void impact(const Event& event, const Phase& phase) {
        ++impacts_;
        // With several contacts, an impacting contact of restitution 0 may become held.
        ContactSet plastic;
        for (std::size_t i = 0; i < probe_.model.contacts(); ++i)
            if (event.contacts.contains(i) && probe_.restitution[i] == 0.0) plastic = plastic.with(i);
        check(event.mode.held().without(plastic) == phase.mode.held().without(event.opened).without(plastic),
              "an impact holds", event.t);
        double speed = 0.0;
        for (std::size_t i = 0; i < probe_.model.contacts(); ++i) {
            if (!event.contacts.contains(i)) continue;
            const Contact contact = probe_.surfaces.of(i).at(before(event));
            check(std::abs(contact.h) <= Probe::off(before(event)), "an impact is off the surface", event.t);
            speed = std::max(speed, -contact.hdot);
        }
        check(speed > 0.0 && std::abs(event.impact_speed - speed) <= 1e-14 * (1.0 + largest(event.v_before)),
              "an impact does not approach", event.t);
        moreau(violations_, probe_, event);
    }
    // Checks h = hdot = 0 of the held contacts, and that no velocity jumps.
    void still(const Event& event, ContactSet held) {
        check(event.v_before == event.v_after, "a velocity jumps where nothing strikes", event.t);
        for (std::size_t i = 0; i < probe_.model.contacts(); ++i) {
            if (!held.contains(i)) continue;
            const Contact contact = probe_.surfaces.of(i).at(after(event));
            check(std::abs(contact.h) <= Probe::off(after(event)) &&
                      std::abs(contact.hdot) <= 1e-12 * std::max(1.0, event.v_after.norm()),
                  "h = hdot = 0 does not hold", event.t);
        }
    }
    void zeno(const Event& event, const Phase& phase) {
        still(event, event.mode.held());
        check(event.mode.held() == phase.mode.held().with(event.contacts) && event.mode.held() != phase.mode.held(),
              "a Zeno point holds", event.t);
        const ClosedContacts held = probe_.surfaces.at(after(event), event.mode.held());
        check(probe_.surfaces.has_friction() ||
                  Probe::least_force(probe_.forces(after(event), held), held, event.latched) >= 0.0,
              "a force pulls at a Zeno point", event.t);
        check(event.impacts == impacts_, "a Zeno point counts other impacts", event.t);
        if (is_plastic_landing(event)) return;
        if (!event.certificate || !event.certificate->certified || !event.truncation)
            return check(false, "a Zeno point without a certificate", event.t);
        check(event.truncation->t >= phase.start && event.truncation->t <= event.t, "a truncation is out of order",
              event.t);
        check(event.certificate->zeno_low <= event.t && event.t <= event.certificate->zeno_high,
              "the Zeno time is outside its interval", event.t);
    }
    // Both contacts have lost their gap rates; those that stay are pressed, and the others leave.
    void collapse(const Event& event) {
        still(event, event.mode.held().with(event.contacts));
        check(event.contacts.count() == 2 && event.opened.without(event.contacts).empty() &&
                  event.opened.within(event.mode.held()).empty(),
              "a collapse opens others than its contacts", event.t);
        const ClosedContacts held = probe_.surfaces.at(after(event), event.mode.held());
        check(held.which.empty() || probe_.forces(after(event), held).minCoeff() >= 0.0,
              "a force pulls after a collapse", event.t);
        if (!event.certificate || !event.certificate->certified || !event.collapse_info)
            return check(false, "a collapse without a certificate", event.t);
        for (const auto& [contact, impulse] : event.collapse_info->impulses)
            check(impulse >= 0.0, "an impulse of a collapse pulls", event.t);
        check(event.certificate->zeno_low <= event.t && event.t <= event.certificate->zeno_high,
              "the time of a collapse is outside its interval", event.t);
    }
    // Accelerations alone may jump.
    void friction(const Event& event, const Phase& phase) {
        still(event, event.mode.held());
        for (const std::size_t i : event.contacts) {
            const bool sticks = slip_sign(event.mode.state(i)) == 0;
            check(event.mode.is_held(i) && sticks == (event.kind == Event::Kind::stick),
                  "an event of friction leaves another state", event.t);
            // Of several events at one instant, the first one ends the phase.
            if (event.mode == phase.mode) continue;
            const int was = slip_sign(phase.mode.state(i));
            check((was == 0) == (event.kind == Event::Kind::slip), "an event of friction has another state before",
                  event.t);
        }
    }
    void release(const Event& event, const Phase& phase) {
        still(event, phase.mode.held());
        // With friction, a release may follow another event of the same instant.
        const bool has_ended = probe_.surfaces.has_friction() && event.mode == phase.mode;
        const ContactSet held = has_ended ? event.mode.held() : phase.mode.held().without(event.contacts);
        check(!event.contacts.empty() && event.mode.held() == held, "a release holds", event.t);
    }

    const Trajectory& trajectory_;
    Violations& violations_;
    Probe probe_;
    std::size_t at_ = 0;
    int impacts_ = 0;
    double t_ = trajectory_.run.options.start_time;
};

}  // namespace

Violations phases(const Trajectory& trajectory) {
    const std::vector<Phase>& phases = trajectory.phases;
    if (phases.empty()) return {"there is no phase"};
    Violations violations;
    const auto check = [&](bool holds, const char* what, double t) {
        complain(violations, holds, fmt::format("{} at t = {:.17g}", what, t));
    };
    check(phases.front().start == trajectory.run.options.start_time, "the first phase starts", phases.front().start);
    check(phases.back().end == trajectory.end_time, "the last phase ends", phases.back().end);
    check(phases.back().mode.held() == trajectory.end_mode.held() && phases.back().kind == trajectory.end_phase,
          "the end is in another phase than the last", phases.back().end);
    for (const Phase& phase : phases) {
        // Jumps may follow one another at one instant.
        const bool may_be_empty = &phase == &phases.back() || trajectory.model->has_jumps();
        check(phase.start < phase.end || (may_be_empty && phase.start == phase.end), "a phase is empty", phase.start);
        check((phase.kind == Phase::Kind::hybrid) == phase.mode.held().empty(), "a phase is of the wrong kind",
              phase.start);
    }
    PhaseCheck along(trajectory, violations);
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) along.take(i);
    along.finish();
    return violations;
}

Violations contact_force(const Trajectory& trajectory) {
    if (trajectory.model->has_friction()) return rough_contact_force(trajectory);
    Violations violations;
    Probe probe(trajectory);
    ContactForces told(probe.model, trajectory.run.parameters);
    double strongest = 0.0;
    // The last instant is the release, or the end of the run.
    for (const Sample& sample : Sampler(trajectory).all(4)) {
        const auto phase = std::find_if(trajectory.phases.begin(), trajectory.phases.end(),
                                        [&](const Phase& one) { return one.start <= sample.t && sample.t < one.end; });
        if (phase == trajectory.phases.end() || phase->mode.held().empty() || sample.mode.held() != phase->mode.held())
            continue;
        const ClosedContacts held = probe.surfaces.at(sample.state, phase->mode.held());
        if (phase->is_nonunique()) {
            // There is a nonnegative solution, and it is recorded.
            told.set(sample);
            const double off = probe.off_balance(sample.state, held, told);
            complain(violations, off <= 1e-9,
                     fmt::format("forces that are told are off by {:.3g} at t = {:.17g}", off, sample.t));
            for (const std::size_t i : held.which)
                complain(violations, told.force(i) >= 0.0,
                         fmt::format("a force that is told pulls at t = {:.17g}", sample.t));
            continue;
        }
        const Eigen::VectorXd forces = probe.forces(sample.state, held);
        strongest = std::max(strongest, forces.maxCoeff());
        for (std::size_t k = 0; k < held.which.size(); ++k) {
            if (sample.latched.contains(held.which[k])) continue;
            const double force = forces[static_cast<Eigen::Index>(k)];
            // Contacts that stay closed without a force have none, as balls in a row after a collapse.
            const bool needs_none =
                trajectory.model->stays_closed_without_force(held.which[k], phase->mode.without(held.which[k]));
            complain(violations, force > 0.0 || (needs_none && force == 0.0),
                     fmt::format("in contact a force is {:.3g} at t = {:.17g}", force, sample.t));
        }
    }
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::release || event.ends_latch) continue;
        const ClosedContacts held = probe.surfaces.at(after(event), event.mode.held().with(event.contacts));
        const Eigen::VectorXd forces = probe.pressing(after(event), held);
        for (std::size_t i = 0; i < held.which.size(); ++i) {
            if (!event.contacts.contains(held.which[i])) continue;
            const double force = forces[static_cast<Eigen::Index>(i)];
            const double size = std::max(strongest, probe.force_scale(after(event), held.contacts[i]));
            complain(violations, std::abs(force) <= 1e-11 * size,
                     fmt::format("released while the force is {:.3g} of {:.3g} at t = {:.17g}", force, size, event.t));
            const ContactSet load_bearing = load_bearing_contacts(trajectory, event.mode, event.t);
            complain(violations,
                     probe.surfaces.of(held.which[i], event.mode.only(load_bearing)).jerk(after(event)) > 0.0,
                     fmt::format("released while h''' <= 0 at t = {:.17g}", event.t));
        }
    }
    return violations;
}

}  // namespace achilles::test
