#include "depend/chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "certify/zeno_time.hpp"

namespace achilles {

namespace {

using Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;

void take_least(std::optional<double>& least, double x) { least = least ? std::min(*least, x) : x; }

}  // namespace

void Link::apply(MatrixXd& Z) const {
    if (kind == Kind::crossing) {
        const RowVectorXd along = G * Z / G.dot(F);
        Z -= F * along;
    } else {
        Z = J * Z;
    }
}

MatrixXd Link::matrix() const {
    if (kind != Kind::crossing) return J;
    return MatrixXd::Identity(F.size(), F.size()) - F * G / G.dot(F);
}

Chain::Chain(const Trajectory& trajectory, Options options)
    : trajectory_(&trajectory),
      model_(trajectory.model.get()),
      options_(std::move(options)),
      tangent_{static_cast<std::size_t>(model_->dof()), model_->contacts(), trajectory.run.parameters.size()},
      surfaces_(*model_, trajectory.run),
      h_(model_->contacts()),
      u_(model_->contacts()) {
    check(trajectory.run);
    state_ = trajectory.run.start();
    held_ = trajectory.phases.front().held;
    for (std::size_t i = 0; i < model_->contacts(); ++i) {
        ContactKinematics& contact = surfaces_.of(i);
        const Contact at = contact.at(state_);
        if (at.h <= 4.0 * contact.gap_error(state_) && std::abs(at.hdot) <= 4.0 * contact.hdot_error(state_))
            resting_ = resting_.with(i);
    }
    if (!trajectory.pieces.empty() && trajectory.pieces.front().start == state_.t) {
        const double t = state_.t;
        state_ = state_in(trajectory.pieces.front(), trajectory.coefficients, model_->dof(), t);
        state_.t = t;
    }
    set_gaps();
}

Chain::~Chain() = default;

void Chain::check(const Run& run) {
    if (run.options.truncation.reinitialization != Reinitialization::euclidean) return;
    throw InputError(
        "derivatives", {},
        "they need the kinetic re-initialisation: past the Euclidean one they are wrong by about the speed at "
        "the cut times its logarithm, and third-order in it past the kinetic one",
        "reinitialization = \"kinetic\"");
}

void Chain::complete(MatrixXd& Z) {
    const State start = trajectory_->run.start();
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        ContactGradient& contact = surface(i, {});
        contact.at(start);
        Z.row(tangent_.h(i)) = contact.h_row() * Z;
        Z.row(tangent_.u(i)) = contact.hdot_row() * Z;
    }
}

// ---- programs ----

ContactGradient& Chain::surface(std::size_t contact, ContactSet held) {
    auto& known = contacts_[{held, contact}];
    if (!known)
        known = std::make_unique<ContactGradient>(*model_, model_->programs_of(contact, held).contact_terms, tangent_,
                                                  trajectory_->run.parameters);
    return *known;
}

FlowSlope& Chain::slope(ContactSet held) {
    if (options_.errors) {
        auto& difference = differences_[held];
        if (!difference)
            difference = std::make_unique<FlowDifference>(*model_, held, tangent_, trajectory_->run.parameters);
        return *difference;
    }
    auto& known = slopes_[held];
    if (!known) {
        const achilles::Options& used =
            trajectory_->made_again_by ? *trajectory_->made_again_by : trajectory_->run.options;
        const double tolerance = std::max(10.0 * used.tolerance, 0x1p-53);
        known = make_flow_slope(*model_, held, tangent_, trajectory_->run.parameters, options_.parameters, tolerance);
    }
    return *known;
}

// ---- where the run stands ----

VectorXd Chain::rate() {
    auto& motion = model_->lazily(motions_, held_, trajectory_->run.parameters);
    set_state(motion, state_);
    motion.run();
    VectorXd F = VectorXd::Zero(tangent_.size());
    F[Tangent::t()] = 1.0;
    for (std::size_t i = 0; i < tangent_.dof; ++i) {
        F[tangent_.q(i)] = state_.v[static_cast<Eigen::Index>(i)];
        F[tangent_.v(i)] = motion.acceleration(i);
    }
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        if (held_.contains(i)) continue;
        F[tangent_.h(i)] = u_[i];
        F[tangent_.u(i)] = motion.hddot(i);
    }
    return F;
}

// From q and v.
void Chain::set_gaps() {
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        const Contact contact = surfaces_.of(i).at(state_);
        h_[i] = held_.contains(i) ? 0.0 : contact.h;
        u_[i] = held_.contains(i) ? 0.0 : contact.hdot;
    }
}

Link& Chain::add(Link::Kind kind, std::optional<std::size_t> event) {
    Link& link = links_.emplace_back();
    link.kind = kind;
    link.event = event;
    return link;
}

