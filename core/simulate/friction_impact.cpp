// Impacts with friction, of one or several contacts (theory-friction.md 3).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contacts/friction_modes.hpp"
#include "simulate/execution.hpp"

namespace achilles {

Exchange energy_of_impact(const ContactRows& rows, const Eigen::VectorXd& impulses) {
    const Eigen::VectorXd change_of_rates = rows.W * impulses;
    Exchange total;
    for (Eigen::Index k = 0; k < rows.size(); ++k) {
        const ContactRows::Row& row = rows.rows[static_cast<std::size_t>(k)];
        const double p = impulses[k], change = -p * (row.rate + 0.5 * change_of_rates[k]);
        (row.is_slip ? total.heat : total.loss) += change;
        total.work -= p * row.drift;
    }
    return total;
}

// Adds to these contacts others that close at the same time, within rounding.
ContactSet ExecutionAutomaton::closing_with(ContactSet landing) {
    const ContactSet still = next_.held().with(next_.touching);
    for (std::size_t i = 0; i < surfaces_->count(); ++i) {
        if (still.with(landing).with(next_.inactive).contains(i)) continue;
        const Contact other = surfaces_->of(i).at(next_.state);
        const double rounding = 4.0 * surfaces_->of(i).gap_error(next_.state);
        if (other.hdot < 0.0 && other.h <= rounding - 0x1p-50 * std::abs(next_.state.t) * other.hdot && does_count(i))
            landing = landing.with(i);
        if (outcome_) break;
    }
    return landing;
}

// The gaps and slips of these contacts before an impact. The rate is 0 for a gap that is `still` closed, and for a slip
// that sticks.
ContactRows ExecutionAutomaton::rows_before_impact(ContactSet contacts, ContactSet still) {
    ContactRows rows = surfaces_->rows(next_.state, contacts, contacts.within(surfaces_->rough()), latched_mode());
    for (ContactRows::Row& row : rows.rows) {
        const bool is_kept =
            row.is_slip ? next_.mode.state(row.which) == ContactState::held : still.contains(row.which);
        if (is_kept) row.rate = 0.0;
    }
    return rows;
}

FrictionImpactProblem ExecutionAutomaton::impact_problem(const ContactRows& rows, ContactSet contacts) {
    using enum ContactState;
    FrictionImpactProblem problem;
    problem.may_gain_energy = run_.options.energy_gain == EnergyGain::stop;
    problem.W = rows.W;
    problem.before.resize(rows.size());
    for (Eigen::Index k = 0; k < rows.size(); ++k) problem.before[k] = rows.rows[static_cast<std::size_t>(k)].rate;
    std::vector<std::size_t> numbers;
    for (const std::size_t i : contacts) {
        numbers.push_back(i);
        FrictionProblem::Element each{i, rows.gap_of(i), rows.slip_of(i), 0.0, 0.0, false, {open, held}};
        if (surfaces_->frictionless().contains(i)) {
            each.slides = true;  // with either sign, since its friction force is 0
            each.states = {open, slip_plus};
        } else if (each.slip >= 0 && !surfaces_->never_slides(i))
            each.states.insert(each.states.end(), {slip_plus, slip_minus});
        problem.elements.push_back(each);
        problem.e.push_back(restitution(i));
        if (each.slip >= 0) {
            const std::uint32_t speed = model_->layout().sliding_speed();
            problem.is_constant =
                problem.is_constant && !depends_on(model_->equations().friction.at(i).level, {&speed, 1});
        }
    }
    problem.coefficient = [this, numbers](std::size_t element, double speed) {
        const std::size_t i = numbers[element];
        if (surfaces_->never_slides(i)) return std::numeric_limits<double>::infinity();
        return surfaces_->slip(i, next_.state, {}, speed).coefficient;
    };
    return problem;
}

// Ends the run if no impulses obey the impact law, or several, or if the impact gains energy. False if the run ends.
bool ExecutionAutomaton::check_impact(const FrictionImpact& impact, ContactSet landing, ContactSet contacts) {
    if (impact.kind != FrictionChoice::Kind::one) {
        const bool none = impact.kind == FrictionChoice::Kind::none;
        const bool pulls = none && contacts.has_one() && surfaces_->rough().contains(contacts.only()) &&
                           surfaces_->never_slides(contacts.only());
        stop(pulls ? Outcome::Kind::painleve : Outcome::Kind::impact_not_unique,
             pulls ? fmt::format("the impulse of {} would have to pull: it never slides, at {}", names_of(contacts),
                                 where(next_.state))
                   : fmt::format("{} impulses obey the impact law with friction of {}, at {}", none ? "no" : "several",
                                 names_of(contacts), where(next_.state)));
        return false;
    }
    if (impact.gains_energy)
        stop(Outcome::Kind::energy_gain,
             fmt::format("the impact of {} would change the energy by {:.6g}, a gain: skew bodies may gain some where "
                         "their slip ends within the impact, at {}",
                         names_of(landing), impact.energy_change, where(next_.state)));
    return !outcome_;
}

// The mode just after an impact of these contacts, at the present velocity: those with hdot+ > 0 leave at once, and the
// others stay closed. Sets the starts of next_. nullopt if the run ends.
std::optional<Mode> ExecutionAutomaton::mode_after_impact(const ContactRows& rows, const FrictionImpact& impact,
                                                          ContactSet contacts) {
    Mode mode = sliding_mode(all_joints()).with(next_.latched, ContactState::held);
    for (const std::size_t i : contacts) {
        const double hdot = impact.after[rows.gap_of(i)];
        next_.starts[i] = {{0.0, hdot, 0.0, 0.0, state_error()}, 1};
        if (hdot > 0.0) {
            if (!too_short_to_resolve(i, hdot)) continue;
            stop(Outcome::Kind::undecided,
                 fmt::format("the flights of {} became shorter than double precision resolves, and {}, at {}",
                             name_of(i), obstacle_text(), where(next_.state)));
            return std::nullopt;
        }
        mode = mode.with(i, ContactState::held);
        if (rows.slip_of(i) < 0) continue;
        const double u = impact.after[rows.slip_of(i)];
        const ContactState state = impact.mode.state(i);
        // Without an impulse of friction the slip is what it was before.
        if (surfaces_->frictionless().contains(i) || (state == ContactState::open && u != 0.0))
            mode = mode.with(i, slip_state(u > 0.0 ? 1 : -1));
        else if (slip_sign(state) != 0)
            mode = mode.with(i, state);
    }
    return mode;
}

// Contacts that land, with those that are held or touch. Joints take no impulse, because their level is finite.
void ExecutionAutomaton::collide_with_friction(ContactSet landing) {
    const ContactSet latched = next_.latched, held = next_.held().without(latched), still = held.with(next_.touching);
    landing = closing_with(landing);
    if (outcome_) return;
    const Jumps jumps = jumps_after(landing, falling_jumps());
    if (outcome_) return;
    const ContactSet all = still.with(landing);
    if (all.with(latched).count() > max_closed_contacts)
        return stop(Outcome::Kind::redundant_contacts,
                    fmt::format("{} contacts are closed at once, and at most {} can be resolved: {}, at {}",
                                all.count(), max_closed_contacts, names_of(all), where(next_.state)));
    if (!surfaces_->project(next_.state, all.with(latched), {})) return fail_projection();
    if (!check_friction_levels(all)) return;
    const ContactRows rows = rows_before_impact(all, still);
    FrictionImpactProblem problem = impact_problem(rows, all);
    const bool collapses = is_collapse_at_tie(landing);  // then the impact is plastic, whatever the restitutions
    const auto limit = collapses ? sliding_collapse_info(landing) : nullptr;
    if (collapses) std::fill(problem.e.begin(), problem.e.end(), 0.0);
    const FrictionImpact impact = friction_impact(problem);
    if (!check_impact(impact, landing, all)) return;
    const Vector v_before = next_.state.v, v_after = rows.after(v_before, impact.impulses);
    double speed = 0.0;
    for (const std::size_t i : landing)
        speed = std::max(speed, -rows.rows[static_cast<std::size_t>(rows.gap_of(i))].rate);
    auto joint = std::make_shared<MultiContactInfo>();
    auto friction = std::make_shared<Event::FrictionImpulses>();
    for (const ContactRows::Row& row : rows.rows) {
        const double p = impact.impulses[&row - rows.rows.data()];
        (row.is_slip ? friction->tangential : joint->impulses).emplace_back(row.which, p);
    }
    for (const auto& [element, factor] : impact.caps) {
        friction->energy_cap = factor;
        friction->capped = friction->capped.with(problem.elements[element].which);
    }
    const ContactSet unlatched = unlatched_by(landing);
    if (unlatched.empty()) {
        const ImpactWithFriction known{landing, rows, problem, impact, joint, friction};
        if (complete_with_friction(known) || complete_sliding_collapse(known)) return;
    }
    Exchange exchange = energy_of_impact(rows, impact.impulses);
    exchange.work += add_impulses_of_latched(*joint, friction.get(), v_after - v_before).work;
    record_.impact(next_.state, v_after, speed, exchange, landing, std::move(joint));
    record_.friction_at_impact(std::move(friction));
    if (!landing.has_one() || impact.mode.state(landing.only()) != ContactState::held)
        last_sliding_impact_ = record_.impacts_of_phase();
    const State before = next_.state;
    next_.state.v = v_after;
    unlatch(unlatched);
    if (!jumps.empty()) {
        ContactSet opened;
        for (const std::size_t i : held)
            if (impact.after[rows.gap_of(i)] > 0.0) opened = opened.with(i);
        return jump_after_impact(jumps, landing, opened);
    }
    for (const std::size_t i : landing)
        if (!(impact.after[rows.gap_of(i)] > 0.0)) latch_landed(i);
    const std::optional<Mode> stays = mode_after_impact(rows, impact, all);
    if (!stays) return;
    const Mode after = stays->with(unlatched, ContactState::held);
    if (!surfaces_->settle(next_.state, after)) return fail_projection();
    change_other_rates(v_before, all.with(latched));
    const bool is_decided = decide_with_friction(after.held(), after);
    if (collapses && !is_decided) return stop_at_collapse(landing);
    if (!is_decided) return;
    if (collapses) {
        record_collapse_at_tie(landing, limit);  // the collapse, not its impact, changes the mode
        return begin_stretch(next_.mode, run_.options.end_time);
    }
    const ContactSet opened = held.with(unlatched).without(next_.held());
    const bool is_plastic = landing.has_one() && restitution(landing.only()) == 0.0 && opened.empty() &&
                            next_.mode.is_held(landing.only()) && still == held && unlatched.empty();
    record_.after_impact(opened, is_plastic ? record_.mode() : next_.mode);
    if (is_plastic) {
        record_.set_latched(next_.latched);
        record_plastic_landing(landing.only(), before, speed);
    }
    if (!(next_.mode == record_.mode())) enter_phase();
    begin_stretch(next_.mode, run_.options.end_time);
}

// With restitution 0 the contact starts without a bounce, as in capture().
void ExecutionAutomaton::record_plastic_landing(std::size_t contact, const State& before, double speed) {
    Certificate certificate;
    certificate.certified = true;
    certificate.conditions = run_.options.truncation.conditions;
    certificate.zeno_low = certificate.zeno_high = certificate.zeno_time = next_.state.t;
    certificate.shadowing_position = certificate.shadowing_velocity = certificate.uniform_position = 0.0;
    const Interval force = surfaces_->motion(next_.mode).enclosed(next_.state)[contact].value;
    certificate.a_min = -force.hi();
    certificate.a_max = -force.lo();
    certificate.tightest_bound = "restitution 0: no impact sequence is truncated";
    if (!next_.latched.contains(contact)) certificate.assumptions = {{"normal acceleration", force.hi(), 0.0}};
    Event event;
    event.kind = Event::Kind::zeno;
    event.t = next_.state.t;
    event.truncation = Event::TruncationRecord{before.t, before.q, before.v, next_.state.v, speed};
    event.certificate = std::move(certificate);
    event.contacts = ContactSet::of(contact);
    event.mode = next_.mode;
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    record_.event(std::move(event));
}

}  // namespace achilles
