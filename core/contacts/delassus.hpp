// The Delassus matrix W = G M^-1 G' of several contacts (the rows of G are the g_j = dh_j), and the effect of held
// contacts on the others. Numbers are doubles, or intervals in proofs. All storage is on the stack.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "number/interval.hpp"
#include "run/contact_set.hpp"

namespace achilles {

inline constexpr Eigen::Index max_closed_contacts = 8;  // largest number of contacts closed at one time

template <class Number>
using ContactMatrix =
    Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, 0, max_closed_contacts, max_closed_contacts>;
template <class Number>
using ContactVector = Eigen::Matrix<Number, Eigen::Dynamic, 1, 0, max_closed_contacts, 1>;

inline bool contains(ContactSet set, Eigen::Index contact) { return set.contains(static_cast<std::size_t>(contact)); }
inline ContactSet with(ContactSet set, Eigen::Index contact) { return set.with(static_cast<std::size_t>(contact)); }
inline ContactSet without(ContactSet set, Eigen::Index contact) {
    return set.without(static_cast<std::size_t>(contact));
}

// A number counts as 0 if it is 0 within rounding (theory-gaps.md 8): at most rounded_zero times its natural size. The
// natural size is sqrt(W_ii W_kk) for W_ik and sqrt(W_ii/W_jj) for kappa_ji. An interval counts as 0 if it contains
// 0 and is that narrow.
inline constexpr double rounded_zero = 64 * 0x1p-52;
inline bool counts_as_zero(const Interval& x, double natural) {
    return x.contains(0.0) && width(x) <= rounded_zero * natural;
}

// Error bound of a Delassus matrix evaluated in double: a few roundings of its terms.
ContactMatrix<double> rounding_radius(const ContactMatrix<double>& W);
// W +- radius, entry by entry: for a matrix that was computed and the bound on its error.
ContactMatrix<Interval> enclosure(const ContactMatrix<double>& W, const ContactMatrix<double>& radius);

// Response of contact i while the set A is held (theory-gaps.md 2). An impulse p on i causes the impulse kappa_j p on
// each j in A:
//     kappa = -W_AA^-1 W_Ai,   W = W_i^A = W_ii + W_iA kappa,   n_i^A = M^-1 (g_i' + G_A' kappa)/W_i^A,
// so that g_i n_i^A = 1 and g_j n_i^A = 0.
template <class Number>
struct Transmission {
    ContactVector<Number> kappa;  // 0 outside of A
    Number W;
};

// The block W_AA of a symmetric matrix, as L D L'.
template <class Number>
class HeldBlock {
 public:
    // A pivot below this fraction of its diagonal entry is not clearly positive.
    static constexpr double clear = 0x1p-33;

    // Returns nullopt if W_AA is not positive definite. For doubles: a pivot is at most `min_pivot` times its
    // diagonal entry. For intervals: the pivots are not proved positive for every symmetric matrix inside.
    static std::optional<HeldBlock> of(const ContactMatrix<Number>& W, ContactSet held, double min_pivot = clear);

    // x_A = W_AA^-1 b_A, and 0 outside of A.
    ContactVector<Number> solve(const ContactVector<Number>& b) const;

    // For a contact i outside of A. W is the matrix that contains this block.
    Transmission<Number> transmission(const ContactMatrix<Number>& W, Eigen::Index i) const;
    // W_ik^A = W_ik + W_iA kappa, where kappa is the transmission of k.
    static Number between(const ContactMatrix<Number>& W, Eigen::Index i, Eigen::Index k,
                          const ContactVector<Number>& kappa);

 private:
    ContactSet held_;
    ContactMatrix<Number> factor_;  // L below the diagonal, D on it
};

extern template class HeldBlock<double>;
extern template class HeldBlock<Interval>;

}  // namespace achilles
