// The Delassus matrix W = G M^-1 G' of several contacts (the rows of G are the g_j = dh_j), and what holding some of them
// does to the others. Numbers are doubles, or intervals where something is to be proved. Everything is on the stack.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "number/interval.hpp"
#include "run/contact_set.hpp"

namespace achilles {

inline constexpr Eigen::Index most_contacts = 8;  // that are closed at one time

template <class Number>
using ContactMatrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, 0, most_contacts, most_contacts>;
template <class Number>
using ContactVector = Eigen::Matrix<Number, Eigen::Dynamic, 1, 0, most_contacts, 1>;

inline bool contains(ContactSet set, Eigen::Index contact) { return set.contains(static_cast<std::size_t>(contact)); }
inline ContactSet with(ContactSet set, Eigen::Index contact) { return set.with(static_cast<std::size_t>(contact)); }
inline ContactSet without(ContactSet set, Eigen::Index contact) {
    return set.without(static_cast<std::size_t>(contact));
}

// What is 0 only within its rounding counts as 0 (theory-gaps.md 8): so small beside the number that is natural for it, as
// sqrt(W_ii W_kk) is for W_ik and sqrt(W_ii/W_jj) for kappa_ji. Intervals cannot decide it: an enclosure of 0 counts that is so
// narrow.
inline constexpr double rounded_zero = 64 * 0x1p-52;
inline bool counts_as_zero(const Interval& x, double natural) {
    return x.contains(0.0) && width(x) <= rounded_zero * natural;
}

// W +- radius, entry by entry: for a matrix that was computed and the bound on its error.
ContactMatrix<Interval> enclosure(const ContactMatrix<double>& W, const ContactMatrix<double>& radius);

// How contact i feels while the set A is held (theory-gaps.md 2): an impulse p on i is passed on to j in A as kappa_j p,
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
    // A pivot below this part of its diagonal entry is not clearly positive.
    static constexpr double clear = 0x1p-33;

    // Nothing where W_AA is not positive definite: as doubles where a pivot is at most `least_pivot` of its diagonal
    // entry, as intervals where positive pivots are not proved for every symmetric matrix inside.
    static std::optional<HeldBlock> of(const ContactMatrix<Number>& W, ContactSet held, double least_pivot = clear);

    // x_A = W_AA^-1 b_A, and 0 outside of A.
    ContactVector<Number> solve(const ContactVector<Number>& b) const;

    // For i outside of A; W is the matrix of which this is a block.
    Transmission<Number> transmission(const ContactMatrix<Number>& W, Eigen::Index i) const;
    // W_ik^A = W_ik + W_iA kappa, kappa the transmission of k.
    static Number between(const ContactMatrix<Number>& W, Eigen::Index i, Eigen::Index k,
                          const ContactVector<Number>& kappa);

 private:
    ContactSet held_;
    ContactMatrix<Number> factor_;  // L below the diagonal, D on it
};

extern template class HeldBlock<double>;
extern template class HeldBlock<Interval>;

}  // namespace achilles