const Link* Chain::next() {
    while (links_.empty() && broken_.empty()) {
        const auto& pieces = trajectory_->pieces;
        const auto& events = trajectory_->events;
        const bool any_piece = next_piece_ < pieces.size(), any_event = next_event_ < events.size();
        if (!any_piece && !any_event) return nullptr;
        if (any_event && (!any_piece || events[next_event_].t <= pieces[next_piece_].start))
            happen(next_event_++);
        else
            step();
    }
    if (links_.empty()) return nullptr;
    link_ = std::move(links_.front());
    links_.pop_front();
    return &link_;
}

// ---- steps ----

void Chain::step() {
    const Piece& piece = trajectory_->pieces[next_piece_++];
    if (piece.carriers != piece.held)
        return break_off("contacts whose gradients depend on one another are held: what each bears is not unique");
    if (piece.held != held_) return break_off("what is held changes without an event of its own");
    state_ = state_in(piece, trajectory_->coefficients, model_->dof(), piece.start);
    state_.t = piece.start;
    FlowSlope& slope = this->slope(held_);
    const int degree = static_cast<int>(piece.degree);
    MatrixXd left_out;
    while (state_.t < piece.end) {
        const double left = piece.end - state_.t;
        const double span = slope.expand(state_, left, options_.errors ? degree + FlowDifference::more_orders : degree);
        if (options_.errors && state_.t == piece.start)
            differences_.at(held_)->left_out(degree, piece.end - piece.start, left_out);
        Link& link = add(Link::Kind::step);
        link.length = span;
        link.J = MatrixXd::Identity(tangent_.size(), tangent_.size());
        slope.slope_after(span, held_, link.J);
        if (!options_.errors) watch_minima(slope, span);
        const bool is_end = span >= left;
        const double t = is_end ? piece.end : state_.t + span;
        if (!is_end && !(t > state_.t)) return break_off("no step is small enough for the derivatives");
        state_ = state_in(piece, trajectory_->coefficients, model_->dof(), t);
        state_.t = t;
        if (!held_.empty()) {
            retract(link.J, held_);
            if (is_end && options_.errors) retract(left_out, held_);
        }
        if (is_end && options_.errors) link.left_out = left_out;
    }
    if (options_.errors) set_gaps();
}

// The gaps along the step, in values: where one comes to a minimum that is no impact.
void Chain::watch_minima(const FlowSlope& slope, double span) {
    const int order = slope.order();
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        if (held_.contains(i)) continue;
        const auto at = [&](double t) {
            double u = 0.0, h = 0.0;
            for (int k = order; k >= 0; --k) {
                const double c = slope.coefficient(k, 2 * tangent_.dof + i) / (k + 1);
                u = u * t + c;
                h = h * t + c / (k + 2);
            }
            return std::pair(h_[i] + (u_[i] + h * t) * t, u_[i] + u * t);
        };
        constexpr int parts = 8;
        double before = 0.0, falling = u_[i];
        for (int part = 1; part <= parts; ++part) {
            const double t = span * part / parts, rate = at(t).second;
            if (falling < 0.0 && rate >= 0.0) {
                double low = before, high = t;
                for (int round = 0; round < 50; ++round) {
                    const double middle = 0.5 * (low + high);
                    (at(middle).second < 0.0 ? low : high) = middle;
                }
                take_least(margins_.gap_minimum, at(high).first);
            }
            before = t;
            falling = rate;
        }
        std::tie(h_[i], u_[i]) = at(span);
    }
}

// The rows of q and v of what lies on h = 0, hdot = 0 of these contacts: dq -= n dh, then dv -= n dhdot. One after the other,
// each while those before it are held, so that they stay there.
void Chain::retract(MatrixXd& J, ContactSet onto) {
    ContactSet before;
    const auto each = [&](const auto& act) {
        before = {};
        for (std::size_t i = 0; i < tangent_.contacts; ++i) {
            if (!onto.contains(i)) continue;
            ContactGradient& contact = surface(i, before);
            contact.at(state_);
            act(contact);
            before = before.with(i);
        }
    };
    each([&](ContactGradient& contact) {
        const RowVectorXd dh = contact.h_row() * J;
        for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.q(k)) -= contact.n(k) * dh;
    });
    each([&](ContactGradient& contact) {
        const RowVectorXd du = contact.hdot_row() * J;
        for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.v(k)) -= contact.n(k) * du;
    });
    for (std::size_t i = 0; i < tangent_.contacts; ++i)
        if (onto.contains(i)) {
            J.row(tangent_.h(i)).setZero();
            J.row(tangent_.u(i)).setZero();
        }
}

