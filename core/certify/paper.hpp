// The reliable truncation of the paper (Def. 7, Thm. 3; theory.md 3), proved by interval evaluation.
//
// The neighborhood V = {|q - q*| < eps_q', |v - v*| < eps_v'} of the restart (q*, v*) is here the smallest box that
// contains it and v-. Over V, let -hddot lie in [a_min, a_max], r = a_max/a_min, e' = e r < 1, e'' = e sqrt(r),
// beta = |v*| + eps_v', eta = max |n|, zeta = max |f|. With w = |hdot| at the collision,
//
//     c1 = a_min (1 - e')/(2 e) eps_t          c2 = a_min (1 - e')/(2 e beta) eps_q'
//     c3 = eps_v' / ((1 + e) eta/(1 - e'') + 2 e zeta/(a_min (1 - e')) + 1/|g(q*)|)      Euclidean R*
//     c3 = eps_v' / ((e + e'') eta/(1 - e'') + 2 e zeta/(a_min (1 - e')))                kinetic, restart at s
//
// w < min(c1, c2, c3) proves tau_inf - tau_k < eps_t, |q_inf - q*| < eps_q', |v_inf - v*| < eps_v'.
//
// c3 adds up the velocity jumps of all impacts, although they nearly cancel. If Thm. 3 holds, V contains the whole
// bouncing motion. The tangential velocity s, which impacts do not change (model/bouncing.hpp), then gives a closer
// bound:
//
//     |v_inf - v*| <= |s_k - v*| + T max |s'|     T = A w (theory.md 4),  |hdot| <= w,  s in V - n [-w, w]
//
// The velocity bound of the certificate is the smaller of the two. The decision still uses c3, as in the paper.
//
// Choice of eps' <= eps: a smaller V makes every bound smaller, because interval evaluation is monotone under
// inclusion. Among all V that satisfy their own conditions there is therefore a smallest one. It is found from below: V
// grows to the size of its own bounds until these lie inside V. The time grows in the same way if the system depends on
// it; all maxima are then over V and the times from tau_k to tau_k + eps_t'. If a bound exceeds eps on the way, no
// eps' <= eps can succeed. If eps' = eps succeeds, the smallest V succeeds too, with smaller bounds.
#pragma once

#include "certify/range.hpp"
#include "certify/truncation.hpp"

namespace achilles {

class PaperConditions : public TruncationConditions {
 public:
    PaperConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key, ContactSet unpressed,
                    const FloatEnvironmentGuard& ground);

    bool fails_at_point(const Collision& collision) override;

 protected:
    std::optional<Certificate> do_certify(const Collision& collision, CertificateScope scope) override;
    // The same with tolerances so large that no bound exceeds them.
    std::optional<Certificate> do_prove_any(const Collision& collision) override;

 private:
    struct Bounds;
    std::optional<Certificate> prove(const Collision& collision, const Truncation& tolerances);
    std::optional<Bounds> bounds_over(const Collision& collision, double eps_q, double eps_v, double eps_t);
    Certificate certificate_of(const Collision& collision, const Bounds& bounds);
    Interval tangential_bound(const Collision& collision, const Bounds& bounds, const Interval& accumulation_time);

    Definition7Terms<Evaluator<double>> point_;
    Range hddot_;
    Definition7Terms<Evaluator<Interval>> box_;
    BouncingRates<Evaluator<Interval>> rates_;
};

}  // namespace achilles
