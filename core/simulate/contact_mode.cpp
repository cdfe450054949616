// Decides which contacts are held, released or touching after an event (theory-gaps.md 2.2, 2.5).
#include <fmt/format.h>

#include <cmath>

#include "contacts/complementarity.hpp"
#include "simulate/execution.hpp"

namespace achilles {

// Classifies contacts with h = 0 and hdot = 0 as held, released or touching (theory-gaps.md 2.2). The mode before the
// event is not used. The forces of `vanishing` are known to be 0.
void ExecutionAutomaton::decide(ContactSet closed, ContactSet vanishing) {
    forget_held();
    not_unique_ = false;
    closed = closed.without(next_.latched);
    if (closed.empty()) return;
    if (closed.count() > max_closed_contacts)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("{} contacts are closed at once, and at most {} can be resolved: {}, at {}",
                                closed.count(), max_closed_contacts, names_of(closed), where(next_.state)));
    base_ = with_forces_of_now(latched_mode(), closed);
    const ClosedContacts all = surfaces_->at(next_.state, closed, latched_mode());
    const ContactVector<double> hddot = accelerations(all);
    const auto forces = solve_complementarity(all.W, hddot);
    if (!forces)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("no contact forces can hold {}, at {}", names_of(closed), where(next_.state)));
    not_unique_ = !forces->unique;
    const bool decided = forces->unique ? judge(closed, all.contacts_at(forces->active), vanishing)
                                        : hold_dependent(all, hddot, *forces);
    if (!decided)
        stop(Outcome::Kind::undecided, fmt::format("the contact force and its rate are zero to within rounding: cannot "
                                                   "decide between contact and release{}{} at {}",
                                                   surfaces_->count() > 1 ? " for " : "",
                                                   surfaces_->count() > 1 ? names_of(closed) : "", where(next_.state)));
    else
        start_released(base_.acting().without(next_.resting().held()));
}

// hddot while only latched contacts are held, at the current state.
ContactVector<double> ExecutionAutomaton::accelerations(const ClosedContacts& closed) {
    ContactVector<double> hddot(closed.W.rows());
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        hddot[static_cast<Eigen::Index>(i)] = surfaces_->of(closed.which[i], base_).normal_acceleration(next_.state);
    return hddot;
}

// The doubtful contacts whose force grows from 0, in this mode.
ContactSet ExecutionAutomaton::pressed_by_rates(ContactSet doubtful, Mode mode) {
    const ClosedContacts closed = surfaces_->at(next_.state, doubtful.with(mode.held()));
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(mode.held()));
    if (!block) return {};
    std::vector<std::size_t> which;
    std::vector<Eigen::Index> places;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (doubtful.contains(closed.which[i])) {
            which.push_back(closed.which[i]);
            places.push_back(static_cast<Eigen::Index>(i));
        }
    const auto n = static_cast<Eigen::Index>(which.size());
    ContactMatrix<double> W(n, n);
    ContactVector<double> jerk(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto at = static_cast<std::size_t>(i);
        jerk[i] = surfaces_->of(which[at], mode.with_acting(base_.acting())).jerk(next_.state);
        const ContactVector<double> kappa = block->transmission(closed.W, places[at]).kappa;
        for (Eigen::Index k = 0; k < n; ++k)
            W(k, i) = HeldBlock<double>::between(closed.W, places[static_cast<std::size_t>(k)], places[at], kappa);
    }
    const auto rates = solve_complementarity(W, jerk);
    ContactSet pressed;
    for (std::size_t i = 0; rates && i < which.size(); ++i)
        if (rates->active.contains(i)) pressed = pressed.with(which[i]);
    return pressed;
}

// Proves the mode that the contact forces in double precision suggest: contacts in `active` are held, other closed
// contacts leave. Where the sign of hddot is uncertain, its rate h''' along the motion decides. Returns true, with
// the mode in next_, if every contact is decided.
bool ExecutionAutomaton::judge(ContactSet closed, ContactSet active, ContactSet vanishing) {
    const ContactSet unpressed = unpressed_among(closed, active);
    return judge(closed, active, vanishing, unpressed) ||
           (!unpressed.empty() && judge(closed, active, vanishing, {}));  // other contacts may press them
}

bool ExecutionAutomaton::judge(ContactSet closed, ContactSet active, ContactSet vanishing, ContactSet unpressed) {
    active = active.with(unpressed);
    next_.touching = {};
    Mode mode = latched_mode().with(unpressed, ContactState::held);
    ContactSet doubtful;
    const double resolved = 16.0 * 0x1p-52 * std::abs(next_.state.t);
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (unpressed.contains(i)) next_.starts[i] = {};
        if (!closed.without(unpressed).contains(i)) continue;
        const auto [hddot, jerk] =
            surfaces_->of(i, base_.with(active.without(i), ContactState::held)).normal(next_.state);
        // True if hddot is known to be 0, or vanishes at a time that equals t within rounding.
        const bool is_zero = vanishing.contains(i) || mag(hddot) <= resolved * mag(jerk);
        if (!is_zero && certainly_negative(hddot)) {
            mode = mode.with(i, ContactState::held);
            next_.starts[i] = {};
        } else if (!is_zero && certainly_positive(hddot)) {
            next_.starts[i] = {{0.0, 0.0}, 2};
        } else {
            doubtful = doubtful.with(i);
        }
    }
    if (!doubtful.empty()) {
        // The rates mu of the contact forces suggest which doubtful contacts are pressed: 0 <= mu perpendicular h''' +
        // W mu >= 0. The signs of h''' prove it, each with the other pressed contacts held.
        ContactSet pressed = doubtful.count() == 1 ? doubtful : pressed_by_rates(doubtful, mode);
        const bool alone = doubtful.count() == 1;
        for (std::size_t i = 0; i < surfaces_->count(); ++i) {
            if (!doubtful.contains(i)) continue;
            const Mode others = alone ? mode : mode.with(pressed, ContactState::held).without(i);
            const auto normal = surfaces_->of(i, others.with_acting(base_.acting())).normal(next_.state);
            if (certainly_negative(normal.jerk) && pressed.contains(i)) {
                mode = mode.with(i, ContactState::held);
                next_.starts[i] = {{}, 1};
            } else if (certainly_positive(normal.jerk) && (alone || !pressed.contains(i))) {
                next_.starts[i] = {{0.0, 0.0}, 3};
            } else if (stays_closed(i, mode)) {
                next_.touching = next_.touching.with(i);
            } else {
                return false;
            }
        }
    }
    next_.mode = mode;
    next_.unpressed = unpressed;
    return unpressed_of(unpressed, mode) == unpressed;
}

