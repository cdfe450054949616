// Impacts of two sliding contacts that collapse without force (theory-collapse.md 5).
#include <algorithm>
#include <cmath>

#include "contacts/collapse.hpp"
#include "contacts/friction_modes.hpp"
#include "simulate/execution.hpp"

namespace achilles {

// Two contacts that slide, each with one sign, while nothing else is held. A unit contact force comes with the friction
// force `ratio` = -sign mu, so that one number for each contact describes its impulses.
struct SlidingPair {
    std::array<std::size_t, 2> which;
    ContactRows rows;
    std::array<double, 2> ratio, e;
    Mode closed;  // in which both slide

    Eigen::Index gap(std::size_t k) const { return rows.gap_of(which[k]); }
    Eigen::Index slip(std::size_t k) const { return rows.slip_of(which[k]); }
    double rate(Eigen::Index row) const { return rows.rows[static_cast<std::size_t>(row)].rate; }
    // The change of the rate of this row by a unit impulse on contact l.
    double change(Eigen::Index row, std::size_t l) const {
        return rows.W(row, gap(l)) + (slip(l) < 0 ? 0.0 : ratio[l] * rows.W(row, slip(l)));
    }
    template <class Number>
    PairLaw<Number> law() const {
        const auto W = [&](std::size_t k, std::size_t l) { return widened<Number>(change(gap(k), l), k, l); };
        return {W(0, 0), W(0, 1), W(1, 0), W(1, 1), {Number(e[0]), Number(e[1])}};
    }
    // The impulses on all rows by these on the contacts.
    Eigen::VectorXd impulses(const std::array<double, 2>& normal) const {
        Eigen::VectorXd result = Eigen::VectorXd::Zero(rows.size());
        for (std::size_t k = 0; k < 2; ++k) {
            result[gap(k)] = normal[k];
            if (slip(k) >= 0) result[slip(k)] = ratio[k] * normal[k];
        }
        return result;
    }
    // Those that leave both gaps closed.
    std::array<double, 2> plastic() const {
        const auto [W11, W12, W21, W22, e_unused] = law<double>();
        const double a = -rate(gap(0)), b = -rate(gap(1)), det = W11 * W22 - W12 * W21;
        return {(W22 * a - W12 * b) / det, (W11 * b - W21 * a) / det};
    }
    // Whether no slip changes its sign until both gaps are at rest. The slips are u = u_inf + L sigma with the slips u_inf
    // after the plastic impact, and |sigma| does not grow in the norm of W.
    bool keeps_sliding() const {
        const PairLaw<double> W = law<double>();
        const double det = W.W11 * W.W22 - W.W12 * W.W21, c = std::sqrt(W.coupling());
        const std::array<double, 2> size = W.sizes(), x{rate(gap(0)) / size[0], rate(gap(1)) / size[1]};
        const double r0 = std::sqrt((x[0] * x[0] + 2.0 * c * x[0] * x[1] + x[1] * x[1]) / (1.0 - c * c));
        for (std::size_t k = 0; k < 2; ++k) {
            if (slip(k) < 0) continue;
            const double by_1 = change(slip(k), 0), by_2 = change(slip(k), 1);
            const double L1 = (by_1 * W.W22 - by_2 * W.W21) / det * size[0],
                         L2 = (by_2 * W.W11 - by_1 * W.W12) / det * size[1];
            const double limit = rate(slip(k)) - L1 * x[0] - L2 * x[1];  // u_inf
            const double most = r0 * std::sqrt(L1 * L1 - 2.0 * c * L1 * L2 + L2 * L2);
            if (!(slip_sign(closed.state(which[k])) * limit > most)) return false;
        }
        return true;
    }

