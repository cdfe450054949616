#include "contacts/friction_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/impact_law.hpp"
#include "number/dense.hpp"

namespace achilles {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Collects the smallest of several quantities, each relative to its size.
class Margin {
 public:
    void require_positive(double value, double size) {
        const double relative = size > 0.0 ? value / size : 0.0;
        if (!(relative >= least_)) least_ = relative;
    }
    double least() const { return least_; }

 private:
    double least_ = 1.0;
};

// The force columns of a combination, one for each unknown force, and the rows that it keeps at acceleration 0.
struct Unknowns {
    std::vector<VectorXd> columns;  // forces by row for a unit of the unknown
    std::vector<Index> kept;
    VectorXd given;  // known forces
};

Unknowns unknowns_of(const FrictionProblem& problem, Mode mode) {
    const Index n = problem.accelerations.size();
    Unknowns result{{}, {}, VectorXd::Zero(n)};
    const ContactSet implied = implied_slips(problem, mode);
    for (const FrictionProblem::Element& each : problem.elements) {
        const ContactState state = mode.state(each.which);
        const int sign = slip_sign(state);
        if (state == ContactState::open) continue;
        if (each.gap < 0 && sign != 0) result.given[each.slip] = -sign * each.sliding;
        if (each.gap >= 0) {
            VectorXd column = VectorXd::Zero(n);
            column[each.gap] = 1.0;
            if (sign != 0) column[each.slip] = -sign * each.sliding;
            result.columns.push_back(column);
            result.kept.push_back(each.gap);
        }
        if (sign == 0 && each.slip >= 0 && !implied.contains(each.which)) {
            VectorXd column = VectorXd::Zero(n);
            column[each.slip] = 1.0;
            result.columns.push_back(column);
            result.kept.push_back(each.slip);
        }
    }
    return result;
}

bool is_same_motion(const FrictionMotion& a, const FrictionMotion& b) {
    const double size = std::max(a.accelerations.cwiseAbs().maxCoeff(), b.accelerations.cwiseAbs().maxCoeff());
    return (a.accelerations - b.accelerations).cwiseAbs().maxCoeff() <= 1e-9 * size;
}

// Whether the closed contacts of every group stick, or slip with one sign.
bool are_together(const FrictionProblem& problem, Mode mode) {
    for (const FrictionProblem::Element& a : problem.elements)
        for (const FrictionProblem::Element& b : problem.elements)
            if (a.group >= 0 && a.group == b.group && mode.is_held(a.which) && mode.is_held(b.which) &&
                mode.state(a.which) != mode.state(b.which))
                return false;
    return true;
}

// All combinations of the states to be tried.
template <class Take>
void for_each_mode(const FrictionProblem& problem, std::size_t from, Mode mode, const Take& take) {
    if (from == problem.elements.size()) return are_together(problem, mode) ? take(mode) : void();
    const FrictionProblem::Element& each = problem.elements[from];
    for (const ContactState state : each.states) for_each_mode(problem, from + 1, mode.with(each.which, state), take);
}

}  // namespace

void group_equal_slips(FrictionProblem& problem) {
    constexpr double rounding = 64 * 0x1p-52;
    int groups = 0;
    std::vector<FrictionProblem::Element>& all = problem.elements;
    const auto may_join = [](const FrictionProblem::Element& each) {
        return each.gap >= 0 && each.slip >= 0 && !each.slides;
    };
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t k = 0; k < i && may_join(all[i]) && all[i].group < 0; ++k) {
            if (!may_join(all[k])) continue;
            bool is_equal = true;
            for (Index row = 0; row < problem.W.rows(); ++row) {
                const double natural = std::sqrt(problem.W(row, row) * problem.W(all[i].slip, all[i].slip));
                const double difference = problem.W(row, all[i].slip) - problem.W(row, all[k].slip);
                is_equal = is_equal && std::abs(difference) <= rounding * natural;
            }
            if (!is_equal) continue;
            if (all[k].group < 0) all[k].group = groups++;
            all[i].group = all[k].group;
        }
}

