// The truncation conditions that choose their own neighbourhood (THEORY sections 4 to 6): conditions = "sharp".
//
// In the coordinates (q, s) of model/bouncing.hpp the motion is continuous through impacts. X is a box around (q, s) at
// the collision, sigma = hdot runs over [-w, w]. With -hddot in [a_min, a_max] on X, r = a_max/a_min and e^2 r < 1:
//
//   time      A_lo w <= tau_inf - tau_k <= A w =: T,   A = 2 e (1+e)/(a_min (1 - e^2 r)),  A_lo = 2 e (1+e)/(a_max (1 -
//   e^2/r))
//             (the worst motion rises with a_min and falls first with a_min, then with a_max: attained, section 4)
//   inclusion rho_q = max |v| T and rho_s = max |s'| T inside X's radii prove that X contains the motion until tau_inf:
//   at a
//             first exit the time passed would be below T, so (q, s) would be strictly inside
//   Zeno      |q_inf - q*| <= |max |v| T|,   |v_inf - s| <= |max |s'| T|
//   shadowing the constrained motion started at tau_k differs at tau_inf by at most E = O(w^3). By parts, with h = 0 at
//   both
//             ends, q^ = q - n h and s^ = s - B h obey the constrained equations up to terms in h and hdot^2, whose
//             integrals are at most I_h = 2 e^3 w^3/(3 a_min^2 (1 - e''^3)) and a_max I_h; then Gronwall:
//                 c_q = max |B - ndot| I_h,   c_s = max |dA/dq n + dA/ds B - Bdot| I_h + a_max max |D| I_h
//                 E_q = c_q + K max(c_q, c_s),  E_s = c_s + K max(c_q, c_s),  K = exp(kap T) - 1,
//                 kap = max(1, row sums of |dA/d(q,s)|)
//             X must also contain the shifted variables: h <= h_m = (e w)^2/(2 a_min) moves them by max |n| h_m, max
//             |B| h_m. The comparison motion is the case sigma = 0, so it is inside X as well.
//   Euclidean v* = s + d, d_i = w |n_i - g_i/|g|^2|: |v_inf - v*| gains d, E_q gains K max d, E_s gains d + K max d, if
//             d_i + max |A_i| T is inside X's radius of s_i.
#pragma once

#include "certify/range.hpp"
#include "certify/truncation.hpp"

namespace achilles {

class SharpConditions : public TruncationConditions {
 public:
    SharpConditions(const Model& model, const Run& run, const Ground& ground);
    bool hopeless(const Collision& collision) override;
    bool hopeless_at(double speed) override;
    void forget() override { wide_speed_ = too_wide_ = last_speed_ = 0.0; }

 protected:
    std::optional<Certificate> certify(const Collision& collision) override;
    std::optional<Certificate> certify_widest(const Collision& collision) override;

 private:
    struct Box;
    struct Time;
    struct Shadow;
    std::optional<Certificate> prove(const Collision& collision);
    std::optional<Time> time_over(const Box& box);
    bool contain_motion(Box& box, const Time& time);
    bool contain_shadow(Box& box, const Time& time);
    Shadow shadow_over(const Box& box, const Time& time) const;
    Certificate certificate_of(const Collision& collision, const Box& box, const Time& time,
                               const Shadow& shadow) const;
    void set(Evaluator<Interval>& program, const Box& box) const;
    void remember(double speed, double too_wide);

    std::size_t n_;
    std::uint32_t sigma_;
    Truncation truncation_;
    Interval e_;
    Range hddot_;
    Evaluator<Interval> motion_, shadow_, surface_;
    Evaluator<double> trend_;
    // The last proof or guess that was too wide: at this impact speed, by this factor.
    double wide_speed_ = 0.0, too_wide_ = 0.0;
    double last_speed_ = 0.0;              // of the last collision that was looked at
    std::vector<Interval> variables_;      // q, s, sigma over the box that is looked at
    std::vector<double> need_q_, need_s_;  // radii that the last test of a box asked for
};

}  // namespace achilles