 private:
    template <class Number>
    Number widened(double x, std::size_t k, std::size_t l) const {
        if constexpr (std::is_same_v<Number, Interval>) {
            const double radius = 0x1p-40 * (std::abs(rows.W(gap(k), gap(l))) + std::abs(x));
            return Interval(x) + Interval(-radius, radius);
        } else {
            return x;
        }
    }
};

// The pair at the current state; nullopt if the two do not both slide with a constant coefficient, or something else is
// held.
std::optional<SlidingPair> ExecutionAutomaton::sliding_pair(std::size_t first, std::size_t second) {
    const ContactSet two = ContactSet::of(first).with(second), rough = two.within(surfaces_->rough());
    if (!next_.mode.is_free() || !all_joints().empty() || !rough.within(surfaces_->varying()).empty())
        return std::nullopt;
    SlidingPair pair{{first, second},
                     surfaces_->rows(next_.state, two, rough, latched_mode()),
                     {0.0, 0.0},
                     {restitution(first), restitution(second)},
                     next_.mode.with(two, ContactState::held)};
    for (std::size_t k = 0; k < 2; ++k) {
        if (!(pair.e[k] > 0.0 && pair.e[k] < 1.0)) return std::nullopt;
        if (!rough.contains(pair.which[k])) continue;
        const double u = pair.rate(pair.slip(k));
        if (u == 0.0 || surfaces_->never_slides(pair.which[k])) return std::nullopt;
        const int sign = u > 0.0 ? 1 : -1;
        pair.ratio[k] = -sign * pair.rows.slips.at(pair.which[k]).coefficient;
        pair.closed = pair.closed.with(pair.which[k], slip_state(sign));
    }
    return pair;
}

// Whether two contacts that close at the same time lose their speeds at once, both sliding on.
bool ExecutionAutomaton::slides_into_collapse(ContactSet landing) {
    const std::size_t first = *landing.begin(), second = landing.without(first).only();
    const auto pair = sliding_pair(first, second);
    return pair && collapses_at_tie(pair->law<Interval>()) && pair->keeps_sliding();
}

// The plastic impact on a pair at the current state.
std::shared_ptr<CollapseInfo> ExecutionAutomaton::sliding_collapse_info(ContactSet two) {
    auto info = std::make_shared<CollapseInfo>();
    const std::size_t first = *two.begin(), second = two.without(first).only();
    const auto pair = sliding_pair(first, second);
    if (!pair) return info;
    const AlternateImpacts law(pair->law<double>());
    info->speed_ratio = law.mu_plus;
    info->gap_ratio = law.mu_minus;
    const std::array<double, 2> normal = pair->plastic();
    for (std::size_t k = 0; k < 2; ++k) info->impulses.emplace_back(pair->which[k], normal[k]);
    info->loss = energy_of_impact(pair->rows, pair->impulses(normal)).loss;
    return info;
}

// Completes the impacts of a contact that slides at this one, and of another open one that slides, if they alternate
// without end. collapse_failure_ then says why not.
bool ExecutionAutomaton::complete_sliding_collapse(const ImpactWithFriction& impact) {
    collapse_failure_ = {};
    if (!impact.landing.has_one() || completing() || !next_.touching.empty() || !impact.solved.caps.empty())
        return false;
    const std::size_t which = impact.landing.only();
    for (std::size_t j = 0; j < surfaces_->count(); ++j) {
        const ContactSet two = impact.landing.with(j);
        if (j == which || next_.mode.is_held(j) || next_.inactive.contains(j)) continue;
        if (may_jump(two, {}) || do_forces_see(two)) continue;
        if (complete_sliding_collapse(impact, j)) return true;
    }
    return false;
}

bool ExecutionAutomaton::complete_sliding_collapse(const ImpactWithFriction& impact, std::size_t other) {
    const std::size_t which = impact.landing.only();
    const auto before = sliding_pair(which, other);
    if (!before) return false;
    const PairLaw<double> law = before->law<double>();
    if (!(law.W12 < 0.0 && law.W21 < 0.0)) return false;
    const bool slides = before->slip(0) < 0 || impact.solved.mode.state(which) == before->closed.state(which);
    if (!slides) {
        collapse_failure_ = {collapse::slides, impact.landing.with(other)};
        return false;
    }
    const double u = -before->rate(before->gap(0));
    const CollapsingPair pair{
        {which, other}, law, u, before->rate(before->gap(1)), surfaces_->of(other).at(next_.state).h, before->closed};
    const State after{next_.state.q, impact.rows.after(next_.state.v, impact.solved.impulses), next_.state.t};
    auto completion = certify_collapse(pair, after, is_at_rounding(which, u));
    if (!completion) return false;
    State restart = completion->restart;
    if (!surfaces_->settle(restart, pair.closed)) return false;
    record_.impact(next_.state, after.v, u, energy_of_impact(impact.rows, impact.solved.impulses), impact.landing,
                   impact.joint);
    record_.friction_at_impact(impact.friction);
    next_.state.v = after.v;
    const auto rest = sliding_pair(which, other);  // at the rates after the impact
    Exchange exchange = energy_of_impact(rest->rows, rest->impulses(rest->plastic()));
    if (record_.knows_energies())
        exchange.loss = record_.exchange_of_jump(after, restart, exchange.work).loss - exchange.heat;
    record_.add(exchange);
    continue_to_collapse(pair, after, restart, std::move(*completion),
                         sliding_collapse_info(ContactSet::of(which).with(other)));
    return true;
}

}  // namespace achilles
