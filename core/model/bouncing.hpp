// The motion of a bouncing contact in coordinates that impacts do not change: (q, s), where s is the tangential
// velocity (theory.md 5.1).
//
//     q' = s + n sigma,   s' = F(q,s,sigma,t) = A + B sigma + D sigma^2,   sigma = hdot
//
// A is the constrained acceleration f_c(q, s, t), and
//     F = f_c(q, s + n sigma, t) - (dn/dq (s + n sigma) + n_t) sigma
//     B = df_c/dv n - dn/dq s - n_t,     D = 1/2 n' (d2f_c/dv2) n - dn/dq n
// In B, v = s. If f_c has degree 2 or less in the velocity, v = s in D as well, and D does not depend on sigma. If a
// force makes f_c another function of the velocity (theory-gaps.md 1), v = s + n sigma in D. The values of D over all
// sigma' between 0 and sigma then include Lagrange's form of the remainder.
// In every program here the slots of v hold s, and the slot sigma holds hdot.
#pragma once

#include <array>
#include <map>
#include <string_view>

#include "model/derive.hpp"
#include "program/program.hpp"
#include "program/terms.hpp"

namespace achilles {

// At sigma = 0: hddot, its time derivative along the constrained motion (P below), and its derivative with respect to
// sigma. For a contact that sticks at its impacts, the derivative with respect to its slip u follows.
template <class Base>
class TrendTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(Expression hddot, Expression rate, Expression by_sigma, const Expressions& by_slip = {}) {
        return joined({{hddot, rate, by_sigma}, by_slip});
    }
    decltype(auto) hddot() const { return this->output(0); }
    decltype(auto) rate() const { return this->output(1); }
    decltype(auto) by_sigma() const { return this->output(2); }
    decltype(auto) by_slip() const { return this->output(3); }
};

// The rates q' = s + n sigma and s'.
template <class Base>
class BouncingRates : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(const Expressions& q_rate, const Expressions& s_rate) { return joined({q_rate, s_rate}); }
    decltype(auto) rate(std::size_t i) const { return this->output(i); }  // of variable i of (q, s)
    decltype(auto) s_rate(std::size_t i) const { return rate(this->dof_ + i); }
};

// The terms that bound the shadow of a bouncing motion, and the rate of hddot(q, s) along it (theory-truncation.md 4):
//     d/dt = P + Phi sigma + Xi sigma^2
//     P = hddot_q s + hddot_s A + hddot_t,   Phi = hddot_q n + hddot_s B,   Xi = hddot_s D
template <class Base>
class ShadowTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    static Expressions list(const Expressions& A, const Expressions& n, const Expressions& B, const Expressions& D,
                            const Expressions& ndot, const Expressions& Bdot, const Expressions& dA_dq,
                            const Expressions& dA_ds, const Expressions& P_Phi_Xi) {
        return joined({A, n, B, D, ndot, Bdot, dA_dq, dA_ds, P_Phi_Xi});
    }
    decltype(auto) A(std::size_t i) const { return row(0, i); }
    decltype(auto) n(std::size_t i) const { return row(1, i); }
    decltype(auto) B(std::size_t i) const { return row(2, i); }
    decltype(auto) D(std::size_t i) const { return row(3, i); }
    decltype(auto) ndot(std::size_t i) const { return row(4, i); }
    decltype(auto) Bdot(std::size_t i) const { return row(5, i); }
    decltype(auto) dA_dq(std::size_t i, std::size_t j) const { return row(6 + i, j); }
    decltype(auto) dA_ds(std::size_t i, std::size_t j) const { return row(6 + this->dof_ + i, j); }
    decltype(auto) P() const { return row(6 + 2 * this->dof_, 0); }
    decltype(auto) Phi() const { return row(6 + 2 * this->dof_, 1); }
    decltype(auto) Xi() const { return row(6 + 2 * this->dof_, 2); }
    // dA/dq n + dA/ds B - Bdot: the effect of the impulses on the drift of s.
    auto drift(std::size_t i) const {
        auto sum = -Bdot(i);
        for (std::size_t j = 0; j < this->dof_; ++j) sum = sum + dA_dq(i, j) * n(j) + dA_ds(i, j) * B(j);
        return sum;
    }
    // Bound on how fast A_i varies with q and s: the sum of |dA_i/dq_j| and |dA_i/ds_j|.
    auto steepness(std::size_t i) const {
        auto sum = abs(dA_dq(i, 0)) + abs(dA_ds(i, 0));
        for (std::size_t j = 1; j < this->dof_; ++j) sum = sum + abs(dA_dq(i, j)) + abs(dA_ds(i, j));
        return sum;
    }

 private:
    decltype(auto) row(std::size_t k, std::size_t i) const { return this->output(k * this->dof_ + i); }
};

