// Closed contacts with linearly dependent gradients, such as a table on four legs (theory-gaps.md 2.5). The motion
// holds some of them, the load-bearing contacts, whose gradients are independent and whose forces press. The gaps of
// the others stay 0 as a consequence.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contacts/complementarity.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

// Fractions of the largest force: below in_doubt the sign of a force is uncertain; above `clearly` it presses, whatever
// the integration error.
constexpr double in_doubt = 1e-9, clearly = 1e-3;

ContactSet all_places(const ClosedContacts& closed) {
    ContactSet all;
    for (std::size_t i = 0; i < closed.which.size(); ++i) all = all.with(i);
    return all;
}

bool depends(const ClosedContacts& closed, std::size_t place, ContactSet on) {
    const auto k = static_cast<Eigen::Index>(place);
    const auto block = HeldBlock<double>::of(closed.W, on);
    return block && block->transmission(closed.W, k).W <= HeldBlock<double>::clear * closed.W(k, k);
}

// A maximal subset with independent gradients.
ContactSet basis_of(const ClosedContacts& closed, ContactSet set) {
    ContactSet basis;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (set.contains(i) && HeldBlock<double>::of(closed.W, basis.with(i))) basis = basis.with(i);
    return basis;
}

}  // namespace

// Bound on the rounding of hddot, whose terms may cancel.
ContactVector<double> ExecutionAutomaton::rounding_of(const ClosedContacts& closed) {
    ContactVector<double> rounding(closed.W.rows());
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        rounding[static_cast<Eigen::Index>(i)] = 4.0 * width(surfaces_->of(closed.which[i], base_).hddot(next_.state));
    return rounding;
}

// All sets of closed contacts that could carry the load at these accelerations: independent, with forces that press or
// are uncertain, while no other gap closes. Larger sets come first; among equal sizes, those with the largest minimum
// force.
std::vector<ExecutionAutomaton::LoadSharing> ExecutionAutomaton::possible_load_sharings(
    const ClosedContacts& closed, const ContactVector<double>& hddot) {
    std::vector<LoadSharing> found;
    const std::size_t count = closed.which.size();
    const ContactVector<double> unit = closed.W.diagonal().cwiseSqrt();  // makes forces comparable in any units
    const ContactVector<double> rounding = rounding_of(closed);
    for (std::uint32_t bits = 0; bits < 1u << count; ++bits) {
        LoadSharing one;
        for (std::size_t i = 0; i < count; ++i)
            if (bits >> i & 1u) one.places = one.places.with(i);
        const auto block = HeldBlock<double>::of(closed.W, one.places);
        if (!block) continue;
        const ContactVector<double> lambda = -block->solve(hddot), y = hddot + closed.W * lambda;
        const double most = one.most = lambda.cwiseProduct(unit).cwiseAbs().maxCoeff();
        bool possible = true;
        one.least = 1.0;
        for (std::size_t i = 0; possible && i < count; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            const double size = std::abs(hddot[k]) + closed.W.row(k).cwiseAbs().dot(lambda.cwiseAbs());
            const double zero = 1e-12 * size + rounding[k];
            if (one.places.contains(i)) {
                one.least = std::min(one.least, most > 0.0 ? lambda[k] * unit[k] / most : 0.0);
                possible = one.least >= -in_doubt;
            } else {
                possible = y[k] >= -zero;
                if (y[k] > zero) one.opening = one.opening.with(i);
            }
        }
        if (possible) found.push_back(one);
    }
    std::stable_sort(found.begin(), found.end(), [](const LoadSharing& a, const LoadSharing& b) {
        return a.places.count() != b.places.count() ? a.places.count() > b.places.count() : a.least > b.least;
    });
    return found;
}

