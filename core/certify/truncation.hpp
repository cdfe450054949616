// Truncation of a bouncing motion at a collision: bounds on the accumulation time, the base of all truncation
// conditions, and the check that the other contacts keep their states.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "number/float_environment.hpp"
#include "number/interval.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// ---- the accumulation time after an impact of speed w ----

// Bounds on tau_inf - tau_k if -hddot stays in [a_min, a_max] and e^2 a_max/a_min < 1 (theory.md 4). They are attained:
//     A_lo w <= tau_inf - tau_k <= A w,   A = 2 e (1+e)/(a_min (1 - e^2 r)),   A_lo = 2 e (1+e)/(a_max (1 - e^2/r)).
struct AccumulationTime {
    Interval earliest, latest;
};
AccumulationTime accumulation_time_bounds(const Interval& e, const Interval& a_min, const Interval& a_max,
                                          const Interval& w);

// The variation of -hddot along a bouncing motion, at the restart (q, s) and sigma = 0: its value a, its rate b along
// the constrained motion, and its derivative c with respect to sigma = hdot.
struct AccelerationTrend {
    double a = 0.0, b = 0.0, c = 0.0;
};

// Estimate of the accumulation time (s) to second order in w (theory-truncation.md 3):
//     T0 - T0^2 (b/(3a) + c/6),   T0 = 2 e w/(a (1 - e)).    Needs a > 0, e < 1.
double estimated_accumulation_time(const AccelerationTrend& trend, double e, double w);
// The same for any number type.
template <class Number>
Number estimated_accumulation_time(const Number& a, const Number& b, const Number& c, const Number& e,
                                   const Number& w) {
    const Number T0 = 2.0 * e * w / (a * (1.0 - e));
    return T0 - T0 * T0 * (b / (3.0 * a) + c / 6.0);
}
// If the contact sticks at its impacts (theory-friction.md 4.2): the integral I_u (m) of its slip over the bouncing, and
// what the slip adds to the accumulation time (s), both to second order in w. alpha is the acceleration of the slip, and
// c_u is the derivative of -hddot by the slip.
template <class Number>
Number estimated_slip_integral(const Number& a, const Number& alpha, const Number& e, const Number& w) {
    return 2.0 * alpha * e * e * w * w / (a * a * (1.0 - e * e));
}
template <class Number>
Number estimated_delay_by_slip(const Number& a, const Number& alpha, const Number& c_u, const Number& e,
                               const Number& w) {
    const Number K = (1.0 + e) / (1.0 - e), ew = e * w;
    return c_u * alpha / (a * a * a) * (2.0 * K / 3.0 - 2.0) * ew * ew / (1.0 - e * e);
}

// Enclosures of the terms of -hddot = G(q, s, sigma) over a box that contains the bouncing motion. P, Phi and Xi are
// those of model/bouncing.hpp with G in place of hddot.
struct AccelerationBounds {
    Interval start;       // G(q, s, 0) at the collision
    Interval by_sigma;    // dG/dsigma over the box
    Interval P, Phi, Xi;  // over the box
};

// Encloses the accumulation time to third order in w (theory-truncation.md 4). `trend` may be any doubles with a > 0;
// the trend of the collision gives the tightest result. Let T be the upper end of `latest`, h_m = (e w)^2/(2 a_min) and
// K = (1+e)/(1-e). Then
//     delta = -hddot - a = b t + c hdot + R,   |R| <= rho
//     rho = |G(q,s,0) - a| + |G_sigma - c| w + |P - b| T + |mid Phi| h_m + rad(Phi) w T + |Xi| w^2 T
//     |tau_inf - tau_k - (T0 - T0^2 (b/(3a) + c/6))| <= T (2 rho/(a (1-e)) + d_m S)
//     d_m = max |a_max - a|, |a - a_min|
//     S = T (|cA| + 1.09 |cB| + |cE|) + 2 z_m (|cC| + |cD| + |cF| + |cG|),  z_m = w sqrt(max(e, e'')^2 + e^2 a/a_min)
// Proof: for any constant a, Theta = (hdot + K z)/a with z = sqrt(hdot^2 + 2 a h) is continuous across impacts and
// falls at the rate 1 if hddot = -a. The contribution of delta is integrated by parts with the quadratic form Psi in
// (t, hdot, z), which is also continuous across impacts and has the coefficients cA to cG. The result is undefined if
// the enclosures are.
Interval third_order_accumulation_time(const AccelerationTrend& trend, const AccelerationBounds& drift,
                                       const Interval& e, const Interval& a_min, const Interval& a_max,
                                       const Interval& w, const Interval& latest);
// Only the bound T (2 rho/(a (1-e)) + d_m S); its upper end is the result.
Interval third_order_error(const AccelerationTrend& trend, const AccelerationBounds& drift, const Interval& e,
                           const Interval& a_min, const Interval& a_max, const Interval& w, const Interval& latest);