// Two contacts that bounce together, in coordinates that their impacts do not change (theory-gaps.md 3). N has a column
// for each contact, N = M^-1 G_C' W_CC^-1 while others are held, and
//     v = s + N sigma,   q' = s + N sigma,   s' = F(q,s,sigma,t) = A + B sigma + sum D_ij sigma_i sigma_j
// A is the acceleration while both are held. The slots of v hold s; sigma and the second sigma are hdot of the two
// contacts. For a contact that sticks at its impacts (theory-friction.md 4.2) they are hdot and its slip u, and its
// second "hddot" is the acceleration of the slip.
template <class Base>
class PairTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    // For the contacts k = 0, 1: hddot while both are open, N, B and their time derivatives; W_00, W_01, W_11; D_00,
    // 2 D_01, D_11. `skew` is W_10, if it may differ from W_01.
    static Expressions list(const Expressions& hddot, const Expressions& delassus, const Expressions& A,
                            const Expressions& N, const Expressions& B, const Expressions& Ndot,
                            const Expressions& Bdot, const Expressions& D, const Expressions& dA_dq,
                            const Expressions& dA_ds, const Expressions& skew = {}) {
        return joined({hddot, delassus, A, N, B, Ndot, Bdot, D, dA_dq, dA_ds, skew});
    }
    decltype(auto) hddot(std::size_t k) const { return this->output(k); }
    decltype(auto) W(std::size_t k, std::size_t l) const { return this->output(2 + k + l); }
    decltype(auto) A(std::size_t i) const { return row(0, i); }
    decltype(auto) N(std::size_t k, std::size_t i) const { return row(1 + k, i); }
    decltype(auto) B(std::size_t k, std::size_t i) const { return row(3 + k, i); }
    decltype(auto) Ndot(std::size_t k, std::size_t i) const { return row(5 + k, i); }
    decltype(auto) Bdot(std::size_t k, std::size_t i) const { return row(7 + k, i); }
    decltype(auto) D(std::size_t k, std::size_t i) const { return row(9 + k, i); }
    decltype(auto) dA_dq(std::size_t i, std::size_t j) const { return row(12 + i, j); }
    decltype(auto) dA_ds(std::size_t i, std::size_t j) const { return row(12 + this->dof_ + i, j); }
    // Contacts that slide make W unsymmetric.
    decltype(auto) W_10() const { return row(12 + 2 * this->dof_, 0); }

 private:
    decltype(auto) row(std::size_t k, std::size_t i) const { return this->output(5 + k * this->dof_ + i); }
};

// A contact that bounces while the other contacts and joints are in some mode. Its impacts move v along n.
struct BouncingContact {
    Expression hddot;
    Expressions f, f_c, n;  // the accelerations in flight and in contact, f_c = f - n hddot
    // If n depends on v, which it does through the slip u = d v + c only: d and dn/du. Otherwise empty.
    Expressions d, n_u;
};

struct BouncingModel {
    // The variables of the programs: q, s, sigma, and t if the system depends on time. For a contact that sticks at its
    // impacts the slip (second sigma) follows sigma, and only `trend` and `sticking` are set.
    std::vector<std::uint32_t> variables;
    Program hddot;                      // hddot(q, s + n sigma)
    Program gradient;                   // its derivatives with respect to the variables
    TypedProgram<BouncingRates> rates;  // of q and s
    TypedProgram<TrendTerms> trend;
    Program shadow;  // the gradient again (it shares most of its work with the rest), then ShadowTerms
    TypedProgram<PairTerms> sticking;
};

