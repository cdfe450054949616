// Impacts of several contacts, and pairs that chatter together (theory-gaps.md 2.1, 2.4, 2.6).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contacts/moreau.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

}  // namespace

std::string ExecutionAutomaton::names_of(ContactSet contacts) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (contacts.contains(i)) names.push_back("'" + model_->description().constraints[i].name + "'");
    return fmt::format("{}", fmt::join(names, ", "));
}

// Effect on a gap of roundings of the coordinates at the largest values they have had.
double ExecutionAutomaton::rounding_so_far(const Contact& contact) const {
    return 0x1p-53 * contact.g.cwiseAbs().dot(scale_.q);
}

// Whether these impacts have the same outcome in every order, given the held contacts (theory-gaps.md 2.4).
bool ExecutionAutomaton::is_order_independent(ContactSet landing) {
    if (is_collapse_at_tie(landing)) return true;
    const ContactSet held = next_.held().without(next_.latched);
    const ClosedContacts closed = surfaces_->at(next_.state, held.with(landing), latched_mode());
    ContactVector<double> e(closed.W.rows());
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        e[static_cast<Eigen::Index>(i)] = restitution(closed.which[i]);
    return !order_dependence(enclosure(closed.W, rounding_radius(closed.W)), e, closed.places_of(held),
                             closed.places_of(landing))
                .matters();
}

// The contacts whose impacts cannot be separated in time from this one (theory-gaps.md 2.4). Returns nullopt, and the
// run has ended, if the order matters and a smaller tolerance may decide it.
std::optional<ContactSet> ExecutionAutomaton::landing_with(std::size_t which, const Contact& contact) {
    constexpr double few = 4.0, resolved = 16.0;
    const double time = ulp(next_.state.t);
    std::optional<double> when;  // the uncertainty of the time of impact; computed if another contact approaches
    ContactSet landing = ContactSet::of(which), in_doubt;
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (i == which || next_.mode.is_held(i) || next_.touching.contains(i) || next_.inactive.contains(i)) continue;
        const Contact other = surfaces_->of(i).at(next_.state);
        if (!(other.hdot < 0.0)) continue;
        if (other.h <= next_.starts[i].gap.error + few * rounding_so_far(other) && !does_count(i)) {
            if (outcome_) return std::nullopt;
            continue;
        }
        if (!when) when = few * surfaces_->of(which).gap_error(next_.state) / std::abs(contact.hdot) + time;
        const double own = few * surfaces_->of(i).gap_error(next_.state) - other.hdot * (time + *when);
        const double rounding = few * rounding_so_far(other) - other.hdot * resolved * time;
        if (other.h <= std::max(own, rounding)) {
            landing = landing.with(i);
        } else if (other.h <= next_.starts[i].gap.error && next_.held().count() + 2 <= max_closed_contacts &&
                   !is_order_independent(ContactSet::of(which).with(i))) {
            in_doubt = in_doubt.with(i);
        }
    }
    if (in_doubt.empty() || run_.options.tolerance <= exact_tolerance) return landing.with(in_doubt);
    stop(Outcome::Kind::undecided, fmt::format("cannot decide at this tolerance which of {} closes first, at {}",
                                               names_of(landing.with(in_doubt)), where(next_.state)));
    return std::nullopt;
}

// Whether all held contacts stay held at an impact of this contact: the impact presses them (kappa >= 0), and so do the
// forces with the velocities after it.
bool ExecutionAutomaton::stays_held(std::size_t which, const Contact& contact) {
    const ContactSet holding = next_.held().without(next_.latched);
    if (holding.empty()) return true;
    if (next_.held().count() >= max_closed_contacts) return false;
    const ClosedContacts closed = surfaces_->at(next_.state, holding.with(which), latched_mode());
    const auto held = closed.places_of(holding), lands = closed.places_of(ContactSet::of(which));
    ContactVector<double> e = ContactVector<double>::Zero(closed.W.rows());
    const auto W = enclosure(closed.W, rounding_radius(closed.W));
    if (order_dependence(W, e, held, lands).by_transmission) return false;
    const State after{next_.state.q, impact(contact, next_.state.v, restitution(which)), next_.state.t};
    const bool rests = restitution(which) == 0.0 && surfaces_->of(which, next_.mode).normal_acceleration(after) < 0.0;
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const std::size_t other = closed.which[i];
        if (!next_.unpressed.contains(other)) continue;
        if (!surfaces_->needs_no_force(other, model_->unconstrained(next_.mode, other), after, scale_)) return false;
        e[static_cast<Eigen::Index>(i)] = restitution(other);
        if (restitution(other) > 0.0 && order_dependence(W, e, held.without(i), lands.with(i)).matters()) return false;
    }
    const ContactSet pressed = held.without(closed.places_of(next_.unpressed));
    return is_pressed(closed, rests ? pressed.with(lands) : pressed, after);
}

