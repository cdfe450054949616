// The truncation conditions `conditions = "sharp"`, which choose their own neighborhood (theory.md 4 to 6,
// theory-truncation.md 2 to 4).
//
// In the coordinates (q, s) of model/bouncing.hpp the motion is continuous through impacts. X is a box around (q, s) at
// the collision; sigma = hdot ranges over [-w, w]. With -hddot in [a_min, a_max] on X, r = a_max/a_min and e^2 r < 1:
//
// time       A_lo w <= tau_inf - tau_k <= A w =: T (certify/truncation.hpp). In the motion that takes longest, -hddot
//            is a_min while the contact opens; while it closes, -hddot is first a_min, then a_max. The interval is
//            intersected with the one of third order,
//            except if only the decision is required (CertificateScope) and the attained bounds suffice for it.
//
// inclusion  If rho_q = max |v| T and rho_s = max |s'| T are below X's radii, X contains the motion until tau_inf: at a
//            first exit, the time passed would be less than T, so (q, s) would be strictly inside. If the system
//            depends on time, X is a box in (q, s, t), where t ranges from the enclosure of tau_k to T and a little
//            more later.
//
// Zeno       |q_inf - q*| <= |max |v| T|,   |v_inf - s| <= |max |s'| T|
//
// shadowing  The constrained motion started at tau_k differs at tau_inf by at most E = O(w^3). Integration by parts,
//            with h = 0 at both ends, shows that q^ = q - n h and s^ = s - B h obey the constrained equations up to
//            terms in h and hdot^2. Their integrals are at most I_h = 2 e^3 w^3/(3 a_min^2 (1 - e''^3)) and a_max I_h.
//            By Gronwall:
//                c_q = max |B - ndot| I_h,   c_s = max |dA/dq n + dA/ds B - Bdot| I_h + a_max max |D| I_h
//                E_q = c_q + K max(c_q, c_s),  E_s = c_s + K max(c_q, c_s),  K = exp(kap T) - 1,
//                kap = max(1, row sums of |dA/d(q,s)|)
//            X must also contain the shifted variables: h <= h_m = (e w)^2/(2 a_min) shifts them by max |n| h_m and
//            max |B| h_m. The comparison motion is the case sigma = 0, so it is inside X as well.
//
// uniform    At every instant from tau_k to tau_inf, where q~ is the constrained motion:
//                |q_i - q~_i| <= E_q,i + max |n_i| h_m
//            The integrals of h and hdot^2 up to any time are at most those up to tau_inf, because they increase.
//            (q^, s^) is therefore within E at all times, and q = q^ + n h.
//
// Euclidean  v* = s + d, d_i = w |n_i - g_i/|g|^2|: |v_inf - v*| gains d, E_q gains K max d, E_s gains d + K max d, if
//            d_i + max |A_i| T is inside X's radius of s_i.
//
// change     Where forces see the contact, the acceleration changes by df at the Zeno point, and the run makes this change
//            at its estimate of tau_inf. E_s gains |df| W exp(kap T) and E_q that times T, with the width W of the time
//            interval, if |df| T more fits into X's radius of s.
//
// The bouncing is truncated if half of the time interval is within eps_t, the uniform bound within eps_q, and the
// shadowing bound on the velocity within eps_v.
#pragma once

#include "certify/range.hpp"
#include "certify/truncation.hpp"

namespace achilles {

class SharpConditions : public TruncationConditions {
 public:
    SharpConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key, ContactSet unpressed,
                    const FloatEnvironmentGuard& ground);
    bool fails_at_point(const Collision& collision) override;
    bool fails_by_speed(double speed) override { return earlier_.fails(speed); }
    void restart(const Interval& e) override {
        TruncationConditions::restart(e);
        earlier_ = {};
    }

 protected:
    std::optional<Certificate> do_certify(const Collision& collision, CertificateScope scope) override;
    std::optional<Certificate> do_prove_any(const Collision& collision) override {
        return prove(collision, CertificateScope::full);
    }

 private:
    struct Time;
    // X: a box in (q, s), sigma and t.
    struct SharpBox : CollisionBox {
        std::vector<Interval> d;  // v* - s, if the restart velocity is v*
        Interval w, sigma;
        explicit SharpBox(std::size_t dof) : CollisionBox(dof), d(dof) {}
    };
    struct ShadowingBound {
        std::vector<Interval> E_q, E_s;  // at tau_inf
        std::vector<Interval> uniform;   // bound on q at all times
        Interval growth;                 // exp(kap T)
    };
    std::optional<Certificate> prove(const Collision& collision, CertificateScope scope);
    void begin_box(const Collision& collision);
    void predict_radii(const Collision& collision, const AccelerationTrend& trend);
    std::optional<Time> time_over_box();
    bool contain(const Time& time);
    void sharpen(Time& time, const AccelerationTrend& trend);
    void find_shadow(const Time& time);
    Certificate certificate_of(const Collision& collision, const Time& time, const AccelerationTrend& trend) const;

    ShadowTerms<Range> hddot_;
    BouncingRates<Evaluator<double>> guess_;
    SpeedGuess earlier_;
    // Data of the current proof, kept as members so that further proofs allocate no memory.
    SharpBox box_;
    ShadowingBound shadow_;
    std::vector<Interval> variables_;      // q, s, sigma, t over the box
    std::vector<double> need_q_, need_s_;  // radii that the last inclusion test required
    std::vector<double> rising_;           // q', s' just before the impact
};

}  // namespace achilles
