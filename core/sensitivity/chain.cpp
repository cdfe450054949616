#include "sensitivity/chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace achilles {

using Eigen::RowVectorXd, Eigen::VectorXd;

namespace {

struct Entry {
    Eigen::Index column;
    double value;
};

// Columns first .. first + Columns of row i of a product J Z, from the nonzero entries of row i of J.
template <int Columns>
void multiply(std::span<const Entry> row, const RowMatrix& Z, Eigen::Index i, Eigen::Index first, RowMatrix& product) {
    Eigen::Matrix<double, 1, Columns> sum = Eigen::Matrix<double, 1, Columns>::Zero();
    for (const Entry& entry : row) sum += entry.value * Z.row(entry.column).segment<Columns>(first);
    product.row(i).segment<Columns>(first) = sum;
}

}  // namespace

// The matrices are small, so that a product by entries is faster than by blocks.
void ChainLink::apply(RowMatrix& Z) const {
    if (kind == Kind::crossing) {
        const RowVectorXd along = (G / G.dot(F)).lazyProduct(Z);
        Z.noalias() -= F.lazyProduct(along);
        return;
    }
    RowMatrix product(changed, Z.cols());
    std::vector<Entry> entries(static_cast<std::size_t>(J.cols()));
    for (Eigen::Index i = 0; i < changed; ++i) {
        std::size_t count = 0;  // J is sparse
        for (Eigen::Index j = 0; j < J.cols(); ++j)
            if (const double c = J(i, j); c != 0.0) entries[count++] = {j, c};
        const std::span<const Entry> row(entries.data(), count);
        Eigen::Index first = 0;
        for (; first + 8 <= Z.cols(); first += 8) multiply<8>(row, Z, i, first, product);
        for (; first + 4 <= Z.cols(); first += 4) multiply<4>(row, Z, i, first, product);
        for (; first + 2 <= Z.cols(); first += 2) multiply<2>(row, Z, i, first, product);
        if (first < Z.cols()) multiply<1>(row, Z, i, first, product);
    }
    Z.topRows(changed) = product;
}

Chain::Chain(const Trajectory& trajectory, ChainOptions options)
    : trajectory_(&trajectory),
      model_(trajectory.model.get()),
      options_(std::move(options)),
      tangent_{static_cast<std::size_t>(model_->dof()), model_->contacts(), trajectory.run.parameters.size()},
      surfaces_(*model_, trajectory.run),
      h_(model_->contacts()),
      u_(model_->contacts()) {
    check(trajectory.run);
    state_ = trajectory.run.start();
    mode_ = trajectory.phases.front().mode;
    for (std::size_t i = 0; i < model_->contacts(); ++i) {
        ContactKinematics& contact = surfaces_.of(i);
        const Contact at = contact.at(state_);
        if (at.h <= 4.0 * contact.gap_error(state_) && std::abs(at.hdot) <= 4.0 * contact.hdot_error(state_))
            resting_ = resting_.with(i);
    }
    find_critical_slips();
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
    throw InputError("derivatives", {},
                     "they need the kinetic reinitialization: with w the gap speed at the cut, their error is about w "
                     "log w after a Euclidean reinitialization, and of third order in w after a kinetic one",
                     "reinitialization = \"kinetic\"");
}

void Chain::complete(RowMatrix& Z) {
    const State start = trajectory_->run.start();
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        ContactGradient& contact = surface(i, {});
        contact.at(start);
        Z.row(tangent_.h(i)) = contact.h_row() * Z;
        Z.row(tangent_.u(i)) = contact.hdot_row() * Z;
    }
}

// ---- programs ----

ContactGradient& Chain::surface(std::size_t contact, Mode mode) {
    auto& known = contacts_[{mode, contact}];
    if (!known)
        known = std::make_unique<ContactGradient>(*model_, model_->programs_of(contact, mode).contact_terms, tangent_,
                                                  trajectory_->run.parameters);
    return *known;
}