// Whether the forces of these held contacts are positive by more than their rounding.
bool ExecutionAutomaton::is_pressed(const ClosedContacts& closed, ContactSet held, const State& state) {
    const auto block = HeldBlock<double>::of(closed.W, held);
    if (!block) return false;
    const Mode others = latched_mode().with_acting(closed.contacts_at(held).within(model_->equations().in_forces));
    ContactVector<double> hddot(closed.W.rows());
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        hddot[static_cast<Eigen::Index>(i)] = surfaces_->of(closed.which[i], others).normal_acceleration(state);
    const ContactVector<double> lambda = -block->solve(hddot);
    constexpr double rounding = 1e-12;
    for (Eigen::Index i = 0; i < lambda.size(); ++i) {
        const double size = std::abs(hddot[i]) + closed.W.row(i).cwiseAbs().dot(lambda.cwiseAbs());
        if (contains(held, i) && !(lambda[i] * closed.W(i, i) > rounding * size)) return false;
    }
    return true;
}

// Work and loss of an impact, including the impulses transmitted to held contacts with moving surfaces.
Exchange ExecutionAutomaton::exchange_beside(const Contact& contact, double e, Exchange own) {
    if (!model_->equations().has_power()) return own;
    const ClosedContacts closed = surfaces_->at(next_.state, next_.held().with(which_));
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(next_.held()));
    if (!block) return own;
    const auto place = std::find(closed.which.begin(), closed.which.end(), which_) - closed.which.begin();
    const ContactVector<double> kappa = block->transmission(closed.W, place).kappa;
    const double impulse = newton::impulse(e, contact.hdot, contact.W);
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (next_.mode.is_held(closed.which[i]))
            own.work += newton::work(kappa[static_cast<Eigen::Index>(i)] * impulse, closed.contacts[i].gap_t);
    return own;
}

// Work of moving contact surfaces when contacts are brought to rest: -p dh/dt, p = -W^-1 hdot.
double ExecutionAutomaton::plastic_work(const State& before, ContactSet contacts) {
    if (!model_->equations().has_power()) return 0.0;
    const ClosedContacts closed = surfaces_->at(before, contacts);
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(contacts));
    if (!block) return 0.0;
    const ContactVector<double> p = block->solve(-closed.rates());
    double work = 0.0;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        work += newton::work(p[static_cast<Eigen::Index>(i)], closed.contacts[i].gap_t);
    return work;
}

// Notes whether the outcome of a simultaneous impact depends on the order of the impacts and, if it does, the gap rates
// after each order. `before` and `after` are the gap rates of the closed contacts, `e` their restitutions.
void ExecutionAutomaton::note_order(MultiContactInfo& joint, const ClosedContacts& closed,
                                    const ContactVector<double>& before, const ContactVector<double>& e,
                                    const ContactVector<double>& after) const {
    // An unpressed contact with e > 0 would be opened by an impact just before, so for the order it counts as
    // impacting.
    ContactSet loose, all;
    for (const std::size_t i : closed.which) {
        all = all.with(i);
        if (next_.unpressed.contains(i) && restitution(i) > 0.0) loose = loose.with(i);
    }
    const ContactSet open = closed.places_of(all.without(next_.resting().held().without(loose)));
    const ContactSet fast = closed.places_of(next_.held().without(next_.latched).without(loose));
    if (open.count() <= 1) return;
    const auto order = order_dependence(enclosure(closed.W, rounding_radius(closed.W)), e, fast, open);
    joint.order_matters = order.matters();
    joint.rounded_zero = order.rounded_zero;
    if (!joint.order_matters) return;
    const auto rates = [&](const ContactVector<double>& hdot) {
        std::vector<std::pair<std::size_t, double>> list;
        for (std::size_t i = 0; i < closed.which.size(); ++i)
            list.emplace_back(closed.which[i], hdot[static_cast<Eigen::Index>(i)]);
        return list;
    };
    joint.alternatives.push_back({std::nullopt, rates(after)});
    for (const ImpactSequence& other : alternatives(closed.W, before, e, fast))
        joint.alternatives.push_back({closed.which[static_cast<std::size_t>(other.first)], rates(other.hdot_after)});
}

