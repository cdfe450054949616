// The effect of events on a small change: impacts, truncations and their Zeno points, releases (theory-derivatives.md 3
// to 6). For errors, also the gap left at an impact and the move onto the contact surface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "certify/truncation.hpp"
#include "sensitivity/chain.hpp"

namespace achilles {

using Eigen::RowVectorXd, Eigen::VectorXd;

namespace {

constexpr const char* several_at_zeno_point =
    "several contacts reach a Zeno point together: no derivatives are computed past this point";
constexpr const char* at_collapse = "the impacts of two contacts collapse: no derivatives are computed past this point";

// A number and its derivatives by the components of a change, for the impact law.
struct ValueWithGradient {
    double value;
    RowVectorXd row;
};
ValueWithGradient operator+(double a, const ValueWithGradient& b) { return {a + b.value, b.row}; }
ValueWithGradient operator-(const ValueWithGradient& a) { return {-a.value, -a.row}; }
ValueWithGradient operator*(const ValueWithGradient& a, const ValueWithGradient& b) {
    return {a.value * b.value, b.value * a.row + a.value * b.row};
}

// Applies v -= n rate to changes: J maps the components before the impact to those after it. n does not depend on v.
void take_out(const ValueWithGradient& rate, const ContactGradient& surface, const TangentLayout& tangent,
              RowMatrix& J) {
    for (std::size_t k = 0; k < tangent.dof; ++k) {
        RowVectorXd change = (rate.value * surface.n_row(k)).lazyProduct(J);
        change += surface.n(k) * rate.row;
        J.row(tangent.v(k)) -= change;
    }
}

}  // namespace

void Chain::handle_event(std::size_t event) {
    const Event& now = trajectory_->events[event];
    state_ = {now.q_before(), now.v_before, now.t};
    switch (now.kind) {
        case Event::Kind::impact:
            return model_->has_friction() ? land_with_friction(event) : land(event);
        case Event::Kind::zeno:
            return reach_zeno_point(event);
        case Event::Kind::collapse:
            return break_off(at_collapse);
        case Event::Kind::release:
            return model_->has_friction() ? change_friction(event) : release(event);
        case Event::Kind::stick:
        case Event::Kind::slip:
        case Event::Kind::reversal:
            return change_friction(event);
        case Event::Kind::jump:
            return jump(event);
        case Event::Kind::pass:
            return pass(event);
    }
}

ChainLink& Chain::cross(std::size_t event, RowVectorXd G, double residual) {
    ChainLink& link = add(ChainLink::Kind::crossing, event);
    link.F = rate();
    link.G = std::move(G);
    link.residual = residual;
    return link;
}

// The contacts that a latch holds before an event.
ContactSet Chain::latched_before(std::size_t event) const {
    return event == 0 ? trajectory_->start_latched : trajectory_->events[event - 1].latched;
}

// The crossing of the surface of the contact that impacts, which is closed from here on.
ChainLink& Chain::cross_surface(std::size_t event) {
    const Event& now = trajectory_->events[event];
    const std::size_t i = now.contacts.only();
    set_gaps();
    h_[i] = 0.0;
    u_[i] = -now.impact_speed;
    RowVectorXd to_surface = RowVectorXd::Zero(tangent_.size());
    to_surface[tangent_.h(i)] = 1.0;
    return cross(event, to_surface, 0.0);
}

// Sets the rows of the gap rates of the open contacts, but for one, by the rows of the state.
void Chain::set_rate_rows(RowMatrix& J, std::size_t but) {
    for (std::size_t k = 0; k < tangent_.contacts; ++k) {
        if (mode_.is_held(k) || k == but) continue;
        ContactGradient& other = surface(k, {});
        other.at(state_);
        J.row(tangent_.u(k)) = other.hdot_row().lazyProduct(J).eval();
    }
}

void Chain::land(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (waiting_) return break_off("an impact happens before the Zeno time of another contact");
    if (now.contacts.count() != 1)
        return break_off(
            "several contacts close at the same time: which is first depends on the direction of the perturbation");
    const std::size_t i = now.contacts.only();
    // Find which of the other contacts are loaded by the impact.
    Mode others = mode_;
    if (now.joint) {
        if (now.joint->order_matters || now.joint->is_nonunique)
            return break_off(
                "the outcome of the simultaneous impact is not unique: it depends on the order, or on the impulses "
                "chosen");
        ContactSet loaded;
        double scale = 0.0;
        for (const auto& [contact, impulse] : now.joint->impulses) scale = std::max(scale, impulse);
        for (const auto& [contact, impulse] : now.joint->impulses) {
            if (contact == i) continue;
            if (!mode_.is_held(contact))
                return break_off("a contact that is closed without a force takes part in an impact");
            const double rate = surfaces_.of(contact).at({now.q, now.v_after, now.t}).hdot;
            constexpr double strictly = 1e-10;
            const bool is_latched = latched_before(event).contains(contact) && !(rate > strictly * now.impact_speed);
            if (is_latched || impulse > strictly * scale)
                loaded = loaded.with(contact);
            else if (!(rate > strictly * now.impact_speed))
                return break_off("an impact neither loads a held contact nor opens it");
        }
        others = mode_.only(loaded);
    }
    ChainLink& crossing = cross_surface(event);
    if (options_.errors) meet_surface(i, others, crossing);

    ContactSet joins;
    if (auto reason = next_completion(event, joins)) return break_off(std::move(*reason));
    ContactGradient& contact = surface(i, others);
    contact.at(state_);
    const double u = u_[i];
    const auto hddot_at = [&](const Vector& v) {
        return surfaces_.of(i, others).normal_acceleration({state_.q, v, state_.t});
    };
    Vector s = state_.v;
    newton::move_along(
        s.data(), tangent_.dof, [&](std::size_t k) { return contact.n(k); }, u);
    if (hddot_at(s) > 0.0) take_least(margins_.grazing_speed, -u);

    ChainLink& link = add(ChainLink::Kind::jump, event);
    RowMatrix& J = link.J;
    // Back onto the surface: the rows of q leave it by the omitted terms of steps.
    for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.q(k)) -= contact.n(k) * contact.h_row();
    J.row(tangent_.h(i)).setZero();
    const ValueWithGradient before{u, J.row(tangent_.u(i))}, e{surfaces_.restitution(i).value, restitution(i).row(0)};
    const bool completes = joins.contains(i);
    const bool rests = completes || now.mode.is_held(i);
    if (completes) {
        RowMatrix drawn = J;
        take_out(newton::removed_rate(e, before), contact, tangent_, drawn);
        take_out(before, contact, tangent_, J);
        state_.v = s;
        const BouncingKey key{i, others};
        link.completion = ChainLink::PendingCompletion{key, state_, -u, std::move(drawn)};
        J.row(tangent_.accumulation_time()) = accumulation_time_row(J, key, -u);
        retract(J, others.with(i, ContactState::held));
        waiting_ = true;
    } else {
        take_out(newton::removed_rate(e, before), contact, tangent_, J);
        state_.v = now.v_after;
        J.row(tangent_.u(i)) = newton::rate_after(e, before).row;
        retract(J, rests ? others.with(i, ContactState::held) : others);
    }
    mode_ = completes ? mode_after_cut(others.with(i, ContactState::held)) : now.mode;
    if (completes && others != now.mode.without(i))
        return break_off("the impact sequence is cut at an impact that opens a contact");
    set_rate_rows(J, i);
    set_gaps();
    if (!rests) {
        h_[i] = 0.0;
        u_[i] = newton::rate_after(e, before).value;
    }
}