ContactSet implied_slips(const FrictionProblem& problem, Mode mode) {
    ContactSet implied;
    for (std::size_t i = 0; i < problem.elements.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const FrictionProblem::Element &each = problem.elements[i], &other = problem.elements[k];
            if (each.group >= 0 && each.group == other.group && mode.state(each.which) == ContactState::held &&
                mode.state(other.which) == ContactState::held)
                implied = implied.with(each.which);
        }
    return implied;
}

FrictionMotion motion_in(const FrictionProblem& problem, Mode mode) {
    const Unknowns unknowns = unknowns_of(problem, mode);
    const auto count = static_cast<Index>(unknowns.columns.size());
    FrictionMotion motion{mode, unknowns.given, {}, std::numeric_limits<double>::quiet_NaN(), true};
    if (count > 0) {
        MatrixXd A(count, count);
        VectorXd b(count);
        const VectorXd start = problem.accelerations + problem.W * unknowns.given;
        for (Index k = 0; k < count; ++k) {
            const VectorXd effect = problem.W * unknowns.columns[static_cast<std::size_t>(k)];
            for (Index i = 0; i < count; ++i) A(i, k) = effect[unknowns.kept[static_cast<std::size_t>(i)]];
            b[k] = -start[unknowns.kept[static_cast<std::size_t>(k)]];
        }
        const auto [z, is_unique] = pivoted_solution(A, b, 1e-10);
        motion.is_unique = is_unique;
        if (!z.allFinite() || (A * z - b).cwiseAbs().maxCoeff() > 1e-9 * (b.cwiseAbs().maxCoeff() + 1e-300))
            return motion;
        for (Index k = 0; k < count; ++k) motion.forces += z[k] * unknowns.columns[static_cast<std::size_t>(k)];
    }
    motion.accelerations = problem.accelerations + problem.W * motion.forces;
    for (const Index row : unknowns.kept) motion.accelerations[row] = 0.0;
    Margin margin;
    const ContactSet implied = implied_slips(problem, mode);
    for (const std::size_t i : implied)
        for (const FrictionProblem::Element& each : problem.elements)
            if (each.which == i) motion.accelerations[each.slip] = 0.0;
    const auto size_of = [&](Index row) {
        return std::abs(problem.accelerations[row]) + problem.W.row(row).cwiseAbs().dot(motion.forces.cwiseAbs());
    };
    for (const FrictionProblem::Element& each : problem.elements) {
        const ContactState state = mode.state(each.which);
        const int sign = slip_sign(state);
        if (state == ContactState::open) {
            if (each.gap >= 0) margin.require_positive(motion.accelerations[each.gap], size_of(each.gap));
            continue;
        }
        const double lambda = each.gap >= 0 ? motion.forces[each.gap] : 1.0;
        if (each.gap >= 0) margin.require_positive(lambda * problem.W(each.gap, each.gap), size_of(each.gap));
        if (each.slip < 0) continue;
        if (sign == 0 && !std::isinf(each.resting) && !implied.contains(each.which)) {
            const double tau = motion.forces[each.slip];
            double most = each.resting * lambda;
            for (const FrictionProblem::Element& other : problem.elements)
                if (each.group >= 0 && other.group == each.group && implied.contains(other.which))
                    most += other.resting * motion.forces[other.gap];
            // Both may be small only because the terms of the force cancel.
            const double size = std::abs(most) + std::abs(tau);
            margin.require_positive(most - std::abs(tau), size > 0.0 ? size : 1.0);
        }
        if (sign != 0 && !each.slides)
            margin.require_positive(sign * motion.accelerations[each.slip], size_of(each.slip));
    }
    motion.margin = margin.least();
    return motion;
}