SlipGradient& Chain::slip(std::size_t which) {
    auto& known = slips_[which];
    if (!known)
        known =
            std::make_unique<SlipGradient>(*model_, model_->slip_terms(which), tangent_, trajectory_->run.parameters);
    return *known;
}

Gradient& Chain::event_functions(Mode mode) {
    auto& known = event_functions_[mode];
    if (!known)
        known =
            std::make_unique<Gradient>(*model_, model_->motion(mode).program, tangent_, trajectory_->run.parameters);
    return *known;
}

// It depends only on parameters.
Gradient& Chain::restitution(std::size_t contact) {
    auto& known = restitutions_[contact];
    if (!known) {
        known =
            std::make_unique<Gradient>(*model_, model_->restitution(contact), tangent_, trajectory_->run.parameters);
        known->at(state_);
    }
    return *known;
}

FlowSensitivity& Chain::slope(Mode mode) {
    if (options_.errors) {
        auto& difference = differences_[mode];
        if (!difference)
            difference = std::make_unique<FlowDifference>(*model_, mode, tangent_, trajectory_->run.parameters);
        return *difference;
    }
    auto& known = slopes_[mode];
    if (!known) {
        const achilles::Options& used =
            trajectory_->rerun_options ? *trajectory_->rerun_options : trajectory_->run.options;
        const double tolerance = std::max(10.0 * used.tolerance, 0x1p-53);
        known = make_flow_slope(*model_, mode, tangent_, trajectory_->run.parameters, options_.parameters, tolerance);
    }
    return *known;
}

// ---- state ----

VectorXd Chain::rate() {
    auto& motion = model_->lazily(motions_, mode_, trajectory_->run.parameters);
    set_state(motion, state_);
    motion.run();
    VectorXd F = VectorXd::Zero(tangent_.size());
    F[TangentLayout::t()] = 1.0;
    for (std::size_t i = 0; i < tangent_.dof; ++i) {
        F[tangent_.q(i)] = state_.v[static_cast<Eigen::Index>(i)];
        F[tangent_.v(i)] = motion.acceleration(i);
    }
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        if (mode_.is_held(i)) continue;
        F[tangent_.h(i)] = u_[i];
        F[tangent_.u(i)] = motion.hddot(i);
    }
    return F;
}

// Recomputes h_ and u_ from q and v.
void Chain::set_gaps() {
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        const Contact contact = surfaces_.of(i).at(state_);
        h_[i] = mode_.is_held(i) ? 0.0 : contact.h;
        u_[i] = mode_.is_held(i) ? 0.0 : contact.hdot;
    }
}

ChainLink& Chain::add(ChainLink::Kind kind, std::optional<std::size_t> event) {
    if (link_count_ == links_.size()) links_.emplace_back();
    ChainLink& link = links_[link_count_++];
    link.kind = kind;
    link.event = event;
    link.length = 0.0;
    link.left_out.resize(0);
    link.by_place.resize(0);
    link.completion.reset();
    link.changed = tangent_.p(0);
    if (kind != ChainLink::Kind::crossing) link.J.setIdentity(tangent_.size(), tangent_.size());
    return link;
}

const ChainLink* Chain::next() {
    if (next_link_ == link_count_) next_link_ = link_count_ = 0;
    if (!begun_) {
        begun_ = true;
        if (model_->has_friction()) begin_with_friction();
    }
    while (link_count_ == 0 && broken_.empty()) {
        const auto& pieces = trajectory_->pieces;
        const auto& events = trajectory_->events;
        const bool any_piece = next_piece_ < pieces.size(), any_event = next_event_ < events.size();
        if (!any_piece && !any_event) {
            if (model_->has_friction()) end_with_friction();
            return nullptr;
        }
        if (any_event && (!any_piece || events[next_event_].t <= pieces[next_piece_].start))
            handle_event(next_event_++);
        else
            step();
    }
    return next_link_ < link_count_ ? &links_[next_link_++] : nullptr;
}

// ---- steps ----

