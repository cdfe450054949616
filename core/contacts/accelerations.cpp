#include "contacts/accelerations.hpp"

namespace achilles {

namespace {

using Eigen::Index;

class Classification {
 public:
    Classification(const ContactMatrix<Interval>& W, const ContactVector<Interval>& hddot, ContactSet active)
        : W_(W), hddot_(hddot), active_(active) {}

    // Doubt spreads: it may take away what the proof of another sign stood on.
    std::optional<AccelerationSigns> settled() {
        for (;;) {
            signs_ = AccelerationSigns();
            signs_.undecided = doubtful_;
            first_ = true;
            if (!every_choice(0, active_)) return std::nullopt;
            const ContactSet doubtful = united(doubtful_, found_);
            if (doubtful == doubtful_) break;
            doubtful_ = doubtful;
        }
        for (Index j = 0; j < hddot_.size(); ++j) {
            if (contains(doubtful_, j)) continue;
            ContactSet& set = contains(active_, j) ? signs_.held : signs_.leaves;
            set = with(set, j);
        }
        return signs_;
    }

 private:
    ContactSet united(ContactSet a, ContactSet b) const {
        for (Index j = 0; j < hddot_.size(); ++j)
            if (contains(b, j)) a = with(a, j);
        return a;
    }

    // From contact j on, every choice among the doubtful.
    bool every_choice(Index j, ContactSet held) {
        while (j < hddot_.size() && !contains(doubtful_, j)) ++j;
        if (j == hddot_.size()) return look(held);
        return every_choice(j + 1, with(held, j)) && every_choice(j + 1, without(held, j));
    }

    // With these held: lambda_A = -W_AA^-1 hddot_A and hddot_j + W_jA lambda_A for the others.
    bool look(ContactSet held) {
        const auto block = HeldBlock<Interval>::of(W_, held);
        if (!block) return false;
        ContactVector<Interval> opposite(hddot_.size()), acceleration(hddot_.size());
        for (Index j = 0; j < hddot_.size(); ++j) opposite[j] = -hddot_[j];
        const ContactVector<Interval> lambda = block->solve(opposite);
        for (Index j = 0; j < hddot_.size(); ++j) {
            const bool is_held = contains(held, j);
            acceleration[j] = 0.0;
            if (!is_held) {
                acceleration[j] = hddot_[j];
                for (Index k = 0; k < hddot_.size(); ++k)
                    if (contains(held, k)) acceleration[j] += W_(j, k) * lambda[k];
            }
            if (!certainly_positive(is_held ? lambda[j] : acceleration[j])) found_ = with(found_, j);
        }
        join(lambda, acceleration);
        return true;
    }

    void join(const ContactVector<Interval>& lambda, const ContactVector<Interval>& acceleration) {
        if (first_) {
            signs_.lambda = lambda;
            signs_.acceleration = acceleration;
            first_ = false;
            return;
        }
        for (Index j = 0; j < lambda.size(); ++j) {
            signs_.lambda[j] = hull(signs_.lambda[j], lambda[j]);
            signs_.acceleration[j] = hull(signs_.acceleration[j], acceleration[j]);
        }
    }

    const ContactMatrix<Interval>& W_;
    const ContactVector<Interval>& hddot_;
    ContactSet active_, doubtful_, found_;
    AccelerationSigns signs_;
    bool first_ = true;
};

}  // namespace

std::optional<AccelerationSigns> classify(const ContactMatrix<Interval>& W, const ContactVector<Interval>& hddot,
                                          ContactSet active) {
    return Classification(W, hddot, active).settled();
}

}  // namespace achilles