FrictionChoice choose_mode(const FrictionProblem& problem) {
    FrictionChoice choice;
    std::vector<FrictionMotion> doubtful;
    for_each_mode(problem, 0, Mode(), [&](Mode mode) {
        FrictionMotion motion = motion_in(problem, mode);
        if (motion.margin > zero_force)
            choice.motions.push_back(std::move(motion));
        else if (motion.margin >= -zero_force)
            doubtful.push_back(std::move(motion));
    });
    if (choice.motions.empty()) {
        choice.kind = doubtful.empty() ? FrictionChoice::Kind::none : FrictionChoice::Kind::undecided;
        choice.motions = std::move(doubtful);
        return choice;
    }
    const auto sticks = [&](const FrictionMotion& motion) {
        return std::count_if(problem.elements.begin(), problem.elements.end(), [&](const auto& each) {
            return each.slip >= 0 && motion.mode.state(each.which) == ContactState::held;
        });
    };
    std::stable_sort(choice.motions.begin(), choice.motions.end(),
                     [&](const FrictionMotion& a, const FrictionMotion& b) { return sticks(a) > sticks(b); });
    choice.kind = FrictionChoice::Kind::one;
    for (const FrictionMotion& other : choice.motions) {
        const bool counts = sticks(other) == sticks(choice.motions.front());
        if (counts && !is_same_motion(other, choice.motions.front())) choice.kind = FrictionChoice::Kind::several;
    }
    // A mode in doubt matters if it moves otherwise and at least as many stick.
    for (const FrictionMotion& other : doubtful)
        if (sticks(other) >= sticks(choice.motions.front()) && !is_same_motion(other, choice.motions.front()))
            choice.kind = FrictionChoice::Kind::undecided;
    return choice;
}

// ---- impacts ----

namespace {

// The law at one set of restitutions. It has the form of the law of forces, with (1 + e) hdot- and u- in place of the
// accelerations.
FrictionImpact impact_at(const FrictionImpactProblem& problem, double part_of_e) {
    constexpr int rounds = 200;
    constexpr double accurate = 0x1p-50;
    const std::size_t count = problem.elements.size();
    FrictionProblem forces{problem.elements, problem.W, problem.before};
    for (std::size_t i = 0; i < count; ++i) {
        FrictionProblem::Element& each = forces.elements[i];
        const double e = part_of_e * problem.e[i];
        forces.accelerations[each.gap] = newton::removed_rate(e, forces.accelerations[each.gap]);
        if (each.slip < 0) continue;
        each.resting = problem.coefficient(i, newton::slip_speed(0.0, e, problem.before[each.slip]));
    }
    group_equal_slips(forces);
    std::vector<FrictionMotion> found;
    for_each_mode(forces, 0, Mode(), [&](Mode mode) {
        FrictionProblem one = forces;
        FrictionMotion motion;
        // The coefficient belongs to the speed at the end of the compression, which depends on it.
        double change = 1.0;
        for (std::size_t i = 0; i < count; ++i)
            if (one.elements[i].slip >= 0)
                one.elements[i].sliding = problem.coefficient(i, std::abs(problem.before[one.elements[i].slip]));
        for (int round = 0; round < rounds && change > accurate; ++round) {
            motion = motion_in(one, mode);
            change = 0.0;
            for (std::size_t i = 0; i < count && !problem.is_constant; ++i) {
                FrictionProblem::Element& each = one.elements[i];
                if (slip_sign(mode.state(each.which)) == 0 || std::isnan(motion.margin)) continue;
                const double e = part_of_e * problem.e[i], u = problem.before[each.slip];
                const double speed = newton::slip_speed(motion.accelerations[each.slip], e, u);
                const double mu = problem.coefficient(i, speed);
                change = std::max(change, std::abs(mu - each.sliding) / std::max(mu, 1e-300));
                each.sliding = mu;
            }
        }
        if (motion.margin >= -zero_force && change <= 1e-9) found.push_back(std::move(motion));
    });
    FrictionImpact impact;
    if (found.empty()) return impact;
    // Impulses at an edge of the law belong to several modes with the same velocities.
    std::stable_sort(found.begin(), found.end(),
                     [](const FrictionMotion& a, const FrictionMotion& b) { return a.margin > b.margin; });
    impact.kind = FrictionChoice::Kind::one;
    const double size = problem.before.cwiseAbs().maxCoeff();
    for (const FrictionMotion& other : found)
        if ((other.accelerations - found.front().accelerations).cwiseAbs().maxCoeff() > 1e-9 * size)
            impact.kind = FrictionChoice::Kind::several;
    const FrictionMotion& motion = found.front();
    impact.mode = motion.mode;
    impact.impulses = motion.forces;
    impact.after = motion.accelerations;
    for (std::size_t i = 0; i < count; ++i) {
        const Index gap = problem.elements[i].gap;
        impact.after[gap] -= part_of_e * problem.e[i] * problem.before[gap];
    }
    impact.energy_change = 0.5 * impact.impulses.dot(problem.before + impact.after);
    return impact;
}

// The same with the largest part of the restitutions at which the impact gains no energy.
FrictionImpact capped_impact(const FrictionImpactProblem& problem) {
    FrictionImpact impact = impact_at(problem, 1.0);
    const double size = impact.kind == FrictionChoice::Kind::one
                            ? impact.impulses.cwiseAbs().dot(problem.before.cwiseAbs() + impact.after.cwiseAbs())
                            : 0.0;
    impact.gains_energy = impact.energy_change > 0x1p-46 * size;
    if (!impact.gains_energy || problem.may_gain_energy) return impact;
    double gains = 1.0, loses = 0.0;
    while (gains - loses > 0x1p-54) {
        const double middle = 0.5 * (gains + loses);
        if (middle == gains || middle == loses) break;
        (impact_at(problem, middle).energy_change > 0.0 ? gains : loses) = middle;
    }
    impact = impact_at(problem, loses);
    for (std::size_t i = 0; i < problem.elements.size(); ++i) impact.caps.emplace_back(i, loses);
    return impact;
}

// The elements that W couples with the first one, directly or through others.
std::vector<std::size_t> coupled_with_first(const FrictionImpactProblem& problem, const std::vector<bool>& done) {
    constexpr double rounded_zero = 64 * 0x1p-52;
    const auto rows_of = [&](std::size_t i) {
        std::vector<Index> rows{problem.elements[i].gap};
        if (problem.elements[i].slip >= 0) rows.push_back(problem.elements[i].slip);
        return rows;
    };
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < done.size() && found.empty(); ++i)
        if (!done[i]) found.push_back(i);
    for (std::size_t k = 0; k < found.size(); ++k)
        for (std::size_t i = 0; i < done.size(); ++i) {
            if (done[i] || std::find(found.begin(), found.end(), i) != found.end()) continue;
            bool is_coupled = false;
            for (const Index a : rows_of(found[k]))
                for (const Index b : rows_of(i)) {
                    const double natural = std::sqrt(std::abs(problem.W(a, a) * problem.W(b, b)));
                    is_coupled = is_coupled || std::abs(problem.W(a, b)) > rounded_zero * natural;
                }
            if (is_coupled) found.push_back(i);
        }
    return found;
}

}  // namespace

