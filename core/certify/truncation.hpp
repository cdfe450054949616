// May the bouncing be cut short at this collision? Two sets of conditions answer with a certificate, or not at all.
#pragma once

#include <memory>
#include <optional>

#include "certify/zeno_time.hpp"
#include "model/model.hpp"
#include "number/ground.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// Everything the conditions may look at.
struct Collision {
    State before;        // (q, v-) at tau_k, h(q) = 0
    double speed = 0.0;  // w = |hdot| before
    Vector tangential;   // s = v- - n hdot
    Vector restart;      // after reinitialization: s, or v*
    // The same place and time with another velocity.
    State with(const Vector& v) const { return {before.q, v, before.t}; }
};

// No certificate is made but on a Ground: whoever constructs the conditions shows one, and the questions stand on one
// of their own.
class TruncationConditions {
 public:
    explicit TruncationConditions(const Ground&) {}
    virtual ~TruncationConditions() = default;
    // Quick: true where they can be seen not to hold.
    virtual bool fails_at_point(const Collision& collision) = 0;
    // Quicker: the same by the impact speed w alone, and what the collisions before have shown.
    virtual bool fails_by_speed(double /*speed*/) { return false; }
    // Another run begins, of this restitution and the same motion: what the collisions before have shown is none of its
    // business.
    virtual void restart(const Interval& e) = 0;
    // The certificate if the conditions hold for the run's tolerances; nothing if they do not, or cannot be proved.
    // Takes long: ask fails_at_point() first.
    std::optional<Certificate> certify(const Collision& collision) {
        const Ground ground;
        return do_certify(collision);
    }
    // What can be proved here whatever the tolerances, for a collision after which no further flight can be resolved.
    std::optional<Certificate> prove_any(const Collision& collision) {
        const Ground ground;
        return do_prove_any(collision);
    }

 protected:
    virtual std::optional<Certificate> do_certify(const Collision& collision) = 0;
    virtual std::optional<Certificate> do_prove_any(const Collision& collision) = 0;
};

// The conditions that the run asks for, of a contact with restitution e while others are held, of which `unpressed` need no
// force.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            std::size_t contact, ContactSet held, ContactSet unpressed);
// The same for one question: e is evaluated.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, std::size_t contact = 0,
                                                            ContactSet held = {}, ContactSet unpressed = {});

// Euclidean norm of an enclosed vector.
Interval norm(const std::vector<Interval>& x);

// When a collision is: its time is known to what the gap's rounding and the resolution of time make of it at this speed,
//     d = (4 err(h) + |hdot| ulp(t))/|hdot|     (theory-gaps.md 1)
Interval instant_of(const Collision& collision, ContactTerms<Evaluator<Interval>>& contact);

// How -hddot changes at a collision.
Trend trend_at(TrendTerms<Evaluator<double>>& terms, const Collision& collision);

// Writes into the certificate that tau_inf lies between tau_k + earliest and tau_k + latest, and where it is estimated:
// inside, and not before tau_k.
void set_zeno_time(Certificate& certificate, double tau_k, const Wait& wait, double estimated);

}  // namespace achilles