// Holds contacts with linearly dependent gradients by a set of load-bearing contacts. If the force of a load-bearing
// contact was uncertain, the new load-bearing contacts must differ from `doubted` and press clearly.
bool ExecutionAutomaton::hold_dependent(const ClosedContacts& closed, const ContactVector<double>& hddot,
                                        const Complementarity& forces, ContactSet doubted) {
    const ContactSet pressed = forces.active;
    const auto all = possible_load_sharings(closed, hddot);
    const auto now =
        std::find_if(all.begin(), all.end(), [&](const LoadSharing& one) { return one.places == doubted; });
    const double known_to = doubted.empty() || now == all.end() ? 0.0 : now->least * now->most;
    for (const LoadSharing& sharing : all) {
        const bool sure = sharing.least > clearly && clearly * sharing.least * sharing.most > known_to;
        if (!doubted.empty() && !sure) continue;
        if (!hold_load_sharing(closed, sharing)) continue;
        update_load_sharing_candidates(closed, pressed);
        return true;
    }
    // At permanent rest, it does not matter which of the pressed contacts bear the load.
    const ContactSet pressed_ones = closed.contacts_at(pressed);
    const bool rests = doubted.empty() && is_at_rest(latched_mode().with(pressed_ones, ContactState::held));
    if (!rests && (!doubted.empty() || !is_stuck(closed, pressed)))
        return (doubted.empty() || !can_retry_tight()) && share(closed, hddot, forces);
    const ContactSet carrying = rests ? pressed_ones : closed.contacts_at(enough_of(closed, hddot, pressed));
    if (!HeldBlock<double>::of(closed.W, closed.places_of(carrying))) return false;
    for (const std::size_t contact : closed.which) next_.starts[contact] = {};
    hold(latched_mode().with(carrying, ContactState::held), closed.contacts_at(all_places(closed)).without(carrying));
    update_load_sharing_candidates(closed, pressed);
    return true;
}

// Handles the case that the force of every possible load-bearing contact may touch 0 although all contacts together
// press clearly. An example is a load that moves to the middle of a table and turns back. For a short time, the
// load-bearing contacts are not checked for events.
bool ExecutionAutomaton::share(const ClosedContacts& closed, const ContactVector<double>& hddot,
                               const Complementarity& forces) {
    const ContactVector<double> rounding = rounding_of(closed);
    const ContactVector<double> p = forces.p.cwiseProduct(closed.W.diagonal().cwiseSqrt());
    for (Eigen::Index i = 0; i < p.size(); ++i)
        if (contains(forces.active, i) &&
            !(p[i] > clearly * p.maxCoeff() && clearly * forces.p[i] * closed.W(i, i) > rounding[i]))
            return false;  // otherwise all forces may vanish together
    const ContactSet all = all_places(closed);
    const auto sharing = possible_load_sharings(closed, hddot);
    if (sharing.empty() || sharing.front().least > clearly || !sharing.front().opening.empty() ||
        sharing.front().places.count() != basis_of(closed, all).count() ||
        basis_of(closed, forces.active).count() != sharing.front().places.count())
        return false;
    const ContactSet held = closed.contacts_at(sharing.front().places);
    for (const std::size_t contact : closed.which) next_.starts[contact] = {};
    hold(latched_mode().with(held, ContactState::held), closed.contacts_at(all).without(held));
    update_load_sharing_candidates(closed, forces.active);
    next_.unwatched = held;
    return true;
}

// Ends the time during which load-bearing contacts are not checked.
void ExecutionAutomaton::end_sharing() {
    const Mode resting = next_.resting();
    acting_ = next_.mode.seen_by_forces().within(model_->equations().in_forces);
    decide(next_.held().with(next_.touching));
    if (outcome_) return;
    if (next_.resting() == resting) return continue_phase();
    stop(Outcome::Kind::undecided, fmt::format("cannot decide which of {} were released just before, at {}",
                                               names_of(resting.held()), where(next_.state)));
}

// Holds these load-bearing contacts if each force is proved to press, or to grow from 0. The other contacts rest with
// them, touch, or leave.
bool ExecutionAutomaton::hold_load_sharing(const ClosedContacts& closed, const LoadSharing& sharing) {
    const Mode mode = latched_mode().with(closed.contacts_at(sharing.places), ContactState::held);
    std::vector<EventStart> starts = next_.starts;
    ContactSet touching;
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const std::size_t contact = closed.which[i];
        EventStart& start = starts[contact];
        const bool is_candidate = !mode.is_held(contact) && depends(closed, i, sharing.places);
        if (is_candidate) {
            touching = sharing.opening.contains(i) ? touching : touching.with(contact);
            start = {{0.0, 0.0}, 2};  // order of its zero if it opens
            continue;
        }
        const auto normal =
            surfaces_->of(contact, mode.without(contact).with_acting(base_.acting())).normal(next_.state);
        if (mode.is_held(contact)) {
            const bool presses = certainly_negative(normal.hddot);
            if (!presses && (certainly_positive(normal.hddot) || !certainly_negative(normal.jerk))) return false;
            start = presses ? EventStart{} : EventStart{{}, 1};
        } else if (certainly_positive(normal.hddot)) {
            start = {{0.0, 0.0}, 2};
        } else if (!certainly_negative(normal.hddot) && certainly_positive(normal.jerk)) {
            start = {{0.0, 0.0}, 3};
        } else if (!certainly_negative(normal.hddot) && !certainly_negative(normal.jerk) &&
                   stays_closed(contact, mode)) {
            touching = touching.with(contact);
        } else {
            return false;
        }
    }
    next_.starts = std::move(starts);
    hold(mode, touching);
    return true;
}

