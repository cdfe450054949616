// Two contacts that bounce together, in coordinates that no impact of theirs disturbs (theory-gaps.md 3): N has a column for
// each, N = M^-1 G_C' W_CC^-1 while others are held, and
//     v = s + N sigma,   q' = s + N sigma,   s' = F(q,s,sigma,t) = A + B sigma + sum D_ij sigma_i sigma_j
// with A the acceleration where both are held. The slots of v hold s; sigma and the second sigma are hdot of the two.
#pragma once

#include "model/bouncing.hpp"

namespace achilles {

template <class Base>
class PairTerms : public Terms<Base> {
 public:
    using Terms<Base>::Terms;
    // Of contact k = 0, 1: hddot while both are open, N, B, their rates; W_00, W_01, W_11; D_00, 2 D_01, D_11.
    static Expressions list(const Expressions& hddot, const Expressions& delassus, const Expressions& A,
                            const Expressions& N, const Expressions& B, const Expressions& Ndot,
                            const Expressions& Bdot, const Expressions& D, const Expressions& dA_dq,
                            const Expressions& dA_ds) {
        return joined({hddot, delassus, A, N, B, Ndot, Bdot, D, dA_dq, dA_ds});
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

 private:
    decltype(auto) row(std::size_t k, std::size_t i) const { return this->output(5 + k * this->dof_ + i); }
};

struct PairPrograms {
    ProgramOf<PairTerms> terms;
    Neighbours others;
};

// Two contacts while others are held. Throws std::domain_error where the two cannot be held at once with these.
PairPrograms derive_pair(std::size_t first, std::size_t second, Mode mode, ContactModes& motions,
                         const Equations& equations, const Layout& layout);

}  // namespace achilles