void Chain::step() {
    const DenseSegment& piece = trajectory_->pieces[next_piece_++];
    if (piece.load_bearing != piece.mode.held())
        return break_off(
            "the gradients of the held contacts are linearly dependent: the contact forces are not unique");
    if (piece.mode != mode_) return break_off("the set of held contacts changes without an event");
    state_ = state_in(piece, trajectory_->coefficients, model_->dof(), piece.start);
    state_.t = piece.start;
    FlowSensitivity& slope = this->slope(mode_);
    const int degree = static_cast<int>(piece.degree);
    RowMatrix left_out;
    while (state_.t < piece.end) {
        const double left = piece.end - state_.t;
        const double span = slope.expand(state_, left, options_.errors ? degree + FlowDifference::more_orders : 0);
        if (options_.errors && state_.t == piece.start)
            differences_.at(mode_)->left_out(degree, piece.end - piece.start, left_out);
        ChainLink& link = add(ChainLink::Kind::step);
        link.length = span;
        slope.slope_after(span, mode_, link.J);
        if (!options_.errors) watch_minima(slope, span, piece.inactive);
        const bool is_end = span >= left;
        const double t = is_end ? piece.end : state_.t + span;
        if (!is_end && !(t > state_.t))
            return break_off("the derivatives would need steps below the resolution of time");
        state_ = state_in(piece, trajectory_->coefficients, model_->dof(), t);
        state_.t = t;
        if (!(mode_ == Mode())) {
            retract(link.J, mode_);
            if (is_end && options_.errors) retract(left_out, mode_);
        }
        if (is_end && options_.errors) link.left_out = left_out;
    }
    if (options_.errors) set_gaps();
}

// Finds minima of open gaps inside the step, by values.
void Chain::watch_minima(const FlowSensitivity& slope, double span, ContactSet but) {
    const int order = slope.order();
    for (std::size_t i = 0; i < tangent_.contacts; ++i) {
        if (mode_.is_held(i)) continue;
        std::array<double, MotionSeries::highest_order + 1> c{};
        for (int k = 2; k <= order; ++k) c[static_cast<std::size_t>(k)] = slope.coefficient(k, 2 * tangent_.dof + i);
        const auto at = [&](double t) {
            double u = 0.0, h = 0.0;
            for (int k = order; k >= 2; --k) {
                u = u * t + k * c[static_cast<std::size_t>(k)];
                h = h * t + c[static_cast<std::size_t>(k)];
            }
            return std::pair(h_[i] + (u_[i] + h * t) * t, u_[i] + u * t);
        };
        // If the gap rate decreases along the whole step, there is no minimum.
        double rising = 2.0 * c[2], power = 1.0;
        for (int k = 3; k <= order; ++k) {
            power *= span;
            rising += k * (k - 1) * std::abs(c[static_cast<std::size_t>(k)]) * power;
        }
        const int parts = rising < 0.0 || but.contains(i) ? 0 : 8;
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

// Projects the rows of q and v onto h = 0, hdot = 0 of the held contacts of a mode: dq -= n dh, then dv -= n dhdot. The
// contacts are processed one by one, each while those before it are held, so that these stay satisfied.
void Chain::retract(RowMatrix& J, Mode onto) {
    if (model_->has_friction()) return settle(J, onto);
    const auto each = [&](const auto& act) {
        ContactSet before;
        for (const std::size_t i : onto.held()) {
            ContactGradient& contact = surface(i, onto.only(before));
            contact.at(state_);
            act(contact);
            before = before.with(i);
        }
    };
    each([&](ContactGradient& contact) {
        const RowVectorXd dh = contact.h_row().lazyProduct(J);
        for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.q(k)) -= contact.n(k) * dh;
    });
    each([&](ContactGradient& contact) {
        const RowVectorXd du = contact.hdot_row().lazyProduct(J);
        for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.v(k)) -= contact.n(k) * du;
    });
    for (const std::size_t i : onto.held()) {
        J.row(tangent_.h(i)).setZero();
        J.row(tangent_.u(i)).setZero();
    }
}

}  // namespace achilles