// Why a bouncing motion is not completed: what a contact or joint does, or is not proved to do. The text follows its
// name.
struct BouncingObstacle {
    std::size_t which = 0;  // contact or joint
    std::string_view text;
};

// The rows of contacts that are closed at the impacts, and of joints that stick, while one of the contacts bounces:
// from them certify/impact_law_proof.hpp proves that the laws of impact and force have one solution. The program
// returns W, row by row; the rates of the rows before an impact; for every element with a slip its mu, at the speed
// Layout::sliding_speed(), and mu_s; and twice the kinetic energy.
struct ImpactLawTerms {
    struct Element {
        std::size_t which;        // contact or joint
        int gap = -1, slip = -1;  // rows; -1: none
        bool slides = false, never_slides = false;
        bool depends_on_speed = false;  // mu does
        bool has_moving_surface = false;
    };
    std::vector<Element> elements;  // none: nothing needs a proof
    std::size_t rows = 0;
    Program program;
};

// Conditions on the other contacts while one contact (theory-gaps.md 2.3) or two contacts (3) bounce. Every other
// contact is held or open. `velocity` has an expression for each slot of v. The program returns:
//   for every bouncing contact: W;
//   for every held contact, in the mode that holds the other held ones: hddot (negative if pressed), W, and for each
//       bouncing contact kappa, the factor by which it transmits an impulse;
//   for every open contact: its gap;
//   functions that must stay positive: of friction (theory-friction.md 4.1), and `when` of the bouncing contacts;
//   `on` of the watched jumps, which must not vanish (theory-modes.md 3).
//   for every held contact that sticks: the distances of its impulse from the two sides of its friction cone, which
//       must not be negative (theory-friction.md 4.3).
struct OtherContactTerms {
    std::vector<std::size_t> bouncing, held, open;
    Program program;
    std::size_t positive = 0, nonzero = 0;  // the numbers of these functions
    // With friction: what the first of the positive functions prove, and the contacts with a cone.
    std::vector<BouncingObstacle> conditions;
    std::vector<std::size_t> cones;
    ImpactLawTerms impact_law;
};
// What friction adds: conditions, with functions that must be positive; for held contacts, which are none without
// friction, hddot (minus the force times W), W and kappa; and the cones.
struct FrictionConditions {
    struct HeldContact {
        Expression hddot, W, kappa;
    };
    Expressions positive;
    std::vector<BouncingObstacle> conditions;
    std::map<std::size_t, HeldContact> held;
    Expressions cones;
    std::vector<std::size_t> contacts_with_cone;
};
OtherContactTerms derive_other_contacts(const std::vector<std::size_t>& bouncing, Mode mode,
                                        const Expressions& velocity, ContactModes& motions, const Layout& layout,
                                        const FrictionConditions& friction = {});
OtherContactTerms derive_other_contacts(std::size_t contact, Mode mode, ContactModes& motions, const Layout& layout);

// Derives and compiles the programs of a contact, in a copy of its graph.
BouncingModel derive_bouncing(const BouncingContact& contact, const Equations& equations, const Layout& layout);

// The terms of v = s + N sigma for two components of sigma: the columns of N, A, the accelerations of sigma in flight
// at this velocity, and W. If A is `bent`, it is not a polynomial of degree 2 in the velocity.
TypedProgram<PairTerms> derive_pair_terms(const Expressions& A, const std::array<Expressions, 2>& N,
                                          const Expressions& accelerations, const Expressions& delassus, bool bent,
                                          const Layout& layout, const Expressions& skew = {});
// The velocity s + N sigma of these terms.
Expressions pair_velocity(const std::array<Expressions, 2>& N, const Layout& layout);

struct PairPrograms {
    TypedProgram<PairTerms> terms;
    OtherContactTerms others;
    // For every contact of the pair with friction: its slip at v = s and the two coefficients of sigma in it, all times
    // the sign with which it slides.
    Program slips;
    std::size_t sliding = 0;  // how many there are
};

// The programs of two contacts without friction that are held in the mode `closed`, with the others. Throws
// std::domain_error if they cannot be held together.
PairPrograms derive_pair(std::size_t first, std::size_t second, Mode closed, ContactModes& motions,
                         const Equations& equations, const Layout& layout);

}  // namespace achilles
