// May a bouncing be cut short at this collision? How long it would still last, what the conditions have in common, and whether
// the other contacts stay as they are.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "number/ground.hpp"
#include "number/interval.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// How long a bouncing still lasts after an impact of speed w: bounds that motions attain, and to third order in w.

// tau_inf - tau_k wherever -hddot stays in [a_min, a_max] and e^2 a_max/a_min < 1 (theory.md 4): attained bounds
//     A_lo w <= tau_inf - tau_k <= A w,   A = 2 e (1+e)/(a_min (1 - e^2 r)),   A_lo = 2 e (1+e)/(a_max (1 - e^2/r)).
struct Wait {
    Interval earliest, latest;
};
Wait wait_for_zeno(const Interval& e, const Interval& a_min, const Interval& a_max, const Interval& w);

// How -hddot changes along a bouncing, at the restart (q, s) and sigma = 0: its value a, its rate b along the
// constrained motion, its derivative c with respect to sigma = hdot.
struct Trend {
    double a = 0.0, b = 0.0, c = 0.0;
};

// The wait to second order in w, an estimate (theory-truncation.md 3):
//     T0 - T0^2 (b/(3a) + c/6),   T0 = 2 e w/(a (1 - e)).    Needs a > 0, e < 1.
double estimated_wait(const Trend& trend, double e, double w);
// The same over any number.
template <class Number>
Number estimated_wait(const Number& a, const Number& b, const Number& c, const Number& e, const Number& w) {
    const Number T0 = 2.0 * e * w / (a * (1.0 - e));
    return T0 - T0 * T0 * (b / (3.0 * a) + c / 6.0);
}

// What is proved of -hddot = G(q, s, sigma) over a box that contains the bouncing, its bounds a_min and a_max apart. P,
// Phi and Xi are those of model/bouncing.hpp with G for hddot.
struct Drift {
    Interval start;       // G(q, s, 0) at the collision
    Interval by_sigma;    // dG/dsigma over the box
    Interval P, Phi, Xi;  // over the box
};

// Encloses the wait to third order in w (theory-truncation.md 4): `trend` may be any doubles with a > 0, and is
// best that of the collision. With T the latest end of the wait, h_m = (e w)^2/(2 a_min) and K = (1+e)/(1-e),
//     delta = -hddot - a = b t + c hdot + R,   |R| <= rho
//     rho = |G(q,s,0) - a| + |G_sigma - c| w + |P - b| T + |mid Phi| h_m + rad(Phi) w T + |Xi| w^2 T
//     |wait - (T0 - T0^2 (b/(3a) + c/6))| <= T (2 rho/(a (1-e)) + d_m S),   d_m = max |a_max - a|, |a - a_min|
//     S = T (|cA| + 1.09 |cB| + |cE|) + 2 z_m (|cC| + |cD| + |cF| + |cG|),  z_m = w sqrt(max(e, e'')^2 + e^2 a/a_min)
// The proof: for any constant a, Theta = (hdot + K z)/a with z = sqrt(hdot^2 + 2 a h) is continuous across impacts and
// falls at the rate 1 where hddot = -a; what delta adds is integrated by parts with the quadratic form Psi in (t, hdot,
// z), continuous across impacts too, whose coefficients are cA to cG. Undefined where the enclosures are.
Interval third_order_wait(const Trend& trend, const Drift& drift, const Interval& e, const Interval& a_min,
                          const Interval& a_max, const Interval& w, const Interval& latest);
// That bound by itself, whose upper end counts: T (2 rho/(a (1-e)) + d_m S).
Interval third_order_error(const Trend& trend, const Drift& drift, const Interval& e, const Interval& a_min,
                           const Interval& a_max, const Interval& w, const Interval& latest);

// Two sets of conditions answer with a certificate, or not at all.

// Everything the conditions may look at.
struct Collision {
    State before;        // (q, v-) at tau_k, h(q) = 0
    double speed = 0.0;  // w = |hdot| before
    Vector tangential;   // s = v- - n hdot
    Vector restart;      // after reinitialization: s, or v*
    // The same place and time with another velocity.
    State with(const Vector& v) const { return {before.q, v, before.t}; }
};

// A box around a collision in q, s and t: what the computed state stands for, and radii beyond that.
struct CollisionBox {
    std::vector<Interval> q0, s0;
    std::vector<double> q_radius, s_radius;
    Interval t0;            // tau_k
    double duration = 0.0;  // s

    explicit CollisionBox(std::size_t dof) : q0(dof), s0(dof), q_radius(dof), s_radius(dof) {}
    // q and s, as the first of these variables.
    void put_into(std::vector<Interval>& variables) const;
    Interval time() const { return {t0.lo(), (Interval(t0.hi()) + Interval(duration)).hi()}; }
};