void ExecutionAutomaton::hold(Mode mode, ContactSet touching) {
    next_.mode = mode;
    next_.touching = touching;
    next_.unwatched = next_.unpressed = {};
    for (std::size_t i = 0; i < next_.starts.size(); ++i)
        if (touching.contains(i)) next_.starts[i] = {{0.0, 0.0}, 1};
}

// Sets next_.load_sharing_candidates: the touching contacts that may share the load, because their gradients depend on
// those of other load-bearing contacts.
void ExecutionAutomaton::update_load_sharing_candidates(const ClosedContacts& closed, ContactSet pressed) {
    const ContactSet bearing = closed.places_of(next_.held()).with(pressed);
    next_.load_sharing_candidates = {};
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (next_.touching.contains(closed.which[i]) &&
            depends(closed, i, basis_of(closed, bearing.without(ContactSet::of(i)))))
            next_.load_sharing_candidates = next_.load_sharing_candidates.with(closed.which[i]);
}

// Whether these contacts, if pressed, leave no motion: velocities are 0, no contact surface moves, and the gradients
// span the whole space.
bool ExecutionAutomaton::is_stuck(const ClosedContacts& closed, ContactSet pressed) {
    if (next_.state.v != Vector::Zero(next_.state.v.size())) return false;
    for (const Contact& contact : closed.contacts)
        if (contact.gap_t != 0.0) return false;
    return basis_of(closed, pressed).count() == model_->dof();
}

// From contacts that hold everything at rest, the smallest set that presses by itself and opens no other; all of them
// if there is none.
ContactSet ExecutionAutomaton::enough_of(const ClosedContacts& closed, const ContactVector<double>& hddot,
                                         ContactSet pressed) {
    const auto found = possible_load_sharings(closed, hddot);
    const auto enough = std::find_if(found.rbegin(), found.rend(), [&](const LoadSharing& one) {
        return !one.places.empty() && one.places.without(pressed).empty() && one.least > in_doubt &&
               one.opening.empty();
    });
    return enough == found.rend() ? pressed : enough->places;
}

// Called if the force of a load-bearing contact may touch 0 and this cannot be decided. Tries to continue with other
// load-bearing contacts.
bool ExecutionAutomaton::continue_without(std::size_t which, const State& state) {
    if (next_.load_sharing_candidates.empty() || !next_.mode.is_held(which)) return false;
    const StepRequest before = next_;
    next_.state = state;
    const ClosedContacts closed = surfaces_->at(state, before.held().with(before.touching));
    const ContactVector<double> hddot = accelerations(closed);
    const auto forces = solve_complementarity(closed.W, hddot);
    const bool goes_on = forces && hold_dependent(closed, hddot, *forces, closed.places_of(before.held())) &&
                         next_.resting() == before.resting();
    if (!goes_on) next_ = before;
    return goes_on;
}

// Continues the phase: the same contacts rest, but the load-bearing contacts may have changed.
void ExecutionAutomaton::continue_phase() {
    constexpr int many = 100;  // more changes at one time would never end
    load_sharing_changes_ = next_.state.t == load_sharing_since_ ? load_sharing_changes_ + 1 : 0;
    load_sharing_since_ = next_.state.t;
    if (load_sharing_changes_ > many)
        return stop(Outcome::Kind::undecided, fmt::format("cannot decide which of {} carry load, at {}",
                                                          names_of(next_.resting().held()), where(next_.state)));
    enter_or_stay();
    begin_stretch(next_.mode, run_.options.end_time);
}

// End of the time during which load-bearing contacts are not checked (s): long enough for an uncertain touch to pass,
// and short compared with the time scale of the motion.
double ExecutionAutomaton::end_of_sharing() const {
    constexpr double part = 1.0 / 16, least = 1e-6;
    return next_.state.t + std::max(part * last_step_, least * (1.0 + std::abs(next_.state.t)));
}

}  // namespace achilles