// Sets `joins` to the contacts that become held because the impact sequence is cut at this impact; leaves it empty
// without a cut. Returns why the derivative is not known, nullopt if it is.
std::optional<std::string> Chain::next_completion(std::size_t event, ContactSet& joins) const {
    const auto& events = trajectory_->events;
    const Event& now = events[event];
    const bool is_zeno = event + 1 < events.size() && events[event + 1].is_zeno() && events[event + 1].truncation &&
                         events[event + 1].truncation->t == now.t;
    if (is_zeno) {
        joins = events[event + 1].contacts;
    } else if (next_piece_ < trajectory_->pieces.size()) {
        const DenseSegment& piece = trajectory_->pieces[next_piece_];
        if (event + 1 < events.size() && events[event + 1].is_collapse() && events[event + 1].truncation &&
            events[event + 1].truncation->t == now.t)
            return at_collapse;
        if (piece.start == now.t && (event + 1 == events.size() || events[event + 1].t > now.t))
            joins = piece.mode.held().without(now.mode.held());
    }
    if (joins.count() > 1) return several_at_zeno_point;
    return std::nullopt;
}

// The derivatives of the accumulation time T(a, b, c, e, w) of theory-derivatives.md 4 by the components before the
// jump, with the delay by the slip of a contact that sticks. J has the rows of q, v, t and p at (q, s), the restart
// before any drift; so must state_.
RowVectorXd Chain::accumulation_time_row(const RowMatrix& J, const BouncingKey& key, double speed) {
    auto& trend = trends_[key];
    if (!trend)
        trend = std::make_unique<Gradient>(*model_, model_->bouncing(key).trend, tangent_, trajectory_->run.parameters);
    trend->at(state_);
    const double e = surfaces_.restitution(key.contact).value;
    const auto e_row = restitutions_[key.contact]->row(0);
    if (e == 0.0 && e_row.isZero(0.0)) return RowVectorXd::Zero(J.cols());  // no flight follows
    if (e == 0.0 && model_->stays_closed_without_force(key.contact, key.mode))
        break_off("the contact is unloaded: with a restitution above 0 it would bounce off");
    using Number = Jet<double, 7>;
    const auto minus = [&](std::size_t output, std::size_t k) { return Number::variable(-trend->value(output), k); };
    const Number a = minus(0, 0), restitution = Number::variable(e, 3), w = Number::variable(speed, 4);
    Number accumulation_time = estimated_accumulation_time(a, minus(1, 1), minus(2, 2), restitution, w);
    RowVectorXd row = RowVectorXd::Zero(J.cols());
    if (sticks_at_impacts(*model_, key)) {
        const Gradient& terms = sticking(key);
        const std::size_t alpha = PairTerms<IdentityLayout>({}, tangent_.dof).hddot(1);
        accumulation_time = accumulation_time + estimated_delay_by_slip(a, Number::variable(terms.value(alpha), 6),
                                                                        minus(3, 5), restitution, w);
        row = accumulation_time.slope[6] * (terms.row(alpha) * J) - accumulation_time.slope[5] * (trend->row(3) * J);
    }
    row += accumulation_time.slope[3] * (e_row * J);
    for (std::size_t k = 0; k < 3; ++k) row -= accumulation_time.slope[k] * (trend->row(k) * J);
    return row - accumulation_time.slope[4] * J.row(tangent_.u(key.contact));
}