// Base of the conditions for cutting the bouncing of one contact or the chatter of a pair: the run's tolerances, what
// is proved of the other contacts, and what all certificates have. No certificate is made but on a Ground: a
// constructor shows one, and the questions stand on one of their own.
class ConditionsBase {
 protected:
    // A box has an interval for each of the variables. Without others `others` is null; those of them in `unpressed`
    // need no contact force.
    ConditionsBase(const Model& model, const Run& run, const Neighbours* others, std::vector<std::uint32_t> variables,
                   ContactSet unpressed, const Ground&);

    void set_box(auto& program, const std::vector<Interval>& box) const {
        for (std::size_t i = 0; i < variables_.size(); ++i) program.input(variables_[i]) = box[i];
    }
    // Whether the other contacts stay as they are (theory-gaps.md 2.3): over the box every held contact is pressed,
    // impulses press it more, and every other gap is open. Where there are others, `proved` is what is proved of them.
    bool prove_others(const std::vector<Interval>& box, std::optional<Certificate::Others>& proved);
    // A certificate whose tau_inf lies between tau_k + earliest and tau_k + latest, and where it is estimated: inside,
    // and not before tau_k.
    Certificate certificate_at(double tau_k, const Wait& wait, double estimated) const;
    // Adds the decision by the time and what is proved of the shadowing.
    void decide(Certificate& certificate, double half_width) const;

    std::size_t dof_;
    Truncation truncation_;

 private:
    std::vector<std::uint32_t> variables_;
    ContactSet unpressed_;
    const Neighbours* neighbours_;
    Evaluator<Interval> others_;
};

class TruncationConditions : protected ConditionsBase {
 public:
    TruncationConditions(const Model& model, const Run& run, const Interval& e, std::size_t contact, Mode mode,
                         ContactSet unpressed, const Ground& ground);
    virtual ~TruncationConditions() = default;
    // Quick: true where they can be seen not to hold.
    virtual bool fails_at_point(const Collision& collision) = 0;
    // Quicker: the same by the impact speed w alone, and what the collisions before have shown.
    virtual bool fails_by_speed(double /*speed*/) { return false; }
    // Another run begins, of this restitution and the same motion: what the collisions before have shown is none of its
    // business.
    virtual void restart(const Interval& e) { e_ = e; }
    // The certificate if the conditions hold for the run's tolerances; nothing if they do not, or cannot be proved.
    // Takes long: ask fails_at_point() first.
    std::optional<Certificate> certify(const Collision& collision) {
        const Ground ground;
        return do_certify(collision);
    }
    // What can be proved here whatever the tolerances, for a collision after which no further flight can be resolved.
    std::optional<Certificate> prove_any(const Collision& collision) {
        const Ground ground;
        auto certificate = do_prove_any(collision);
        if (certificate) certificate->below_rounding = true;
        return certificate;
    }

 protected:
    virtual std::optional<Certificate> do_certify(const Collision& collision) = 0;
    virtual std::optional<Certificate> do_prove_any(const Collision& collision) = 0;
    // How -hddot changes at a collision.
    Trend trend_at(const Collision& collision);

    std::uint32_t sigma_;
    bool autonomous_;
    Interval e_;
    ContactTerms<Evaluator<Interval>> contact_;
    TrendTerms<Evaluator<double>> trend_;
};

// The conditions that the options of the run select, for a contact with restitution e in a mode in which it is open.
// Held contacts in `unpressed` need no contact force.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            std::size_t contact, Mode mode, ContactSet unpressed);
// The same; evaluates e.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, std::size_t contact = 0,
                                                            Mode mode = {}, ContactSet unpressed = {});

// Euclidean norm of an enclosed vector.
Interval norm(const std::vector<Interval>& x);

// When a collision is: its time is known to what the gap's rounding and the resolution of time make of it at this speed,
//     d = (4 err(h) + |hdot| ulp(t))/|hdot|     (theory-gaps.md 1)
Interval instant_of(const Collision& collision, ContactTerms<Evaluator<Interval>>& contact);

// What the program of these neighbours proves, which has run. Nothing where one is not proved pressed, or open. Those that are
// known to need no force (theory-gaps.md 2.7), `unpressed`, need not be pressed.
std::optional<Certificate::Others> others_proved(const Neighbours& neighbours, const Evaluator<Interval>& program,
                                                 ContactSet unpressed);

// kappa of held contact i of these for the one that bounces, of a program that has run.
Interval transmission(const Neighbours& neighbours, const Evaluator<Interval>& program, std::size_t i);

}  // namespace achilles