// Simultaneous impact of several contacts, by Newton's law in Moreau's form.
void ExecutionAutomaton::collide(ContactSet landing) {
    const ContactSet latched = next_.latched, held = next_.held().without(latched), resting = next_.resting().held(),
                     still = held.with(next_.touching), all = still.with(landing);
    if (all.with(latched).count() > max_closed_contacts)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("{} contacts are closed at once, and at most {} can be resolved: {}, at {}",
                                all.count(), max_closed_contacts, names_of(all), where(next_.state)));
    if (completing())
        return stop(Outcome::Kind::undecided, fmt::format("impact of {} before the Zeno time of another contact, at {}",
                                                          names_of(landing), where(next_.state)));
    if (!surfaces_->project(next_.state, all.with(latched), still.with(latched))) return fail_projection();
    const ClosedContacts closed = surfaces_->at(next_.state, all, latched_mode());
    const ContactSet places = closed.places_of(held);
    const bool collapses = is_collapse_at_tie(landing);  // then the impact is plastic, whatever the restitutions
    ContactVector<double> before = closed.rates(), e(before.size());
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        e[k] = collapses && landing.contains(closed.which[i]) ? 0.0 : restitution(closed.which[i]);
        if (still.contains(closed.which[i])) before[k] = 0.0;
    }
    const auto impact = moreau_impact(closed.W, before, e, places);
    if (!impact)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("no impulses satisfy the impact law of {}, at {}", names_of(all), where(next_.state)));
    const Vector v_before = next_.state.v, v_after = closed.after(v_before, impact->impulses);
    const ContactSet falling = falling_jumps();
    const Jumps jumps = jumps_after(landing, falling);
    if (outcome_) return;
    const ContactSet unlatched = unlatched_by(landing);
    const bool is_cut = !may_jump(landing, falling) && unlatched.empty();
    if (is_cut && !collapses && complete_pair(landing, v_after, false)) return;
    const auto limit = collapses ? collapse_info(landing, law_of_tie(landing)) : nullptr;
    auto joint = std::make_shared<MultiContactInfo>();
    joint->is_nonunique = !impact->unique;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        joint->impulses.emplace_back(closed.which[i], impact->impulses[static_cast<Eigen::Index>(i)]);
    const Exchange by_latches = add_impulses_of_latched(*joint, nullptr, v_after - v_before);
    note_order(*joint, closed, before, e, impact->hdot_after);
    if (joint->order_matters && run_.options.simultaneous == Simultaneous::stop)
        return stop(
            Outcome::Kind::simultaneous_impacts,
            fmt::format(
                "{} close at the same time, and the outcome depends on which is first (simultaneous = \"stop\"), at {}",
                names_of(all.without(held)), where(next_.state)));
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const double hdot = impact->hdot_after[static_cast<Eigen::Index>(i)];
        if (!(hdot > 0.0) || !jumps.empty() || !too_short_to_resolve(closed.which[i], hdot)) continue;
        if (!is_cut || !complete_pair(landing, v_after, true)) end_chatter(all);
        return;
    }
    Exchange exchange{by_latches.work, impact->loss};
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        exchange.work += newton::work(impact->impulses[static_cast<Eigen::Index>(i)], closed.contacts[i].gap_t);
    double speed = 0.0;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (landing.contains(closed.which[i])) speed = std::max(speed, -closed.contacts[i].hdot);
    record_.impact(next_.state, v_after, speed, exchange, landing, surfaces_->count() > 1 ? std::move(joint) : nullptr);
    next_.state.v = v_after;
    unlatch(unlatched);
    if (!jumps.empty()) {
        ContactSet opened;
        for (std::size_t i = 0; i < closed.which.size(); ++i)
            if (held.contains(closed.which[i]) && impact->hdot_after[static_cast<Eigen::Index>(i)] > 0.0)
                opened = opened.with(closed.which[i]);
        return jump_after_impact(jumps, landing, opened);
    }
    // Contacts with hdot+ > 0 leave at once; the others may be held.
    ContactSet left;
    forget_held();
    for (std::size_t i = 0; i < closed.which.size(); ++i) {
        const std::size_t contact = closed.which[i];
        const double hdot = impact->hdot_after[static_cast<Eigen::Index>(i)];
        next_.starts[contact] = {{0.0, hdot, 0.0, 0.0, state_error()}, 1};
        if (hdot > 0.0) continue;
        left = left.with(contact);
        if (landing.contains(contact)) latch_landed(contact);
    }
    left = left.with(unlatched);
    for (const std::size_t i : unlatched) next_.starts[i] = {};
    change_rates(v_before, all.with(latched));
    decide(left);
    if (collapses && outcome_) return stop_at_collapse(landing);
    if (collapses) {
        record_collapse_at_tie(landing, limit);  // the collapse, not its impact, changes the mode
    } else {
        record_.after_impact(resting.without(next_.resting().held()), next_.resting());
        enter_or_stay();
    }
    if (!outcome_) begin_stretch(next_.mode, run_.options.end_time);
}

