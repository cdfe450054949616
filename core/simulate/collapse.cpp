// Impacts of a pair that collapse without force (theory-collapse.md 6).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/collapse.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

double ulp_of(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

// Indices of a pair in ClosedContacts, in ascending order.
std::array<Eigen::Index, 2> places_of_pair(const ClosedContacts& closed, ContactSet pair) {
    std::array<Eigen::Index, 2> places{};
    std::size_t next = 0;
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (pair.contains(closed.which[i])) places[next++] = static_cast<Eigen::Index>(i);
    return places;
}

}  // namespace

// The law of this pair while the other closed contacts `held` are held. nullopt if they cannot all be held, or an
// impact of the pair might open one of them.
std::optional<PairLaw<Interval>> ExecutionAutomaton::law_of_pair(ContactSet pair, ContactSet held) {
    const ClosedContacts closed = surfaces_->at(next_.state, held.with(pair));
    const auto W = enclosure(closed.W, rounding_radius(closed.W));
    const auto block = HeldBlock<Interval>::of(W, closed.places_of(held));
    if (!block) return std::nullopt;
    const auto [first, second] = places_of_pair(closed, pair);
    const auto by_first = block->transmission(W, first), by_second = block->transmission(W, second);
    for (const std::size_t i : closed.places_of(held.without(next_.latched))) {
        const auto k = static_cast<Eigen::Index>(i);
        for (const Transmission<Interval>* by : {&by_first, &by_second})
            if (!(by->kappa[k].lo() >= 0.0) && !counts_as_zero(by->kappa[k], std::sqrt(mid(by->W) / mid(W(k, k)))))
                return std::nullopt;
    }
    const auto e = [&](Eigen::Index place) {
        return surfaces_->restitution(closed.which[static_cast<std::size_t>(place)]).enclosure;
    };
    const Interval between = HeldBlock<Interval>::between(W, first, second, by_second.kappa);
    return PairLaw<Interval>{by_first.W, between, between, by_second.W, {e(first), e(second)}};
}

// Whether two contacts that close at the same time lose their speeds at once: the plastic impact is then the limit of
// both orders (theory-collapse.md 4).
bool ExecutionAutomaton::is_collapse_at_tie(ContactSet landing) {
    if (landing.count() != 2 || !next_.touching.empty() || next_.held().count() + 2 > max_closed_contacts) return false;
    if (may_jump(landing, {})) return false;  // a contact with a jump is never cut
    if (surfaces_->has_friction()) return slides_into_collapse(landing);
    for (const std::size_t i : landing)
        if (!(surfaces_->of(i).at(next_.state).hdot < 0.0)) return false;
    const FloatEnvironmentGuard ground;
    const auto law = law_of_pair(landing, next_.held());
    return law && collapses_at_tie(*law);
}

AlternateImpacts ExecutionAutomaton::law_of_tie(ContactSet landing) {
    const FloatEnvironmentGuard ground;
    const auto law = law_of_pair(landing, next_.held());
    return AlternateImpacts(
        {mid(law->W11), mid(law->W12), mid(law->W21), mid(law->W22), {mid(law->e[0]), mid(law->e[1])}});
}

// Tries to complete the impacts of this contact and another open one that alternate without end. `at_rounding`: no
// further flight can be resolved. Returns whether they were completed; collapse_failure_ then says why not.
bool ExecutionAutomaton::complete_collapse(std::size_t which, const Contact& contact, bool at_rounding) {
    collapse_failure_ = {};
    const double e = restitution(which);
    if (completing() || !next_.touching.empty() || !(e > 0.0 && e < 1.0)) return false;
    for (std::size_t j = 0; j < surfaces_->count(); ++j) {
        if (j == which || next_.mode.is_held(j) || !(restitution(j) > 0.0 && restitution(j) < 1.0)) continue;
        const ContactSet two = ContactSet::of(which).with(j);
        if (next_.inactive.contains(j) || may_jump(two, {}) || do_forces_see(two)) continue;
        const Contact other = surfaces_->of(j, next_.mode).at(next_.state);
        const double W = other.g.dot(contact.impulse_direction) * contact.W;
        if (!(W < 0.0)) continue;
        if (complete_collapse({which, j}, {contact, other}, W, at_rounding)) return true;
    }
    return false;
}