// ---- events ----

void Chain::happen(std::size_t event) {
    const Event& now = trajectory_->events[event];
    state_ = {now.q, now.v_before, now.t};
    switch (now.kind) {
        case Event::Kind::impact:
            return land(event);
        case Event::Kind::zeno:
            return reach_zeno_point(event);
        case Event::Kind::release:
            return release(event);
    }
}

Link& Chain::cross(std::size_t event, RowVectorXd G, double residual) {
    Link& link = add(Link::Kind::crossing, event);
    link.F = rate();
    link.G = std::move(G);
    link.residual = residual;
    return link;
}

// v -= times u n over changes: J is what the components are of those before; du the row of u, de that of `times`.
void Chain::take_out_rate(MatrixXd& J, ContactGradient& surface, double times, double u, const RowVectorXd& du) {
    const MatrixXd before = J;
    for (std::size_t k = 0; k < tangent_.dof; ++k)
        J.row(tangent_.v(k)) -= surface.n(k) * du + times * u * (surface.n_row(k) * before);
}

void Chain::land(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (waiting_) return break_off("an impact happens before the Zeno time of another contact");
    if (now.contacts.count() != 1)
        return break_off("several contacts land at once: which is first depends on the direction");
    const std::size_t i = now.contacts.only();
    // What of the others takes part.
    ContactSet others = held_;
    if (now.joint) {
        if (now.joint->order_matters || now.joint->not_unique)
            return break_off("what the impact leads to depends on an order that cannot be told");
        others = {};
        double scale = 0.0;
        for (const auto& [contact, impulse] : now.joint->impulses) scale = std::max(scale, impulse);
        for (const auto& [contact, impulse] : now.joint->impulses) {
            if (contact == i) continue;
            if (!held_.contains(contact))
                return break_off("a contact that touches without a force takes part in an impact");
            const double rate = surfaces_.of(contact).at({now.q, now.v_after, now.t}).hdot;
            constexpr double strictly = 1e-10;
            if (impulse > strictly * scale)
                others = others.with(contact);
            else if (!(rate > strictly * now.impact_speed))
                return break_off("a held contact is neither pressed by an impact nor opened by it");
        }
    }
    set_gaps();
    h_[i] = 0.0;
    u_[i] = -now.impact_speed;
    RowVectorXd to_surface = RowVectorXd::Zero(tangent_.size());
    to_surface[tangent_.h(i)] = 1.0;
    Link& crossing = cross(event, to_surface, 0.0);
    if (options_.errors) meet_surface(i, others, crossing);

    ContactSet joins;
    if (auto reason = next_completion(event, joins)) return break_off(std::move(*reason));
    ContactGradient& contact = surface(i, others);
    contact.at(state_);
    auto& restitution = restitutions_[i];
    if (!restitution)
        restitution =
            std::make_unique<Gradient>(*model_, model_->restitution(i), tangent_, trajectory_->run.parameters);
    restitution->at(state_);
    const double e = restitution->value(0), u = u_[i];
    const auto hddot_at = [&](const Vector& v) {
        return surfaces_.of(i, others).normal_acceleration({state_.q, v, state_.t});
    };
    Vector s = state_.v;
    for (std::size_t k = 0; k < tangent_.dof; ++k) s[static_cast<Eigen::Index>(k)] -= u * contact.n(k);
    if (hddot_at(s) > 0.0) take_least(margins_.grazing_speed, -u);

    Link& link = add(Link::Kind::jump, event);
    MatrixXd& J = link.J = MatrixXd::Identity(tangent_.size(), tangent_.size());
    // Back onto the surface, which the components of q and v leave by what steps leave out.
    const RowVectorXd off = contact.h_row() * J;
    for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.q(k)) -= contact.n(k) * off;
    J.row(tangent_.h(i)).setZero();
    const RowVectorXd du = J.row(tangent_.u(i)), de = restitution->row(0) * J;
    const bool completes = joins.contains(i);
    const bool rests = completes || now.held.contains(i);
    if (completes) {
        MatrixXd newton = J;
        take_out_rate(newton, contact, 1.0 + e, u, (1.0 + e) * du + u * de);
        link.completion = Link::Completion{i, others, -u, std::move(newton)};
        take_out_rate(J, contact, 1.0, u, du);
        state_.v = s;
        J.row(tangent_.wait()) = wait_row(J, i, others, -u);
        retract(J, others.with(i));
        waiting_ = true;
    } else {
        take_out_rate(J, contact, 1.0 + e, u, (1.0 + e) * du + u * de);
        state_.v = now.v_after;
        J.row(tangent_.u(i)) = -e * du - u * de;
        retract(J, rests ? others.with(i) : others);
    }
    held_ = completes ? others.with(i) : now.held;
    if (completes && others != now.held.without(i)) return break_off("a bouncing is cut where a contact opens");
    for (std::size_t k = 0; k < tangent_.contacts; ++k) {
        if (held_.contains(k) || k == i) continue;
        ContactGradient& other = surface(k, {});
        other.at(state_);
        J.row(tangent_.u(k)) = other.hdot_row() * J;
        if (now.opened.contains(k)) J.row(tangent_.h(k)).setZero();
    }
    set_gaps();
    if (!rests) {
        h_[i] = 0.0;
        u_[i] = -e * u;
    }
}

