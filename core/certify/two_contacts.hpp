// Proves how long two contacts that chatter together bounce on until both rest, and how far the motion that holds both
// is from theirs (theory-gaps.md 3).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "certify/truncation.hpp"
#include "model/model.hpp"

namespace achilles {

using PairMatrix = std::array<std::array<Interval, 2>, 2>;

// Bounds on the pair at a collision, in units of its energy E = sigma' W^-1 sigma/2 + lambda' h, r0 = sqrt(2 E).
struct PairAtCollision {
    std::array<Interval, 2> a, lambda, e;  // -hddot, the forces that hold both, the restitutions
    PairMatrix W;
    Interval r0;
    // Upper bounds over the neighborhood: Delta of |W^-1/2 (hddot + a)|, omega of |W^-1/2 (W(q) - W) W^-1/2|.
    Interval Delta, omega;
};
// Bounds until both contacts rest: tau_inf - tau_k <= T, integral of h_i <= J/lambda_i, of |sigma_i sigma_j| <= 2 d_i
// d_j J, with d_i = sqrt(W_ii). sqrt(2 E) grows at most by the factor m.
struct PairBound {
    Interval T, J, m;
};
// Returns nullopt if no eta is admissible, for example if a restitution is 1.
std::optional<PairBound> pair_bound(const PairAtCollision& pair);

// A collision of the pair: the state before it, and the gaps h and gap rates sigma = hdot of the two contacts.
struct PairCollision {
    State before;
    std::array<double, 2> h, sigma;
};

// A truncation of the impacts of a pair.
struct PairCompletion {
    Certificate certificate;
    State restart;  // (q - N h, s - B h), to be projected onto all contact surfaces
};

// Base of the conditions for two contacts: the box around a cut, and the shadow of the motion in it.
class TwoContactConditions : protected ConditionsBase {
 public:
    using ConditionsBase::set_states;
    // For two contacts while others are held; those in `unpressed` need no contact force. In the mode `closed` the two
    // are held, too, and slide if they have friction.
    TwoContactConditions(const Model& model, const Run& run, const std::array<Interval, 2>& e, std::size_t first,
                         std::size_t second, Mode closed, ContactSet unpressed, const FloatEnvironmentGuard& ground);

 protected:
    // Neighborhood: `duration` and `growth` are assumed values of T and m.
    struct PairBox : CollisionBox {
        double growth = 1.0;
        std::vector<Interval> all;  // q, s, the two sigma, t
        explicit PairBox(std::size_t dof) : CollisionBox(dof), all(2 * dof + 3) {}
    };
    // Upper bounds on the motion until both contacts rest: its duration, the growth m of sigma, h_k <= peak/force_k, and
    // the integrals of h_k and of |sigma_0^2|, |sigma_0 sigma_1|, |sigma_1^2|.
    struct MotionBounds {
        Interval T, growth, peak;
        std::array<Interval, 2> force, gap;
        std::array<Interval, 3> products;
    };
    // Evaluates the terms of the pair over a box. Returns whether both W_ii are proved positive.
    bool evaluate_terms(const std::vector<Interval>& box);
    // The terms at a state with sigma = 0.
    bool evaluate_terms_at(const State& tangential);
    // s = v - N sigma; leaves the terms of the collision in point_.
    State tangential_of(const PairCollision& collision);
    // A first box for a motion of this duration; point_ must be at the tangential state.
    PairBox first_box(const PairCollision& collision, const State& tangential, double duration, double growth);
    // Sets the variables of the box; |sigma_k| <= size_k growth r0.
    void update(PairBox& box, const std::array<Interval, 2>& size, const Interval& r0) const;
    // Whether the motion and the shifted variables are proved to stay inside the box. If not, the box grows to the
    // required size. terms_ must be those over the box.
    bool contain(PairBox& box, const MotionBounds& bounds);
    // Adds the bounds on the shadow of the motion to a certificate.
    void add_shadow(Certificate& c, const PairBox& box, const MotionBounds& bounds);
    // (q - N h, s - B h)
    State restart_of(const PairCollision& collision, const State& tangential) const;
    // Whether the bounds of a certificate are within the tolerances of the run.
    static bool is_accepted(const Certificate& certificate);

    Layout layout_;
    std::array<Interval, 2> e_;
    PairTerms<Evaluator<Interval>> terms_;
    PairTerms<Evaluator<double>> point_;
};

class PairConditions : private TwoContactConditions {
 public:
    using TwoContactConditions::set_states;
    using TwoContactConditions::TwoContactConditions;

    // The certificate for a truncation at this collision, and the state after it. nullopt if the proof fails or its
    // bounds exceed the tolerances of the run. With `cut_at_resolution` the tolerances do not matter: time cannot
    // resolve the flights any more.
    std::optional<PairCompletion> certify(const PairCollision& collision, bool cut_at_resolution);

 private:
    std::optional<PairAtCollision> at_collision(const PairCollision& collision, const State& shifted);
    static MotionBounds motion_bounds(const PairBound& bound, const PairAtCollision& pair);
    Certificate certificate_of(const PairBox& box, const PairBound& bound, const PairAtCollision& pair,
                               const PairCollision& collision);
};

// x' W^-1 y for 2-vectors and a symmetric W.
Interval by_inverse(const PairMatrix& W, const std::array<Interval, 2>& x, const std::array<Interval, 2>& y);
// Bound of |W0^-1/2 (W + skew [0 1; -1 0] - W0) W0^-1/2|, for symmetric W and W0.
Interval deviation(const PairMatrix& W, const PairMatrix& W0, const Interval& skew = Interval(0.0));
// The upper end of an interval, as a point.
inline Interval top(const Interval& x) { return Interval(x.hi()); }

}  // namespace achilles