// The same for this pair without friction, of which the first one impacts.
bool ExecutionAutomaton::complete_collapse(const std::array<std::size_t, 2>& pair,
                                           const std::array<Contact, 2>& contacts, double W12, bool at_rounding) {
    const double e = restitution(pair[0]), u = -contacts[0].hdot;
    const State after{next_.state.q, impact(contacts[0], next_.state.v, e), next_.state.t};
    const ContactSet two = ContactSet::of(pair[0]).with(pair[1]);
    const CollapsingPair collapsing{pair,
                                    {contacts[0].W, W12, W12, contacts[1].W, {e, restitution(pair[1])}},
                                    u,
                                    contacts[1].hdot,
                                    contacts[1].h,
                                    next_.mode.with(two, ContactState::held)};
    auto completion = certify_collapse(collapsing, after, at_rounding);
    if (!completion) return false;
    const ContactSet all = next_.held().with(two);
    State restart = completion->restart;
    if (!surfaces_->project(restart, all, all)) return false;
    record_.impact(next_.state, after.v, u, exchange_of(contacts[0], e), ContactSet::of(pair[0]));
    next_.state.v = after.v;
    const auto info = collapse_info(two, AlternateImpacts(collapsing.law));
    record_.add(record_.exchange_of_jump(after, restart, plastic_work(after, all)));
    continue_to_collapse(collapsing, after, restart, std::move(*completion), info);
    return true;
}

// The certificate for a truncation at this impact, which leads to the state `after`.
std::optional<PairCompletion> ExecutionAutomaton::certify_collapse(const CollapsingPair& pair, const State& after,
                                                                   bool at_rounding) {
    const std::size_t which = pair.which[0], j = pair.which[1];
    const double e = pair.law.e[0], u = pair.speed;
    const AlternateImpacts law(pair.law);
    const auto fail = [&](std::string_view inequality) {
        collapse_failure_ = {inequality, ContactSet::of(which).with(j)};
        return std::nullopt;
    };
    if (!law.is_real) return fail(collapse::real);
    const double sigma = pair.rate - law.k[0] * u;
    const double error = surfaces_->of(j).gap_error(next_.state), h = std::max(0.0, pair.gap) + error;
    // Contacts that close at the same time are decided together.
    if (!at_rounding && pair.rate < 0.0 && h <= 8.0 * error - pair.rate * ulp_of(next_.state.t)) return std::nullopt;
    const double T = law.time(0, e * u, sigma, h);
    if (!(T > 0.0)) return fail(collapse::cone);
    const std::array<double, 2> size{std::sqrt(pair.law.W11), std::sqrt(pair.law.W22)};  // W_ii = 1 in these units
    double acceleration = 0.0;
    for (std::size_t k = 0; k < 2; ++k)
        acceleration = std::max(
            acceleration, std::abs(surfaces_->of(pair.which[k], next_.mode).normal_acceleration(after)) / size[k]);
    if (!law.is_fast && acceleration > 0.0) return fail(collapse::fast);
    const double beta = acceleration * h * pair.law.W11 / (size[1] * u * u);
    if (!(beta < 0.2)) return fail(collapse::weak_force);
    constexpr double resolved = 16.0;
    const bool cut_at_resolution =
        at_rounding || h <= resolved * error || h <= next_.starts[j].gap.error || T < resolved * ulp_of(next_.state.t);
    // The enclosure of the time is never narrower than the first flight allows: this saves the proof.
    if (!cut_at_resolution && T > 2.0 * run_.options.truncation.eps_t) return fail(collapse::tolerances);

    CollapseConditions& conditions = collapse_conditions(std::min(which, j), std::max(which, j), pair.closed);
    const std::size_t landed = which < j ? 0 : 1;
    CollapseConditions::CollapseStart start{{after, {}, {}}, landed, u};
    start.collision.sigma[landed] = e * u;
    start.collision.sigma[1 - landed] = sigma;
    start.collision.h[1 - landed] = h;
    std::string_view failed;
    conditions.set_states(next_.inactive, next_.latched);
    auto completion = timed([&] { return conditions.certify(start, cut_at_resolution, failed); });
    if (!completion) return fail(failed);
    return completion;
}

CollapseConditions& ExecutionAutomaton::collapse_conditions(std::size_t first, std::size_t second, Mode closed) {
    const ContactSet unpressed = always_unpressed(next_.mode);
    for (CollapseConditionsCache& known : all_collapses_)
        if (known.first == first && known.second == second && known.closed == closed && known.unpressed == unpressed)
            return *known.conditions;
    const FloatEnvironmentGuard ground;
    const std::array e{surfaces_->restitution(first).enclosure, surfaces_->restitution(second).enclosure};
    all_collapses_.push_back(
        {first, second, closed, unpressed,
         std::make_unique<CollapseConditions>(*model_, run_, e, first, second, closed, unpressed, ground)});
    return *all_collapses_.back().conditions;
}

