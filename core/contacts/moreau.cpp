#include "contacts/moreau.hpp"

#include <algorithm>
#include <cmath>

#include "contacts/complementarity.hpp"
#include "contacts/impact_law.hpp"

namespace achilles {

namespace {

using Matrix = ContactMatrix<double>;
using Vector = ContactVector<double>;
using Eigen::Index;

// The only contact of `colliding` with hdot != 0; -1 if there is none or more than one.
Index only_closing_contact(const Vector& hdot, ContactSet colliding) {
    Index landing = -1;
    for (Index j = 0; j < hdot.size(); ++j) {
        if (!contains(colliding, j) || hdot[j] == 0.0) continue;
        if (landing >= 0) return -1;
        landing = j;
    }
    return landing;
}

// The impulses if contact i impacts and `others` stay closed: p_i by Newton's law with W_i^A, and kappa_j p_i. nullopt
// if a kappa_j is negative, so that a contact would open, or W is nearly singular.
std::optional<Vector> passed_on(const Matrix& W, double e, double hdot, Index i, ContactSet others) {
    const auto block = HeldBlock<double>::of(W, others);
    if (!block) return std::nullopt;
    const auto [kappa, W_i] = block->transmission(W, i);
    if (!(W_i > HeldBlock<double>::clear * W(i, i)) || !(kappa.minCoeff() >= 0.0)) return std::nullopt;
    const double p = newton::impulse(e, hdot, W_i);
    if (!std::isfinite(p)) return std::nullopt;
    Vector impulses = p * kappa;
    impulses[i] = p;
    return impulses;
}

// Solves the problem over `colliding` alone: p, and y = hdot+ + e hdot-, both 0 for the other contacts.
std::optional<Complementarity> solve_among(const Matrix& W, const Vector& b, ContactSet colliding) {
    Matrix block(colliding.count(), colliding.count());
    Vector right(colliding.count());
    Index row = 0;
    for (Index i = 0; i < b.size(); ++i) {
        if (!contains(colliding, i)) continue;
        right[row] = b[i];
        Index column = 0;
        for (Index k = 0; k < b.size(); ++k)
            if (contains(colliding, k)) block(row, column++) = W(i, k);
        ++row;
    }
    const auto among = solve_complementarity(block, right);
    if (!among) return std::nullopt;
    Complementarity result{Vector::Zero(b.size()), Vector::Zero(b.size()), {}, among->unique};
    row = 0;
    for (Index i = 0; i < b.size(); ++i) {
        if (!contains(colliding, i)) continue;
        result.p[i] = among->p[row];
        result.y[i] = among->y[row++];
    }
    return result;
}

// The impulses p of Moreau's law, and y = hdot+ + e hdot-. nullopt if no solution is found.
std::optional<Complementarity> solve_impact(const Matrix& W, const Vector& hdot, const Vector& e,
                                            ContactSet colliding) {
    if (const Index i = only_closing_contact(hdot, colliding); i >= 0)
        if (const auto p = passed_on(W, e[i], hdot[i], i, without(colliding, i)))
            return Complementarity{*p, Vector::Zero(hdot.size()), {}, true};
    return solve_among(W, hdot + e.cwiseProduct(hdot), colliding);
}

}  // namespace

std::optional<MoreauImpact> moreau_impact(const Matrix& W, const Vector& hdot_before, const Vector& e, ContactSet held,
                                          ContactSet colliding) {
    Vector hdot = hdot_before;
    for (Index j = 0; j < hdot.size(); ++j)
        if (contains(held, j)) hdot[j] = 0.0;
    const auto solution = solve_impact(W, hdot, e, colliding);
    if (!solution) return std::nullopt;
    MoreauImpact impact;
    impact.impulses = solution->p;
    impact.unique = solution->unique;
    impact.hdot_after = hdot + W * solution->p;
    for (Index j = 0; j < hdot.size(); ++j) {
        if (!contains(colliding, j)) continue;
        const double y = solution->y[j];
        impact.hdot_after[j] = hdot[j] == 0.0 ? y : y - e[j] * hdot[j];
        if (solution->p[j] > 0.0) impact.active = with(impact.active, j);
        if (contains(held, j) && y > 0.0) impact.opened = with(impact.opened, j);
        impact.loss += newton::loss(solution->p[j], e[j], hdot[j]);
    }
    return impact;
}

std::optional<MoreauImpact> moreau_impact(const Matrix& W, const Vector& hdot_before, const Vector& e,
                                          ContactSet held) {
    ContactSet colliding = held;
    for (Index j = 0; j < hdot_before.size(); ++j)
        if (hdot_before[j] <= 0.0) colliding = with(colliding, j);
    return moreau_impact(W, hdot_before, e, held, colliding);
}

// ---- successive impacts ----

namespace {

constexpr double negligible = 0x1p-40;

class Turns {
 public:
    Turns(const Matrix& W, const Vector& hdot_before, const Vector& e, ContactSet held)
        : W_(W), e_(e), at_rest_(held), hdot_(hdot_before), impulses_(Vector::Zero(hdot_before.size())) {
        for (Index j = 0; j < hdot_.size(); ++j) {
            if (contains(held, j)) hdot_[j] = 0.0;
            start_ = std::max(start_, approach(j));
        }
    }