// The mode of the motion after a cut that holds these contacts. Until the Zeno point forces may not see one of them.
Mode Chain::mode_after_cut(Mode held) const {
    const auto& pieces = trajectory_->pieces;
    const bool follows = next_piece_ < pieces.size() && pieces[next_piece_].start == state_.t;
    return follows ? held.with_silent(pieces[next_piece_].mode.silent()) : held;
}

void Chain::reach_zeno_point(std::size_t event) {
    const auto& events = trajectory_->events;
    const Event& now = events[event];
    if (!waiting_ || now.contacts.count() != 1) return break_off(several_at_zeno_point);
    if (!mode_.silent().empty() && event + 1 < events.size() && events[event + 1].t == now.t)
        return break_off("forces begin to see a contact at its Zeno point, and another one changes its state there");
    waiting_ = false;
    set_gaps();
    const std::size_t i = now.contacts.only();
    const double a = -surfaces_.of(i, mode_.without(i)).normal_acceleration(state_);
    const bool may_be_unpressed = is_plastic_landing(now) && now.certificate->a_max == 0.0;
    if (!may_be_unpressed || !model_->stays_closed_without_force(i, mode_.without(i))) take_least(margins_.a_inf, a);
    // Perturbed runs with a longer accumulation time continue for the difference.
    ChainLink& link = add(ChainLink::Kind::jump, event);
    link.F = rate();
    link.J.col(tangent_.accumulation_time()) += link.F;
    link.J.row(tangent_.accumulation_time()).setZero();
    retract(link.J, mode_);
    // A contact that sticks at its impacts may slide from here, and forces see the contact.
    if (model_->has_friction() || !mode_.silent().empty()) mode_ = now.mode;
}