// The contacts of this set that the mode holds and that stay closed without a force.
ContactSet ExecutionAutomaton::unpressed_of(ContactSet contacts, Mode mode) {
    ContactSet found;
    for (const std::size_t i : contacts)
        if (mode.is_held(i) && needs_no_force(i, mode)) found = found.with(i);
    return found;
}

// The current unpressed contacts that no state presses as long as these contacts are held.
ContactSet ExecutionAutomaton::always_unpressed(Mode mode) {
    ContactSet found;
    for (const std::size_t i : next_.unpressed)
        if (mode.is_held(i) && surfaces_->never_needs_force(i, model_->unconstrained(mode, i))) found = found.with(i);
    return found;
}

// The closed contacts that need no force while the others of them and the `active` contacts are held.
ContactSet ExecutionAutomaton::unpressed_among(ContactSet closed, ContactSet active) {
    ContactSet found;
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (closed.contains(i) &&
            surfaces_->is_nearly_free(i, base_.with(active.without(i), ContactState::held), next_.state, scale_))
            found = found.with(i);
    active = active.without(found);  // forces that may be 0 press no other contact
    for (ContactSet before; before != found;) {
        before = found;
        found = unpressed_of(found, base_.with(active.with(found), ContactState::held));
    }
    return found;
}

// The held contacts whose forces vanish together with that of this one, within the accuracy of the state; for example,
// if only a floor presses a ball against a wall.
ContactSet ExecutionAutomaton::vanishing_with(std::size_t which) {
    ContactSet found = ContactSet::of(which);
    const double known = state_error() + 0x1p-40;
    const State scale{known * scale_.q, known * scale_.v, 0.0};
    for (const std::size_t i : next_.held()) {
        if (i == which || next_.unpressed.with(next_.latched).contains(i)) continue;
        const Interval hddot = surfaces_->of(i, model_->unconstrained(next_.mode, i)).hddot_within(scale, next_.state);
        if (!certainly_negative(hddot)) found = found.with(i);
    }
    return found;
}

// Whether a contact with h = hdot = hddot = 0 stays closed in a mode: hddot is 0 everywhere, or the system is at
// permanent rest.
bool ExecutionAutomaton::stays_closed(std::size_t contact, Mode mode) {
    return (surfaces_->count() > 1 && model_->stays_closed_without_force(contact, mode)) || is_at_rest(mode);
}

// Ends the run if a touching contact has opened or penetrated.
void ExecutionAutomaton::check_touching() {
    if (next_.touching.empty()) return;
    constexpr double closed = 1e-9;
    const double size = 1.0 + next_.state.q.cwiseAbs().maxCoeff();
    const std::string while_held =
        next_.mode.is_free() ? "no contact was held"
                             : names_of(next_.held()) + (next_.held().count() == 1 ? " was held" : " were held");
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (!next_.touching.contains(i)) continue;
        const Contact contact = surfaces_->of(i).at(next_.state);
        if (std::abs(contact.h) <= closed * size * contact.g.norm()) continue;
        return stop(
            Outcome::Kind::redundant_contacts,
            fmt::format(
                "{} was closed while {}, and is no longer closed: cannot decide which contacts carry load, at {}",
                names_of(ContactSet::of(i)), while_held, where(next_.state)));
    }
}

// Whether the system is at permanent rest: zero velocity, no dependence on time, and zero acceleration in this mode.
bool ExecutionAutomaton::is_at_rest(Mode mode) {
    if (!model_->equations().autonomous || next_.state.v != Vector::Zero(next_.state.v.size())) return false;
    const ClosedContacts closed = surfaces_->at(next_.state, mode.held());
    ContactSet places;
    for (std::size_t i = 0; i < closed.which.size(); ++i) places = places.with(i);
    if (!mode.is_free() && !HeldBlock<double>::of(closed.W, places)) return false;
    auto motion = model_->evaluator(model_->motion(mode).program, run_.parameters);
    MotionTerms<Evaluator<double>> terms(std::move(motion), static_cast<std::size_t>(model_->dof()),
                                         model_->contacts());
    set_state(terms, next_.state);
    terms.run();
    for (std::size_t i = 0; i < static_cast<std::size_t>(model_->dof()); ++i)
        if (terms.acceleration(i) != 0.0) return false;
    return true;
}

}  // namespace achilles