// Contacts that W does not couple are solved apart: a gain of one is not paid for by another.
FrictionImpact friction_impact(const FrictionImpactProblem& problem) {
    FrictionImpact whole;
    whole.kind = FrictionChoice::Kind::one;
    whole.impulses = VectorXd::Zero(problem.before.size());
    whole.after = problem.before;
    std::vector<bool> done(problem.elements.size());
    for (;;) {
        const std::vector<std::size_t> members = coupled_with_first(problem, done);
        if (members.empty()) return whole;
        FrictionImpactProblem part;
        std::vector<Index> rows;
        for (const std::size_t i : members) {
            done[i] = true;
            FrictionProblem::Element each = problem.elements[i];
            rows.push_back(each.gap);
            each.gap = static_cast<Index>(rows.size()) - 1;
            if (each.slip >= 0) {
                rows.push_back(each.slip);
                each.slip = static_cast<Index>(rows.size()) - 1;
            }
            part.elements.push_back(each);
            part.e.push_back(problem.e[i]);
        }
        part.is_constant = problem.is_constant;
        part.may_gain_energy = problem.may_gain_energy;
        part.coefficient = [&](std::size_t i, double speed) { return problem.coefficient(members[i], speed); };
        part.W = problem.W(rows, rows);
        part.before = problem.before(rows);
        const FrictionImpact solved = capped_impact(part);
        if (solved.kind != FrictionChoice::Kind::one) return solved;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            whole.impulses[rows[k]] = solved.impulses[static_cast<Index>(k)];
            whole.after[rows[k]] = solved.after[static_cast<Index>(k)];
        }
        for (const FrictionProblem::Element& each : part.elements)
            whole.mode = whole.mode.with(each.which, solved.mode.state(each.which));
        whole.energy_change += solved.energy_change;
        whole.gains_energy = whole.gains_energy || solved.gains_energy;
        for (const auto& [i, factor] : solved.caps) whole.caps.emplace_back(members[i], factor);
    }
}

}  // namespace achilles