// ---- the truncation conditions: PaperConditions, SharpConditions and StickingConditions ----

// Whether a contact sticks at its impacts, rather than sliding or having no friction.
inline bool sticks_at_impacts(const Model& model, const BouncingKey& key) {
    return key.state == ContactState::held && model.equations().friction.contains(key.contact);
}

// A collision, with all quantities that the conditions may use.
struct Collision {
    State before;            // (q, v-) at tau_k, h(q) = 0
    double speed = 0.0;      // w = |hdot| before
    Vector tangential;       // s = v- - n hdot
    Vector restart;          // after reinitialization: s, or v*
    Vector position = {};    // q at the restart of a contact that sticks at its impacts; else empty
    bool is_capped = false;  // with friction: the restitution of the impact was reduced, so that no energy is gained
    // The same position and time with another velocity.
    State with(const Vector& v) const { return {before.q, v, before.t}; }
};

// Whether a proof will probably fail at an impact speed, from earlier proofs and guesses. It never replaces a proof.
class SpeedGuess {
 public:
    // Extrapolates the last proof or guess, because the bounds fall with a power of w.
    bool fails(double speed);
    // A proof or guess at this speed was too wide by a factor that falls with this power of the speed.
    void remember(double speed, double too_wide, int power);

 private:
    double wide_speed_ = 0.0, too_wide_ = 0.0;
    int power_ = 3;
    double last_speed_ = 0.0;  // speed of the last collision that was examined
};

// A box around a collision in q, s and t: the rounding of the computed state, and radii beyond that.
struct CollisionBox {
    std::vector<Interval> q0, s0;
    std::vector<double> q_radius, s_radius;
    Interval t0;            // tau_k
    double duration = 0.0;  // s

    explicit CollisionBox(std::size_t dof) : q0(dof), s0(dof), q_radius(dof), s_radius(dof) {}
    // Writes q and s as the first variables.
    void put_into(std::vector<Interval>& variables) const;
    Interval time() const { return {t0.lo(), (Interval(t0.hi()) + Interval(duration)).hi()}; }
};

// Base of the conditions for truncating the bouncing of one contact or the chatter of a pair. It holds the tolerances
// of the run, the proof for the other contacts, and the common part of all certificates. Certificates need the
// floating-point environment of a FloatEnvironmentGuard. Constructors take one as evidence; certify() and prove_any()
// create their own.
class ConditionsBase {
 protected:
    // A box has one interval for each of the variables. `others` is null if there are no other contacts. Those in
    // `unpressed` need no contact force.
    ConditionsBase(const Model& model, const Run& run, const OtherContactTerms* others,
                   std::vector<std::uint32_t> variables, ContactSet unpressed, const FloatEnvironmentGuard&);

 public:
    // Which contact or joint is not proved to keep its state, since the last proof failed for that reason.
    const std::optional<BouncingObstacle>& obstacle() const { return obstacle_; }
    // The contacts that do not count, from the next proof on: their gaps must stay below zero; and those held by a
    // latch, which nothing need press (theory-modes.md 3, 4).
    void set_states(ContactSet inactive, ContactSet latched) {
        inactive_ = inactive;
        latched_ = latched;
    }

 protected:
    void set_box(auto& program, const std::vector<Interval>& box) const {
        for (std::size_t i = 0; i < variables_.size(); ++i) program.input(variables_[i]) = box[i];
    }
    // Whether the other contacts are proved to keep their states (theory-gaps.md 2.3): over the box every held contact
    // is pressed, impulses press it further, and every other gap is open; and whether no jump happens, no latch ends and
    // the bouncing contacts count. If there are others, `proved` receives their bounds. With friction: also that all
    // contacts and joints stick or slide as they do, for the restitution e; `ratio` encloses p_T/p of the impulses of a
    // contact that sticks at its impacts.
    bool prove_other_contacts_stay(const std::vector<Interval>& box,
                                   std::optional<Certificate::OtherContactBounds>& proved,
                                   const Interval& e = Interval(0.0), const Interval& ratio = Interval(0.0));
    // A certificate with tau_inf in [tau_k + earliest, tau_k + latest]. Its estimate of tau_inf is clamped to that
    // interval, and to at least tau_k.
    Certificate certificate_at(double tau_k, const AccumulationTime& accumulation_time, double estimated) const;
    // Adds the decision by the half width of the time interval and the shadowing bounds.
    void decide(Certificate& certificate, double half_width) const;

    std::size_t dof_;
    Truncation truncation_;
    std::optional<BouncingObstacle> obstacle_;

