// The effect of dry friction on a small change: stick, slip and reversal (theory-friction.md 6), and the constraints of
// contacts and joints that stick. Impacts are in friction_impact_sensitivity.cpp.
#include <algorithm>
#include <cmath>

#include "number/dense.hpp"
#include "sensitivity/chain.hpp"

namespace achilles {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

namespace {

// Rows x -> G x and columns M^-1 G' of several gaps and slips.
struct ConstraintRows {
    RowMatrix rates;       // of a change
    MatrixXd G, impulses;  // rows by coordinate, columns by coordinate
    Index count = 0;

    ConstraintRows(Index most, Index dof, Index columns) : rates(most, columns), G(most, dof), impulses(dof, most) {}
    void append(const RowVectorXd& rate, const auto& gradient, const auto& impulse) {
        for (Index k = 0; k < G.cols(); ++k) {
            G(count, k) = gradient(static_cast<std::size_t>(k));
            impulses(k, count) = impulse(static_cast<std::size_t>(k));
        }
        rates.row(count++) = rate;
    }
    void append(const RowVectorXd& rate, const ContactGradient& contact) {
        append(
            rate, [&](std::size_t k) { return contact.g(k); },
            [&](std::size_t k) { return contact.W() * contact.n(k); });
    }
    // Takes out the rates: dx -= M^-1 G' (G M^-1 G')^-1 rates.
    void take_out(RowMatrix& J, Index first) const {
        const auto by = impulses.leftCols(count);
        const MatrixXd W = G.topRows(count) * by;
        J.middleRows(first, G.cols()) -= by * least_solution(W, MatrixXd(rates.topRows(count)));
    }
};

}  // namespace

// A slip of the start that sticks ends soon only if the kinetic friction is larger than the force of sticking.
void Chain::find_critical_slips() {
    for (const std::size_t i : mode_.slipping())
        if (std::abs(surfaces_.slip(i, state_).u) <= 4.0 * surfaces_.slip_error(i, state_))
            critical_slips_ = critical_slips_.with(i);
    const FrictionLaws& laws = model_->equations().friction;
    for (const std::size_t i : mode_.elements_in(ContactState::held).within(surfaces_.rough())) {
        if (mode_.implied().contains(i) || !laws.at(i).has_jump) continue;
        auto force = model_->evaluator(model_->friction_force(i, mode_), trajectory_->run.parameters);
        set_state(force, state_);
        force.run();
        const double kinetic = surfaces_.slip(i, state_, {}, 0.0).coefficient;
        if (!(std::abs(force.output(1)) < kinetic * force.output(0))) critical_slips_ = critical_slips_.with(i);
    }
}

// A start at slip 0 that sticks: the change of a slip ends after a time of first order. Meanwhile friction takes it out
// along M^-1 d', or so that gaps stay closed, whatever its sign.
void Chain::begin_with_friction() {
    if (mode_ == Mode()) return;
    settle(add(ChainLink::Kind::jump).J, mode_);
}

void Chain::end_with_friction() {
    switch (trajectory_->outcome.kind) {
        case Outcome::Kind::painleve:
        case Outcome::Kind::impact_not_unique:
        case Outcome::Kind::redundant_contacts:
        case Outcome::Kind::undecided:
            return break_off("the run stops where its motion is not determined: " + trajectory_->outcome.message);
        default:
            return;
    }
}

RowVectorXd Chain::slip_row_at_start(std::size_t which) {
    SlipGradient& slip = this->slip(which);
    slip.at(trajectory_->run.start(), 0.0);
    return slip.u_row();
}

// Moves the rows of q onto h = 0 of these contacts, along M^-1 G'.
void Chain::move_onto(RowMatrix& J, ContactSet surfaces) {
    if (surfaces.empty()) return;
    ConstraintRows rows(surfaces.count(), static_cast<Index>(tangent_.dof), J.cols());
    for (const std::size_t i : surfaces) {
        ContactGradient& contact = surface(i, {});
        contact.at(state_);
        rows.append(contact.h_row() * J, contact);
    }
    rows.take_out(J, tangent_.q(0));
}

// Projects the rows of q onto the gaps that a mode keeps closed, then those of v, in one solve, onto hdot = 0 of these
// and u = 0 of all that stick.
void Chain::settle(RowMatrix& J, Mode onto) {
    const ContactSet held = onto.held();
    move_onto(J, held);
    const ContactSet stuck = onto.elements_in(ContactState::held).within(surfaces_.rough()).without(onto.implied());
    if (held.empty() && stuck.empty()) return;
    ConstraintRows rows(held.count() + stuck.count(), static_cast<Index>(tangent_.dof), J.cols());
    for (const std::size_t i : held) {
        ContactGradient& contact = surface(i, {});
        contact.at(state_);
        rows.append(contact.hdot_row() * J, contact);
    }
    for (const std::size_t i : stuck) {
        SlipGradient& slip = this->slip(i);
        slip.at(state_, 0.0);
        rows.append(
            slip.u_row() * J, [&](std::size_t k) { return slip.d(k); }, [&](std::size_t k) { return slip.impulse(k); });
    }
    rows.take_out(J, tangent_.v(0));
    for (const std::size_t i : held) {
        J.row(tangent_.h(i)).setZero();
        J.row(tangent_.u(i)).setZero();
    }
}

// The slip at the end of the last step by its own polynomials, before v is projected onto u = 0; 0 if it is within
// rounding.
double Chain::slip_residual(std::size_t which, double at_event) {
    if (next_piece_ == 0) return at_event;
    const DenseSegment& piece = trajectory_->pieces[next_piece_ - 1];
    if (piece.end != state_.t) return at_event;
    State reached = state_in(piece, trajectory_->coefficients, model_->dof(), piece.end);
    reached.t = piece.end;
    const double u = surfaces_.slip(which, reached).u;
    return std::abs(u) > 4.0 * surfaces_.slip_error(which, reached) ? u : 0.0;
}

// The number of the event function that vanishes at a change of friction: the slip that ends, else the limit of the
// friction force that is reached, else the contact force. What happens besides at the same instant is its consequence.
// Breaks off if there are several.
std::optional<std::size_t> Chain::vanishing_function(std::size_t event) {
    const std::vector<Event>& events = trajectory_->events;
    ContactSet ended, started, released;
    for (std::size_t i = event; i < events.size() && events[i].t == events[event].t; ++i) {
        const Event& each = events[i];
        if (!(each.mode == events[event].mode) || each.is_impact() || each.is_zeno()) break;
        ContactSet& set = each.is_release() ? released : each.kind == Event::Kind::slip ? started : ended;
        set = set.with(each.contacts);
    }
    Gradient& values = event_functions(mode_);
    values.at(state_);
    const VectorXd F = rate();
    const std::vector<FrictionEvent>& friction = model_->motion(mode_).friction;
    std::vector<std::pair<double, std::size_t>> candidates;  // how far from its zero (s), and the function
    for (std::size_t k = 0; k < friction.size() && (!ended.empty() || !started.empty()); ++k) {
        const std::size_t which = friction[k].contact;
        const FrictionFunction watched = friction[k].watched;
        const bool is_slip = watched == FrictionFunction::slip;
        if (watched == FrictionFunction::pivot || is_slip == ended.empty()) continue;
        if (!(is_slip ? ended : started).contains(which)) continue;
        const std::size_t number = tangent_.contacts + k, output = 2 * tangent_.dof + number;
        candidates.emplace_back(std::abs(values.value(output) / (values.row(output) * F)), number);
    }
    if (ended.empty() && started.empty())
        for (const std::size_t i : released) candidates.emplace_back(0.0, i);
    std::sort(candidates.begin(), candidates.end());
    constexpr double simultaneous = 1e-9;  // relative to the time
    std::vector<std::size_t> found;
    for (const auto& [away, number] : candidates)
        if (away <= std::max(simultaneous * (1.0 + std::abs(state_.t)), 100.0 * candidates.front().first))
            found.push_back(number);
    // Equal slips, as of the feet of a table, end together in every perturbed run.
    const auto row = [&](std::size_t number) {
        return RowVectorXd(values.row(2 * tangent_.dof + number)).normalized().eval();
    };
    while (found.size() > 1 && (row(found[0]) - row(found.back())).norm() < 1e-12) found.pop_back();
    if (found.size() == 1) return found.front();
    break_off(found.empty()
                  ? "the function whose zero changes the friction is not found"
                  : "the friction of several contacts changes at the same time: which is first depends on the "
                    "direction of the perturbation");
    return std::nullopt;
}

// A contact leaves because its latch has ended by an expression.
void Chain::end_latch_with_friction(std::size_t event) {
    const Event& now = trajectory_->events[event];
    const ContactSet released = mode_.held().without(now.mode.held());
    if (!released.has_one() || mode_.without(released) != now.mode)
        return break_off("the end of a latch changes other contacts, too: no derivatives are computed past it");
    cross_guard(event, true, released.only());
    ChainLink& link = add(ChainLink::Kind::jump, event);
    settle(link.J, mode_);
    mode_ = now.mode;
    set_gaps();
    h_[released.only()] = u_[released.only()] = 0.0;
}

void Chain::change_friction(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (waiting_) return break_off("the friction changes before the Zeno time of a contact");
    if (mode_ == now.mode && event > 0 && trajectory_->events[event - 1].t == now.t) {
        add(ChainLink::Kind::jump, event);  // a further record of the same change
        return;
    }
    set_gaps();
    if (now.ends_latch) return end_latch_with_friction(event);
    const auto number = vanishing_function(event);
    if (!number) return;
    Mode at_event = mode_;  // in which the slip that ends is 0
    const Gradient& values = event_functions(mode_);
    const std::size_t output = 2 * tangent_.dof + *number;
    double residual = values.value(output);
    if (*number >= tangent_.contacts) {
        const FrictionEvent& friction = model_->motion(mode_).friction[*number - tangent_.contacts];
        if (friction.watched == FrictionFunction::slip) {
            residual = slip_sign(mode_.state(friction.contact)) * slip_residual(friction.contact, residual);
            at_event = mode_.with(friction.contact, ContactState::held);
        }
    }
    const ChainLink& crossing = cross(event, values.row(output), residual);
    const double rate = crossing.G.dot(crossing.F);
    if (*number < tangent_.contacts) take_least(margins_.release_jerk, std::abs(rate));
    ChainLink& link = add(ChainLink::Kind::jump, event);
    const ContactSet released = mode_.held().without(now.mode.held());
    settle(link.J, at_event);
    mode_ = now.mode;
    settle(link.J, mode_);
    set_gaps();
    for (const std::size_t i : released) h_[i] = u_[i] = 0.0;
}

}  // namespace achilles
