// Where a run was at an impact, and where it was moved to: what errors need besides what changes do.
#include <cmath>

#include "depend/chain.hpp"

namespace achilles {

// The gap where the last step came to by its own polynomials, before it was moved onto the surface: 0 where that is its rounding.
// What was added to the first order of q is how far it was moved.
double Chain::residual_before(std::size_t contact) {
    if (next_piece_ == 0) return 0.0;
    const Piece& piece = trajectory_->pieces[next_piece_ - 1];
    if (piece.end != state_.t) return 0.0;
    const double* const c = trajectory_->coefficients.data() + piece.first;
    const std::size_t n = tangent_.dof;
    const double span = piece.end - piece.start;
    State reached = state_in(piece, trajectory_->coefficients, model_->dof(), piece.end);
    reached.t = piece.end;
    for (std::size_t i = 0; i < n; ++i) reached.q[static_cast<Eigen::Index>(i)] -= c[2 * n + i] - c[n + i] * span;
    if (!piece.held.empty()) surfaces_.project(reached, piece.held, {});
    ContactKinematics& surface = surfaces_.of(contact);
    const Contact at = surface.at(reached);
    const double rounding = 4.0 * surface.gap_error(reached) + std::abs(at.hdot) * 0x1p-52 * std::abs(piece.end);
    return std::abs(at.h) > rounding ? at.h : 0.0;
}

// Errors at an impact. The run lands by the gap's own series, then moves q onto the surface and takes the rate of the gap from
// there; so the error of q is moved, and that of the rate taken, too.
void Chain::meet_surface(std::size_t contact, ContactSet others, Link& crossing) {
    crossing.residual = residual_before(contact);
    ContactGradient& surface = this->surface(contact, {});
    surface.at(state_);
    crossing.by_place = surface.h_row();
    Link& link = add(Link::Kind::jump);
    RowMatrix& J = link.J;
    ContactGradient& landing = this->surface(contact, others);
    landing.at(state_);
    for (std::size_t k = 0; k < tangent_.dof; ++k) J.row(tangent_.q(k)) -= landing.n(k) * crossing.by_place;
    J.row(tangent_.h(contact)).setZero();
    J.row(tangent_.u(contact)) = surface.hdot_row() * J;
}

}  // namespace achilles