    std::optional<ImpactSequence> from(Index first) {
        ImpactSequence result;
        result.first = first;
        for (ContactSet landing = with({}, first); !landing.empty(); landing = fastest_closing()) {
            if (result.impacts == ImpactSequence::most_impacts) {
                result.end = ImpactSequence::SequenceEnd::cut;
                break;
            }
            if (!collide(landing)) return std::nullopt;
            ++result.impacts;
        }
        if (result.end == ImpactSequence::SequenceEnd::finite && hdot_.minCoeff() < 0.0) {
            result.end = ImpactSequence::SequenceEnd::limit;
            hdot_ = hdot_.cwiseMax(0.0);
        }
        result.hdot_after = hdot_;
        result.impulses = impulses_;
        return result;
    }

 private:
    // Closing speed |hdot|/sqrt(W_jj), the square root of twice an energy; 0 for a contact that does not close.
    double approach(Index j) const { return hdot_[j] < 0.0 ? -hdot_[j] / std::sqrt(W_(j, j)) : 0.0; }

    // The contacts with the largest closing speed (ties within rounding); empty if all are within rounding of zero.
    ContactSet fastest_closing() const {
        double most = 0.0;
        for (Index j = 0; j < hdot_.size(); ++j) most = std::max(most, approach(j));
        ContactSet set;
        if (most <= negligible * start_) return set;
        for (Index j = 0; j < hdot_.size(); ++j)
            if (approach(j) >= (1.0 - negligible) * most) set = with(set, j);
        return set;
    }

    bool collide(ContactSet landing) {
        ContactSet colliding = at_rest_;
        for (Index j = 0; j < hdot_.size(); ++j)
            if (contains(landing, j)) colliding = with(colliding, j);
        const auto impact = moreau_impact(W_, hdot_, e_, at_rest_, colliding);
        if (!impact) return false;
        hdot_ = impact->hdot_after;
        impulses_ += impact->impulses;
        for (Index j = 0; j < hdot_.size(); ++j) {
            if (!contains(colliding, j)) continue;
            if (hdot_[j] > 0.0) at_rest_ = without(at_rest_, j);
            if (hdot_[j] == 0.0 && e_[j] == 0.0) at_rest_ = with(at_rest_, j);
        }
        return true;
    }

    const Matrix& W_;
    const Vector& e_;
    ContactSet at_rest_;
    Vector hdot_, impulses_;
    double start_ = 0.0;  // the largest closing speed before the first impact
};

}  // namespace

std::optional<ImpactSequence> impacts_in_turn(const Matrix& W, const Vector& hdot_before, const Vector& e,
                                              ContactSet held, Index first) {
    return Turns(W, hdot_before, e, held).from(first);
}

std::vector<ImpactSequence> alternatives(const Matrix& W, const Vector& hdot_before, const Vector& e, ContactSet held) {
    std::vector<ImpactSequence> result;
    for (Index i = 0; i < hdot_before.size(); ++i)
        if (!contains(held, i) && hdot_before[i] < 0.0)
            if (const auto sequence = impacts_in_turn(W, hdot_before, e, held, i)) result.push_back(*sequence);
    return result;
}

// ---- dependence on the order of impacts ----

namespace {

// Decides signs; a number that is 0 within rounding becomes 0, and that is recorded.
class Signs {
 public:
    // `natural` is the size to which the rounding of x is compared (counts_as_zero).
    Interval judged(const Interval& x, double natural) {
        if (!(width(x) > 0.0) || !counts_as_zero(x, natural)) return x;
        rounded_ = true;
        return 0.0;
    }
    bool rounded() const { return rounded_; }

 private:
    bool rounded_ = false;
};

}  // namespace

OrderDependence order_dependence(const ContactMatrix<Interval>& W_given, const Vector& e, ContactSet held,
                                 ContactSet landing) {
    const Index size = W_given.rows();
    const auto natural = [&](Index i, Index k) { return std::sqrt(mid(W_given(i, i)) * mid(W_given(k, k))); };
    Signs signs;
    ContactMatrix<Interval> W = W_given;
    bool plastic = true;
    for (Index i = 0; i < size; ++i) {
        if (contains(landing, i) && e[i] != 0.0) plastic = false;
        for (Index k = 0; k < size; ++k)
            if (i != k) W(i, k) = signs.judged(W(i, k), natural(i, k));
    }
    OrderDependence result;
    const auto block = HeldBlock<Interval>::of(W, held);
    if (!block) return {!held.empty(), landing.count() > 1, signs.rounded()};
    for (Index k = 0; k < size; ++k) {
        if (!contains(landing, k)) continue;
        const auto [kappa, W_k] = block->transmission(W, k);
        for (Index j = 0; j < size; ++j)
            if (contains(held, j) && !(signs.judged(kappa[j], natural(k, k) / natural(j, k)).lo() >= 0.0))
                result.by_transmission = true;
        for (Index i = 0; i < k; ++i) {
            if (!contains(landing, i)) continue;
            const Interval W_ik = signs.judged(HeldBlock<Interval>::between(W, i, k, kappa), natural(i, k));
            const bool is_zero = W_ik.lo() == 0.0 && W_ik.hi() == 0.0;
            if (!(plastic ? W_ik.hi() <= 0.0 : is_zero)) result.by_landings = true;
        }
    }
    result.rounded_zero = signs.rounded();
    return result;
}

}  // namespace achilles
