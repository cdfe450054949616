// The effect of jumps of the state, and of passes, on a small change (theory-modes.md 6).
#include <fmt/format.h>

#include <algorithm>

#include "number/dense.hpp"
#include "sensitivity/chain.hpp"

namespace achilles {

using Eigen::Index, Eigen::RowVectorXd;

namespace {

// The part of a row that is no combination of other rows, relative to the row.
double independent_part(const RowVectorXd& row, const RowMatrix& others) {
    const double size = row.norm();
    if (size == 0.0 || others.rows() == 0) return size == 0.0 ? 0.0 : 1.0;
    const Eigen::VectorXd c = least_solution(others.transpose(), Eigen::VectorXd(row.transpose()));
    return (row - c.transpose() * others).norm() / size;
}

}  // namespace

Gradient& Chain::jump_map(std::size_t number) {
    auto& known = jump_maps_[number];
    if (!known)
        known = std::make_unique<Gradient>(*model_, model_->jump_map(number), tangent_, trajectory_->run.parameters);
    return *known;
}

Gradient& Chain::guards() {
    if (!guards_)
        guards_ = std::make_unique<Gradient>(*model_, model_->guards(), tangent_, trajectory_->run.parameters);
    return *guards_;
}

// The contacts that are closed at the present state within the roundings of the run, whether they count or not.
ContactSet Chain::closed_here() {
    constexpr double few = 4.0;
    if (scale_.q.size() == 0) scale_ = scale_of(*trajectory_);
    ContactSet closed = mode_.held();
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        ContactKinematics& contact = surfaces_.of(i);
        const Contact at = contact.at(state_);
        const double rounding = contact.gap_error(state_) + 0x1p-53 * at.g.cwiseAbs().dot(scale_.q);
        if (std::abs(at.h) <= few * rounding) closed = closed.with(i);
    }
    return closed;
}

// What every perturbed run keeps at 0 at its own event: the gaps that are closed there, the gap rates of the held
// contacts, and the function of the jump.
void Chain::keep_zeros(std::optional<std::size_t> watched) {
    std::vector<RowVectorXd> rows;
    for (const std::size_t i : closed_here()) {
        ContactGradient& contact = surface(i, {});
        contact.at(state_);
        rows.emplace_back(contact.h_row());
        if (mode_.is_held(i)) rows.emplace_back(contact.hdot_row());
    }
    if (watched) rows.emplace_back(guards().row(*watched));
    zeros_.resize(static_cast<Index>(rows.size()), tangent_.size());
    for (std::size_t k = 0; k < rows.size(); ++k) zeros_.row(static_cast<Index>(k)) = rows[k];
    since_zeros_.setIdentity(tangent_.size(), tangent_.size());
}

// Crosses the zero of a watched guard, of this jump or of the latch of this contact. Returns its number.
std::size_t Chain::cross_guard(std::size_t event, bool is_latch, std::size_t number) {
    const std::vector<WatchedGuard>& all = model_->watched_guards();
    const auto guard = std::find_if(all.begin(), all.end(), [&](const WatchedGuard& one) {
        return one.is_latch == is_latch && one.number == number;
    });
    const auto watched = static_cast<std::size_t>(guard - all.begin());
    guards().at(state_);
    cross(event, guards().row(watched), guards().value(watched));
    return watched;
}

void Chain::jump(std::size_t event) {
    const auto& events = trajectory_->events;
    const Event& now = events[event];
    const std::vector<JumpLaw>& laws = model_->equations().jumps;
    const JumpLaw& law = laws[now.jump->number];
    const std::string& name = model_->description().jumps[now.jump->number].name;
    if (waiting_) return break_off(fmt::format("the jump '{}' happens before the Zeno time of a contact", name));
    const Event* before = event > 0 && events[event - 1].t == now.t ? &events[event - 1] : nullptr;
    const bool follows_jump = before != nullptr && before->is_jump(),
               follows_impact = before != nullptr && before->is_impact();
    if (law.on) {
        const bool is_same = follows_jump && laws[before->jump->number].on == law.on;
        if ((follows_jump && !is_same) || follows_impact)
            return break_off(
                fmt::format("the jump '{}' happens together with another event: which is first depends on "
                            "the direction of the perturbation",
                            name));
        if (!follows_jump) {
            set_gaps();
            keep_zeros(cross_guard(event, false, now.jump->number));
        }
    } else if (!follows_jump) {
        keep_zeros({});
    }
    Gradient& map = jump_map(now.jump->number);
    map.at(state_);
    ChainLink& link = add(ChainLink::Kind::jump, event);
    for (std::size_t i = 0; i < tangent_.dof; ++i) {
        link.J.row(tangent_.q(i)) = map.row(i);
        link.J.row(tangent_.v(i)) = map.row(tangent_.dof + i);
    }
    state_ = {now.q, now.v_after, now.t};
    mode_ = now.mode;
    since_zeros_ = (link.J * since_zeros_).eval();
    if (event + 1 == events.size() || !events[event + 1].is_jump() || events[event + 1].t != now.t)
        if (!continue_after_jump(now, name)) return;
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        ContactGradient& contact = surface(i, {});
        contact.at(state_);
        link.J.row(tangent_.h(i)) = (contact.h_row() * link.J).eval();
        link.J.row(tangent_.u(i)) = (contact.hdot_row() * link.J).eval();
    }
    retract(link.J, mode_);
    set_gaps();
}

// What is closed after the jump must stay closed in every perturbed run. False if the chain is broken.
bool Chain::continue_after_jump(const Event& now, const std::string& name) {
    constexpr double rounding = 1e-9;
    for (const std::size_t i : closed_here()) {
        ContactGradient& contact = surface(i, {});
        contact.at(state_);
        const bool keeps_gap = independent_part(contact.h_row() * since_zeros_, zeros_) <= rounding;
        const bool keeps_rate =
            !now.mode.is_held(i) || independent_part(contact.hdot_row() * since_zeros_, zeros_) <= rounding;
        if (keeps_gap && keeps_rate) continue;
        break_off(
            fmt::format("after the jump '{}' the gap of '{}' is zero, and a perturbed run would be above or below "
                        "the surface there",
                        name, model_->description().constraints[i].name));
        return false;
    }
    return true;
}

// Nothing happens to the state; a change follows the event.
void Chain::pass(std::size_t event) {
    const std::size_t contact = trajectory_->events[event].contacts.only();
    set_gaps();
    h_[contact] = 0.0;
    RowVectorXd to_surface = RowVectorXd::Zero(tangent_.size());
    to_surface[tangent_.h(contact)] = 1.0;
    cross(event, std::move(to_surface), 0.0);
    add(ChainLink::Kind::jump, event);
}

}  // namespace achilles
