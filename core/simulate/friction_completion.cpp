// Completion of bouncing with friction (theory-friction.md 4): the contact slides with one sign at all further impacts,
// or sticks at all of them.
#include <fmt/format.h>

#include "simulate/execution.hpp"

namespace achilles {

namespace {

// The impulses after which the gap stays closed (restitution 0), if the slip keeps its sign or stops as in an impact.
Eigen::VectorXd plastic_impulses(const ContactRows& rows, const Eigen::VectorXd& impulses, double e, bool sticks) {
    if (!sticks) return impulses / (1.0 + e);
    const double det = rows.W(0, 0) * rows.W(1, 1) - rows.W(0, 1) * rows.W(1, 0);
    const double hdot = rows.rows[0].rate, u = rows.rows[1].rate;
    Eigen::VectorXd result(2);
    result << (rows.W(0, 1) * u - rows.W(1, 1) * hdot) / det, (rows.W(1, 0) * hdot - rows.W(0, 0) * u) / det;
    return result;
}

}  // namespace

// The balance of the energy that the cut takes away. A contact that sticks also moves by the drift of its slip.
Exchange ExecutionAutomaton::exchange_of_cut(const ImpactWithFriction& impact, const Eigen::VectorXd& plastic,
                                             const Collision& collision) {
    Exchange exchange = energy_of_impact(impact.rows, plastic);
    if (collision.position.size() == 0 || !record_.knows_energies()) return exchange;
    const State restart{collision.position, collision.restart, collision.before.t};
    exchange.heat = record_.exchange_of_jump(collision.before, restart, exchange.work).loss - exchange.loss;
    return exchange;
}

// Truncates the bouncing at this impact of a single contact, if that is certified. False if the contact bounces on.
bool ExecutionAutomaton::complete_with_friction(const ImpactWithFriction& impact) {
    if (!impact.landing.has_one() || (model_->has_jumps() && may_jump(impact.landing, falling_jumps()))) return false;
    const std::size_t which = impact.landing.only();
    const ContactState state = impact.mode.state(which);
    const double e = restitution(which), speed = -impact.rows.rows[0].rate;
    const bool sticks = state == ContactState::held && impact.rows.slip_of(which) >= 0;
    which_ = which;
    if (!(e > 0.0) || state == ContactState::open || impact.is_capped || !next_.mode.is_free() ||
        !model_->has_bouncing({which, next_.mode, state}))
        return false;
    find_conditions(state);
    if (conditions_ != nullptr && conditions_->fails_by_speed(speed) && is_well_resolved(speed)) return false;
    const Eigen::VectorXd plastic = plastic_impulses(impact.rows, impact.impulses, e, sticks);
    const Vector tangential = impact.rows.after(next_.state.v, plastic);
    Collision collision{next_.state, speed, tangential, tangential, {}};
    const bool could = could_truncate(collision, state), is_last = !could && too_short_to_resolve(collision, e);
    if (!could && !is_last) return false;
    if (sticks) {
        State restart = conditions_->restart_at(collision);
        if (!surfaces_->settle(restart, next_.mode.with(which, state))) {
            fail_projection();
            return true;
        }
        collision.position = restart.q;
        collision.restart = restart.v;
    }
    auto certificate = could ? timed([&] { return conditions_->certify(collision, proof_scope_); }) : std::nullopt;
    if (!certificate) {
        if (!too_short_to_resolve(collision, e)) return false;
        certificate = timed([&] { return conditions_->prove_any(collision); });
        if (!certificate) {
            stop(Outcome::Kind::undecided,
                 fmt::format("the flights of {} became shorter than double precision resolves, and it is not proved "
                             "whether it slides or sticks at all further impacts, at {}",
                             name_of(which), where(next_.state)));
            return true;
        }
    }
    record_.impact(next_.state, impact.rows.after(next_.state.v, impact.impulses), speed,
                   exchange_of_cut(impact, plastic, collision), impact.landing, impact.joint);
    record_.friction_at_impact(impact.friction);
    continue_to_zeno_point(collision, state, std::move(*certificate), sticks ? last_sliding_impact_ + 1 : 0);
    return true;
}

}  // namespace achilles
