// The time that two contacts which chatter together still need until both rest, and how far the motion that holds both is
// from theirs (theory-gaps.md 3).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "certify/truncation.hpp"
#include "model/model.hpp"

namespace achilles {

// What is known of the pair at a collision, in units of its energy E = sigma' W^-1 sigma/2 + lambda' h, r0 = sqrt(2 E).
struct PairAtCollision {
    std::array<Interval, 2> a, lambda, e;  // -hddot, the forces that hold both, restitutions
    std::array<std::array<Interval, 2>, 2> W;
    Interval r0;
    // Over the neighbourhood: |W^-1/2 (hddot + a)| and |W^-1/2 (W(q) - W) W^-1/2| are at most these.
    Interval Delta, omega;
};
// T, and J: tau_inf - tau_k <= T, integral of h_i <= J/lambda_i, of |sigma_i sigma_j| <= 2 d_i d_j J, d_i = sqrt(W_ii). m is
// by how much sqrt(2 E) may grow on the way.
struct PairBound {
    Interval T, J, m;
};
// Nothing where no eta is admissible, as with a restitution of 1.
std::optional<PairBound> pair_bound(const PairAtCollision& pair);

// A collision of the pair: the state before it, h and hdot of the two.
struct PairCollision {
    State before;
    std::array<double, 2> h, sigma;
};

class PairConditions : protected ConditionsBase {
 public:
    // While others are held, of which `unpressed` need no force.
    PairConditions(const Model& model, const Run& run, const std::array<Interval, 2>& e, std::size_t first,
                   std::size_t second, Mode mode, ContactSet unpressed, const Ground& ground);

    struct Completion {
        Certificate certificate;
        State restart;  // (q - N h, s - B h), to be projected onto all surfaces
    };
    // The certificate where it is within the run's tolerances, or, of a chatter that cannot be resolved any more, whatever it is.
    std::optional<Completion> certify(const PairCollision& collision, bool below_rounding);

 private:
    // T and m as they are assumed: duration, growth.
    struct Box : CollisionBox {
        double growth = 1.0;
        std::vector<Interval> all;  // q, s, the two sigma, t
        explicit Box(std::size_t dof) : CollisionBox(dof), all(2 * dof + 3) {}
    };
    bool look(const std::vector<Interval>& box);
    std::optional<PairAtCollision> at_collision(const PairCollision& collision, const State& shifted);
    bool contain(Box& box, const PairBound& bound, const PairAtCollision& pair);
    Certificate certificate_of(const Box& box, const PairBound& bound, const PairAtCollision& pair,
                               const PairCollision& collision) const;

    Layout layout_;
    std::array<Interval, 2> e_;
    PairTerms<Evaluator<Interval>> terms_;
    PairTerms<Evaluator<double>> point_;
};

}  // namespace achilles