// Tries to complete the motion of a pair: one of the impacting contacts and another one that is open or that the
// impacts would open. v_after is the velocity after the impact. Returns whether a pair was completed.
bool ExecutionAutomaton::complete_pair(ContactSet landing, const Vector& v_after, bool cut_at_resolution) {
    if (completing()) return false;
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (!landing.contains(i) || !(restitution(i) < 1.0)) continue;
        for (std::size_t j = 0; j < surfaces_->count(); ++j) {
            const ContactSet two = ContactSet::of(i).with(j);
            // All other closed contacts must be held.
            if (j == i || !next_.touching.without(two).empty() || !landing.without(two).empty()) continue;
            if (next_.inactive.contains(j) || do_forces_see(two)) continue;
            if (model_->has_jumps() && may_jump(two, {})) continue;
            if (complete_pair(std::min(i, j), std::max(i, j), next_.mode.without(two), landing, v_after,
                              cut_at_resolution))
                return true;
        }
    }
    return false;
}

bool ExecutionAutomaton::complete_pair(std::size_t first, std::size_t second, Mode others, ContactSet landing,
                                       const Vector& v_after, bool cut_at_resolution) {
    const std::array<std::size_t, 2> pair{first, second};
    PairCollision collision{next_.state, {}, {}};
    double speed = 0.0, approach = 0.0, height = 0.0;  // `speed` is the gap rate; the other two refer to |dh| = 1
    for (std::size_t k = 0; k < 2; ++k) {
        const Contact contact = surfaces_->of(pair[k], others).at(next_.state);
        const bool closed =
            landing.contains(pair[k]) || next_.mode.is_held(pair[k]) || next_.touching.contains(pair[k]);
        collision.h[k] = closed ? 0.0 : contact.h;
        collision.sigma[k] = next_.mode.is_held(pair[k]) ? 0.0 : contact.hdot;
        const double slope = surfaces_->of(pair[k]).at(next_.state).g.norm();
        height += collision.h[k] / slope;
        if (!landing.contains(pair[k])) continue;
        speed = std::max(speed, -contact.hdot);
        approach = std::max(approach, -contact.hdot / slope);
    }
    // Fast check: a pair far above the tolerances is not examined.
    if (!cut_at_resolution && (approach > 1e-2 || height > 1e-4)) return false;
    const ContactSet unpressed = always_unpressed(others);
    const auto same = [&](const PairConditionsCache& known) {
        return known.first == first && known.second == second && known.mode == others && known.unpressed == unpressed;
    };
    auto known = std::find_if(all_pairs_.begin(), all_pairs_.end(), same);
    if (known == all_pairs_.end()) {
        const ClosedContacts both = surfaces_->at(next_.state, others.held().with(first).with(second));
        ContactSet places;
        for (std::size_t i = 0; i < both.which.size(); ++i) places = places.with(i);
        if (!HeldBlock<double>::of(both.W, places)) return false;  // they cannot both be held with the others
        const FloatEnvironmentGuard ground;
        const std::array e{surfaces_->restitution(first).enclosure, surfaces_->restitution(second).enclosure};
        all_pairs_.push_back(
            {first, second, others, unpressed,
             std::make_unique<PairConditions>(*model_, run_, e, first, second,
                                              others.with(ContactSet::of(first).with(second), ContactState::held),
                                              unpressed, ground)});
        known = std::prev(all_pairs_.end());
    }
    known->conditions->set_states(next_.inactive, next_.latched);
    auto completion = timed([&] { return known->conditions->certify(collision, cut_at_resolution); });
    if (!completion) return false;
    const ContactSet two = ContactSet::of(first).with(second), all = others.held().with(two);
    const Mode mode = others.with(two, ContactState::held);
    State restart = completion->restart;
    if (!surfaces_->project(restart, all, all)) return false;
    const State before = next_.state;
    const Exchange exchange = record_.exchange_of_jump(before, restart, plastic_work(before, all));
    record_.impact(before, v_after, speed, exchange, landing);
    Event& event = completion_.emplace();
    event.kind = Event::Kind::zeno;
    event.t = completion->certificate.zeno_time;
    event.truncation = Event::TruncationRecord{before.t, before.q, before.v, restart.v, speed};
    cut_error_ += std::max(completion->certificate.shadowing_position.value_or(0.0),
                           completion->certificate.shadowing_velocity.value_or(0.0));
    event.certificate = std::move(completion->certificate);
    event.contacts = two;
    event.mode = mode;
    next_.state = restart;
    next_.touching = next_.load_sharing_candidates = next_.unwatched = {};
    next_.unpressed = unpressed_of(next_.unpressed, mode);
    for (std::size_t i = 0; i < next_.starts.size(); ++i)
        if (all.contains(i)) next_.starts[i] = {};
    change_rates(before.v, all);
    begin_stretch(mode, std::min(event.t, run_.options.end_time));
    return true;
}

