// Latches, and forces that depend on contact (theory-modes.md 4, 5).
#include <fmt/format.h>

#include <algorithm>

#include "simulate/execution.hpp"

namespace achilles {

// Every held contact with a latch is latched, unless the latch has ended since the contact was last open.
void ExecutionAutomaton::latch_held() {
    const ContactSet held = next_.held();
    spent_ = spent_.within(held);
    next_.latched = next_.latched.within(held);
    for (const std::size_t i : held.without(spent_))
        if (model_->equations().latches[i]) next_.latched = next_.latched.with(i);
    record_.set_latched(next_.latched);
}

// A contact that comes to rest at an impact latches at once, whatever the sign of its force.
void ExecutionAutomaton::latch_landed(std::size_t contact) {
    const ContactSet latched = next_.latched.with(contact);
    if (!model_->equations().latches[contact] || spent_.contains(contact)) return;
    const ClosedContacts closed = surfaces_->at(next_.state, latched);
    if (HeldBlock<double>::of(closed.W, closed.places_of(latched))) next_.latched = latched;
}

// The impulses p = W^-1 (g dv - ...) of latched contacts at an impact that changes the velocity by dv, added to those of
// the others, which may have tangential ones; their work.
Exchange ExecutionAutomaton::add_impulses_of_latched(MultiContactInfo& joint, const Event::FrictionImpulses* friction,
                                                     const Vector& dv) {
    Exchange exchange;
    if (next_.latched.empty()) return exchange;
    ContactSet gaps = next_.latched, slips;
    for (const auto& [contact, impulse] : joint.impulses) gaps = gaps.with(contact);
    if (friction != nullptr)
        for (const auto& [contact, impulse] : friction->tangential) slips = slips.with(contact);
    const ContactRows rows = surfaces_->rows(next_.state, gaps, slips, {});
    Eigen::VectorXd others = Eigen::VectorXd::Zero(rows.size());
    for (const auto& [contact, impulse] : joint.impulses) others[rows.gap_of(contact)] = impulse;
    if (friction != nullptr)
        for (const auto& [contact, impulse] : friction->tangential) others[rows.slip_of(contact)] = impulse;
    Eigen::VectorXd rest = -rows.W * others;  // the change of the rates that the latched contacts prevent
    ContactSet places;
    for (const std::size_t i : next_.latched) {
        const Eigen::Index place = rows.gap_of(i);
        rest[place] += rows.rows[static_cast<std::size_t>(place)].gradient.dot(dv);
        places = with(places, place);
    }
    const auto block = HeldBlock<double>::of(rows.W, places);
    if (!block) return exchange;
    const Eigen::VectorXd p = block->solve(rest);
    for (const std::size_t i : next_.latched) {
        const Eigen::Index place = rows.gap_of(i);
        joint.impulses.emplace_back(i, p[place]);
        exchange.work += newton::work(p[place], rows.rows[static_cast<std::size_t>(place)].drift);
    }
    std::sort(joint.impulses.begin(), joint.impulses.end());
    return exchange;
}

// The latched contacts whose latch ends with an impact of one of these.
ContactSet ExecutionAutomaton::unlatched_by(ContactSet landing) const {
    ContactSet found;
    for (const std::size_t i : next_.latched) {
        const std::optional<std::size_t>& other = model_->equations().latches[i]->contact;
        if (other && landing.contains(*other)) found = found.with(i);
    }
    return found;
}

void ExecutionAutomaton::unlatch(ContactSet contacts) {
    next_.latched = next_.latched.without(contacts);
    spent_ = spent_.with(contacts);
    record_.set_latched(next_.latched);
}

// The expressions that end the latches of these contacts rise through zero. They are then ordinary held contacts.
void ExecutionAutomaton::end_latches(ContactSet contacts) {
    if (completing())
        return stop(Outcome::Kind::undecided,
                    fmt::format("the latch of {} ends before the Zeno time of another contact, at {}",
                                names_of(contacts), where(next_.state)));
    const Mode before = next_.mode;
    const ContactSet resting = next_.resting().held();
    unlatch(contacts);
    if (surfaces_->has_friction()) {
        if (!decide_with_friction(before.held(), before)) return;
        if (next_.mode == before) return go_on_in_mode();
        return enter_friction_mode(before, {}, contacts);
    }
    decide(next_.held().with(next_.touching));
    if (outcome_) return;
    const ContactSet gone = resting.without(next_.resting().held());
    gone.empty() ? continue_phase() : leave(gone, !gone.within(contacts).empty());
}

// ---- forces that depend on contact ----

// Ends the run if a held contact, whose held(NAME) is 1 now, is not pressed.
void ExecutionAutomaton::check_held_forces() {
    const ContactSet held = next_.mode.seen_by_forces().within(model_->equations().in_forces).without(next_.latched);
    if (held.empty()) return;
    const auto values = surfaces_->motion(next_.mode).enclosed(next_.state);
    for (const std::size_t i : held)
        if (next_.starts[i].multiplicity == 0 && certainly_positive(values[i].value))
            return stop(Outcome::Kind::undecided,
                        fmt::format("held({0}) undoes itself: {1} closes by the forces without it, and opens by those "
                                    "with it, at {2}",
                                    model_->description().constraints[i].name, name_of(i), where(next_.state)));
}

// The starts of the gaps of contacts that are released in the present mode. Their held(NAME) is 0 from here on, which
// may change their acceleration at once. Ends the run if they would close again.
void ExecutionAutomaton::start_released(ContactSet contacts) {
    for (const std::size_t i : contacts.within(model_->equations().in_forces)) {
        const auto [hddot, jerk] = surfaces_->of(i, next_.mode).normal(next_.state);
        if (certainly_positive(hddot)) {
            next_.starts[i] = {{0.0, 0.0}, 2};
        } else if (!certainly_negative(hddot) && certainly_positive(jerk)) {
            next_.starts[i] = {{0.0, 0.0}, 3};
        } else {
            return stop(Outcome::Kind::undecided,
                        fmt::format("held({0}) undoes itself: {1} opens by the forces with it, and {2} by those "
                                    "without it, at {3}",
                                    model_->description().constraints[i].name, name_of(i),
                                    certainly_negative(hddot) ? "closes" : "may close", where(next_.state)));
        }
    }
}

}  // namespace achilles