// The plastic impact on a pair at the current state, while the held contacts are held.
std::shared_ptr<CollapseInfo> ExecutionAutomaton::collapse_info(ContactSet pair, const AlternateImpacts& law) {
    auto info = std::make_shared<CollapseInfo>();
    info->speed_ratio = law.mu_plus;
    info->gap_ratio = law.mu_minus;
    const ContactSet all = next_.held().with(pair);
    const ClosedContacts closed = surfaces_->at(next_.state, all);
    const auto block = HeldBlock<double>::of(closed.W, closed.places_of(all));
    if (!block) return info;
    ContactVector<double> rates = closed.rates();
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        if (!pair.contains(closed.which[i])) rates[static_cast<Eigen::Index>(i)] = 0.0;
    const ContactVector<double> p = block->solve(-rates);
    info->loss = -0.5 * p.dot(rates);
    for (std::size_t i = 0; i < closed.which.size(); ++i)
        info->impulses.emplace_back(closed.which[i], p[static_cast<Eigen::Index>(i)]);
    return info;
}

// The motion that holds both contacts, from the restart to the time of the collapse.
void ExecutionAutomaton::continue_to_collapse(const CollapsingPair& collapsing, const State& after,
                                              const State& restart, PairCompletion completion,
                                              std::shared_ptr<const CollapseInfo> info) {
    const Mode mode = collapsing.closed;
    const ContactSet pair = ContactSet::of(collapsing.which[0]).with(collapsing.which[1]);
    Event& event = completion_.emplace();
    event.kind = Event::Kind::collapse;
    event.t = completion.certificate.zeno_time;
    event.truncation = Event::TruncationRecord{after.t, after.q, after.v, restart.v, collapsing.speed};
    cut_error_ += std::max(completion.certificate.shadowing_position.value_or(0.0),
                           completion.certificate.shadowing_velocity.value_or(0.0));
    event.certificate = std::move(completion.certificate);
    event.collapse_info = std::move(info);
    event.contacts = pair;
    event.mode = mode;
    next_.state = restart;
    next_.load_sharing_candidates = {};
    next_.unpressed = unpressed_of(next_.unpressed, mode);
    for (const std::size_t i : mode.held()) next_.starts[i] = {};
    change_rates(after.v, mode.held());
    begin_stretch(mode, std::min(event.t, run_.options.end_time));
    next_.unwatched = pair;  // their forces may have any sign until then
}

// Records the collapse of a pair that closed at one time, just after its plastic impact has been recorded.
void ExecutionAutomaton::record_collapse_at_tie(ContactSet pair, std::shared_ptr<const CollapseInfo> info) {
    Event event;
    event.kind = Event::Kind::collapse;
    event.t = next_.state.t;
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    event.contacts = pair;
    event.collapse_info = std::move(info);
    Certificate& certificate = event.certificate.emplace();
    certificate.certified = true;
    certificate.zeno_low = certificate.zeno_high = certificate.zeno_time = event.t;
    certificate.shadowing_position = certificate.shadowing_velocity = certificate.uniform_position = 0.0;
    certificate.tightest_bound = "both close at the same time: no impact sequence is truncated";
    finish_collapse(std::move(event), next_.held(), next_.resting());
}

// The end of a collapse: the accelerations decide by complementarity which contacts stay.
void ExecutionAutomaton::pass_collapse(Event&& event) {
    const ContactSet pair = event.contacts;
    if (surfaces_->has_friction())
        decide_with_friction(next_.held(), next_.mode);
    else
        decide(next_.held());
    if (outcome_) return stop_at_collapse(pair);
    event.q = next_.state.q;
    event.v_before = event.v_after = next_.state.v;
    finish_collapse(std::move(event), next_.held(), next_.resting());
    begin_stretch(next_.mode, run_.options.end_time);
}

void ExecutionAutomaton::finish_collapse(Event&& event, ContactSet held, Mode resting) {
    event.opened = event.contacts.without(held.with(next_.touching));
    event.mode = resting;
    record_.event(std::move(event));
    enter_phase();
}

// Ends a run in which no force decides which contacts stay after a collapse.
void ExecutionAutomaton::stop_at_collapse(ContactSet pair) {
    if (outcome_->kind != Outcome::Kind::undecided) return;
    stop(Outcome::Kind::undecided, fmt::format("no force decides whether {} stay closed after their collapse, at {}",
                                               names_of(pair), where(next_.state)));
}

// "; 'a', 'b' do not collapse without force: k1 k2 > ... is not proved", of the last impact; else empty.
std::string ExecutionAutomaton::collapse_failure_text() const {
    if (collapse_failure_.inequality.empty()) return "";
    return fmt::format("; no collapse of {} without force is proved, because this inequality is not: {}",
                       names_of(collapse_failure_.pair), collapse_failure_.inequality);
}

}  // namespace achilles