// Whether a segment begins just after a step that was short compared with the resolution of time, in a run with several
// contacts and impacts. If no step is possible here, chatter is the cause.
bool ExecutionAutomaton::is_chatter() const {
    constexpr double few_ulps = 0x1p20;  // 2e-10 of t
    return surfaces_->count() > 1 && record_.impacts() > 1 && next_.begins &&
           last_step_ < few_ulps * ulp(next_.state.t);
}

// Whether the flight before an impact at this speed was lower than the rounding of another open contact's gap that is
// 0 within that rounding. Roundings would then decide which contact impacts next, possibly forever.
bool ExecutionAutomaton::moves_within_rounding(std::size_t which, double speed) {
    constexpr double few = 16.0;
    const double way = speed * last_step_ / surfaces_->of(which).at(next_.state).g.norm();
    if (!(way < 0x1p-40 * (1.0 + next_.state.q.cwiseAbs().maxCoeff()))) return false;  // cheap
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (i == which || next_.mode.is_held(i) || next_.touching.contains(i) || next_.inactive.contains(i)) continue;
        const Contact other = surfaces_->of(i).at(next_.state);
        const double known = few * surfaces_->of(i).gap_error(next_.state);
        if (other.h < known && std::abs(other.hdot) * last_step_ < known && speed * last_step_ < known) return true;
    }
    return false;
}

// Whether no time is left between impacts, which may happen to contacts that impact in turn even if each alone would
// bounce high.
bool ExecutionAutomaton::is_at_rounding(std::size_t which, double speed) {
    constexpr double resolved = 16.0;
    return record_.impacts() > 1 && (last_step_ < resolved * ulp(next_.state.t) || moves_within_rounding(which, speed));
}

// Ends the run: a chatter that cannot be resolved any further has no certified limit. The message names these contacts
// and those that are nearly closed.
void ExecutionAutomaton::end_chatter(ContactSet contacts) {
    constexpr double close = 1e-6;
    for (std::size_t i = 0; i < surfaces_->count(); ++i)
        if (!next_.inactive.contains(i) && surfaces_->of(i).at(next_.state).h < close) contacts = contacts.with(i);
    stop(Outcome::Kind::undecided,
         fmt::format("contacts {} chatter together, in flights shorter than double precision resolves{}, at {}",
                     names_of(contacts), obstacle_ ? "; " + obstacle_text() : "", where(next_.state)) +
             collapse_failure_text());
}

// As for a single contact: the next flight, to leading order.
bool ExecutionAutomaton::too_short_to_resolve(std::size_t which, double hdot) {
    ContactKinematics& surface = surfaces_->of(which);
    const double a = -surface.normal_acceleration(next_.state);
    if (!(a > 0.0)) return false;
    return hdot * hdot / (2.0 * a) < 4.0 * surface.gap_error(next_.state) || 2.0 * hdot / a < 4.0 * ulp(next_.state.t);
}

}  // namespace achilles