void Chain::release(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (now.contacts.count() != 1 || now.joint || mode_.without(now.contacts) != now.mode)
        return break_off(
            "several contacts are released at the same time: which is first depends on the direction of the "
            "perturbation");
    const std::size_t i = now.contacts.only();
    set_gaps();
    if (now.ends_latch) {
        cross_guard(event, true, i);
    } else {
        const Mode others = model_->unconstrained(mode_, i);
        auto& normal = normals_[{others, i}];
        if (!normal)
            normal = std::make_unique<Gradient>(*model_, model_->programs_of(i, others).normal_acceleration, tangent_,
                                                trajectory_->run.parameters);
        normal->at(state_);
        take_least(margins_.release_jerk, surfaces_.of(i, others).jerk(state_));
        cross(event, normal->row(0), normal->value(0));
    }
    ChainLink& link = add(ChainLink::Kind::jump, event);
    retract(link.J, mode_);
    mode_ = now.mode;
    set_gaps();
    h_[i] = u_[i] = 0.0;
}

// The gap at the end of the last step by its own polynomials, before the projection onto the surface; 0 if it is within
// rounding. The correction of the linear coefficient of q is the distance of the projection.
double Chain::residual_before(std::size_t contact) {
    if (next_piece_ == 0) return 0.0;
    const DenseSegment& piece = trajectory_->pieces[next_piece_ - 1];
    if (piece.end != state_.t) return 0.0;
    const double* const c = trajectory_->coefficients.data() + piece.first;
    const std::size_t n = tangent_.dof;
    const double span = piece.end - piece.start;
    State reached = state_in(piece, trajectory_->coefficients, model_->dof(), piece.end);
    reached.t = piece.end;
    for (std::size_t i = 0; i < n; ++i) reached.q[static_cast<Eigen::Index>(i)] -= c[2 * n + i] - c[n + i] * span;
    if (!piece.mode.is_free()) surfaces_.project(reached, piece.mode.held(), {});
    ContactKinematics& surface = surfaces_.of(contact);
    const Contact at = surface.at(reached);
    const double rounding = 4.0 * surface.gap_error(reached) + std::abs(at.hdot) * 0x1p-52 * std::abs(piece.end);
    return std::abs(at.h) > rounding ? at.h : 0.0;
}

// Errors at an impact. The run finds the impact by the series of the gap, then projects q onto the surface and takes
// the gap rate there. The error of q is projected, and that of the rate recomputed, in the same way.
void Chain::meet_surface(std::size_t contact, Mode others, ChainLink& crossing) {
    crossing.residual = residual_before(contact);
    ContactGradient& surface = this->surface(contact, {});
    surface.at(state_);
    crossing.by_place = surface.h_row();
    ChainLink& link = add(ChainLink::Kind::jump);
    RowMatrix& J = link.J;
    if (model_->has_friction()) {
        move_onto(J, mode_.held().with(contact));
    } else {
        ContactGradient& landing = this->surface(contact, others);
        landing.at(state_);
        for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.q(k)) -= landing.n(k) * crossing.by_place;
    }
    J.row(tangent_.h(contact)).setZero();
    J.row(tangent_.u(contact)) = surface.hdot_row() * J;
}

}  // namespace achilles
