// An independent implementation of Def. 7 of the paper (theory.md 3.1) for any neighborhood, to test core/certify.
#pragma once

#include <optional>

#include "certify/range.hpp"
#include "certify/truth.hpp"

namespace achilles::test {

class Definition7 {
 public:
    Definition7(const Model& model, const Run& run, std::size_t contact = 0, Mode mode = {});

    // The bounds on time, position and velocity per unit of impact speed: eps_t/c1, eps_q'/c2, eps_v'/c3.
    struct Factors {
        double time, position, velocity;
    };
    // With the maxima over the neighborhood of radii eps_q' and eps_v', for autonomous systems. Returns nullopt if
    // a_min > 0 and e' < 1 are not proved.
    std::optional<Factors> over(const Collision& collision, double eps_q, double eps_v);
    // With the maxima replaced by the values at the restart: a lower bound for every choice of V.
    Factors at(const Collision& collision);

 private:
    struct Maxima {
        double a_min, a_max, beta, eta, zeta;
    };
    Factors factors(const Collision& collision, const Maxima& maxima);

    std::size_t dof_;
    bool kinetic_;
    double e_;
    Range hddot_;
    Definition7Terms<Evaluator<Interval>> box_;
    Definition7Terms<Evaluator<double>> point_;
    ContactTerms<Evaluator<double>> surface_;
};

}  // namespace achilles::test