// The contacts that come to rest after an impact, by a bouncing that is cut there. A reason where that has no derivative.
std::optional<std::string> Chain::next_completion(std::size_t event, ContactSet& joins) const {
    const auto& events = trajectory_->events;
    const Event& now = events[event];
    const bool is_zeno = event + 1 < events.size() && events[event + 1].kind == Event::Kind::zeno &&
                         events[event + 1].truncation && events[event + 1].truncation->t == now.t;
    if (is_zeno) {
        joins = events[event + 1].contacts;
    } else if (next_piece_ < trajectory_->pieces.size()) {
        const Piece& piece = trajectory_->pieces[next_piece_];
        if (piece.start == now.t && (event + 1 == events.size() || events[event + 1].t > now.t))
            joins = piece.held.without(now.held);
    }
    if (joins.count() > 1)
        return "two contacts come to rest together: their Zeno point has no derivative that is known";
    return std::nullopt;
}

// The derivatives of how long the bouncing still lasts, T(a, b, c, e, w) of theory-derivatives.md 4, by the components before the
// jump; J is what q, v, t and p are of these at the restart, where the state stands.
RowVectorXd Chain::wait_row(const MatrixXd& J, std::size_t contact, ContactSet others, double speed) {
    auto& trend = trends_[{others, contact}];
    if (!trend)
        trend = std::make_unique<Gradient>(*model_, model_->bouncing(contact, others).trend, tangent_,
                                           trajectory_->run.parameters);
    trend->at(state_);
    const Gradient& e = *restitutions_[contact];
    using Number = Jet<double, 5>;
    const auto minus = [&](std::size_t output, std::size_t k) { return Number::variable(-trend->value(output), k); };
    const Number wait = estimated_wait(minus(0, 0), minus(1, 1), minus(2, 2), Number::variable(e.value(0), 3),
                                       Number::variable(speed, 4));
    RowVectorXd row = wait.slope[3] * (e.row(0) * J);
    for (std::size_t k = 0; k < 3; ++k) row -= wait.slope[k] * (trend->row(k) * J);
    return row - wait.slope[4] * J.row(tangent_.u(contact));
}

void Chain::reach_zeno_point(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (!waiting_ || now.contacts.count() != 1)
        return break_off("two contacts come to rest together: their Zeno point has no derivative that is known");
    waiting_ = false;
    set_gaps();
    const std::size_t i = now.contacts.only();
    const double a = -surfaces_.of(i, held_.without(i)).normal_acceleration(state_);
    take_least(margins_.a_inf, a);
    // The members that wait for longer go on for so long.
    Link& link = add(Link::Kind::jump, event);
    link.J = MatrixXd::Identity(tangent_.size(), tangent_.size());
    link.J.col(tangent_.wait()) += rate();
    link.J.row(tangent_.wait()).setZero();
    retract(link.J, held_);
}

void Chain::release(std::size_t event) {
    const Event& now = trajectory_->events[event];
    if (now.contacts.count() != 1 || now.joint || held_.without(now.contacts) != now.held)
        return break_off("several contacts are let go at once: which is first depends on the direction");
    const std::size_t i = now.contacts.only();
    const ContactSet others = held_.without(i);
    auto& normal = normals_[{others, i}];
    if (!normal)
        normal = std::make_unique<Gradient>(*model_, model_->programs_of(i, others).normal_acceleration, tangent_,
                                            trajectory_->run.parameters);
    normal->at(state_);
    set_gaps();
    const double jerk = surfaces_.of(i, others).jerk(state_);
    take_least(margins_.release_jerk, jerk);
    cross(event, normal->row(0), normal->value(0));
    Link& link = add(Link::Kind::jump, event);
    link.J = MatrixXd::Identity(tangent_.size(), tangent_.size());
    retract(link.J, held_);
    held_ = now.held;
    set_gaps();
    h_[i] = u_[i] = 0.0;
}

}  // namespace achilles