 private:
    std::vector<std::uint32_t> variables_;
    bool is_alone_;  // there is no other contact; there may be joints
    ContactSet unpressed_, inactive_, latched_;
    const OtherContactTerms* other_contact_terms_;
    Evaluator<Interval> other_contact_program_, impact_law_program_;
    std::uint32_t impulse_ratio_, sliding_speed_;  // inputs
};

// How much a certificate must contain. `decision`: what decides the truncation, and what the further motion depends on.
// The enclosure of the accumulation time may then be wider, because no report has it.
enum class CertificateScope { full, decision };

class TruncationConditions : protected ConditionsBase {
 public:
    using ConditionsBase::obstacle;
    using ConditionsBase::set_states;
    TruncationConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key,
                         ContactSet unpressed, const FloatEnvironmentGuard& ground);
    virtual ~TruncationConditions() = default;
    // Fast check: true if the conditions obviously fail.
    virtual bool fails_at_point(const Collision& collision) = 0;
    // Faster check, by the impact speed w and the results at earlier collisions.
    virtual bool fails_by_speed(double /*speed*/) { return false; }
    // Prepares for another run with this restitution and the same equations of motion: results at earlier collisions
    // are discarded.
    virtual void restart(const Interval& e) { e_ = e; }
    // The certificate if the conditions are proved for the tolerances of the run; otherwise nullopt. Slow: call
    // fails_at_point() first.
    std::optional<Certificate> certify(const Collision& collision, CertificateScope scope = CertificateScope::full) {
        const FloatEnvironmentGuard ground;
        return do_certify(collision, scope);
    }
    // The certificate that can be proved here whatever the tolerances, for a collision after which no further flight
    // can be resolved numerically.
    std::optional<Certificate> prove_any(const Collision& collision) {
        const FloatEnvironmentGuard ground;
        auto certificate = do_prove_any(collision);
        if (certificate) certificate->cut_at_resolution = true;
        return certificate;
    }
    // The restart of the motion in contact, before it is projected. A contact that sticks at its impacts drifts.
    virtual State restart_at(const Collision& collision) { return collision.with(collision.restart); }

 protected:
    virtual std::optional<Certificate> do_certify(const Collision& collision, CertificateScope scope) = 0;
    virtual std::optional<Certificate> do_prove_any(const Collision& collision) = 0;
    // The variation of -hddot at a collision.
    AccelerationTrend trend_at(const Collision& collision);
    // Encloses over a box by how much each acceleration changes at the Zeno point, where forces begin to see the contact
    // (theory-modes.md 5).
    void find_change(const std::vector<Interval>& box);
    // What this change adds to the distance of a velocity, because the run makes it at the estimated Zeno time of the
    // certificate. `growth` bounds how distances grow until then.
    Interval late_change(std::size_t i, const Certificate& certificate, const Interval& growth) const;

    std::uint32_t sigma_;
    bool autonomous_;
    Interval e_;
    ContactState state_;
    ContactTerms<Evaluator<Interval>> contact_;
    TrendTerms<Evaluator<double>> trend_;
    std::vector<Interval> change_;  // sizes, of every acceleration; 0 if no force sees the contact

 private:
    std::optional<Evaluator<Interval>> change_program_;
};

// The conditions selected by the options of the run, for a contact with restitution e; Model::has_bouncing() must be
// true. Held contacts in `unpressed` need no contact force.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            const BouncingKey& key, ContactSet unpressed);
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            std::size_t contact, Mode mode, ContactSet unpressed);
// The same; evaluates e.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, std::size_t contact = 0,
                                                            Mode mode = {}, ContactSet unpressed = {});

// Euclidean norm of an enclosed vector.
Interval norm(const std::vector<Interval>& x);

// The interval of the time of a collision (s): its uncertainty follows from the rounding of the gap and the resolution
// of time at this speed,
//     d = (4 err(h) + |hdot| ulp(t))/|hdot|     (theory-gaps.md 1)
Interval instant_of(const Collision& collision, ContactTerms<Evaluator<Interval>>& contact);

// The bounds on the other contacts from the outputs of their program, which must have run. Returns nullopt if one of
// them is not proved pressed, or open, a function is not proved positive, or a jump is not excluded. Contacts in
// `unpressed`, which need no force (theory-gaps.md 2.7), need not be pressed; `latched` ones may pull; the gaps of
// `inactive` ones must be negative. `obstacle`, if not null, receives what is not proved.
std::optional<Certificate::OtherContactBounds> bounds_on_other_contacts(
    const OtherContactTerms& other_contact_terms, const Evaluator<Interval>& program, ContactSet unpressed,
    ContactSet inactive = {}, ContactSet latched = {}, std::optional<BouncingObstacle>* obstacle = nullptr);

// kappa of held contact i for the bouncing contact, from a program that has run.
Interval transmission(const OtherContactTerms& other_contact_terms, const Evaluator<Interval>& program, std::size_t i);

}  // namespace achilles
