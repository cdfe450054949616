// Impacts of two contacts that alternate until they have used up their speeds, without any force (theory-collapse.md 1).
//
// With W_12, W_21 < 0, every impact of one contact drives the other toward its surface. Let k_i = |W_ji| (1 + e_i)/W_ii.
// The speeds of successive impacts obey u' = k_i u - e_j u_before, whose two-impact factors mu+ >= mu- have
//     mu+ + mu- = k_1 k_2 - e_1 - e_2,   mu+ mu- = e_1 e_2
// Everything holds as well while other contacts are held, with the Delassus matrix in that mode. W_12 and W_21 differ if
// the two contacts slide.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "number/interval.hpp"

namespace achilles {

// Delassus matrix of a pair and its restitutions. W_21 is the change of the rate of gap 2 by a unit impulse on contact 1.
template <class Number>
struct PairLaw {
    Number W11, W12, W21, W22;
    std::array<Number, 2> e;

    // k_1 k_2 = W_12 W_21 (1 + e_1)(1 + e_2)/(W_11 W_22).
    Number product() const { return W12 * W21 * (1.0 + e[0]) * (1.0 + e[1]) / (W11 * W22); }
    // Positive if mu+ and mu- are real and positive: k_1 k_2 - (sqrt e_1 + sqrt e_2)^2.
    Number reality() const {
        using std::sqrt;
        const Number root = sqrt(e[0]) + sqrt(e[1]);
        return product() - root * root;
    }
    // W = (1, -c; -c, 1) in these units of the gap rates and with impulses in units of size_k/W_kk, c^2 = coupling().
    Number coupling() const { return W12 * W21 / (W11 * W22); }
    std::array<Number, 2> sizes() const {
        using std::sqrt;
        const Number twist = sqrt(sqrt(W12 / W21));
        return {sqrt(W11) * twist, sqrt(W22) / twist};
    }
};

// The limit of alternate impacts in double precision, for contacts with W_12, W_21 < 0 and 0 < e_i < 1.
struct AlternateImpacts {
    std::array<double, 2> k, e;
    double mu_plus = 0.0, mu_minus = 0.0;  // factors of the speeds and of the gaps per two impacts
    bool is_real = false;                  // k_1 k_2 >= (sqrt e_1 + sqrt e_2)^2
    bool is_fast = false;                  // mu- < mu+^2: the forces matter less with every impact

    explicit AlternateImpacts(const PairLaw<double>& pair);
    // The factor nu_i: after an impact of contact i, the impacts go on for ever if -sigma_j > nu_i sigma_i.
    double nu(std::size_t i) const { return (mu_plus + e[1 - i]) / (mu_plus * k[1 - i]); }
    // Time (s) until both contacts are at rest, after an impact of contact i that leaves the rates sigma_i > 0 and
    // sigma_j < 0, and the other gap h_j. Negative or infinite if they do not collapse.
    double time(std::size_t i, double sigma_i, double sigma_j, double h_j) const {
        return h_j / (-sigma_j - nu(i) * sigma_i);
    }
};

// The inequalities, as messages name them.
namespace collapse {
inline constexpr std::string_view real = "k1 k2 >= (sqrt e1 + sqrt e2)^2", fast = "k1 k2 > e1 + e2 + p + p^2",
                                  cone = "-sigma_j > nu_i sigma_i", weak_force = "beta < 0.2",
                                  still_gap = "2 beta < rho^2", falls = "r > 0", stays_up = "e_i >= d/2",
                                  rises = "rho' > 0", contracts = "rho'' >= rho, beta'' <= beta, q q' < 1",
                                  contained = "the motion stays in the box of its bounds",
                                  negative_c = "W_12 < 0 over the box", others = "the other contacts keep their states",
                                  tolerances = "the errors are within eps_q, eps_v and eps_t",
                                  who_stays = "a force decides which contacts stay",
                                  slides = "both slide in one direction until they are at rest on their surfaces";
}  // namespace collapse

// Whether two contacts that close together are proved to lose their speeds at once, in either order of their impacts.
inline bool collapses_at_tie(const PairLaw<Interval>& pair) {
    for (const Interval& e : pair.e)
        if (!certainly_positive(e) || !certainly_less(e, Interval(1.0))) return false;
    return certainly_negative(pair.W12) && certainly_negative(pair.W21) && certainly_positive(pair.W11) &&
           certainly_positive(pair.W22) && certainly_positive(pair.reality());
}

inline AlternateImpacts::AlternateImpacts(const PairLaw<double>& pair) : k{}, e(pair.e) {
    k = {std::abs(pair.W21) * (1.0 + e[0]) / pair.W11, std::abs(pair.W12) * (1.0 + e[1]) / pair.W22};
    const double sum = k[0] * k[1] - e[0] - e[1], product = e[0] * e[1];
    const double p = std::cbrt(product);
    is_real = pair.reality() >= 0.0;
    is_fast = k[0] * k[1] > e[0] + e[1] + p + p * p;
    if (!is_real) return;
    mu_plus = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
    mu_minus = product / mu_plus;  // without cancellation
}

}  // namespace achilles
