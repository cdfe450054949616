// Completion of bouncing with friction (theory-friction.md 4): the contact slides with one sign at all further impacts,
// or sticks at all of them. Others that are held stay as they are.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contacts/friction_modes.hpp"
#include "simulate/execution.hpp"

namespace achilles {

namespace {

// The impulses after which the gaps stay closed (restitution 0) in the branches of an impact: what slides keeps its
// sign, and what sticks stops.
Eigen::VectorXd plastic_impulses(const FrictionImpactProblem& problem, const FrictionImpact& impact, double e,
                                 bool sticks) {
    if (!sticks) return impact.impulses / (1.0 + e);
    FrictionProblem rows{problem.elements, problem.W, problem.before};
    for (std::size_t i = 0; i < rows.elements.size(); ++i) {
        FrictionProblem::Element& each = rows.elements[i];
        if (each.slip >= 0) each.sliding = problem.coefficient(i, std::abs(problem.before[each.slip]));
    }
    return motion_in(rows, impact.mode).forces;
}

}  // namespace

// Why an impact leaves the held contacts in other states, or nothing.
std::optional<BouncingObstacle> ExecutionAutomaton::change_at_impact(const ImpactWithFriction& impact) const {
    double largest = 0.0;
    for (Eigen::Index k = 0; k < impact.rows.size(); ++k)
        largest = std::max(largest, std::abs(impact.solved.impulses[k]));
    for (const std::size_t j : next_.held()) {
        const Eigen::Index gap = impact.rows.gap_of(j);
        const double speed =
            -impact.rows.rows[static_cast<std::size_t>(impact.rows.gap_of(impact.landing.only()))].rate;
        if (impact.solved.after[gap] > zero_force * speed) return BouncingObstacle{j, "is opened by the impacts"};
        const bool feels = impact.solved.impulses[gap] > zero_force * largest;
        if (feels && surfaces_->rough().contains(j) && impact.solved.mode.state(j) != next_.mode.state(j))
            return BouncingObstacle{j, "changes between sticking and sliding at the impacts"};
    }
    return std::nullopt;
}

// The balance of the energy that the cut takes away. A contact that sticks also moves by the drift of its slip.
Exchange ExecutionAutomaton::exchange_of_cut(const ImpactWithFriction& impact, const Eigen::VectorXd& plastic,
                                             const Collision& collision) {
    Exchange exchange = energy_of_impact(impact.rows, plastic);
    if (collision.position.size() == 0 || !record_.knows_energies()) return exchange;
    const State restart{collision.position, collision.restart, collision.before.t};
    exchange.heat = record_.exchange_of_jump(collision.before, restart, exchange.work).loss - exchange.loss;
    return exchange;
}

// What keeps the bouncing after this impact from being completed, as far as it can be said without a proof.
std::optional<BouncingObstacle> ExecutionAutomaton::obstacle_to_completion(const ImpactWithFriction& impact) {
    const std::size_t which = impact.landing.only();
    if (!next_.latched.empty()) return BouncingObstacle{*next_.latched.begin(), "is held by a latch"};
    if (!next_.touching.empty()) return BouncingObstacle{*next_.touching.begin(), "touches without a force"};
    if (auto change = change_at_impact(impact)) return change;
    return model_->obstacle_to_bouncing({which, next_.mode, impact.solved.mode.state(which)});
}

// Truncates the bouncing at this impact of a single contact, if that is certified. False if the contact bounces on.
bool ExecutionAutomaton::complete_with_friction(const ImpactWithFriction& impact) {
    obstacle_.reset();
    if (!impact.landing.has_one() || (model_->has_jumps() && may_jump(impact.landing, falling_jumps()))) return false;
    const std::size_t which = impact.landing.only();
    const ContactState state = impact.solved.mode.state(which);
    const double e = restitution(which),
                 speed = -impact.rows.rows[static_cast<std::size_t>(impact.rows.gap_of(which))].rate;
    if (e > 0.0 && !may_cut(which)) return false;
    const bool sticks = state == ContactState::held && impact.rows.slip_of(which) >= 0,
               is_capped = !impact.solved.caps.empty();
    which_ = which;
    // An impact that keeps the direction of the slip gains no energy.
    if (!(e > 0.0) || state == ContactState::open || (is_capped && !sticks)) return false;
    if ((obstacle_ = obstacle_to_completion(impact))) return false;
    find_conditions(state);
    if (conditions_ != nullptr && conditions_->fails_by_speed(speed) && is_well_resolved(speed)) return false;
    const Eigen::VectorXd plastic = plastic_impulses(impact.problem, impact.solved, e, sticks);
    const Vector tangential = impact.rows.after(next_.state.v, plastic);
    Collision collision{next_.state, speed, tangential, tangential, {}, is_capped};
    const bool could = could_truncate(collision, state), is_last = !could && too_short_to_resolve(collision, e);
    if (!could && !is_last) return false;
    if (sticks) {
        State restart = conditions_->restart_at(collision);
        if (!surfaces_->settle(restart, next_.mode.with(which, state))) {
            if (is_last)
                stop(Outcome::Kind::undecided,
                     fmt::format("the flights of {} became shorter than double precision resolves, and it cannot be "
                                 "brought to rest beside what is held, at {}",
                                 name_of(which), where(next_.state)));
            return is_last;
        }
        collision.position = restart.q;
        collision.restart = restart.v;
    }
    auto certificate = could ? timed([&] { return conditions_->certify(collision, proof_scope_); }) : std::nullopt;
    if (!certificate) {
        if (!too_short_to_resolve(collision, e)) return false;
        certificate = timed([&] { return conditions_->prove_any(collision); });
        if (!certificate) {
            obstacle_ = conditions_->obstacle();
            stop(
                Outcome::Kind::undecided,
                fmt::format(
                    "the flights of {} became shorter than double precision resolves, and {}, at {}", name_of(which),
                    obstacle_ ? obstacle_text() : "it is not proved whether it slides or sticks at all further impacts",
                    where(next_.state)));
            return true;
        }
    }
    record_.impact(next_.state, impact.rows.after(next_.state.v, impact.solved.impulses), speed,
                   exchange_of_cut(impact, plastic, collision), impact.landing, impact.joint);
    record_.friction_at_impact(impact.friction);
    continue_to_zeno_point(collision, state, std::move(*certificate), sticks ? last_sliding_impact_ + 1 : 0);
    return true;
}

// Why the bouncing is not completed.
std::string ExecutionAutomaton::obstacle_text() const {
    if (!obstacle_) return "bouncing with friction is not completed";
    return fmt::format("bouncing is not completed because {} {}", name_of(obstacle_->which), obstacle_->text);
}

}  // namespace achilles
