// The truncation conditions of a contact that sticks at every impact (theory-friction.md 4.2).
//
// In the coordinates (q, s) with v = s + n_N hdot + n_T u the motion is continuous through impacts. X is a box around
// (q, s) at the collision, hdot ranges over [-w, w] and u over [-u_m, u_m]. With a = -hddot in [a_min, a_max] and alpha
// = udot over X, the free accelerations:
//
// time       as in theory.md 4
//
// stick      Every landing has u/w = x in [alpha] [2/a_max, 2/a_min], and sticks if
//                mu (W_TT (1+e) + W_NT x) > |W_NT (1+e) + W_NN x|,     mu at the speed e |x| w/(1+e)
//            It gains no energy if (1 - e^2) W_TT + 2 x W_NT + x^2 W_NN >= 0. At rest the contact sticks if
//                mu_s (W_NT alpha + W_TT a) > |W_NT a + W_NN alpha|
//            and slides if this is certainly false; until tau_inf u = 0 is kept in either case
//
// others     They are held, so W is that of the contact in their mode; W_TN is not W_NT if some of them slide. An
//            impulse has p_T/p = -(W_TN (1+e) + W_NN x)/(W_TT (1+e) + W_NT x), from which what they feel follows
//            (ConditionsBase::prove_other_contacts_stay)
//
// cap        If every impact would gain energy, e is e' = sqrt(1 + x (2 W_NT + W_NN x)/W_TT) at each, enclosed over X
//            and x (theory-friction.md 4.2). None of the others may slide then.
//
// restart    u does not cancel over the flights. Its integral I_u is in [alpha] S_2/2, where S_2 is the sum of the
//            squares of the flight times. The motion in contact starts at q + n_T I_u, s + C I_u.
//
// shadowing  q^ = q - n_N h + n_T J and s^ = s - B h + C J obey the equations of contact up to terms in h, J, hdot^2,
//            hdot u and u^2, where J is the integral of u from t to tau_inf and |J| <= U_m = max|alpha| S_2/2:
//                c_q = max|B - ndot_N| I_h + max|C - ndot_T| U_m T
//                c_s = max|A_q n_N + A_s B - Bdot| I_h + max|A_q n_T + A_s C - Cdot| U_m T
//                      + max|D_NN| int hdot^2 + max|D_NT| int |hdot u| + max|D_TT| int u^2
//            Gronwall's lemma adds these and the distance of the restart from (q^, s^).
#pragma once

#include "certify/range.hpp"
#include "certify/truncation.hpp"

namespace achilles {

class StickingConditions : public TruncationConditions {
 public:
    StickingConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key,
                       ContactSet unpressed, const FloatEnvironmentGuard& ground);
    bool fails_at_point(const Collision& collision) override;
    bool fails_by_speed(double speed) override { return earlier_.fails(speed); }
    void restart(const Interval& e) override {
        TruncationConditions::restart(e);
        earlier_ = {};
    }
    State restart_at(const Collision& collision) override;

 protected:
    std::optional<Certificate> do_certify(const Collision& collision, CertificateScope scope) override;
    std::optional<Certificate> do_prove_any(const Collision& collision) override { return prove(collision); }

 private:
    struct Bounds;
    struct StickingBox : CollisionBox {
        Interval w, u;                 // the speed of the impact, and the slip before it
        Interval e;                    // the restitution of the impacts
        double slip = 0.0;             // u_m, assumed
        std::vector<Interval> n_T, C;  // at the collision
        std::vector<double> d_q, d_s;  // distances of the restart from the collision
        explicit StickingBox(std::size_t dof) : CollisionBox(dof), n_T(dof), C(dof), d_q(dof), d_s(dof) {}
    };
    void evaluate_point(const Collision& collision);
    double restitution_at_point(const Collision& collision) const;
    double slip_integral(const Collision& collision) const;
    Interval energy_loss(const Interval& x) const;
    Interval capped_restitution(const Interval& x) const;
    std::optional<Certificate> prove(const Collision& collision);
    bool begin_box(const Collision& collision);
    std::optional<Bounds> bounds_over_box(const Collision& collision);
    bool contain(const Bounds& bounds);
    Certificate::Tail tail_over_box(const Collision& collision, const Bounds& bounds);
    bool prove_others_stay(const Bounds& bounds, std::optional<Certificate::OtherContactBounds>& others);
    std::optional<Certificate> certificate_of(const Collision& collision, const Bounds& bounds);

    bool never_slides_, holds_others_, beside_slip_;
    std::uint32_t second_sigma_, speed_;
    PairTerms<Evaluator<Interval>> terms_;  // over X
    PairTerms<Evaluator<double>> point_;    // at the collision
    SlipTerms<Evaluator<Interval>> slip_;
    SpeedGuess earlier_;
    StickingBox box_;
    std::vector<Interval> variables_;
    std::vector<double> need_q_, need_s_;
};

}  // namespace achilles
